#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "common/core/poly_mesh.h"
#include "strake/render/line_file.h"

namespace strake {

/// What a ray meets.
struct Hit {
  enum class Kind : std::uint8_t { nothing, surface, line };
  Kind kind = Kind::nothing;
  Vec3 position;
  Vec3 geometric_normal;  ///< unit; of surfaces along the face's orientation
  Vec3 shading_normal;    ///< unit; of surfaces: interpolated over the face, not across creases
  Index face = kNone;     ///< of the mesh, surfaces only
  Index line = kNone;     ///< of the line set, lines only
};

/// What is moved and scaled to be centred and of size 1.
struct SceneFrame {
  Vec3 centre = Vec3::Zero();
  double diagonal = 1;
};

/// A plane across an axis of the scene; what lies beyond it, or before it, is left out.
struct Section {
  int axis = 0;      ///< 0, 1, 2
  double place = 0;  ///< in the scene's frame
  bool is_flipped = false;
};

/// A polygon mesh with lines on it, ready for rays.
///
/// Everything is moved and scaled so that the mesh's bounding box is centred and its diagonal is 1.
class Scene {
 public:
  /// \param name  of the mesh, for messages
  /// \param flat  one normal per face instead of normals that are averaged over smooth vertices
  /// \throw InputError where the mesh has no face or no extent
  /// \param frame  of something else that the mesh is to be shown like; default: its bounding box
  Scene(PolyMesh mesh, const std::string& name, bool flat,
        const std::optional<SceneFrame>& frame = {});
  ~Scene();

  /// Adds polylines (model coordinates) as thin tubes; once, before `commit`.
  void add_lines(const Polylines& lines, double radius);
  /// Builds the acceleration structure; after it the scene is read only.
  void commit();

  [[nodiscard]] Hit trace(const Vec3& origin, const Vec3& direction) const;
  /// Whether the surface (not a line) is met within `reach`.
  [[nodiscard]] bool is_blocked(const Vec3& origin, const Vec3& direction, double reach) const;

  /// Whether every edge has two faces: a cut through it has an inside.
  [[nodiscard]] bool is_closed() const;
  [[nodiscard]] const PolyMesh& mesh() const { return mesh_; }
  /// Moves a point from model coordinates into the scene's.
  [[nodiscard]] Vec3 place(const Vec3& point) const { return scale_ * (point - centre_); }

 private:
  void normalise(const std::string& name, const std::optional<SceneFrame>& frame);
  void build_surface(bool flat);
  void attach(RTCGeometry geometry, unsigned id, unsigned mask);

  template <auto Release>
  struct Releaser {
    template <class T>
    void operator()(T* handle) const {
      Release(handle);
    }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>> scene_;

  PolyMesh mesh_;
  Vec3 centre_ = Vec3::Zero();
  double scale_ = 1;
  std::vector<Index> triangle_face_;                            // [T]
  std::vector<std::array<Eigen::Vector3f, 3>> corner_normals_;  // [T]
  std::vector<Index> segment_line_;                             // of each tube segment
};

}  // namespace strake

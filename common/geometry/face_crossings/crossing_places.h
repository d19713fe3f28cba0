#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/placed_face.h"
#include "common/geometry/face_crossings/shared_edges.h"

namespace strake {

/// Faces of a result that meet others in more than what they share, ascending.
struct MeetingFaces {
  std::vector<Index> all;
  /// Those that pass through others. The rest only touch them, as sheets do that were joined in an
  /// edge of more than two faces: nobody sees that, but their edges there are divided differently.
  std::vector<Index> crossing;
};

/// What is thought of faces of a result that are tangled where the input crosses itself.
enum class Tangles : std::uint8_t { kAsTheInput, kFaults };

/// Finds where faces of results cross although the surface does not.
class CrossingPlaces {
 public:
  /// \param mesh  the input, kept by reference
  explicit CrossingPlaces(const TriMesh& mesh, Tangles tangles = Tangles::kAsTheInput)
      : mesh_(mesh), tangles_(tangles) {}

  /// The faces that meet others, but for pairs within reach of which, of either face, the input
  /// crosses itself; those that are tangled count there, too, if tangles are faults.
  MeetingFaces meeting(const PolyMesh& result);
  /// All of them.
  std::vector<Index> faces_of(const PolyMesh& result) { return meeting(result).all; }
  /// The middles of those that cross others, relative to the mesh's origin.
  std::vector<Vec3> of(const PolyMesh& result) { return middles(result, meeting(result).crossing); }
  /// The middles of faces, relative to the mesh's origin.
  [[nodiscard]] std::vector<Vec3> middles(const PolyMesh& result,
                                          const std::vector<Index>& faces) const;
  /// Whether the last result has more pairs of faces that meet, whatever the input does, than
  /// faces: sheets on top of each other, where all that is measured takes many times as long, says
  /// little, and what is put there crosses again.
  [[nodiscard]] bool is_stacked() const { return is_stacked_; }
  /// Whether faces of the input cross near those of results that meet others.
  [[nodiscard]] bool input_crosses() const { return !crossing_.empty(); }

 private:
  /// A ball around a face of a result, relative to the input's origin.
  struct Place {
    Vec3 middle;
    double reach = 0;  ///< of its corners
  };

  /// Pairs of faces of a result that hang together.
  struct Cluster {
    std::size_t pairs = 0;
    std::vector<std::size_t> faces;  ///< places in the list of those that meet others
  };

  /// Boxes that were looked into at the same time.
  struct Look {
    std::vector<BoxTree::Box> boxes;
    BoxTree tree;
  };

  [[nodiscard]] Place place_of(const PolyMesh& result, Index face) const;
  [[nodiscard]] bool is_looked_at(const Place& place) const;
  /// Finds out which faces of the input within reach of these places cross others.
  void look_around(const std::vector<Place>& places);
  /// Whether the input crosses itself within reach of a place that was looked around.
  [[nodiscard]] bool is_crossed_by_itself(const Place& place) const;
  /// Calls visit(i) for the places within reach where the input crosses itself, as long as it
  /// returns true.
  template <class Visit>
  void visit_crossings(const Place& place, Visit visit) const;
  /// The pairs that meet where the input crosses itself.
  /// \param faces   of the pairs
  /// \param is_own  [F] 1: the input crosses itself there
  static std::vector<Cluster> clusters_of(const std::vector<std::array<Index, 2>>& pairs,
                                          const std::vector<Index>& faces,
                                          const std::vector<std::uint8_t>& is_own);
  /// Whether there are many more pairs than two sheets that cross have, and the input.
  /// \param places  of all faces that meet others
  [[nodiscard]] bool is_tangled(const Cluster& cluster, const std::vector<Place>& places) const;
  /// Whether two faces that meet only touch each other.
  [[nodiscard]] bool do_touch(const PolyMesh& result, Index face, Index other);
  /// Whether an edge of the face runs along edges that sheets share, and the other one passes
  /// through it there by no more than chords of a curve may be apart.
  [[nodiscard]] bool touches_along_shared(const PolyMesh& result, Index face,
                                          const PlacedFace& other, double depth) const;

  const TriMesh& mesh_;
  Tangles tangles_;
  bool is_stacked_ = false;
  std::vector<Look> looks_;
  std::vector<std::uint8_t> is_seen_;           ///< [F] of the input: whether it crosses is known
  std::vector<std::array<Index, 2>> crossing_;  ///< pairs of those seen that cross
  BoxTree own_{{}};                             ///< around these
  std::unique_ptr<SharedEdges> shared_;         ///< nullptr: not looked for yet
};

}  // namespace strake

#include "stages/import/shallow_creases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace strake::import {
namespace {

constexpr double kSimilar = 0.5;  ///< share of the bend from which on another one is of its kind
constexpr double kNear = 0.05;    ///< share of the diagonal
constexpr int kMostFaces = 1000;  ///< that a way crosses

/// What a way across the surface comes to.
struct Outlook {
  bool turns_near = false;  ///< by so much in all
  bool bends = false;       ///< by so much at one edge
};

/// A straight way over the surface, unfolded.
class StraightWay {
 public:
  /// Starts in the middle of a half-edge, at right angles into its face.
  StraightWay(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h)
      : mesh_(mesh), normals_(normals), halfedge_(h), place_((at(h) + end(h)) / 2) {
    heading_ = inwards(h);
  }

  /// Goes on to the next edge. \return false where there is none
  bool advance() {
    const Index first = TriMesh::next(halfedge_);
    const Index second = TriMesh::next(first);
    // The corner opposite is on one side of the way; the edge on the other side is left through.
    const Vec3 side = normals_[TriMesh::face_of(halfedge_)].cross(heading_);
    const Index out = (at(second) - place_).dot(side) > 0 ? first : second;
    const Vec3 along = end(out) - at(out);
    const double slope = along.dot(side);
    if (slope == 0) return false;
    const double t = std::clamp((place_ - at(out)).dot(side) / slope, 0.0, 1.0);
    const Vec3 next = at(out) + t * along;
    length_ += (next - place_).norm();
    place_ = next;
    halfedge_ = out;
    return true;
  }

  /// Crosses the edge that it came to. \pre no boundary
  void cross() {
    const Vec3 along = (end(halfedge_) - at(halfedge_)).stableNormalized();
    const double share = heading_.dot(along);
    halfedge_ = mesh_.twin[halfedge_];
    heading_ = share * along + std::sqrt(std::max(0.0, 1 - share * share)) * inwards(halfedge_);
  }

  [[nodiscard]] Index halfedge() const { return halfedge_; }
  [[nodiscard]] double length() const { return length_; }

 private:
  [[nodiscard]] const Vec3& at(Index h) const { return mesh_.positions[mesh_.from(h)]; }
  [[nodiscard]] const Vec3& end(Index h) const { return mesh_.positions[mesh_.to(h)]; }
  /// Unit, in the face of a half-edge and at right angles to it.
  [[nodiscard]] Vec3 inwards(Index h) const {
    return normals_[TriMesh::face_of(h)].cross((end(h) - at(h)).stableNormalized()).normalized();
  }

  const TriMesh& mesh_;
  const std::vector<Vec3>& normals_;
  Index halfedge_;
  Vec3 place_;
  Vec3 heading_;
  double length_ = 0;
};

/// Angle from one normal to another one around an axis.
double turn_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return std::atan2(from.cross(to).dot(axis), from.dot(to) - from.dot(axis) * to.dot(axis));
}

Outlook look_across(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h, double bend) {
  const Vec3 axis = (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).stableNormalized();
  Outlook outlook;
  StraightWay way(mesh, normals, h);
  double turned = 0;
  for (int face = 0; face < kMostFaces && way.advance(); ++face) {
    const Index edge = way.halfedge();
    if (mesh.is_barrier(edge)) break;
    const double turn = turn_about(axis, normals[TriMesh::face_of(edge)],
                                   normals[TriMesh::face_of(mesh.twin[edge])]);
    turned += turn;
    const bool is_near = way.length() <= kNear * mesh.diagonal;
    outlook.turns_near |= is_near && std::abs(turned) > kSimilar * bend;
    outlook.bends |= std::abs(turn) > kSimilar * bend;
    if (outlook.bends || (outlook.turns_near && !is_near)) break;
    way.cross();
  }
  return outlook;
}

/// Whether the way into the face of a half-edge goes on for `length` before the next barrier.
bool goes_on(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h, double length) {
  StraightWay way(mesh, normals, h);
  for (int face = 0; face < kMostFaces && way.advance(); ++face) {
    if (way.length() >= length) return true;
    if (mesh.is_barrier(way.halfedge())) return false;
    way.cross();
  }
  return false;
}

}  // namespace

bool lies_across(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h) {
  const double width = (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
  return goes_on(mesh, normals, h, width) && goes_on(mesh, normals, mesh.twin[h], width);
}

bool stands_alone(const TriMesh& mesh, const std::vector<Vec3>& normals, Index h, double bend) {
  const Outlook here = look_across(mesh, normals, h, bend);
  if (here.turns_near) return false;
  const Outlook there = look_across(mesh, normals, mesh.twin[h], bend);
  return !there.turns_near && !(here.bends && there.bends);
}

}  // namespace strake::import

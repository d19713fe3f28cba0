#include "stages/import/divide_long_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/topology.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake::import {
namespace {

/// Of the wanted length, below which a face is a needle: no piece of it would be less of one.
constexpr double kNeedle = 0.005;
/// Cosine up to which an edge goes on straight from another one: 10 degrees.
constexpr double kStraightOn = 0.985;

double longest_edge(const TriMesh& mesh) {
  double longest = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h)
    longest = std::max(longest, edge_length(mesh, h));
  return longest;
}

/// The height of a face over its longest edge.
double face_width(const TriMesh& mesh, Index f) {
  double longest = 0;
  for (Index h = 3 * f; h < 3 * f + 3; ++h) longest = std::max(longest, edge_length(mesh, h));
  const auto& [a, b, c] = mesh.faces[f];
  const Vec3& p = mesh.positions[a];
  return (mesh.positions[b] - p).cross(mesh.positions[c] - p).norm() / longest;
}

/// Whether a half-edge leaves a corner in the direction in which a feature comes to it.
bool goes_on_from_feature(const TriMesh& mesh, Index h) {
  const Index v = mesh.from(h);
  if (mesh.is_corner[v] == 0) return false;
  const auto way = [&](Index edge) {
    return Vec3((mesh.positions[mesh.to(edge)] - mesh.positions[mesh.from(edge)]).normalized());
  };
  return any_outgoing(mesh, v, [&](Index out) {
    return mesh.is_feature[out] != 0 && way(out).dot(way(h)) < -kStraightOn;
  });
}

/// Whether an edge leads from the end of one feature to that of another one in a row with it.
bool joins_features_in_a_row(const TriMesh& mesh, Index h) {
  const Index twin = mesh.twin[h];
  return twin != kNone && mesh.is_feature[h] == 0 && goes_on_from_feature(mesh, h) &&
         goes_on_from_feature(mesh, twin);
}

/// Edges that are longer than a length, or join features in a row, and have a face beside them that
/// is no needle.
class LongEdges {
 public:
  LongEdges(const TriMesh& mesh, double length, double least_width)
      : mesh_(mesh), length_(length), least_width_(least_width) {}

  /// Calls use(half-edge) once for each.
  template <class Use>
  void for_each(const Use& use) const {
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (mesh_.edge_of(h) != h || !is_worth(h)) continue;
      if (edge_length(mesh_, h) > length_ || joins_features_in_a_row(mesh_, h)) use(h);
    }
  }

 private:
  [[nodiscard]] bool is_worth(Index h) const {
    const auto is_wide = [&](Index side) {
      return side != kNone && face_width(mesh_, TriMesh::face_of(side)) >= least_width_;
    };
    return is_wide(h) || is_wide(mesh_.twin[h]);
  }

  const TriMesh& mesh_;
  double length_;
  double least_width_;
};

/// The new vertex of each of the edges.
/// \return [3F] kNone of the others
std::vector<Index> halve(const std::vector<Index>& edges, TriMesh& mesh) {
  std::vector<Index> middle(static_cast<std::size_t>(mesh.halfedge_count()), kNone);
  for (const Index h : edges) {
    middle[h] = mesh.vertex_count();
    if (mesh.twin[h] != kNone) middle[mesh.twin[h]] = middle[h];
    const Index a = mesh.from(h);
    const Index b = mesh.to(h);
    mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
    mesh.source_vertex.push_back(kNone);
    mesh.is_corner.push_back(0);
    if (mesh.attributes.colour.empty()) continue;
    Colour colour = mesh.attributes.colour[a];
    for (std::size_t i = 0; i < colour.size(); ++i) {
      colour[i] = 0.5 * (colour[i] + mesh.attributes.colour[b][i]);
    }
    mesh.attributes.colour.push_back(colour);
  }
  return middle;
}

/// A place on the outline of a face that is divided: 2 i is its corner i, 2 i + 1 the middle of the
/// edge from there.
using Place = int;

/// Makes the triangles of a mesh anew, with the middles of its edges.
class FaceDivision {
 public:
  FaceDivision(const TriMesh& mesh, const std::vector<Index>& middle)
      : mesh_(mesh), middle_(middle) {
    labels_.resize(mesh.attributes.labels.size());
  }

  void divide(Index face) {
    std::vector<int> halved;
    for (int i = 0; i < 3; ++i) {
      if (middle_[3 * face + i] != kNone) halved.push_back(i);
    }
    face_ = face;
    if (halved.empty()) {
      add({0, 2, 4});
    } else if (halved.size() == 1) {
      const int i = halved[0];
      add({turned(1, i), turned(4, i), turned(0, i)});
      add({turned(1, i), turned(2, i), turned(4, i)});
    } else if (halved.size() == 2) {
      // The first of the two edges in a row; the corner between them is cut off.
      const int i = halved[1] - halved[0] == 1 ? halved[0] : halved[1];
      add({turned(1, i), turned(2, i), turned(3, i)});
      if (distance(turned(1, i), turned(4, i)) <= distance(turned(3, i), turned(0, i))) {
        add({turned(1, i), turned(3, i), turned(4, i)});
        add({turned(1, i), turned(4, i), turned(0, i)});
      } else {
        add({turned(1, i), turned(3, i), turned(0, i)});
        add({turned(3, i), turned(4, i), turned(0, i)});
      }
    } else {
      for (int i = 0; i < 3; ++i) add({turned(5, i), turned(0, i), turned(1, i)});
      add({1, 3, 5});
    }
  }

  /// \param mesh  the one that was divided, with the new vertices
  void store(TriMesh& mesh) {
    mesh.faces = std::move(faces_);
    mesh.source_face = std::move(sources_);
    mesh.is_feature = std::move(is_feature_);
    mesh.attributes.texture = std::move(texture_);
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      mesh.attributes.labels[i].of_face = std::move(labels_[i]);
    }
    build_topology(mesh);
  }

 private:
  /// The place `edges` further around.
  static Place turned(Place place, int edges) { return (place + 2 * edges) % 6; }
  static bool is_corner(Place place) { return place % 2 == 0; }
  [[nodiscard]] Index halfedge(Place place) const { return 3 * face_ + place / 2; }
  [[nodiscard]] Index vertex(Place place) const {
    return is_corner(place) ? mesh_.from(halfedge(place)) : middle_[halfedge(place)];
  }
  [[nodiscard]] double distance(Place a, Place b) const {
    return (mesh_.positions[vertex(a)] - mesh_.positions[vertex(b)]).norm();
  }
  [[nodiscard]] TexturePoint texture(Place place) const {
    const std::vector<TexturePoint>& points = mesh_.attributes.texture;
    const TexturePoint& a = points[halfedge(place)];
    if (is_corner(place)) return a;
    const TexturePoint& b = points[TriMesh::next(halfedge(place))];
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
  }
  /// Whether a straight way between places of the outline is along a feature.
  [[nodiscard]] std::uint8_t is_feature(Place from, Place to) const {
    const bool is_along_edge = turned(from - from % 2, 1) == to || (from + 1) % 6 == to;
    return is_along_edge ? mesh_.is_feature[halfedge(from)] : 0;
  }

  void add(const std::array<Place, 3>& places) {
    faces_.push_back({vertex(places[0]), vertex(places[1]), vertex(places[2])});
    sources_.push_back(mesh_.source_face[face_]);
    for (std::size_t i = 0; i < 3; ++i) {
      is_feature_.push_back(is_feature(places[i], places[(i + 1) % 3]));
      if (!mesh_.attributes.texture.empty()) texture_.push_back(texture(places[i]));
    }
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      labels_[i].push_back(mesh_.attributes.labels[i].of_face[face_]);
    }
  }

  const TriMesh& mesh_;
  const std::vector<Index>& middle_;
  Index face_ = 0;
  std::vector<std::array<Index, 3>> faces_;
  std::vector<Index> sources_;
  std::vector<std::uint8_t> is_feature_;
  std::vector<TexturePoint> texture_;
  std::vector<std::vector<Index>> labels_;
};

}  // namespace

Index divide_long_edges(TriMesh& mesh, double longest, Index most_vertices) {
  const Index before = mesh.vertex_count();
  if (longest >= mesh.diagonal) return 0;
  const double halvings = std::ceil(std::log2(longest_edge(mesh) / longest));
  for (double left = std::max(0.0, halvings - 1); left >= 0; --left) {
    const double length = longest * std::exp2(left);
    while (true) {  // the edges across a face that is divided may be too long, too
      std::vector<Index> edges;
      LongEdges(mesh, length, kNeedle * longest).for_each([&](Index h) { edges.push_back(h); });
      if (edges.empty()) break;
      if (mesh.vertex_count() + static_cast<Index>(edges.size()) > most_vertices) {
        return mesh.vertex_count() - before;
      }
      const std::vector<Index> middle = halve(edges, mesh);
      FaceDivision division(mesh, middle);
      for (Index f = 0; f < mesh.face_count(); ++f) division.divide(f);
      division.store(mesh);
    }
  }
  return mesh.vertex_count() - before;
}

}  // namespace strake::import

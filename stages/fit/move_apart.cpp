#include "stages/fit/move_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/placed_face.h"
#include "common/geometry/patch_fill/mendable_crossings.h"
#include "common/geometry/poly_topology/vertex_faces.h"

namespace strake::fitting {
namespace {

/// Of more pairs none is tried: specks in each other, where moves cost the more and help the less.
constexpr std::size_t kMostPairs = 500;
constexpr std::array<double, 5> kShares = {0.1, 0.25, 0.5, 0.75, 1};  ///< of the way that is tried
/// By how much a vertex may rise over the surface each time that all are tried, as a share of its
/// shortest edge: not at first, so that it is the sheet that sticks out that moves.
constexpr std::array<double, 8> kRises = {0.05, 0.05, 0.05, 0.05, 0.5, 0.5, 0.5, 0.5};

class MoveApart {
 public:
  MoveApart(const PolyMesh& mesh, const FaceGuard& guard, VertexPlaces& places)
      : mesh_(mesh),
        guard_(guard),
        places_(places),
        around_(mesh),
        tree_(boxes()),
        is_moved_(static_cast<std::size_t>(mesh.face_count()), 0),
        in_vain_(mesh.positions.size()) {}

  Index run(const std::vector<std::array<Index, 2>>& pairs) {
    std::set<Index> vertices;
    for (const auto& pair : pairs) {
      for (const Index f : pair) {
        for (const Index v : mesh_.face(f)) vertices.insert(v);
      }
    }
    std::set<Index> moved;
    for (const double rise : kRises) {
      for (const Index v : vertices) {
        if (improve(v, rise)) moved.insert(v);
      }
    }
    return static_cast<Index>(moved.size());
  }

 private:
  [[nodiscard]] BoxTree::Box box(Index face) const {
    BoxTree::Box box;
    for (const Index v : mesh_.face(face)) box.extend(places_.positions()[v]);
    return box;
  }

  [[nodiscard]] std::vector<BoxTree::Box> boxes() const {
    std::vector<BoxTree::Box> boxes;
    for (Index f = 0; f < mesh_.face_count(); ++f) boxes.push_back(box(f));
    return boxes;
  }

  [[nodiscard]] PlacedFace placed(Index face) const {
    return placed_face(places_.positions(), mesh_.face(face));
  }

  [[nodiscard]] BoxTree::Box box_around(Index v) const {
    BoxTree::Box around;
    for (const Index f : around_.faces(v)) around.extend(box(f));
    return around;
  }

  /// Other faces than those around a vertex that reach into a box.
  [[nodiscard]] std::vector<PlacedFace> faces_in(const BoxTree::Box& within, Index v) const {
    std::vector<PlacedFace> faces;
    const auto add = [&](Index f) {
      const bool is_around = std::ranges::binary_search(around_.faces(v), f);
      if (!is_around && box(f).intersects(within)) faces.push_back(placed(f));
    };
    // The tree holds the places at the start: what has moved since is looked at in any case.
    for (const Index f : moved_) add(f);
    tree_.visit_touching(within, [&](Index f) {
      if (is_moved_[f] == 0) add(f);
    });
    return faces;
  }

  /// Pairs of crossing faces of which one at least has this vertex; `most` where there are more.
  [[nodiscard]] std::size_t count_around(Index v, const std::vector<PlacedFace>& others,
                                         std::size_t most) const {
    std::size_t count = 0;
    std::vector<PlacedFace> own;
    for (const Index f : around_.faces(v)) {
      const PlacedFace face = placed(f);
      for (const auto& some : {std::cref(own), std::cref(others)}) {
        for (const PlacedFace& other : some.get()) {
          if (count == most) return count;
          if (faces_cross(face, other)) ++count;
        }
      }
      own.push_back(face);
    }
    return count;
  }

  struct Ways {
    std::vector<Vec3> all;  ///< in a fixed order
    double longest = 0;
    double shortest_edge = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] Ways ways_from(Index v) const {
    const std::vector<Vec3>& p = places_.positions();
    const std::vector<Index> neighbours = around_.neighbours(v);
    Ways ways;
    Vec3 middle = Vec3::Zero();
    for (const Index w : neighbours) {
      ways.all.emplace_back(p[w] - p[v]);
      ways.all.emplace_back(p[v] - p[w]);
      middle += (p[w] - p[v]) / static_cast<double>(neighbours.size());
      ways.shortest_edge = std::min(ways.shortest_edge, (p[w] - p[v]).norm());
    }
    ways.all.push_back(middle);
    ways.all.emplace_back(2 * middle);
    ways.all.emplace_back(ways.shortest_edge * places_.normal(v));
    ways.all.emplace_back(-ways.shortest_edge * places_.normal(v));
    for (const Vec3& way : ways.all) ways.longest = std::max(ways.longest, way.norm());
    return ways;
  }

  /// What was looked at when a vertex could not be moved for the good.
  struct InVain {
    double rise = -1;         ///< none so far
    BoxTree::Box within;      ///< all that matters
    std::size_t changes = 0;  ///< that had been made by then
  };

  /// Whether it would be in vain again, as nothing has changed there.
  [[nodiscard]] bool is_as_before(const InVain& last, double rise) const {
    return last.rise == rise &&
           std::none_of(changed_.begin() + static_cast<std::ptrdiff_t>(last.changes),
                        changed_.end(),
                        [&](const BoxTree::Box& box) { return box.intersects(last.within); });
  }

  /// Moves a vertex to where the faces around it cross the fewest others. \return whether it did
  bool improve(Index v, double rise) {
    if (is_as_before(in_vain_[v], rise)) return false;
    const Ways ways = ways_from(v);
    // What the faces around may come to touch.
    BoxTree::Box within = box_around(v);
    const double reach = kShares.back() * ways.longest;
    within.extend(places_.positions()[v] - Vec3::Constant(reach));
    within.extend(places_.positions()[v] + Vec3::Constant(reach));
    in_vain_[v] = {rise, within, changed_.size()};
    const std::vector<PlacedFace> others = faces_in(within, v);
    const std::size_t before = count_around(v, others, std::numeric_limits<std::size_t>::max());
    if (before == 0) return false;
    const VertexPlaces::State start = places_.state(v);
    const double highest = std::abs(places_.height(v)) + rise * ways.shortest_edge;
    VertexPlaces::State best = start;
    std::size_t fewest = before;
    for (std::size_t i = 0; i < kShares.size() && fewest > 0; ++i) {
      for (const Vec3& way : ways.all) {
        places_.restore(v, start);
        places_.move(v, kShares[i] * way);
        if (std::abs(places_.height(v)) > highest) continue;
        if (std::ranges::any_of(around_.faces(v),
                                [&](Index f) { return guard_.is_spoilt(places_, f); })) {
          continue;
        }
        const std::size_t count = count_around(v, others, fewest);
        if (count == fewest) continue;
        fewest = count;
        best = places_.state(v);
      }
    }
    places_.restore(v, start);
    if (fewest == before) return false;
    changed_.push_back(box_around(v));
    places_.restore(v, best);
    changed_.push_back(box_around(v));
    for (const Index f : around_.faces(v)) {
      if (is_moved_[f] == 0) moved_.push_back(f);
      is_moved_[f] = 1;
    }
    return true;
  }

  const PolyMesh& mesh_;
  const FaceGuard& guard_;
  VertexPlaces& places_;
  VertexFaces around_;
  BoxTree tree_;                        ///< of the faces at the start
  std::vector<Index> moved_;            ///< faces
  std::vector<std::uint8_t> is_moved_;  ///< [F] whether it is one of them
  std::vector<BoxTree::Box> changed_;   ///< of faces that moved, before and after, in turn
  std::vector<InVain> in_vain_;         ///< [V]
};

}  // namespace

Index move_apart(const PolyMesh& mesh, FaceGuard& guard, VertexPlaces& places) {
  if (guard.crossing_count() == 0 || guard.crossing_count() > kMostPairs) return 0;
  const auto pairs = mendable_crossings(mesh, places.positions());
  if (pairs.empty()) return 0;
  guard.set_start(places);
  return MoveApart(mesh, guard, places).run(pairs);
}

}  // namespace strake::fitting

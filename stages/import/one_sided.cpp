#include "stages/import/one_sided.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace strake::import {
namespace {

/// An edge between two faces, or all of those between two patches.
struct Joint {
  Index face;
  Index other;
  /// Along which they look alike less that along which they do not; -0 of an edge without length
  /// along which they do not.
  double length;
  Index halfedge;

  [[nodiscard]] bool is_alike() const { return !std::signbit(length); }
};

/// Patches of faces that are turned against each other or not; a face stands for each.
class Patches {
 public:
  explicit Patches(std::size_t faces) : above_(faces), is_turned_(faces, 0) {
    std::iota(above_.begin(), above_.end(), 0);
  }

  struct Side {
    Index patch;
    bool is_turned;  ///< against the face that stands for the patch
  };
  Side side_of(Index face) {
    if (above_[face] == face) return {face, false};
    // The way up is short: whatever is passed is hung directly below the top.
    Index top = face;
    bool is_turned = false;
    for (; above_[top] != top; top = above_[top]) is_turned ^= is_turned_[top] != 0;
    bool rest = is_turned;
    for (Index at = face; above_[at] != top;) {
      const Index next = above_[at];
      const bool own = is_turned_[at] != 0;
      above_[at] = top;
      is_turned_[at] = rest ? 1 : 0;
      rest ^= own;
      at = next;
    }
    return {top, is_turned};
  }

  void join(Index patch, Index other, bool is_alike) {
    const Side low = side_of(patch);
    const Side high = side_of(other);
    if (low.patch == high.patch) return;
    const auto [top, below] = std::minmax({low.patch, high.patch});
    above_[below] = top;
    is_turned_[below] = (low.is_turned != high.is_turned) == is_alike ? 1 : 0;
  }

 private:
  std::vector<Index> above_;
  std::vector<std::uint8_t> is_turned_;  ///< against the one above
};

/// Faces are known by their rank among those of the piece by place, not by their number.
class OneSided {
 public:
  OneSided(const Soup& soup, std::span<const Index> twin, std::span<const Index> faces)
      : soup_(soup), side_(faces.size(), 0) {
    const std::vector<Index> by_place = sorted_by_place(faces);
    std::vector<std::pair<Index, Index>> rank;  // face, rank
    for (std::size_t r = 0; r < by_place.size(); ++r) {
      rank.emplace_back(by_place[r], static_cast<Index>(r));
    }
    std::ranges::sort(rank);
    const auto rank_of = [&](Index face) {
      return std::ranges::lower_bound(rank, face, {}, &std::pair<Index, Index>::first)->second;
    };
    for (const auto& [f, r] : rank) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (twin[h] == kNone || twin[h] < h) continue;
        const double length = (soup.positions[soup.to(h)] - soup.positions[soup.from(h)]).norm();
        const bool is_alike = soup.from(h) != soup.from(twin[h]);
        const auto [low, high] = std::minmax({r, rank_of(twin[h] / 3)});
        edges_.push_back({low, high, is_alike ? length : -length, h});
      }
    }
    std::ranges::sort(edges_, [](const Joint& a, const Joint& b) {
      return std::tie(a.face, a.other, a.length) < std::tie(b.face, b.other, b.length);
    });
  }

  std::vector<Index> run() {
    const double as_it_is = cut_length();
    join_patches();
    turn_single_faces();
    // Faces are not turned over for a little less.
    constexpr double kClearlyShorter = 0.9;
    if (cut_length() > kClearlyShorter * as_it_is) std::ranges::fill(side_, 0);
    std::vector<Index> cuts;
    for (const Joint& edge : edges_) {
      if (is_cut(edge)) cuts.push_back(edge.halfedge);
    }
    return cuts;
  }

 private:
  [[nodiscard]] std::vector<Index> sorted_by_place(std::span<const Index> faces) const {
    using Place = std::array<std::array<double, 3>, 3>;
    std::vector<std::pair<Place, Index>> placed;
    for (const Index f : faces) {
      Place place;
      for (int i = 0; i < 3; ++i) {
        const Vec3& p = soup_.positions[soup_.faces[f][i]];
        place[i] = {p.x(), p.y(), p.z()};
      }
      std::ranges::sort(place);
      placed.emplace_back(place, f);
    }
    std::ranges::sort(placed);
    std::vector<Index> sorted;
    for (const auto& [place, f] : placed) sorted.push_back(f);
    return sorted;
  }

  [[nodiscard]] bool is_cut(const Joint& edge) const {
    return (side_[edge.face] == side_[edge.other]) != edge.is_alike();
  }

  [[nodiscard]] double cut_length() const {
    double sum = 0;
    for (const Joint& edge : edges_) sum += is_cut(edge) ? std::abs(edge.length) : 0;
    return sum;
  }

  void join_patches() {
    Patches patches(side_.size());
    std::vector<Joint> joints = edges_;
    while (!joints.empty()) {
      std::vector<Index> best(side_.size(), kNone);
      for (std::size_t j = 0; j < joints.size(); ++j) {
        for (const Index patch : {joints[j].face, joints[j].other}) {
          Index& at = best[patch];
          // Joints are in order: of equals all patches take the first, so that no ring is closed.
          if (at == kNone || std::abs(joints[j].length) > std::abs(joints[at].length)) {
            at = static_cast<Index>(j);
          }
        }
      }
      for (const Index j : best) {
        if (j != kNone) patches.join(joints[j].face, joints[j].other, joints[j].is_alike());
      }
      joints = between_patches(patches, joints);
    }
    for (std::size_t f = 0; f < side_.size(); ++f) {
      side_[f] = patches.side_of(static_cast<Index>(f)).is_turned ? 1 : 0;
    }
  }

  /// The joints between different patches, each pair once.
  static std::vector<Joint> between_patches(Patches& patches, const std::vector<Joint>& joints) {
    std::vector<Joint> moved;
    for (const Joint& joint : joints) {
      const Patches::Side a = patches.side_of(joint.face);
      const Patches::Side b = patches.side_of(joint.other);
      if (a.patch == b.patch) continue;
      const auto [low, high] = std::minmax({a.patch, b.patch});
      moved.push_back(
          {low, high, a.is_turned == b.is_turned ? joint.length : -joint.length, kNone});
    }
    std::ranges::sort(moved, [](const Joint& a, const Joint& b) {
      return std::tie(a.face, a.other, a.length) < std::tie(b.face, b.other, b.length);
    });
    std::vector<Joint> sums;
    for (const Joint& joint : moved) {
      if (!sums.empty() && sums.back().face == joint.face && sums.back().other == joint.other) {
        sums.back().length += joint.length;
      } else {
        sums.push_back(joint);
      }
    }
    return sums;
  }

  /// Turns single faces as long as that shortens the cut.
  void turn_single_faces() {
    constexpr double kGain = 1e-9;
    std::vector<std::array<Index, 3>> around(side_.size(), {kNone, kNone, kNone});
    std::vector<Index> open;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      for (const Index f : {edges_[e].face, edges_[e].other}) {
        *std::ranges::find(around[f], kNone) = static_cast<Index>(e);
        if (is_cut(edges_[e])) open.push_back(f);
      }
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
      double gain = 0;
      double whole = 0;
      for (const Index e : around[open[i]]) {
        if (e == kNone) continue;
        const double length = std::abs(edges_[e].length);
        gain += is_cut(edges_[e]) ? length : -length;
        whole += length;
      }
      if (gain <= kGain * whole) continue;
      side_[open[i]] ^= 1;
      for (const Index e : around[open[i]]) {
        if (e == kNone) continue;
        open.push_back(edges_[e].face == open[i] ? edges_[e].other : edges_[e].face);
      }
    }
  }

  const Soup& soup_;
  std::vector<Joint> edges_;
  std::vector<std::uint8_t> side_;  ///< [faces] 1 where it is to be turned
};

}  // namespace

std::vector<Index> cuts_of_one_sided(const Soup& soup, std::span<const Index> twin,
                                     std::span<const Index> faces) {
  return OneSided(soup, twin, faces).run();
}

}  // namespace strake::import

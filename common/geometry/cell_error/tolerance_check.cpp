#include "common/geometry/cell_error/tolerance_check.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <functional>
#include <limits>
#include <utility>

#include "common/core/mix_bits.h"
#include "common/geometry/flat_triangle.h"

namespace strake {
namespace {

/// Pieces with edges shorter than this share of the tolerance are not halved any more.
constexpr double kSmallestPiece = 0.02;
/// A point of a triangle is at most this share of the longest edge from the nearest corner; rounded
/// up.
constexpr double kFarthestInside = 0.57736;
/// Pieces are cut where one triangle ceases to be near only where that is at least this share of
/// the way; else in the middle. That place is found up to a share of the tolerance.
constexpr double kLeastShare = 0.1;
constexpr double kCutExactly = 0.5;
constexpr double kLeastStep = 1e-12;  // of the way, whatever the tolerance
/// Cuts in a row, from a triangle on, that may be made there.
constexpr int kMostCuts = 16;
/// Pieces of one triangle that any proof may look at; most need but one.
constexpr std::int64_t kFreePieces = 64;
/// Corners in a row of which each is looked for near the foot of the one before.
constexpr std::size_t kCornersInARow = 64;

struct Corner {
  Vec3 place;
  ClosestPoint foot;
};
using Piece = std::array<Corner, 3>;

/// The triangles of a surface that nobody sees.
/// \return [triangles] 1: without area; empty where none or all are
std::vector<char> flat_triangles(const SurfaceDistance& surface) {
  std::vector<char> is_flat(surface.triangles().size());
  const std::vector<Vec3>& p = surface.positions();
  tbb::parallel_for(std::size_t{0}, is_flat.size(), [&](std::size_t t) {
    const auto& [a, b, c] = surface.triangles()[t];
    is_flat[t] = is_flat_triangle(p[a], p[b], p[c]) ? 1 : 0;
  });
  const bool are_like =
      std::ranges::adjacent_find(is_flat, std::ranges::not_equal_to()) == is_flat.end();
  return are_like ? std::vector<char>() : is_flat;
}

/// Proves pieces of one surface to be near the other one, or finds where they are not.
class PieceCheck {
 public:
  /// \param other_flat  as `flat_triangles` gives: nothing is near to these
  /// \param left        pieces that may be looked at, beside the free ones; kept by reference
  PieceCheck(const SurfaceDistance& other, const std::vector<char>& other_flat, double tolerance,
             std::atomic<std::int64_t>& left)
      : other_(other), tolerance_(tolerance), left_(left) {
    if (!other_flat.empty()) {
      has_area_ = [&other_flat](Index t) { return other_flat[t] == 0; };
    }
  }

  /// \param guess  triangle of the other surface near `p`, with an area; kNone: none is known
  [[nodiscard]] Corner corner(const Vec3& p, Index guess) const {
    if (!has_area_) return {p, other_.closest_near(p, guess)};
    const double reach =
        guess == kNone ? std::numeric_limits<double>::infinity() : distance_from(guess, p);
    return {p, other_.closest_if(p, reach, has_area_)};
  }

  /// Calls found(corner, distance) for places of the piece that are too far, or not proven not to
  /// be, and near(triangle) for triangles of the other surface that all else is near to, some of
  /// them several times.
  /// \param pieces  of the triangle that were looked at, counted on
  /// \param cuts  that may still be made elsewhere than in the middle of the longest edge, which
  ///              alone ends for certain
  template <class Found, class Near>
  void check(const Piece& piece, const Found& found, const Near& near, std::int64_t& pieces,
             int cuts = kMostCuts) const {
    if (++pieces > kFreePieces && left_.fetch_sub(1) <= 0) throw ProofTooLong();
    const auto worst = std::max_element(
        piece.begin(), piece.end(),
        [](const Corner& a, const Corner& b) { return a.foot.distance < b.foot.distance; });
    if (worst->foot.distance > tolerance_) {
      found(*worst, worst->foot.distance);
      return;
    }
    const Distances distances = distances_of(piece);
    const auto [bound, triangle] = upper_bound(piece, distances);
    if (bound <= tolerance_) {
      near(triangle);
      return;
    }
    const std::array<double, 3> lengths = edge_lengths(piece);
    const int longest = longest_of(lengths, [](int) { return true; });
    if (worst->foot.distance + kFarthestInside * lengths[longest] <= tolerance_) {
      for (const Corner& corner : piece) near(corner.foot.triangle);
      return;
    }
    const double smallest = kSmallestPiece * tolerance_;
    if (lengths[longest] < smallest) {
      found(*worst, bound);
      return;
    }
    const int uncovered = longest_of(lengths, [&](int i) {
      return cuts > 0 && lengths[i] >= smallest && !is_covered(distances, i);
    });
    const int cut = uncovered == kNone ? longest : uncovered;
    const Corner& a = piece[cut];
    const Corner& b = piece[(cut + 1) % 3];
    const Corner& c = piece[(cut + 2) % 3];
    const double share = uncovered == kNone ? 0.5 : where_to_cut(a, b);
    const Corner between = corner(a.place + share * (b.place - a.place), a.foot.triangle);
    check({a, between, c}, found, near, pieces, cuts - 1);
    check({between, b, c}, found, near, pieces, cuts - 1);
  }

 private:
  /// [i][j] distance of corner j from the triangle nearest to corner i.
  using Distances = std::array<std::array<double, 3>, 3>;

  [[nodiscard]] double distance_from(Index triangle, const Vec3& place) const {
    const auto& [a, b, c] = other_.triangles()[triangle];
    const std::vector<Vec3>& p = other_.positions();
    return closest_point_on_triangle(place, p[a], p[b], p[c]).distance;
  }

  [[nodiscard]] Distances distances_of(const Piece& piece) const {
    Distances distances;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        distances[i][j] =
            i == j ? piece[i].foot.distance : distance_from(piece[i].foot.triangle, piece[j].place);
      }
    }
    return distances;
  }

  /// The least, over the triangles nearest to the corners, of the distance from one that no point
  /// of the piece exceeds; and that triangle.
  static std::pair<double, Index> upper_bound(const Piece& piece, const Distances& distances) {
    std::pair<double, Index> least{std::numeric_limits<double>::infinity(), kNone};
    for (int i = 0; i < 3; ++i) {
      const double largest = std::ranges::max(distances[i]);
      if (largest < least.first) least = {largest, piece[i].foot.triangle};
    }
    return least;
  }

  /// Whether one of the triangles nearest to the corners is near to all of edge i.
  [[nodiscard]] bool is_covered(const Distances& distances, int i) const {
    return std::ranges::any_of(distances, [&](const std::array<double, 3>& from) {
      return from[i] <= tolerance_ && from[(i + 1) % 3] <= tolerance_;
    });
  }

  static std::array<double, 3> edge_lengths(const Piece& piece) {
    std::array<double, 3> lengths;
    for (int i = 0; i < 3; ++i) lengths[i] = (piece[i].place - piece[(i + 1) % 3].place).norm();
    return lengths;
  }

  /// Of those edges that `counts`; kNone where none does.
  template <class Counts>
  static int longest_of(const std::array<double, 3>& lengths, const Counts& counts) {
    int longest = kNone;
    for (int i = 0; i < 3; ++i) {
      if (counts(i) && (longest == kNone || lengths[i] > lengths[longest])) longest = i;
    }
    return longest;
  }

  /// How far along the way from `a` to `b` the triangle nearest to `a` stays near, which it does
  /// not to its end; 0 where that is not worth a cut.
  [[nodiscard]] double covered_share(const Corner& a, const Corner& b) const {
    const auto is_near = [&](double share) {
      const Vec3 place = a.place + share * (b.place - a.place);
      return distance_from(a.foot.triangle, place) <= tolerance_;
    };
    if (!is_near(kLeastShare)) return 0;
    double near = kLeastShare;
    double far = 1;
    const double enough =
        std::max(kCutExactly * tolerance_ / (b.place - a.place).norm(), kLeastStep);
    while (far - near > enough) {
      const double middle = (near + far) / 2;
      (is_near(middle) ? near : far) = middle;
    }
    return near;
  }

  /// The share of the way from `a` to `b`, which no triangle is near to all of, at which to cut it.
  [[nodiscard]] double where_to_cut(const Corner& a, const Corner& b) const {
    const double from_a = covered_share(a, b);
    const double from_b = covered_share(b, a);
    if (from_a + from_b >= 1) return (from_a + 1 - from_b) / 2;
    if (from_a == 0 && from_b == 0) return 0.5;
    return from_a >= from_b ? from_a : 1 - from_b;
  }

  const SurfaceDistance& other_;
  double tolerance_;
  std::atomic<std::int64_t>& left_;
  std::function<bool(Index)> has_area_;  ///< of the other surface; empty: all have one
};

/// What is known of one triangle: its worst place that is beyond the tolerance, if any.
struct Verdict {
  double distance = 0;
  Vec3 place = Vec3::Zero();
  Index on_other = kNone;  ///< nearest to that place; kNone: none is beyond
  /// Triangles of the other surface that all that is not beyond is near to, each to a part of it.
  /// Asks for no memory where it is one, as it mostly is.
  Index first_near = kNone;
  std::vector<Index> other_near;

  void note_near(Index triangle) {
    if (first_near == kNone) first_near = triangle;
    const Index last = other_near.empty() ? first_near : other_near.back();
    if (triangle != last) other_near.push_back(triangle);
  }
  /// Leaves each of the others once.
  void end_notes() {
    std::ranges::sort(other_near);
    other_near.erase(std::unique(other_near.begin(), other_near.end()), other_near.end());
  }
};

/// What is known of some triangles of a surface.
struct Verdicts {
  std::vector<Index> triangle;   ///< ascending
  std::vector<Verdict> verdict;  ///< of each
};

/// \param is_proven  [triangles] 1: need not be looked at
/// \param left       see PieceCheck
Verdicts check_surface(const SurfaceDistance& own, const SurfaceDistance& other, double tolerance,
                       const std::vector<char>& is_proven, std::atomic<std::int64_t>& left) {
  Verdicts found;
  const std::vector<char> is_flat = flat_triangles(own);
  const std::vector<char> other_flat = flat_triangles(other);
  std::vector<Index> corner_of(own.positions().size(), kNone);
  for (std::size_t t = 0; t < own.triangles().size(); ++t) {
    if (is_proven[t] != 0 || (!is_flat.empty() && is_flat[t] != 0)) continue;
    found.triangle.push_back(static_cast<Index>(t));
    for (const Index v : own.triangles()[t]) corner_of[v] = 0;
  }
  std::vector<Index> vertices;
  for (std::size_t v = 0; v < corner_of.size(); ++v) {
    if (corner_of[v] == kNone) continue;
    corner_of[v] = static_cast<Index>(vertices.size());
    vertices.push_back(static_cast<Index>(v));
  }
  const PieceCheck check(other, other_flat, tolerance, left);
  std::vector<Corner> corners(vertices.size());
  const tbb::blocked_range<std::size_t> all(0, corners.size(), kCornersInARow);
  tbb::parallel_for(all, [&](const auto& row) {
    Index guess = kNone;
    for (std::size_t i = row.begin(); i < row.end(); ++i) {
      corners[i] = check.corner(own.positions()[vertices[i]], guess);
      guess = corners[i].foot.triangle;
    }
  });
  found.verdict.resize(found.triangle.size());
  tbb::parallel_for(std::size_t{0}, found.verdict.size(), [&](std::size_t i) {
    const auto& [a, b, c] = own.triangles()[found.triangle[i]];
    Verdict& verdict = found.verdict[i];
    const auto note_found = [&](const Corner& at, double distance) {
      if (distance <= verdict.distance) return;
      verdict.distance = distance;
      verdict.place = at.place;
      verdict.on_other = at.foot.triangle;
    };
    std::int64_t pieces = 0;
    check.check(
        {corners[corner_of[a]], corners[corner_of[b]], corners[corner_of[c]]}, note_found,
        [&](Index triangle) { verdict.note_near(triangle); }, pieces);
    verdict.end_notes();
  });
  return found;
}

/// \param cell  [triangles of the result] its face
std::vector<Excess> excess_of(const Verdicts& of_result, const Verdicts& of_input,
                              const std::vector<Index>& cell) {
  std::vector<Excess> excess;
  for (std::size_t i = 0; i < of_result.verdict.size(); ++i) {
    const Verdict& worst = of_result.verdict[i];
    if (worst.on_other == kNone) continue;
    excess.push_back({worst.distance, worst.place, cell[of_result.triangle[i]], kNone});
  }
  for (std::size_t i = 0; i < of_input.verdict.size(); ++i) {
    const Verdict& worst = of_input.verdict[i];
    if (worst.on_other == kNone) continue;
    excess.push_back({worst.distance, worst.place, cell[worst.on_other], of_input.triangle[i]});
  }
  return excess;
}

}  // namespace

std::vector<Excess> check_tolerance(const ComparedSurfaces& surfaces, double tolerance) {
  return ToleranceProof(surfaces.shared_input(), tolerance).check(surfaces);
}

std::size_t ToleranceProof::Hash::operator()(const Triangle& triangle) const {
  std::uint64_t hash = 0;
  for (const std::uint64_t bits : triangle) hash = mix_bits(hash, bits);
  return hash;
}

ToleranceProof::ToleranceProof(std::shared_ptr<const InputSurface> input, double tolerance)
    : input_(std::move(input)), tolerance_(tolerance), near_(input_->mesh.faces.size(), kNone) {}

void ToleranceProof::report_to(Observer& observer, std::string phase) {
  observer_ = &observer;
  phase_ = std::move(phase);
}

/// Takes what is known of the last result to the triangles of the next one.
void ToleranceProof::carry_over(const SurfaceDistance& result) {
  const auto& triangles = result.triangles();
  std::unordered_map<Triangle, Index, Hash> number;
  number.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle places{};
    for (std::size_t i = 0; i < 9; ++i) {
      places[i] = std::bit_cast<std::uint64_t>(result.positions()[triangles[t][i / 3]][i % 3]);
    }
    number.try_emplace(places, static_cast<Index>(t));
  }
  std::vector<Index> now(is_proven_.size(), kNone);
  std::vector<char> is_proven(triangles.size(), 0);
  for (const auto& [places, before] : number_) {
    const auto found = number.find(places);
    if (found == number.end()) continue;
    now[before] = found->second;
    is_proven[found->second] = is_proven_[before];
  }
  for (Index& near : near_) {
    if (near != kNone) near = now[near];
  }
  for (auto& [face, others] : others_near_) {
    for (Index& near : others) near = now[near];
    if (std::ranges::find(others, kNone) != others.end()) near_[face] = kNone;
  }
  std::erase_if(others_near_, [&](const auto& entry) { return near_[entry.first] == kNone; });
  number_ = std::move(number);
  is_proven_ = std::move(is_proven);
}

void ToleranceProof::assume(const ComparedSurfaces& surfaces, std::span<const char> is_checked) {
  const TriMesh& mesh = input_->mesh;
  assumed_near_.resize(mesh.positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, assumed_near_.size()),
                    [&](const auto& range) {
                      Index last = kNone;
                      for (std::size_t v = range.begin(); v < range.end(); ++v) {
                        last = surfaces.result().closest_near(mesh.positions[v], last).triangle;
                        assumed_near_[v] = last;
                      }
                    });
  carry_over(surfaces.result());
  assumed_number_ = number_;
  assumed_triangles_ = surfaces.triangles().corners.size();
  std::erase_if(assumed_number_, [&](const auto& entry) {
    return !is_checked.empty() && is_checked[surfaces.triangles().face[entry.second]] != 0;
  });
}

/// Takes for proven what there is of the assumed result.
/// \return [F of the input] 1: near to what was assumed, and is there, or to what was proven
std::vector<char> ToleranceProof::take_what_is_assumed() {
  std::vector<char> is_near(near_.size());
  for (std::size_t f = 0; f < near_.size(); ++f) is_near[f] = near_[f] != kNone ? 1 : 0;
  if (assumed_near_.empty()) return is_near;
  std::vector<char> is_there(assumed_triangles_, 0);
  for (const auto& [places, before] : assumed_number_) {
    const auto found = number_.find(places);
    if (found == number_.end()) continue;
    is_there[before] = 1;
    is_proven_[found->second] = 1;
  }
  const auto is_near_one = [&](Index v) {
    return assumed_near_[v] != kNone && is_there[assumed_near_[v]] != 0;
  };
  tbb::parallel_for(std::size_t{0}, is_near.size(), [&](std::size_t f) {
    if (std::ranges::all_of(input_->mesh.faces[f], is_near_one)) is_near[f] = 1;
  });
  return is_near;
}

std::vector<Excess> ToleranceProof::check(const ComparedSurfaces& surfaces) {
  return check(surfaces.result(), surfaces.triangles().face);
}

/// \param cell  [triangles of the result] its face
std::vector<Excess> ToleranceProof::check(const SurfaceDistance& result,
                                          const std::vector<Index>& cell) {
  if (observer_ != nullptr) observer_->report(phase_, 0);
  carry_over(result);
  const std::vector<char> is_near = take_what_is_assumed();
  std::atomic<std::int64_t> left = pieces_left_;
  const Verdicts of_result = check_surface(result, input_->distance, tolerance_, is_proven_, left);
  Verdicts of_input = check_surface(input_->distance, result, tolerance_, is_near, left);
  pieces_left_ = left;
  for (std::size_t i = 0; i < of_result.verdict.size(); ++i) {
    if (of_result.verdict[i].on_other == kNone) is_proven_[of_result.triangle[i]] = 1;
  }
  for (std::size_t i = 0; i < of_input.verdict.size(); ++i) {
    Verdict& verdict = of_input.verdict[i];
    if (verdict.on_other != kNone) continue;
    const Index face = of_input.triangle[i];
    near_[face] = verdict.first_near;
    if (!verdict.other_near.empty()) others_near_[face] = std::move(verdict.other_near);
  }
  return excess_of(of_result, of_input, cell);
}

std::vector<Index> ToleranceProof::cells_in_doubt(const ComparedSurfaces& surfaces) {
  std::vector<Index> in_doubt;
  for (const FaceTriangles& other : other_triangulations(surfaces.faces())) {
    const SurfaceDistance result(surfaces.positions(), other.corners);
    const std::vector<Excess> excess = check(result, other.face);
    if (excess.empty()) continue;
    std::vector<char> is_near(surfaces.positions().size(), 0);
    for (const Excess& e : excess) {
      for (const Index v : surfaces.faces().face(e.cell)) is_near[v] = 1;
    }
    const auto touches = [&](Index cell) {
      return std::ranges::any_of(surfaces.faces().face(cell),
                                 [&](Index v) { return is_near[v] != 0; });
    };
    for (std::size_t t = 0; t < other.corners.size(); ++t) {
      if (other.corners[t] == surfaces.triangles().corners[t]) continue;
      if (touches(other.face[t])) in_doubt.push_back(other.face[t]);
    }
  }
  std::ranges::sort(in_doubt);
  in_doubt.erase(std::unique(in_doubt.begin(), in_doubt.end()), in_doubt.end());
  return in_doubt;
}

}  // namespace strake

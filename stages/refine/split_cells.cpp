#include "stages/refine/split_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake {
namespace {

using Ring = std::vector<Index>;

/// Around a centre at least this convex corners, as the sine of the angle; else a centre is made.
constexpr double kLeastConvex = 0.2;
/// Likewise of a quad of two triangles, which are as sharp without: 3 degrees.
constexpr double kLeastConvexOfPairs = 0.05;

/// Sine of the sharpest turn at a corner of a ring; negative where one is concave.
double least_turn(const std::vector<Vec3>& positions, const Ring& ring, const Vec3& normal) {
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = positions[ring[i]];
    const Vec3 ahead = positions[ring[(i + 1) % n]] - p;
    const Vec3 back = positions[ring[(i + n - 1) % n]] - p;
    const double size = ahead.norm() * back.norm();
    least = std::min(least, size > 0 ? ahead.cross(back).dot(normal) / size : -1.0);
  }
  return least;
}

class FaceSplitter {
 public:
  /// \param mesh  whose edges may not be made a second time
  FaceSplitter(const PolyMesh& mesh, const std::vector<Vec3>& positions, std::size_t max_sides,
               const AddCentre& add_centre, PolyMesh& result)
      : positions_(positions), max_sides_(max_sides), add_centre_(add_centre), result_(result) {
    for (const auto& [a, b] : collect_edges(mesh).vertices) edges_.set(a, b, a);
  }

  /// \param ring    the face with the vertices on its edges
  /// \param is_new  [ring] 1 for those
  void split(const Ring& ring, const std::vector<char>& is_new, bool divide) {
    const auto marks = static_cast<std::size_t>(std::count(is_new.begin(), is_new.end(), 1));
    if (marks == 0 || (!divide && is_good(ring))) {
      result_.add_face(ring);
      return;
    }
    const std::size_t corners = ring.size() - marks;
    const bool all = marks == corners;
    const bool side_by_side = corners == 4 && marks == 2 && !are_opposite(is_new);
    if (ring.size() % 2 == 0 && ring.size() <= 10 && (all || side_by_side)) {
      around_centre(ring, is_new);
    } else {
      by_diagonals(ring, divide);
    }
  }

  /// Into triangles that keep to the inside of a ring however jagged, and quads of pairs of them.
  void split_jagged(const Ring& ring) {
    std::vector<std::array<Index, 3>> triangles;
    triangulate_face(positions_, ring, triangles);
    const std::vector<Diagonal> diagonals = diagonals_of(triangles);
    if (std::ranges::any_of(diagonals, [&](const Diagonal& d) {
          return edges_.at(d.quad[0], d.quad[2]) != kNone;
        })) {
      by_diagonals(ring, true);
      return;
    }
    std::vector<char> is_paired(triangles.size(), 0);
    for (const Diagonal& d : diagonals) {
      if (d.shape > kLeastConvexOfPairs && is_paired[d.sides[0]] == 0 &&
          is_paired[d.sides[1]] == 0) {
        is_paired[d.sides[0]] = is_paired[d.sides[1]] = 1;
        result_.add_face(d.quad);
      } else {
        edges_.set(d.quad[0], d.quad[2], d.quad[0]);
      }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (is_paired[t] == 0) result_.add_face(triangles[t]);
    }
  }

 private:
  /// Of a triangulated ring, from quad[0] to quad[2] of the two triangles at its sides.
  struct Diagonal {
    std::array<std::size_t, 2> sides;
    std::array<Index, 4> quad;
    double shape;  ///< sine of the quad's sharpest turn
  };

  /// Those that leave the best quads first.
  [[nodiscard]] std::vector<Diagonal> diagonals_of(
      const std::vector<std::array<Index, 3>>& triangles) const {
    std::vector<Diagonal> diagonals;
    std::map<std::array<Index, 2>, std::array<std::size_t, 2>> side_of;  // triangle and corner
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = triangles[t][i];
        const Index b = triangles[t][(i + 1) % 3];
        side_of[{a, b}] = {t, i};
        const auto other = side_of.find({b, a});
        if (other == side_of.end()) continue;
        const auto [beyond, corner] = other->second;
        const std::array<Index, 4> quad = {b, triangles[t][(i + 2) % 3], a,
                                           triangles[beyond][(corner + 2) % 3]};
        const Ring ring(quad.begin(), quad.end());
        const Vec3 normal = newell_normal(positions_, ring).normalized();
        diagonals.push_back({{t, beyond}, quad, least_turn(positions_, ring, normal)});
      }
    }
    std::stable_sort(diagonals.begin(), diagonals.end(),
                     [](const Diagonal& a, const Diagonal& b) { return a.shape > b.shape; });
    return diagonals;
  }

  [[nodiscard]] bool is_good(const Ring& ring) const {
    return ring.size() <= max_sides_ && !is_concave_face(positions_, ring);
  }

  /// Whether the two new vertices of a ring of six lie opposite each other.
  static bool are_opposite(const std::vector<char>& is_new) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_new[i] != 0 && is_new[i + 3] != 0) return true;
    }
    return false;
  }

  /// Joins every other vertex, among them as many new ones as possible, to one in the middle.
  void around_centre(const Ring& ring, const std::vector<char>& is_new) {
    std::size_t new_at_even = 0;
    std::size_t new_at_odd = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      (i % 2 == 0 ? new_at_even : new_at_odd) += is_new[i] != 0 ? 1 : 0;
    }
    const std::size_t first = new_at_odd > new_at_even ? 1 : 0;
    const std::size_t n = ring.size();
    const Index centre = add_centre_(ring[first], ring[first + n / 2], ring);
    for (std::size_t i = first; i < n + first; i += 2) {
      result_.add_face(
          std::array<Index, 4>{ring[i % n], ring[(i + 1) % n], ring[(i + 2) % n], centre});
    }
  }

  /// Cuts along the diagonal that leaves the best shaped parts, quads first, until all are small.
  void by_diagonals(const Ring& ring, bool divide) {
    const std::size_t n = ring.size();
    if (n == 3 || (!divide && is_good(ring))) {
      result_.add_face(ring);
      return;
    }
    const Vec3 normal = newell_normal(positions_, ring).normalized();
    Ring best_a;
    Ring best_b;
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 2; j < n; ++j) {
        if ((i == 0 && j == n - 1) || edges_.at(ring[i], ring[j]) != kNone) continue;
        const Ring a(ring.begin() + i, ring.begin() + j + 1);
        Ring b(ring.begin() + j, ring.end());
        b.insert(b.end(), ring.begin(), ring.begin() + i + 1);
        const double shape =
            std::min(least_turn(positions_, a, normal), least_turn(positions_, b, normal));
        const bool quads = a.size() == 4 || b.size() == 4;
        const double value = shape + (quads && shape > kLeastConvex ? 1 : 0);
        if (value <= best) continue;
        best = value;
        best_a = a;
        best_b = b;
      }
    }
    if (best_a.empty()) {
      result_.add_face(ring);
      return;
    }
    edges_.set(best_a.front(), best_a.back(), best_a.front());
    by_diagonals(best_a, false);
    by_diagonals(best_b, false);
  }

  const std::vector<Vec3>& positions_;
  std::size_t max_sides_;
  const AddCentre& add_centre_;
  PolyMesh& result_;
  EdgeMarks
      edges_;  ///< of the mesh, and diagonals made so far: two faces may have the same corners
};

}  // namespace

PolyMesh split_cells(const PolyMesh& mesh, const std::vector<char>& divide, const EdgeMarks& marks,
                     std::size_t max_sides, const std::vector<Vec3>& positions,
                     const AddCentre& add_centre) {
  PolyMesh result;
  FaceSplitter splitter(mesh, positions, max_sides, add_centre, result);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    Ring ring;
    std::vector<char> is_new;
    bool is_jagged = false;
    for (std::size_t i = 0; i < face.size(); ++i) {
      ring.push_back(face[i]);
      is_new.push_back(0);
      const std::span<const Index> chain = marks.chain(face[i], face[(i + 1) % face.size()]);
      ring.insert(ring.end(), chain.begin(), chain.end());
      is_jagged = is_jagged || !chain.empty();
      const Index middle = marks.at(face[i], face[(i + 1) % face.size()]);
      if (middle == kNone) continue;
      ring.push_back(middle);
      is_new.push_back(1);
    }
    if (is_jagged) {
      splitter.split_jagged(ring);
    } else {
      splitter.split(ring, is_new, divide[f] != 0);
    }
  }
  result.positions = positions;
  return result;
}

}  // namespace strake

#include "stages/refine/inlay.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <unordered_set>
#include <utility>

#include "common/geometry/angles.h"
#include "common/geometry/patch_fill/fill_band.h"
#include "common/geometry/patch_fill/patch_outline.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/refine/enclosed.h"
#include "stages/refine/surface_part.h"

namespace strake {
namespace {

/// Times that a patch which touches itself in a vertex takes in all around that, or gives it up.
constexpr int kMostClosings = 8;
/// Faces of the input around one inlay, and edges to choose from in a band.
constexpr std::size_t kMostFaces = 20000;
constexpr std::size_t kMostBandEdges = 400000;
/// Of the size of a patch; edges of the input that are shorter are not divided.
constexpr double kLeastStep = 1.0 / 48;
/// Share of its edges within which the input's vertices are on an outline.
constexpr double kOnOutline = 0.05;
/// What the square of an edge's distance from the input costs in a band, over that of its length,
/// and the share of the cost that remains along a feature line.
constexpr double kOffCost = 100;
constexpr double kAlongLine = 1e-6;

using Polygon = std::vector<Index>;

}  // namespace

/// Connected cells.
struct InlayCutter::Patch {
  std::vector<Index> cells;  ///< ascending
  PatchOutline outline;      ///< without paths: they are a whole component
};

/// The faces of the input over a patch.
class InlayCutter::Cover {
 public:
  Cover(const InlayCutter& cutter, const Patch& patch) : surfaces_(cutter.surfaces_) {
    std::set<Index> around;
    for (const PatchOutline::Path& path : patch.outline.paths) {
      for (const Index v : path.vertices) cutter.add_around(v, around);
    }
    around.insert(patch.cells.begin(), patch.cells.end());
    Eigen::AlignedBox3d box;
    std::vector<Index> feet;
    for (const Index f : around) {
      const bool is_in = std::ranges::binary_search(patch.cells, f);
      for (const Index v : cutter.quads_.mesh.face(f)) {
        box.extend(surfaces_.positions()[v]);
        if (is_in) feet.push_back(cutter.quads_.provenance.face[v]);
      }
      for (Index t = surfaces_.first_triangle(f); t < surfaces_.first_triangle(f + 1); ++t) {
        const auto& [a, b, c] = surfaces_.triangles().corners[t];
        const Vec3& p = surfaces_.positions()[a];
        triangles_.push_back({a, b, c});
        is_of_patch_.push_back(is_in ? 1 : 0);
        normals_.push_back((surfaces_.positions()[b] - p).cross(surfaces_.positions()[c] - p));
      }
    }
    const double length = mean_side(patch.outline);
    const double longest = std::max(length, kLeastStep * box.diagonal().norm());
    part_ = surface_part(surfaces_.mesh(), feet, box, longest, kMostFaces);
    if (part_.faces.empty()) return;
    nearest_.emplace(surfaces_.positions(), triangles_);
    classify(kOnOutline * length);
  }

  [[nodiscard]] const SurfacePart& part() const { return part_; }

  /// Faces of the part over the patch; empty where there are none.
  /// \param outline  gets what is around them
  std::vector<Index> faces(PatchOutline& outline) {
    for (int i = 0; i < kMostClosings; ++i) {
      std::set<Index> over = largest_component();
      if (over.empty()) return {};
      add_enclosed(over, [&](Index f, const auto& visit) {
        for (const Index g : part_.neighbours[f]) visit(g);
      });
      std::vector<Polygon> corners;
      for (const Index f : over) corners.emplace_back(part_.faces[f].begin(), part_.faces[f].end());
      outline = patch_outline(corners, {}, [&](Index a, Index b) {
        return part_.boundary.contains({a, b});
      });
      if (outline.pinched.empty()) return {over.begin(), over.end()};
      for (const Index v : outline.pinched) is_inside_[v] = 0;
    }
    return {};
  }

 private:
  [[nodiscard]] double mean_side(const PatchOutline& outline) const {
    double length = 0;
    std::size_t sides = 0;
    for (const auto& [path, is_closed] : outline.paths) {
      const std::size_t n = is_closed ? path.size() : path.size() - 1;
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3& p = surfaces_.positions()[path[i]];
        length += (surfaces_.positions()[path[(i + 1) % path.size()]] - p).norm();
      }
      sides += n;
    }
    return length / static_cast<double>(sides);
  }

  /// Inside are vertices of the part that are nearer to the patch than to the cells around, of
  /// those that face the same way.
  /// \param margin  distance from the outline, as seen along the normal
  void classify(double margin) {
    std::vector<Vec3> normal(part_.positions.size(), Vec3::Zero());
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      const Vec3 own = surfaces_.input_normals()[part_.parent[f]];
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& p = part_.positions[part_.faces[f][i]];
        normal[part_.faces[f][i]] +=
            angle_between(part_.positions[part_.faces[f][(i + 1) % 3]] - p,
                          part_.positions[part_.faces[f][(i + 2) % 3]] - p) *
            own;
      }
    }
    is_inside_.assign(part_.positions.size(), 0);
    tbb::parallel_for(std::size_t{0}, is_inside_.size(), [&](std::size_t v) {
      const Vec3& p = part_.positions[v];
      const auto nearest_within = [&](double reach, std::uint8_t is_of_patch) {
        return nearest_->closest_if(p, reach, [&](Index t) {
          return is_of_patch_[t] == is_of_patch && normals_[t].dot(normal[v]) > 0;
        });
      };
      const double inside = nearest_within(std::numeric_limits<double>::infinity(), 1).distance;
      const double reach = std::hypot(inside, margin);
      is_inside_[v] = reach < nearest_within(reach, 0).distance ? 1 : 0;
    });
  }

  /// The most faces over the patch that are joined by edges.
  [[nodiscard]] std::set<Index> largest_component() const {
    const auto is_over = [&](Index f) {
      return std::ranges::all_of(part_.faces[f], [&](Index v) { return is_inside_[v] != 0; });
    };
    std::vector<Index> largest;
    std::unordered_set<Index> seen;
    for (Index f = 0; f < static_cast<Index>(part_.faces.size()); ++f) {
      if (!is_over(f) || !seen.insert(f).second) continue;
      std::vector<Index> component = {f};
      for (std::size_t i = 0; i < component.size(); ++i) {
        for (const Index g : part_.neighbours[component[i]]) {
          if (g != kNone && is_over(g) && seen.insert(g).second) component.push_back(g);
        }
      }
      if (component.size() > largest.size()) largest = std::move(component);
    }
    return {largest.begin(), largest.end()};
  }

  const ComparedSurfaces& surfaces_;
  SurfaceDistance::Triangles triangles_;    ///< of the patch and the cells around
  std::vector<std::uint8_t> is_of_patch_;   ///< [triangles] 0 or 1
  std::vector<Vec3> normals_;               ///< [triangles]
  std::optional<SurfaceDistance> nearest_;  ///< to `triangles_`, where there is a part
  SurfacePart part_;
  std::vector<std::uint8_t> is_inside_;  ///< [V of the part] 0 or 1
};

InlayCutter::InlayCutter(const ComparedSurfaces& surfaces, const QuadMesh& quads,
                         std::size_t most_whole)
    : surfaces_(surfaces),
      quads_(quads),
      most_whole_(most_whole),
      lines_(surfaces.mesh()),
      around_(quads.mesh) {}

void InlayCutter::add_around(Index vertex, std::set<Index>& cells) const {
  const std::span<const Index> faces = around_.faces(vertex);
  cells.insert(faces.begin(), faces.end());
}

void InlayCutter::add_ring(std::set<Index>& cells) const {
  for (const Index f : std::vector<Index>(cells.begin(), cells.end())) {
    for (const Index v : quads_.mesh.face(f)) add_around(v, cells);
  }
}

/// The other cell at an edge of a cell; kNone at the boundary.
Index InlayCutter::neighbour(Index cell, Index a, Index b) const {
  for (const Index f : around_.faces(a)) {
    if (f != cell && std::ranges::binary_search(around_.faces(b), f)) return f;
  }
  return kNone;
}

std::optional<InlayCutter::Patch> InlayCutter::patch_of(std::set<Index> cells) const {
  const auto for_sides = [&](Index f, const auto& visit) {
    const std::span<const Index> face = quads_.mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Index next = face[(i + 1) % face.size()];
      visit(face[i], next, neighbour(f, face[i], next));
    }
  };
  for (int i = 0; i < kMostClosings; ++i) {
    add_enclosed(cells, [&](Index f, const auto& visit) {
      for_sides(f, [&](Index /*from*/, Index /*to*/, Index beyond) { visit(beyond); });
    });
    std::vector<Polygon> faces;
    std::set<std::pair<Index, Index>> boundary;
    for (const Index f : cells) {
      const std::span<const Index> face = quads_.mesh.face(f);
      faces.emplace_back(face.begin(), face.end());
      for_sides(f, [&](Index from, Index to, Index beyond) {
        if (beyond == kNone) boundary.emplace(from, to);
      });
    }
    PatchOutline outline = patch_outline(faces, {}, [&](Index a, Index b) {
      return boundary.contains({a, b});
    });
    if (outline.pinched.empty()) return Patch{{cells.begin(), cells.end()}, std::move(outline)};
    for (const Index v : outline.pinched) add_around(v, cells);
  }
  return std::nullopt;
}

/// Joins a path of an inlay's outline to one around its faces, both closed or both open.
/// \param outer, inner  corners of the inlay
/// \return whether that could be
bool InlayCutter::add_band(std::span<const Index> outer, std::span<const Index> inner,
                           bool is_closed, Inlay& inlay) const {
  if (outer.size() * inner.size() > kMostBandEdges) return false;
  if (is_closed && std::min(outer.size(), inner.size()) < 3) return false;
  struct End {
    SurfacePoint foot;
    Vec3 place;
  };
  std::vector<End> outer_ends;
  for (const Index corner : outer) {
    const Index vertex = inlay.outline[corner];
    outer_ends.push_back({foot_of(quads_.provenance, vertex), surfaces_.positions()[vertex]});
  }
  std::vector<End> inner_ends;
  for (const Index corner : inner) {
    const SurfacePoint& point = inlay.points[corner - static_cast<Index>(inlay.outline.size())];
    inner_ends.push_back({point, place_of(surfaces_.mesh(), point)});
  }
  const auto square = [&](std::size_t i, std::size_t j) {
    return (outer_ends[i].place - inner_ends[j].place).squaredNorm();
  };
  const auto is_along = [&](std::size_t i, std::size_t j) {
    return lines_.has_along(outer_ends[i].foot, inner_ends[j].foot);
  };
  const auto cost = [&](std::size_t i, std::size_t j) {
    const Vec3 middle = 0.5 * (outer_ends[i].place + inner_ends[j].place);
    const double off = surfaces_.input().closest(middle).distance;
    const double sum = square(i, j) + kOffCost * off * off;
    return is_along(i, j) ? kAlongLine * sum : sum;
  };
  const auto least = [&](std::size_t i, std::size_t j) {
    return is_along(i, j) ? 0.0 : square(i, j);
  };
  std::set<std::array<Index, 2>> across;
  for (std::array<Index, 3> triangle : is_closed
                                           ? fill_band(outer.size(), inner.size(), cost, least)
                                           : fill_strip(outer.size(), inner.size(), cost, least)) {
    for (Index& v : triangle) {
      const auto at = static_cast<std::size_t>(v);
      v = at < outer.size() ? outer[at] : inner[at - outer.size()];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangle[i];
      const Index b = triangle[(i + 1) % 3];
      const auto first_point = static_cast<Index>(inlay.outline.size());
      // From one corner all around the other polygon: an edge would have four triangles.
      if (a >= first_point && b < first_point && !across.insert({a, b}).second) return false;
    }
    inlay.faces.push_back(triangle);
  }
  return true;
}

/// Joins each path of an inlay's outline to the nearest one around its faces.
/// \param ring  like the outline, its vertices are corners of the inlay
/// \return whether that could be
bool InlayCutter::add_bands(const PatchOutline& outline, const PatchOutline& ring,
                            Inlay& inlay) const {
  const auto distance = [&](const Polygon& outer, const Polygon& inner) {
    double sum = 0;
    for (const Index v : outer) {
      double least = std::numeric_limits<double>::infinity();
      for (const Index corner : inner) {
        const SurfacePoint& point = inlay.points[corner - inlay.outline.size()];
        const Vec3 way = place_of(surfaces_.mesh(), point) - surfaces_.positions()[v];
        least = std::min(least, way.squaredNorm());
      }
      sum += least;
    }
    return sum;
  };
  std::vector<PatchOutline::Path> left = ring.paths;
  Index first = 0;
  for (const auto& [outer, is_closed] : outline.paths) {
    std::size_t nearest = left.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i].is_closed != is_closed) continue;
      const double now = distance(outer, left[i].vertices);
      if (nearest < left.size() && now >= least) continue;
      nearest = i;
      least = now;
    }
    if (nearest == left.size()) return false;
    std::vector<Index> corners(outer.size());
    std::iota(corners.begin(), corners.end(), first);
    first += static_cast<Index>(outer.size());
    if (!add_band(corners, left[nearest].vertices, is_closed, inlay)) return false;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(nearest));
  }
  return true;
}

/// The input's component that cells of a component were made from, undivided.
std::optional<Inlay> InlayCutter::whole_component(std::vector<Index> cells) const {
  if (cells.size() > most_whole_) return std::nullopt;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Eigen::AlignedBox3d everywhere(Vec3::Constant(-kFar), Vec3::Constant(kFar));
  const Index foot = quads_.provenance.face[quads_.mesh.face(cells.front())[0]];
  SurfacePart part = surface_part(surfaces_.mesh(), {foot}, everywhere, kFar, kMostFaces);
  const std::set<Index> faces(part.parent.begin(), part.parent.end());
  const auto is_on_it = [&](Index v) { return faces.contains(quads_.provenance.face[v]); };
  for (const Index cell : cells) {  // feet may have moved to another component near by
    if (!std::ranges::all_of(quads_.mesh.face(cell), is_on_it)) return std::nullopt;
  }
  return Inlay{std::move(cells), {}, std::move(part.points), std::move(part.faces)};
}

std::optional<Inlay> InlayCutter::cut(const std::set<Index>& cells) const {
  std::optional<Patch> patch = patch_of(cells);
  if (!patch) return std::nullopt;
  if (patch->outline.paths.empty()) return whole_component(std::move(patch->cells));
  Cover cover(*this, *patch);
  PatchOutline ring;
  const std::vector<Index> faces = cover.faces(ring);
  if (faces.empty() || !ring.is_like(patch->outline)) return std::nullopt;
  const SurfacePart& part = cover.part();
  Inlay inlay{std::move(patch->cells), {}, {}, {}};
  for (const PatchOutline::Path& path : patch->outline.paths) {
    inlay.outline.insert(inlay.outline.end(), path.vertices.begin(), path.vertices.end());
  }
  std::map<Index, Index> number;  // of the part's vertices that are used
  for (const Index f : faces) {
    std::array<Index, 3> face = part.faces[f];
    for (Index& v : face) {
      const auto [at, is_new] = number.try_emplace(v, static_cast<Index>(inlay.points.size()));
      if (is_new) inlay.points.push_back(part.points[v]);
      v = static_cast<Index>(inlay.outline.size()) + at->second;
    }
    inlay.faces.push_back(face);
  }
  for (PatchOutline::Path& path : ring.paths) {
    for (Index& v : path.vertices) v = static_cast<Index>(inlay.outline.size()) + number.at(v);
  }
  if (!add_bands(patch->outline, ring, inlay)) return std::nullopt;
  return inlay;
}

}  // namespace strake

#include "common/geometry/samples/surface_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>

#include "common/core/error.h"
#include "common/geometry/samples/planar_triangulation.h"
#include "common/geometry/segment.h"

namespace strake {
namespace {

/// Wanted edge length grows by at most this per unit of distance.
constexpr double kGrading = 0.25;
/// A triangle is split while its circumradius exceeds this share of the wanted edge length; new
/// points are then at least this far from others (Chew 1989).
constexpr double kSplitRadius = 0.8;
/// A new point is given up where it would come closer than these shares of the wanted edge length
/// to a vertex, or of an edge's length to an edge of the rim.
constexpr double kVertexClearance = 0.55;
constexpr double kRimClearance = 0.4;

double circumradius(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area2 = (b - a).cross(c - a).norm();
  return (b - a).norm() * (c - b).norm() * (a - c).norm() / (2 * area2);
}

/// The triangulation of one patch: rim first, then points inside until all triangles are small.
class PatchFiller {
 public:
  PatchFiller(const ChartedSurface& surface, double size, SurfaceDraft& draft,
              std::vector<double>& vertex_size, PlanarTriangulation& plane)
      : surface_(surface), size_(size), draft_(draft), vertex_size_(vertex_size), plane_(plane) {
    global_.assign(PlanarTriangulation::kFirstVertex, kNone);
  }

  /// Gives the next vertex of the plane its place in the draft.
  void append(Index global) { global_.push_back(global); }

  void refine() {
    for (Index t = 0; t < static_cast<Index>(plane_.triangles().size()); ++t) enqueue(t);
    while (!queue_.empty()) {
      const Task task = queue_.top();
      queue_.pop();
      if (plane_.triangles()[task.triangle].version == task.version) split(task.triangle);
    }
  }

  void output(Index region) {
    double agreement = 0;
    const std::size_t first = draft_.faces.size();
    for (const auto& t : plane_.triangles()) {
      if (!t.inside) continue;
      const std::array<Index, 3> face = {global_[t.vertices[0]], global_[t.vertices[1]],
                                         global_[t.vertices[2]]};
      const Vec3 &a = at(face[0]), &b = at(face[1]), &c = at(face[2]);
      agreement += (b - a).cross(c - a).dot(surface_.normal(surface_.project((a + b + c) / 3)));
      draft_.faces.push_back(face);
      draft_.face_region.push_back(region);
    }
    if (agreement > 0) return;
    for (std::size_t f = first; f < draft_.faces.size(); ++f) {
      std::swap(draft_.faces[f][1], draft_.faces[f][2]);
    }
  }

 private:
  struct Task {
    double excess;
    Index triangle;
    std::uint32_t version;
    bool operator<(const Task& other) const {
      return excess != other.excess ? excess < other.excess : triangle > other.triangle;
    }
  };

  [[nodiscard]] const Vec3& at(Index global) const { return draft_.positions[global]; }

  [[nodiscard]] double wanted_size(const std::array<Index, 3>& vertices, const Vec3& p) const {
    double wanted = size_;
    for (const Index v : vertices) {
      const Index g = global_[v];
      wanted = std::min(wanted, vertex_size_[g] + kGrading * (at(g) - p).norm());
    }
    return wanted;
  }

  void enqueue(Index triangle) {
    const auto& t = plane_.triangles()[triangle];
    if (!t.inside) return;
    const Vec3 &a = at(global_[t.vertices[0]]), &b = at(global_[t.vertices[1]]),
               &c = at(global_[t.vertices[2]]);
    const double excess = circumradius(a, b, c) / wanted_size(t.vertices, (a + b + c) / 3);
    if (excess > kSplitRadius) queue_.push({excess, triangle, t.version});
  }

  void split(Index triangle) {
    const Vec2 centre = plane_.circumcentre(triangle);
    const std::array<Index, 3> vertices = plane_.triangles()[triangle].vertices;
    if (!plane_.open_cavity(centre, triangle, true)) return;
    const Vec3 p = surface_.lift(centre);
    const double wanted = wanted_size(vertices, p);
    for (const auto& edge : plane_.cavity()) {
      const Vec3 &a = at(global_[edge.from]), &b = at(global_[edge.to]);
      if ((p - a).norm() < kVertexClearance * wanted) return;
      if (edge.locked != 0 && way_to_segment(p, a, b).norm() < kRimClearance * (b - a).norm())
        return;
    }
    plane_.fill_cavity();
    global_.push_back(static_cast<Index>(draft_.positions.size()));
    draft_.positions.push_back(p);
    draft_.vertex_surface.push_back(&surface_);
    vertex_size_.push_back(wanted);
    for (const Index t : plane_.fresh()) enqueue(t);
  }

  const ChartedSurface& surface_;
  double size_;
  SurfaceDraft& draft_;
  std::vector<double>& vertex_size_;
  PlanarTriangulation& plane_;
  std::vector<Index> global_;  ///< [plane vertices] vertex of the draft
  std::priority_queue<Task> queue_;
};

}  // namespace

Index SurfaceBuilder::add_vertex(const Vec3& position, double size) {
  draft_.positions.push_back(position);
  draft_.vertex_surface.push_back(nullptr);
  vertex_size_.push_back(size);
  return static_cast<Index>(draft_.positions.size()) - 1;
}

Index SurfaceBuilder::add_corner(const Vec3& position) {
  return add_vertex(position, std::numeric_limits<double>::infinity());
}

SurfaceBuilder::Curve SurfaceBuilder::sample(const CurveFunction& at, double spacing, bool closed,
                                             Index from, Index to) {
  // Arc length along a fine polyline; the samples themselves are evaluated on the curve.
  constexpr int kSteps = 2000;
  std::vector<double> length(kSteps + 1, 0.0);
  Vec3 previous = at(0);
  for (int i = 1; i <= kSteps; ++i) {
    const Vec3 p = at(static_cast<double>(i) / kSteps);
    length[i] = length[i - 1] + (p - previous).norm();
    previous = p;
  }
  const double total = length.back();
  const int count = std::max(closed ? 3 : 1, static_cast<int>(std::lround(total / spacing)));
  const double step = total / count;
  Curve curve;
  curve.closed = closed;
  if (!closed) curve.vertices.push_back(from);
  for (int i = closed ? 0 : 1; i < count; ++i) {
    // At most a quarter of a step to either side: neighbours stay half a step apart.
    const double target = step * (i + 0.25 * curve_jitter_ * random_.symmetric());
    const auto above = std::upper_bound(length.begin(), length.end(), target);
    const auto k = std::clamp<std::ptrdiff_t>(above - length.begin(), 1, kSteps);
    const double share = (target - length[k - 1]) / (length[k] - length[k - 1]);
    curve.vertices.push_back(add_vertex(at((static_cast<double>(k - 1) + share) / kSteps), step));
  }
  if (!closed) {
    curve.vertices.push_back(to);
    vertex_size_[from] = std::min(vertex_size_[from], step);
    vertex_size_[to] = std::min(vertex_size_[to], step);
  }
  return curve;
}

Index SurfaceBuilder::add_curve(Index from, Index to, const CurveFunction& at, double spacing) {
  curves_.push_back(sample(at, spacing, false, from, to));
  return static_cast<Index>(curves_.size()) - 1;
}

Index SurfaceBuilder::add_loop(const CurveFunction& at, double spacing) {
  curves_.push_back(sample(at, spacing, true, kNone, kNone));
  return static_cast<Index>(curves_.size()) - 1;
}

Index SurfaceBuilder::add_seam(const CurveFunction& at, double spacing, const SurfacePtr& surface) {
  Curve curve = sample(at, spacing, true, kNone, kNone);
  curve.locked = false;
  const double step = vertex_size_.back();
  for (const Index v : curve.vertices) {
    const Vec3 shift = random_.in_cube();
    draft_.positions[v] = surface->project(draft_.positions[v] + 0.2 * step * shift);
    draft_.vertex_surface[v] = surface.get();
  }
  curves_.push_back(std::move(curve));
  return static_cast<Index>(curves_.size()) - 1;
}

void SurfaceBuilder::add_patch(const SurfacePtr& surface, double size,
                               const std::vector<Index>& curves, Index region) {
  draft_.surfaces.push_back(surface);
  std::vector<Index> local(draft_.positions.size(), kNone);
  std::vector<Index> rim;  // vertices of the curves, each once, in order
  std::vector<Vec2> chart;
  for (const Index c : curves) {
    for (const Index v : curves_[c].vertices) {
      if (local[v] != kNone) continue;
      local[v] = PlanarTriangulation::kFirstVertex + static_cast<Index>(rim.size());
      rim.push_back(v);
      chart.push_back(surface->flatten(draft_.positions[v]));
    }
  }
  Vec2 lower = chart.front(), upper = chart.front();
  for (const Vec2& p : chart) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const auto refuse = [&] {
    throw AlgorithmError("sample: region " + std::to_string(region) +
                         " cannot be triangulated at this resolution; ask for more faces");
  };
  PlanarTriangulation plane(lower, upper);
  PatchFiller filler(*surface, size, draft_, vertex_size_, plane);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    if (plane.insert(chart[i]) == kNone) refuse();
    filler.append(rim[i]);
  }
  for (const Index c : curves) {
    const auto& vertices = curves_[c].vertices;
    const std::size_t edges = vertices.size() - (curves_[c].closed ? 0 : 1);
    for (std::size_t i = 0; i < edges; ++i) {
      const Index a = vertices[i], b = vertices[(i + 1) % vertices.size()];
      if (!plane.lock_edge(local[a], local[b])) refuse();
      if (curves_[c].locked) draft_.locked.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  plane.mark_inside();
  filler.refine();
  filler.output(region);
}

SurfaceDraft SurfaceBuilder::finish() {
  std::sort(draft_.locked.begin(), draft_.locked.end());
  draft_.locked.erase(std::unique(draft_.locked.begin(), draft_.locked.end()), draft_.locked.end());
  return std::move(draft_);
}

}  // namespace strake

#include "tests/unit/mesh/line_sets.h"

#include <algorithm>
#include <queue>

namespace strake {

void add_line(LineSet& lines, const std::vector<LinePoint>& points, const std::vector<Index>& faces,
              LineFamily family) {
  const bool closed = faces.size() == points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    lines.points.push_back(points[i]);
    lines.chord_face.push_back(i < faces.size() ? faces[i] : kNone);
    lines.chord_family.push_back(family);
  }
  lines.seed_point.push_back(lines.offsets.back());
  lines.offsets.push_back(static_cast<Index>(lines.points.size()));
  lines.family.push_back(family);
  const LineEnd end = closed ? LineEnd::closed : LineEnd::boundary;
  lines.start_reason.push_back(end);
  lines.end_reason.push_back(end);
}

void add_level_lines(const TriMesh& mesh, const std::function<double(const Vec3&)>& function,
                     LineFamily family, LineSet& lines) {
  std::vector<double> value;
  for (const Vec3& p : mesh.positions) value.push_back(function(p));
  // Lines run with the positive side on their left: they leave faces over rising half-edges' twins.
  const auto leaves = [&](Index h) { return value[mesh.from(h)] < 0 && value[mesh.to(h)] > 0; };
  const auto point = [&](Index h) {
    const double a = value[mesh.from(h)];
    return LinePoint{h, a / (a - value[mesh.to(h)])};
  };
  std::vector<char> used(mesh.halfedge_count(), 0);
  const auto follow = [&](Index start) {  // half-edge through which the line enters its first face
    std::vector<LinePoint> points = {point(start)};
    std::vector<Index> faces;
    for (Index h = start;;) {
      used[h] = 1;
      faces.push_back(TriMesh::face_of(h));
      const Index exit = leaves(TriMesh::next(h)) ? TriMesh::next(h) : TriMesh::prev(h);
      h = mesh.twin[exit];
      if (h == start) break;
      points.push_back(point(exit));
      if (h == kNone) break;
    }
    add_line(lines, points, faces, family);
  };
  const auto enters = [&](Index h) { return value[mesh.from(h)] > 0 && value[mesh.to(h)] < 0; };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h) && enters(h)) follow(h);
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (used[h] == 0 && enters(h)) follow(h);
  }
}

void add_random_loop(const TriMesh& mesh, int steps, std::mt19937_64& random, LineSet& lines) {
  const auto onwards = [&](Index exit, bool left) {
    const Index entry = mesh.twin[exit];
    return left ? TriMesh::prev(entry) : TriMesh::next(entry);
  };
  std::vector<Index> exits = {static_cast<Index>(random() % mesh.halfedge_count())};
  for (int i = 0; i < steps; ++i) exits.push_back(onwards(exits.back(), random() % 2 == 0));
  // Home by the fewest faces.
  std::vector<Index> before(mesh.halfedge_count(), kNone);
  std::queue<Index> queue({exits.back()});
  while (before[exits.front()] == kNone) {
    const Index at = queue.front();
    queue.pop();
    for (const bool left : {false, true}) {
      const Index next = onwards(at, left);
      if (before[next] != kNone) continue;
      before[next] = at;
      queue.push(next);
    }
  }
  std::vector<Index> home;
  for (Index h = before[exits.front()]; h != exits.back(); h = before[h]) home.push_back(h);
  exits.insert(exits.end(), home.rbegin(), home.rend());
  std::vector<LinePoint> points;
  std::vector<Index> faces;
  for (const Index h : exits) {
    points.push_back({h, std::uniform_real_distribution<double>(0.01, 0.99)(random)});
    faces.push_back(TriMesh::face_of(mesh.twin[h]));
  }
  add_line(lines, points, faces);
}

void set_spacing(const TriMesh& mesh, double spacing, LineSet& lines) {
  lines.spacing_along_min.assign(mesh.wedge_count(), spacing);
  lines.spacing_along_max.assign(mesh.wedge_count(), spacing);
}

LineSet subset(const LineSet& lines, const std::function<bool(Index)>& keep) {
  LineSet result;
  result.mesh_id = lines.mesh_id;
  result.spacing_along_min = lines.spacing_along_min;
  result.spacing_along_max = lines.spacing_along_max;
  for (Index l = 0; l < lines.line_count(); ++l) {
    if (!keep(l)) continue;
    const auto first = lines.offsets[l];
    const auto last = lines.offsets[l + 1];
    const auto copy = [&](auto& to, const auto& from) {
      to.insert(to.end(), from.begin() + first, from.begin() + last);
    };
    result.seed_point.push_back(result.offsets.back() + lines.seed_point[l] - first);
    copy(result.points, lines.points);
    copy(result.chord_face, lines.chord_face);
    copy(result.chord_family, lines.chord_family);
    result.offsets.push_back(static_cast<Index>(result.points.size()));
    result.family.push_back(lines.family[l]);
    result.start_reason.push_back(lines.start_reason[l]);
    result.end_reason.push_back(lines.end_reason[l]);
  }
  return result;
}

}  // namespace strake

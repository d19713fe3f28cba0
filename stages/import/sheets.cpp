#include "stages/import/sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "common/core/tri_mesh.h"
#include "stages/import/one_sided.h"

namespace strake::import {
namespace {

void pair_up(std::vector<Index>& twin, Index a, Index b) {
  twin[a] = b;
  twin[b] = a;
}

void unpair(std::vector<Index>& twin, Index h) {
  twin[twin[h]] = kNone;
  twin[h] = kNone;
}

/// One connected, as yet unoriented piece.
struct Sheet {
  std::vector<Index> faces;
  double area = 0;          ///< of all faces
  double flipped_area = 0;  ///< of those turned against the first
  std::int64_t flipped = 0;
  /// Signed, of the cones from the first vertex, with the orientation of the first face throughout.
  double volume = 0;
  Vec3 normal = Vec3::Zero();  ///< of all faces with that orientation, times their area
  Vec3 centre = Vec3::Zero();  ///< of all faces, from the first vertex, times their area
  bool is_closed = true;
  bool is_one_sided = false;  ///< so that no way to turn its faces makes all look alike
};

/// Orients the pieces that the twins join.
class Orienter {
 public:
  Orienter(Soup& soup, std::vector<Index>& twin, Repairs& repairs)
      : soup_(soup), twin_(twin), repairs_(repairs), side_(soup.faces.size(), kUnseen) {}

  void run() {
    const bool consistent = [&] {
      for (Index h = 0; h < soup_.halfedge_count(); ++h) {
        if (twin_[h] != kNone && soup_.from(h) == soup_.from(twin_[h])) return false;
      }
      return true;
    }();
    if (consistent) return;
    std::vector<std::uint8_t> flip(soup_.faces.size(), 0);
    for (Index seed = 0; seed < soup_.face_count(); ++seed) {
      if (side_[seed] != kUnseen) continue;
      const Sheet sheet = collect(seed);
      if (sheet.is_one_sided) {
        cut(sheet, flip);
      } else {
        mark(sheet, flip);
      }
    }
    apply(flip);
  }

 private:
  static constexpr std::uint8_t kUnseen = 2;

  /// Cuts a piece that has only one side, and orients what is left of it.
  void cut(const Sheet& sheet, std::vector<std::uint8_t>& flip) {
    for (const Index h : cuts_of_one_sided(soup_, twin_, sheet.faces)) {
      unpair(twin_, h);
      ++repairs_.non_orientable_cuts;
    }
    for (const Index f : sheet.faces) side_[f] = kUnseen;
    for (const Index f : sheet.faces) {
      if (side_[f] == kUnseen) mark(collect(f), flip);
    }
  }

  /// Marks the faces of a piece that are to be turned over.
  void mark(const Sheet& sheet, std::vector<std::uint8_t>& flip) const {
    const bool flip_others = should_flip_others(sheet);
    for (const Index f : sheet.faces) flip[f] = (side_[f] == 1) == flip_others ? 1 : 0;
  }

  /// Walks over a piece, and notes which faces are turned against the first, and whether that
  /// contradicts itself.
  Sheet collect(Index seed) {
    Sheet sheet;
    side_[seed] = 0;
    sheet.faces.push_back(seed);
    for (std::size_t i = 0; i < sheet.faces.size(); ++i) {
      const Index f = sheet.faces[i];
      add_measures(f, sheet);
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (twin_[h] == kNone) {
          sheet.is_closed = false;
          continue;
        }
        const Index g = twin_[h] / 3;
        const bool turned = soup_.from(h) == soup_.from(twin_[h]);
        const auto side = static_cast<std::uint8_t>(side_[f] ^ (turned ? 1 : 0));
        if (side_[g] == kUnseen) {
          side_[g] = side;
          sheet.faces.push_back(g);
        } else if (side_[g] != side) {
          sheet.is_one_sided = true;
        }
      }
    }
    return sheet;
  }

  void add_measures(Index f, Sheet& sheet) const {
    const auto& [a, b, c] = soup_.faces[f];
    const Vec3& first = soup_.positions[soup_.faces[sheet.faces[0]][0]];
    const Vec3 p = soup_.positions[a] - first;
    const Vec3 q = soup_.positions[b] - first;
    const Vec3 r = soup_.positions[c] - first;
    const Vec3 normal = (side_[f] == 1 ? -0.5 : 0.5) * (q - p).cross(r - p);
    const double area = normal.norm();
    sheet.area += area;
    sheet.volume += normal.dot(p) / 3;
    sheet.normal += normal;
    sheet.centre += area / 3 * (p + q + r);
    if (side_[f] == 1) {
      sheet.flipped_area += area;
      ++sheet.flipped;
    }
  }

  /// Whether the faces turned against the first are to be turned over, rather than the others: what
  /// most of them say; where that is not clear, a closed or hollow piece looks outwards.
  static bool should_flip_others(const Sheet& sheet) {
    constexpr double kClearMajority = 0.25;
    const auto count = static_cast<std::int64_t>(sheet.faces.size());
    const double minority = static_cast<double>(std::min(sheet.flipped, count - sheet.flipped)) /
                            static_cast<double>(count);
    if (minority > kClearMajority && is_hollow(sheet)) return volume_within(sheet) >= 0;
    if (2 * sheet.flipped != count) return 2 * sheet.flipped < count;
    return 2 * sheet.flipped_area <= sheet.area;
  }

  /// The volume of an open piece is that of the cones from its centre of area.
  static double volume_within(const Sheet& sheet) {
    if (sheet.is_closed || !(sheet.area > 0)) return sheet.volume;
    return sheet.volume - sheet.centre.dot(sheet.normal) / (3 * sheet.area);
  }

  /// Whether a piece encloses enough to have an inside: a sphere's volume is 0.094 of what is
  /// compared with here, half a sphere's 0.1.
  static bool is_hollow(const Sheet& sheet) {
    constexpr double kHollow = 0.01;
    return sheet.is_closed || std::abs(volume_within(sheet)) > kHollow * std::pow(sheet.area, 1.5);
  }

  void apply(const std::vector<std::uint8_t>& flip) {
    const auto renamed = [&](Index h) {
      return h == kNone || flip[h / 3] == 0 ? h : 3 * (h / 3) + 2 - h % 3;
    };
    std::vector<Index> twin(twin_.size());
    for (Index h = 0; h < soup_.halfedge_count(); ++h) twin[renamed(h)] = renamed(twin_[h]);
    twin_ = std::move(twin);
    for (Index f = 0; f < soup_.face_count(); ++f) {
      if (flip[f] == 0) continue;
      std::swap(soup_.faces[f][1], soup_.faces[f][2]);
      if (!soup_.texture.empty()) std::swap(soup_.texture[f][1], soup_.texture[f][2]);
      ++repairs_.flipped_faces;
    }
  }

  Soup& soup_;
  std::vector<Index>& twin_;
  Repairs& repairs_;
  std::vector<std::uint8_t> side_;  ///< 0 as the first face of its sheet, 1 against it
};

/// A face at an edge of three or more faces.
struct Flap {
  Index halfedge;
  bool along;    ///< whether the half-edge runs in the direction the angles refer to
  double angle;  ///< around the edge, of the face's apex
};

double turn(double from, double to) {
  const double difference = to - from;
  return difference < 0 ? difference + 2 * std::numbers::pi : difference;
}

/// The faces around an edge in order of angle; empty where one of them has no area.
std::vector<Flap> sort_flaps(const Soup& soup, std::span<const Index> halfedges) {
  const Index from = soup.from(halfedges[0]);
  const Vec3& origin = soup.positions[from];
  const Vec3 axis = soup.positions[soup.to(halfedges[0])] - origin;
  std::vector<Flap> flaps;
  if (!(axis.squaredNorm() > 0)) return flaps;
  const Vec3 direction = axis.normalized();
  const Vec3 x = direction.unitOrthogonal();
  const Vec3 y = direction.cross(x);
  for (const Index h : halfedges) {
    const Vec3 apex = soup.positions[soup.from(TriMesh::prev(h))] - origin;
    if (!(direction.cross(apex).norm() > 0)) return {};
    flaps.push_back({h, soup.from(h) == from, std::atan2(apex.dot(y), apex.dot(x))});
  }
  std::sort(flaps.begin(), flaps.end(), [](const Flap& a, const Flap& b) {
    return std::pair(a.angle, a.halfedge) < std::pair(b.angle, b.halfedge);
  });
  return flaps;
}

/// Pairs the faces of an edge where solids meet: around it, faces look alternately one way and the
/// other. Each pair bounds one of the wedges filled with material.
bool pair_solids(const std::vector<Flap>& flaps, std::vector<Index>& twin) {
  const std::size_t count = flaps.size();
  if (count % 2 != 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (flaps[i].along == flaps[(i + 1) % count].along) return false;
  }
  // A face whose half-edge runs along the axis has its back on the side of lesser angles.
  for (std::size_t i = flaps[0].along ? 1 : 0; i < count; i += 2) {
    pair_up(twin, flaps[i].halfedge, flaps[(i + 1) % count].halfedge);
  }
  return true;
}

/// Pairs faces that continue each other most nearly in a plane; the rest stays apart.
void pair_flattest(const std::vector<Flap>& flaps, std::vector<Index>& twin) {
  constexpr double kSteepest = std::numbers::pi / 3;
  struct Candidate {
    double bend;
    Index a;
    Index b;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < flaps.size(); ++i) {
    for (std::size_t j = i + 1; j < flaps.size(); ++j) {
      if (flaps[i].along == flaps[j].along) continue;
      const double bend = std::abs(turn(flaps[i].angle, flaps[j].angle) - std::numbers::pi);
      if (bend <= kSteepest) candidates.push_back({bend, flaps[i].halfedge, flaps[j].halfedge});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.bend, a.a, a.b) < std::tie(b.bend, b.a, b.b);
  });
  for (const Candidate& candidate : candidates) {
    if (twin[candidate.a] == kNone && twin[candidate.b] == kNone) {
      pair_up(twin, candidate.a, candidate.b);
    }
  }
}

void pair_non_manifold(const Soup& soup, std::span<const Index> halfedges,
                       std::vector<Index>& twin) {
  constexpr std::size_t kMostFlaps = 64;  // pairing by angle is quadratic; cut such a fan apart
  if (halfedges.size() > kMostFlaps) return;
  const std::vector<Flap> flaps = sort_flaps(soup, halfedges);
  if (!flaps.empty() && !pair_solids(flaps, twin)) pair_flattest(flaps, twin);
}

/// Gives every fan of faces around a vertex a vertex of its own.
void split_vertices(Soup& soup, const std::vector<Index>& twin, Repairs& repairs) {
  std::vector<std::uint8_t> seen(soup.halfedge_count(), 0);
  std::vector<std::uint8_t> taken(soup.vertex_count(), 0);
  std::vector<Triangle> faces = soup.faces;
  for (Index h = 0; h < soup.halfedge_count(); ++h) {
    if (seen[h] != 0) continue;
    Index v = soup.from(h);
    if (taken[v] != 0) {
      soup.positions.push_back(Vec3(soup.positions[v]));
      soup.source_vertex.push_back(Index{soup.source_vertex[v]});
      v = soup.vertex_count() - 1;
      ++repairs.split_vertices;
    } else {
      taken[v] = 1;
    }
    Index start = h;
    while (twin[start] != kNone && TriMesh::next(twin[start]) != h)
      start = TriMesh::next(twin[start]);
    Index corner = start;
    do {
      seen[corner] = 1;
      faces[corner / 3][corner % 3] = v;
      corner = twin[TriMesh::prev(corner)];
    } while (corner != kNone && corner != start);
  }
  soup.faces = std::move(faces);
}

/// Gives the corners of a face that is cut in the middle of edge e, and of the new face, their
/// texture coordinates.
void split_texture(Soup& soup, Index e) {
  std::array<TexturePoint, 3>& old = soup.texture[e / 3];
  const TexturePoint from = old[e % 3];
  const TexturePoint to = old[TriMesh::next(e) % 3];
  const TexturePoint middle = {0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])};
  const std::array<TexturePoint, 3> added = {middle, to, old[TriMesh::prev(e) % 3]};
  old[TriMesh::next(e) % 3] = middle;
  soup.texture.push_back(added);
}

/// Puts a vertex into the middle of an edge; its one or two faces become two each.
void split_edge(Soup& soup, std::vector<Index>& twin, Index h) {
  const Index from = soup.from(h);
  const Index to = soup.to(h);
  soup.positions.push_back(0.5 * (soup.positions[from] + soup.positions[to]));
  soup.source_vertex.push_back(kNone);
  const Index middle = soup.vertex_count() - 1;
  const Index other = twin[h];
  // Face (from, to, apex) keeps (from, middle, apex) and gives (middle, to, apex) to a new face.
  const auto cut = [&](Index e) {
    const Index added = soup.face_count();
    const Triangle face = {middle, soup.to(e), soup.from(TriMesh::prev(e))};
    soup.faces.push_back(face);
    soup.source_face.push_back(Index{soup.source_face[e / 3]});
    if (!soup.texture.empty()) split_texture(soup, e);
    soup.faces[e / 3][(e % 3 + 1) % 3] = middle;
    twin.insert(twin.end(), 3, kNone);
    if (twin[TriMesh::next(e)] != kNone) pair_up(twin, 3 * added + 1, twin[TriMesh::next(e)]);
    pair_up(twin, TriMesh::next(e), 3 * added + 2);
    return 3 * added;
  };
  const Index first = cut(h);
  if (other == kNone) return;
  const Index second = cut(other);
  pair_up(twin, h, second);
  pair_up(twin, other, first);
}

/// Splits all but one of the different edges of a group, or joins the two sides of a slit.
void separate_group(Soup& soup, std::vector<Index>& twin, std::span<const Index> group,
                    Repairs& repairs) {
  if (group.size() == 2 && soup.from(group[0]) != soup.from(group[1])) {
    pair_up(twin, group[0], group[1]);
    return;
  }
  for (const Index h : group.subspan(1)) {
    const bool was_split = twin[h] != kNone && twin[h] < h;
    if (was_split || twin[h] == group[0]) continue;
    split_edge(soup, twin, h);
    ++repairs.inserted_vertices;
  }
}

/// Tells apart edges that have the same two end points although they are different edges.
/// \return whether some have to wait for another round, as their faces have changed
bool separate_double_edges(Soup& soup, std::vector<Index>& twin, Repairs& repairs) {
  const EdgeGroups groups(soup);
  std::vector<std::uint8_t> changed(soup.faces.size(), 0);
  bool has_postponed = false;
  for (Index g = 0; g < groups.size(); ++g) {
    const auto group = groups[g];
    if (group.size() == 1 || (group.size() == 2 && twin[group[0]] == group[1])) continue;
    if (std::any_of(group.begin(), group.end(), [&](Index h) { return changed[h / 3] != 0; })) {
      has_postponed = true;
      continue;
    }
    for (const Index h : group) changed[h / 3] = 1;
    separate_group(soup, twin, group, repairs);
  }
  return has_postponed;
}

}  // namespace

std::vector<Index> make_manifold(Soup& soup, Repairs& repairs) {
  std::vector<Index> twin(soup.halfedge_count(), kNone);
  std::vector<Index> crowded;  // groups of three faces and more
  {
    const EdgeGroups groups(soup);
    for (Index g = 0; g < groups.size(); ++g) {
      if (groups[g].size() == 2) pair_up(twin, groups[g][0], groups[g][1]);
      if (groups[g].size() > 2) crowded.push_back(g);
    }
  }
  Orienter(soup, twin, repairs).run();
  repairs.non_manifold_edges = static_cast<std::int64_t>(crowded.size());
  if (!crowded.empty()) {
    const EdgeGroups groups(soup);  // again: faces were turned over
    for (const Index g : crowded) pair_non_manifold(soup, groups[g], twin);
  }
  split_vertices(soup, twin, repairs);
  while (!crowded.empty() && separate_double_edges(soup, twin, repairs)) {
  }
  return twin;
}

}  // namespace strake::import

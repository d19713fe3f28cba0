#include "stages/tensor/part_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/core/error.h"
#include "common/geometry/mesh_measures.h"
#include "stages/tensor/cell_grid.h"

namespace strake {
namespace {

using Three = std::array<Index, 3>;

constexpr Index kRowsAtOnce = 1 << 18;
constexpr const char* kPhase = "reading the part of the mesh";

/// Calls visit(first, count) for all rows, block by block.
template <class Visit>
void for_each_block(Index rows, Visit visit) {
  for (Index first = 0; first < rows;) {
    const Index count = std::min(kRowsAtOnce, rows - first);
    visit(first, count);
    first += count;
  }
}

/// The wanted rows of an array of which read(first, count) gives blocks.
/// \param wanted  ascending
template <class Read>
auto rows_at(const std::vector<Index>& wanted, Index rows, Read read) {
  decltype(read(0, 0)) found;
  found.reserve(wanted.size());
  auto next = wanted.begin();
  for_each_block(rows, [&](Index first, Index count) {
    if (next == wanted.end() || *next >= first + count) return;
    const auto block = read(first, count);
    for (; next != wanted.end() && *next < first + count; ++next) {
      found.push_back(block[*next - first]);
    }
  });
  return found;
}

/// Place of a value in an ascending list; kNone where it is not there.
Index rank_in(const std::vector<Index>& sorted, Index value) {
  const auto found = std::lower_bound(sorted.begin(), sorted.end(), value);
  return found != sorted.end() && *found == value ? static_cast<Index>(found - sorted.begin())
                                                  : kNone;
}

void sort_unique(std::vector<Index>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Which wedges belong to the part, and which faces the balls around them can reach.
class PartSelection {
 public:
  PartSelection(const MeshBlocks& blocks, Index parts, Index part, double reach)
      : blocks_(blocks), grid_(bounding_box()), reach_(grid_.reach(reach)) {
    vertex_cell_.reserve(blocks_.header().vertices);
    for_each_block(blocks_.header().vertices, [&](Index first, Index count) {
      for (const Vec3& p : blocks_.positions(first, count))
        vertex_cell_.push_back(grid_.cell_of(p));
    });
    std::vector<Index> counts(kCellCount, 0);
    for_each_wedge([&](Index, Cell cell) { ++counts[cell]; });
    marks_ = cells_of_part(counts, parts, part);
  }

  [[nodiscard]] std::vector<Index> wedges() const {
    std::vector<Index> found;
    for_each_wedge([&](Index wedge, Cell cell) {
      if (marks_[cell] != 0) found.push_back(wedge);
    });
    return found;
  }

  /// Faces whose bounding box comes near a cell of the part.
  [[nodiscard]] std::vector<Index> faces() const {
    const MarkedCells marked(marks_);
    std::vector<Index> found;
    for_each_block(blocks_.header().faces, [&](Index first, Index count) {
      for (const Three& face : blocks_.faces(first, count)) {
        CellPosition low = position_of(vertex_cell_[face[0]]);
        CellPosition high = low;
        for (const Index vertex : face) {
          const CellPosition at = position_of(vertex_cell_[vertex]);
          for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], at[axis]);
            high[axis] = std::max(high[axis], at[axis]);
          }
        }
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] -= reach_;
          high[axis] += reach_;
        }
        if (marked.any_in(low, high)) found.push_back(first);
        ++first;
      }
    });
    return found;
  }

 private:
  [[nodiscard]] Eigen::AlignedBox3d bounding_box() const {
    Eigen::AlignedBox3d box;
    for_each_block(blocks_.header().vertices, [&](Index first, Index count) {
      for (const Vec3& p : blocks_.positions(first, count)) box.extend(p);
    });
    return box;
  }

  /// Calls visit(wedge, cell of its vertex) for all wedges of the mesh.
  template <class Visit>
  void for_each_wedge(Visit visit) const {
    for_each_block(blocks_.header().wedges, [&](Index first, Index count) {
      for (const Index vertex : blocks_.wedge_vertex(first, count)) {
        visit(first, vertex_cell_[vertex]);
        ++first;
      }
    });
  }

  const MeshBlocks& blocks_;
  CellGrid grid_;
  int reach_;                        ///< of the balls, in cells
  std::vector<Cell> vertex_cell_;    ///< [V]
  std::vector<std::uint8_t> marks_;  ///< 1 for the cells of the part
};

/// A half-edge of a PartMesh whose twin was left out.
struct Cut {
  Index halfedge = kNone;
  Index face_behind = kNone;  ///< of the whole mesh
};

/// Fills in twins from those of the whole mesh. \return the edges along which the part was cut out
std::vector<Cut> number_twins(PartMesh& part, const std::vector<Three>& twins) {
  std::vector<Cut> cuts;
  part.mesh.twin.assign(3 * twins.size(), kNone);
  for (Index h = 0; h < part.mesh.halfedge_count(); ++h) {
    const Index twin = twins[TriMesh::face_of(h)][h % 3];
    if (twin == kNone) continue;
    const Index kept = rank_in(part.face, TriMesh::face_of(twin));
    if (kept == kNone) {
      cuts.push_back({h, TriMesh::face_of(twin)});
    } else {
      part.mesh.twin[h] = 3 * kept + twin % 3;
    }
  }
  return cuts;
}

/// Gives the corners of the part's wedges their new numbers, and all others the last one.
/// \param vertices  [V] kept vertices of the whole mesh;
/// \param wedge_vertex  [n] in it
void number_wedges(PartMesh& part, const std::vector<Index>& vertices,
                   const std::vector<Index>& wedge_vertex) {
  const auto others = static_cast<Index>(part.wedge.size());
  std::vector<std::uint8_t> is_used(part.wedge.size(), 0);
  const auto refuse = [&](Index w) {
    throw InputError("wedge " + std::to_string(part.wedge[w]) +
                     " of the mesh contradicts the faces; the file is damaged, make it again");
  };
  for (Index h = 0; h < part.mesh.halfedge_count(); ++h) {
    Index& wedge = part.mesh.face_wedges[TriMesh::face_of(h)][h % 3];
    const Index rank = rank_in(part.wedge, wedge);
    wedge = rank == kNone ? others : rank;
    if (rank == kNone) continue;
    is_used[rank] = 1;
    if (vertices[part.mesh.from(h)] != wedge_vertex[rank]) refuse(rank);
  }
  part.mesh.wedge_vertex.clear();
  for (Index w = 0; w < others; ++w) {
    if (is_used[w] == 0) refuse(w);
    part.mesh.wedge_vertex.push_back(rank_in(vertices, wedge_vertex[w]));
  }
  part.mesh.wedge_vertex.push_back(kNone);
}

/// Reads all that belongs to the faces and wedges in `part`.
/// \return the edges along which the part was cut out
std::vector<Cut> read_kept(const MeshBlocks& blocks, PartMesh& part) {
  const MeshBlocks::Header& header = blocks.header();
  const auto of_faces = [&](auto read) {
    return rows_at(part.face, header.faces,
                   [&](Index first, Index count) { return (blocks.*read)(first, count); });
  };
  TriMesh& mesh = part.mesh;
  mesh.id = header.id;
  mesh.diagonal = header.diagonal;
  mesh.faces = of_faces(&MeshBlocks::faces);
  std::vector<Index> vertices;
  vertices.reserve(3 * mesh.faces.size());
  for (const Three& face : mesh.faces) vertices.insert(vertices.end(), face.begin(), face.end());
  sort_unique(vertices);
  for (Three& face : mesh.faces) {
    for (Index& vertex : face) vertex = rank_in(vertices, vertex);
  }
  mesh.positions = rows_at(vertices, header.vertices, [&](Index first, Index count) {
    return blocks.positions(first, count);
  });
  mesh.is_feature.clear();
  for (const auto& flags : of_faces(&MeshBlocks::is_feature)) {
    mesh.is_feature.insert(mesh.is_feature.end(), flags.begin(), flags.end());
  }
  mesh.face_wedges = of_faces(&MeshBlocks::face_wedges);
  number_wedges(part, vertices, rows_at(part.wedge, header.wedges, [&](Index first, Index count) {
                  return blocks.wedge_vertex(first, count);
                }));
  return number_twins(part, of_faces(&MeshBlocks::twin));
}

/// Faces of the whole mesh that were left out although slivers at the cut take their normal from
/// there.
std::vector<Index> faces_behind_slivers(const TriMesh& mesh, const std::vector<Cut>& cuts) {
  std::vector<Index> faces;
  for (const Cut& cut : cuts) {
    if (!has_own_normal(mesh, TriMesh::face_of(cut.halfedge))) faces.push_back(cut.face_behind);
  }
  return faces;
}

}  // namespace

PartMesh read_part(const MeshBlocks& blocks, Index parts, Index part, double reach,
                   Observer& observer) {
  PartMesh result;
  observer.report(kPhase, 0);
  {
    const PartSelection selection(blocks, parts, part, reach);
    observer.report(kPhase, 0.3);
    result.wedge = selection.wedges();
    result.face = selection.faces();
  }
  observer.report(kPhase, 0.6);
  for (;;) {
    const std::vector<Cut> cuts = read_kept(blocks, result);
    const std::vector<Index> more = faces_behind_slivers(result.mesh, cuts);
    if (more.empty()) break;
    result.face.insert(result.face.end(), more.begin(), more.end());
    sort_unique(result.face);
    observer.report(kPhase, 0.8);
  }
  observer.report(kPhase, 1);
  return result;
}

}  // namespace strake

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/mesh_blocks.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Blocks of a mesh in memory.
class LoadedMesh : public MeshBlocks {
 public:
  explicit LoadedMesh(const TriMesh& mesh)
      : MeshBlocks(
            {mesh.id, mesh.diagonal, mesh.vertex_count(), mesh.face_count(), mesh.wedge_count()}),
        mesh_(mesh) {}

  [[nodiscard]] std::vector<Vec3> positions(Index first, Index count) const override {
    return rows(mesh_.positions, first, count);
  }
  [[nodiscard]] std::vector<Index> wedge_vertex(Index first, Index count) const override {
    return rows(mesh_.wedge_vertex, first, count);
  }
  [[nodiscard]] std::vector<std::array<Index, 3>> faces(Index first, Index count) const override {
    return rows(mesh_.faces, first, count);
  }
  [[nodiscard]] std::vector<std::array<Index, 3>> face_wedges(Index first,
                                                              Index count) const override {
    return rows(mesh_.face_wedges, first, count);
  }
  [[nodiscard]] std::vector<std::array<Index, 3>> twin(Index first, Index count) const override {
    return threes(mesh_.twin, first, count);
  }
  [[nodiscard]] std::vector<std::array<std::uint8_t, 3>> is_feature(Index first,
                                                                    Index count) const override {
    return threes(mesh_.is_feature, first, count);
  }

 private:
  template <class Row>
  static std::vector<Row> rows(const std::vector<Row>& all, Index first, Index count) {
    return {all.begin() + first, all.begin() + first + count};
  }
  template <class T>
  static std::vector<std::array<T, 3>> threes(const std::vector<T>& all, Index first, Index count) {
    std::vector<std::array<T, 3>> found(count);
    for (Index i = 0; i < 3 * count; ++i) found[i / 3][i % 3] = all[3 * first + i];
    return found;
  }

  const TriMesh& mesh_;
};

}  // namespace strake

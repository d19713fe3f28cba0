#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// A TriMesh that stays where it is and is read block by block, for work that needs a part of it.
class MeshBlocks {
 public:
  struct Header {
    std::string id;       ///< content hash, as TriMesh::id
    double diagonal = 0;  ///< of the bounding box, model units
    Index vertices = 0;
    Index faces = 0;
    Index wedges = 0;
  };

  virtual ~MeshBlocks() = default;
  MeshBlocks(const MeshBlocks&) = delete;
  MeshBlocks& operator=(const MeshBlocks&) = delete;

  [[nodiscard]] const Header& header() const { return header_; }

  // Rows first ... first + count - 1 of TriMesh's arrays of these names, those per half-edge with
  // one row per face. Indices are in range. Throw InputError where they cannot be read.
  [[nodiscard]] virtual std::vector<Vec3> positions(Index first, Index count) const = 0;
  [[nodiscard]] virtual std::vector<Index> wedge_vertex(Index first, Index count) const = 0;
  [[nodiscard]] virtual std::vector<std::array<Index, 3>> faces(Index first, Index count) const = 0;
  [[nodiscard]] virtual std::vector<std::array<Index, 3>> face_wedges(Index first,
                                                                      Index count) const = 0;
  [[nodiscard]] virtual std::vector<std::array<Index, 3>> twin(Index first, Index count) const = 0;
  [[nodiscard]] virtual std::vector<std::array<std::uint8_t, 3>> is_feature(Index first,
                                                                            Index count) const = 0;

 protected:
  explicit MeshBlocks(Header header) : header_(std::move(header)) {}

 private:
  Header header_;
};

}  // namespace strake

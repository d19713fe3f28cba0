#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Red, green, blue and opacity in [0, 1].
using Colour = std::array<double, 4>;
/// Texture coordinates s (or u) and t (or v), any range.
using TexturePoint = std::array<double, 2>;

/// One way in which a file tells parts of a surface apart, by a number for every face.
struct FaceLabels {
  std::string name;                ///< "o", "g", "usemtl" of OBJ; the property's name of PLY
  std::vector<Index> of_face;      ///< [F] index into `names`; any number where there are none
  std::vector<std::string> names;  ///< in order of appearance in the file; empty in PLY

  friend bool operator==(const FaceLabels&, const FaceLabels&) = default;
};

/// What a surface carries besides its shape. An array that is empty is not there.
///
/// Texture coordinates belong to corners of faces: where the two sides of an edge have different
/// ones there is a seam, and nothing is interpolated across it.
struct Attributes {
  std::vector<Colour> colour;         ///< [V]
  std::vector<TexturePoint> texture;  ///< [C] of each corner, in the order of the mesh's corners
  std::vector<FaceLabels> labels;     ///< of different names
  /// Where the materials are that labels "usemtl" name: what each `mtllib` statement of an OBJ file
  /// says, from the folder of that file. Only with such labels.
  std::vector<std::string> material_files;

  [[nodiscard]] bool empty() const { return colour.empty() && texture.empty() && labels.empty(); }
  friend bool operator==(const Attributes&, const Attributes&) = default;
};

}  // namespace strake

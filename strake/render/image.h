#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace strake {

/// A picture of linear RGB values, row by row from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> pixels;  ///< [height * width] linear, 1 is white; clamped on writing

  Image(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, Eigen::Vector3f::Ones()) {}
  Eigen::Vector3f& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// Linear value of an sRGB component in [0, 1].
float linear_from_srgb(float value);

/// Writes an 8-bit sRGB PNG; an existing file is replaced only once the new one is complete.
/// \throw InputError naming the file where it cannot be written
void write_png(const Image& image, const std::filesystem::path& path);

}  // namespace strake

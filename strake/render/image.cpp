#include "strake/render/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "common/artifact/atomic_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

std::uint8_t srgb_byte(float linear) {
  const float v = std::clamp(linear, 0.0F, 1.0F);
  const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

}  // namespace

float linear_from_srgb(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

void write_png(const Image& image, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Eigen::Vector3f& pixel : image.pixels) {
    for (int k = 0; k < 3; ++k) bytes.push_back(srgb_byte(pixel[k]));
  }
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;

  AtomicFile file(path);
  if (png_image_write_to_file(&header, file.temporary().c_str(), 0, bytes.data(), 0, nullptr) ==
      0) {
    throw InputError(path.string() + ": cannot write the picture (" + header.message +
                     "); check the folder and the space left");
  }
  file.commit();
}

}  // namespace strake

#include "strake/render/draw.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace strake {
namespace {

constexpr int kOcclusionRays = 2;         // per sample
constexpr double kOcclusionReach = 0.12;  // of the model's diagonal
constexpr double kOcclusionStrength = 0.75;
constexpr double kRayOffset = 2e-5;
constexpr double kEdgeStrength = 0.85;

Vec3 srgb(double r, double g, double b) {
  return {linear_from_srgb(static_cast<float>(r)), linear_from_srgb(static_cast<float>(g)),
          linear_from_srgb(static_cast<float>(b))};
}

/// Colours as linear RGB.
struct Palette {
  Vec3 plain = srgb(0.88, 0.90, 0.93);
  Vec3 triangle = srgb(0.98, 0.80, 0.56);
  Vec3 pentagon = srgb(0.62, 0.85, 0.68);
  Vec3 larger = srgb(0.95, 0.62, 0.75);
  Vec3 back = srgb(0.62, 0.52, 0.76);
  Vec3 edge = srgb(0.10, 0.12, 0.18);
  Vec3 minimum = srgb(0.13, 0.33, 0.80);
  Vec3 maximum = srgb(0.82, 0.18, 0.16);
  Vec3 feature = srgb(0.08, 0.08, 0.08);
  Vec3 boundary = srgb(0.06, 0.62, 0.46);
  Vec3 guide = srgb(1.0, 0.48, 0.0);
  Vec3 end = srgb(0.88, 0.63, 0.0);
  Vec3 cut = srgb(0.85, 0.78, 0.65);
  Vec3 hatch = srgb(0.63, 0.55, 0.42);
};

/// A value in [0, 1) that depends on nothing but its arguments (splitmix64).
double hash01(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = (a * 0x9E3779B97F4A7C15U) ^ (b + 0xD1B54A32D192ED03U);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

class Painter {
 public:
  Painter(const Scene& scene, const Camera& camera, const std::vector<std::string>& groups,
          const DrawOptions& options)
      : scene_(scene), camera_(camera), groups_(groups), options_(options) {
    const PolyMesh& mesh = scene.mesh();
    for (Index f = 0; f < mesh.face_count() && !tinted_; ++f) tinted_ = mesh.face(f).size() != 3;
    for (const Vec3& c : options.face_colours) colours_.push_back(srgb(c.x(), c.y(), c.z()));
    fills_cut_ = options.section && scene.is_closed();
    if (!options.edges) return;
    projected_.resize(mesh.positions.size());
    tbb::parallel_for(std::size_t{0}, projected_.size(),
                      [&](std::size_t v) { projected_[v] = camera.project(mesh.positions[v]); });
  }

  [[nodiscard]] Eigen::Vector3f pixel(int x, int y) const {
    const int n = options_.samples;
    const auto seed = static_cast<std::uint64_t>(y) * options_.width + x;
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < n * n; ++i) {
      // Rows shifted against each other, so that steep and flat edges get n * n levels of grey.
      const double shift = (i / n + 0.5) / n;
      const double px = x + (i % n + shift) / n;
      const double py = y + (i / n + (i % n + 0.5) / n) / n;
      sum += sample(px, py, seed, i);
    }
    return (sum / (n * n)).cast<float>();
  }

 private:
  [[nodiscard]] Vec3 sample(double px, double py, std::uint64_t seed, int number) const {
    const Vec3 direction = camera_.direction(px, py);
    const std::optional<Hit> seen = first_hit(direction);
    if (!seen) return Vec3::Ones();
    const Hit& hit = *seen;
    if (hit.kind == Hit::Kind::line) {
      const double facing = std::abs(hit.geometric_normal.dot(direction));
      return line_colour(groups_[hit.line]) * (0.7 + 0.3 * facing);
    }
    const bool is_back = hit.geometric_normal.dot(direction) > 0;
    // From beyond the section the inside of a closed surface is seen only through the cut.
    if (is_back && fills_cut_ && height(camera_.position()) > 0) {
      const double stripe = std::fmod(px + py, 9.0);
      return stripe < 1.5 ? palette_.hatch : palette_.cut;
    }
    const double side = is_back ? -1 : 1;
    Vec3 normal = side * hit.shading_normal;
    // An interpolated normal may turn away from the viewer at silhouettes; keep it edge-on.
    const double away = normal.dot(direction);
    if (away > -0.02) normal = (normal - (away + 0.02) * direction).normalized();
    const Vec3 surface = is_back ? palette_.back : face_colour(hit.face);
    const double open = options_.section ? 1
                                         : openness(hit.position, side * hit.geometric_normal,
                                                    normal, seed, number);
    const Vec3 lit = shade(surface, normal, -direction, open);
    const double ink = options_.edges ? edge_ink(hit.face, Vec2(px, py)) : 0.0;
    return lit + ink * (palette_.edge - lit);
  }

  /// How far a point lies beyond the section.
  [[nodiscard]] double height(const Vec3& p) const {
    const Section& section = *options_.section;
    return (p[section.axis] - section.place) * (section.is_flipped ? -1 : 1);
  }

  /// The first thing a ray from the camera meets that is not cut away.
  [[nodiscard]] std::optional<Hit> first_hit(const Vec3& direction) const {
    Vec3 origin = camera_.position();
    const double above = options_.section ? height(origin) : -1;
    if (above > 0) {
      const double falls = above - height(origin + direction);
      if (falls <= 0) return std::nullopt;
      origin += above / falls * direction;
    }
    const Hit hit = scene_.trace(origin, direction);
    const bool is_cut = options_.section && above <= 0 && height(hit.position) > 0;
    if (hit.kind == Hit::Kind::nothing || is_cut) return std::nullopt;
    return hit;
  }

  [[nodiscard]] const Vec3& line_colour(const std::string& group) const {
    if (group == "min") return palette_.minimum;
    if (group == "max") return palette_.maximum;
    if (group == "boundary") return palette_.boundary;
    if (group == "guide") return palette_.guide;
    if (group == "end") return palette_.end;
    return palette_.feature;
  }

  [[nodiscard]] const Vec3& face_colour(Index f) const {
    if (!colours_.empty()) return colours_[f];
    const std::size_t sides = scene_.mesh().face(f).size();
    if (!tinted_ || sides == 4) return palette_.plain;
    if (sides == 3) return palette_.triangle;
    return sides == 5 ? palette_.pentagon : palette_.larger;
  }

  [[nodiscard]] Vec3 shade(const Vec3& surface, const Vec3& normal, const Vec3& to_viewer,
                           double open) const {
    const Vec3 light = (to_viewer + 0.65 * camera_.up() - 0.6 * camera_.right()).normalized();
    const double diffuse = std::max(0.0, (normal.dot(light) + 0.1) / 1.1);
    const double sky = 0.5 + 0.5 * normal.dot(camera_.up());
    const Vec3 ambient = sky * Vec3(0.42, 0.44, 0.46) + (1 - sky) * Vec3(0.20, 0.19, 0.18);
    const double highlight =
        std::pow(std::max(0.0, normal.dot((light + to_viewer).normalized())), 40);
    const double key = 0.70 * diffuse * (0.55 + 0.45 * open);
    return surface.cwiseProduct(open * ambient + Vec3::Constant(key)) +
           Vec3::Constant(0.05 * highlight * open);
  }

  /// Share of the sky over a point that nothing near blocks, estimated.
  [[nodiscard]] double openness(const Vec3& p, const Vec3& geometric, const Vec3& normal,
                                std::uint64_t seed, int number) const {
    const Vec3 u = normal.unitOrthogonal();
    const Vec3 v = normal.cross(u);
    const Vec3 origin = p + kRayOffset * geometric;
    const int total = kOcclusionRays * options_.samples * options_.samples;
    int blocked = 0;
    for (int k = 0; k < kOcclusionRays; ++k) {
      // The rays of all samples of a pixel are one stratified set, turned at random per pixel.
      const int i = number * kOcclusionRays + k;
      const double height2 = (i + hash01(seed, 1 + 2 * i)) / total;
      const double turn = i * 0.6180339887498949 + hash01(seed, 0);
      const double radius = std::sqrt(height2);
      const double angle = 2 * std::numbers::pi * turn;
      const Vec3 ray = radius * (std::cos(angle) * u + std::sin(angle) * v) +
                       std::sqrt(std::max(0.0, 1 - height2)) * normal;
      if (ray.dot(geometric) > 0 && scene_.is_blocked(origin, ray, kOcclusionReach)) ++blocked;
    }
    return 1 - kOcclusionStrength * blocked / kOcclusionRays;
  }

  /// How much of the colour at a place in the picture is the edges' of its face.
  [[nodiscard]] double edge_ink(Index f, const Vec2& place) const {
    const std::span<const Index> face = scene_.mesh().face(f);
    double nearest = std::numeric_limits<double>::infinity();
    double around = 0;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec2& a = projected_[face[i]];
      const Vec2& b = projected_[face[(i + 1) % face.size()]];
      around += (b - a).norm();
      nearest = std::min(nearest, distance_to_segment(place, a, b));
    }
    const double soft = 0.5 / options_.samples + 0.15;
    const double half = options_.edge_width / 2;
    const double cover = 1 - smooth_step(half - soft, half + soft, nearest);
    // Where faces shrink to a few pixels the lines would paint everything dark: let them fade.
    const double mean_length = around / static_cast<double>(face.size());
    return kEdgeStrength * cover * (0.25 + 0.75 * smooth_step(2.5, 9, mean_length));
  }

  const Scene& scene_;
  const Camera& camera_;
  const std::vector<std::string>& groups_;
  const DrawOptions& options_;
  Palette palette_;
  std::vector<Vec2> projected_;  // [V] pixels
  std::vector<Vec3> colours_;    // [F] linear, or empty
  bool fills_cut_ = false;
  bool tinted_ = false;
};

}  // namespace

Image draw(const Scene& scene, const Camera& camera, const std::vector<std::string>& line_groups,
           const DrawOptions& options) {
  Image image(options.width, options.height);
  const Painter painter(scene, camera, line_groups, options);
  tbb::parallel_for(0, options.height, [&](int y) {
    for (int x = 0; x < options.width; ++x) image.at(x, y) = painter.pixel(x, y);
  });
  return image;
}

}  // namespace strake

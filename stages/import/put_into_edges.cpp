#include "stages/import/put_into_edges.h"

#include <array>
#include <cstddef>
#include <span>

namespace strake::import {
namespace {

struct Corner {
  Index vertex;
  TexturePoint texture{};
};

/// A face and what is to be put into each of its sides, along these.
struct DividedFace {
  std::array<Corner, 3> corner;
  std::array<std::span<const Corner>, 3> side;  ///< from corner i to the next
};

class FaceDivider {
 public:
  explicit FaceDivider(Soup& soup) : soup_(soup) {}

  /// Replaces a face by pieces: itself the first, the others behind the last face.
  void divide(Index face, std::span<const Stop> stops) {
    face_ = face;
    is_first_ = true;
    std::array<std::vector<Corner>, 3> put;
    DividedFace whole;
    for (int i = 0; i < 3; ++i) {
      whole.corner[i].vertex = soup_.faces[face][i];
      if (!soup_.texture.empty()) whole.corner[i].texture = soup_.texture[face][i];
    }
    for (const Stop& stop : stops) {
      const int i = stop.halfedge % 3;
      put[i].push_back({stop.vertex, between(whole.corner[i].texture,
                                             whole.corner[(i + 1) % 3].texture, stop.share)});
    }
    for (int i = 0; i < 3; ++i) whole.side[i] = put[i];
    cut(whole);
  }

 private:
  static TexturePoint between(const TexturePoint& a, const TexturePoint& b, double share) {
    TexturePoint result = a;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += share * (b[i] - a[i]);
    return result;
  }

  /// Cuts from the middle one of a side to the corner across, until none is left.
  void cut(const DividedFace& face) {
    int most = 0;
    for (const int i : {1, 2}) {
      if (face.side[i].size() > face.side[most].size()) most = i;
    }
    const std::span<const Corner> side = face.side[most];
    if (side.empty()) return add(face.corner);
    const std::size_t at = side.size() / 2;
    DividedFace before = face;  // of the cut, along the side
    before.corner[(most + 1) % 3] = side[at];
    before.side[most] = side.first(at);
    before.side[(most + 1) % 3] = {};
    DividedFace after = face;
    after.corner[most] = side[at];
    after.side[most] = side.subspan(at + 1);
    after.side[(most + 2) % 3] = {};
    cut(before);
    cut(after);
  }

  void add(const std::array<Corner, 3>& corner) {
    if (!is_first_) {
      soup_.faces.emplace_back();
      soup_.source_face.push_back(soup_.source_face[face_]);
      if (!soup_.texture.empty()) soup_.texture.emplace_back();
    }
    const auto at = is_first_ ? static_cast<std::size_t>(face_) : soup_.faces.size() - 1;
    is_first_ = false;
    for (int i = 0; i < 3; ++i) {
      soup_.faces[at][i] = corner[i].vertex;
      if (!soup_.texture.empty()) soup_.texture[at][i] = corner[i].texture;
    }
  }

  Soup& soup_;
  Index face_ = kNone;
  bool is_first_ = true;
};

}  // namespace

void put_into_edges(Soup& soup, const std::vector<Stop>& stops) {
  FaceDivider divider(soup);
  for (std::size_t i = 0; i < stops.size();) {
    const Index face = stops[i].halfedge / 3;
    std::size_t end = i;
    while (end < stops.size() && stops[end].halfedge / 3 == face) ++end;
    divider.divide(face, std::span(stops).subspan(i, end - i));
    i = end;
  }
}

}  // namespace strake::import

#include "stages/import/copied_pieces.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "stages/import/weld.h"

namespace strake::import {
namespace {

using ExactPlace = std::array<double, 3>;
using FacePlaces = std::array<ExactPlace, 3>;  ///< ascending
using EdgePlaces = std::pair<ExactPlace, ExactPlace>;

/// Faces of a piece in the mean, below which there are no sheets but single faces.
constexpr Index kFewestFaces = 4;

ExactPlace place_of(const Soup& soup, Index vertex) {
  const Vec3& p = soup.positions[vertex];
  return {p.x(), p.y(), p.z()};
}

FacePlaces places_of(const Soup& soup, Index face) {
  FacePlaces places;
  for (int i = 0; i < 3; ++i) places[i] = place_of(soup, soup.faces[face][i]);
  std::sort(places.begin(), places.end());
  return places;
}

/// Connected faces.
struct Piece {
  std::vector<Index> faces;
  ExactPlace low = {};  ///< of the box around it
  ExactPlace high = {};

  /// Equal for pieces that may be copies.
  [[nodiscard]] auto look() const { return std::tuple(faces.size(), low, high); }
};

std::vector<Piece> find_pieces(const Soup& soup) {
  DisjointSets joined(soup.vertex_count());
  for (const auto& [a, b, c] : soup.faces) {
    joined.unite(a, b);
    joined.unite(a, c);
  }
  std::vector<Index> piece_at(soup.positions.size(), kNone);
  Index count = 0;
  for (const Triangle& face : soup.faces) {
    Index& piece = piece_at[joined.find(face[0])];
    if (piece == kNone) piece = count++;
  }
  if (count < 2 || soup.face_count() / count < kFewestFaces) return {};
  std::vector<Piece> pieces(static_cast<std::size_t>(count));
  for (Index f = 0; f < soup.face_count(); ++f) {
    Piece& piece = pieces[piece_at[joined.find(soup.faces[f][0])]];
    if (piece.faces.empty()) piece.low = piece.high = place_of(soup, soup.faces[f][0]);
    piece.faces.push_back(f);
    for (const Index v : soup.faces[f]) {
      const ExactPlace p = place_of(soup, v);
      for (int k = 0; k < 3; ++k) {
        piece.low[k] = std::min(piece.low[k], p[k]);
        piece.high[k] = std::max(piece.high[k], p[k]);
      }
    }
  }
  return pieces;
}

/// [pieces] The first piece with the same faces, or kNone where no other has them.
std::vector<Index> find_copies(const Soup& soup, const std::vector<Piece>& pieces) {
  std::vector<Index> order(pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tuple(pieces[a].look(), a) < std::tuple(pieces[b].look(), b);
  });
  std::vector<Index> first(pieces.size(), kNone);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && pieces[order[end]].look() == pieces[order[begin]].look()) ++end;
    if (end - begin < 2) continue;
    std::map<std::vector<FacePlaces>, Index> known;
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<FacePlaces> faces;
      for (const Index f : pieces[order[i]].faces) faces.push_back(places_of(soup, f));
      std::sort(faces.begin(), faces.end());
      const auto [found, is_new] = known.emplace(std::move(faces), order[i]);
      if (!is_new) first[order[i]] = first[found->second] = found->second;
    }
  }
  return first;
}

/// Those of copies whose border is also that of other pieces, by the first of them.
std::set<Index> parts_of_others(const Soup& soup, const std::vector<Piece>& pieces,
                                const std::vector<Index>& first) {
  std::vector<Index> piece_of(soup.faces.size(), kNone);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (const Index f : pieces[p].faces) piece_of[f] = static_cast<Index>(p);
  }
  const std::vector<Index> border = find_borders(soup);
  const auto places = [&](Index h) -> EdgePlaces {
    return std::minmax(place_of(soup, soup.from(h)), place_of(soup, soup.to(h)));
  };
  std::map<EdgePlaces, Index> of_copies;
  std::set<Index> parts;
  for (const Index h : border) {
    const Index own = first[piece_of[h / 3]];
    if (own == kNone) continue;
    const auto [found, is_new] = of_copies.emplace(places(h), own);
    if (found->second != own) parts.insert({own, found->second});
  }
  for (const Index h : border) {
    if (of_copies.empty()) break;
    if (first[piece_of[h / 3]] != kNone) continue;
    if (const auto found = of_copies.find(places(h)); found != of_copies.end()) {
      parts.insert(found->second);
    }
  }
  return parts;
}

}  // namespace

void drop_copied_pieces(Soup& soup, Repairs& repairs) {
  const std::vector<Piece> pieces = find_pieces(soup);
  const std::vector<Index> first = find_copies(soup, pieces);
  if (std::ranges::count(first, kNone) == std::ssize(first)) return;
  const std::set<Index> parts = parts_of_others(soup, pieces, first);
  std::vector<std::uint8_t> remove(soup.faces.size(), 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (first[p] == kNone || first[p] == static_cast<Index>(p) || parts.contains(first[p])) {
      continue;
    }
    for (const Index f : pieces[p].faces) {
      remove[f] = 1;
      ++repairs.duplicate_faces;
      repairs.duplicate_area += face_area(soup, f);
    }
  }
  remove_faces(soup, remove);
}

}  // namespace strake::import

#include "stages/import/border_contacts.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "stages/import/bulges.h"
#include "stages/import/gaps.h"

namespace strake::import {
namespace {

/// Edges around a vertex: where that many meet nothing tells which belong together.
constexpr std::size_t kMany = 256;
/// How many times as far away as the nearest what a vertex is near to may be: not the other side of
/// a thin plate. Gaps at random differ that much in one of a thousand cases.
constexpr double kAsNear = 30;

/// How far out a vertex may be over the circle that a border follows, as a curve is not always one;
/// and the most, over the diagonal.
constexpr double kOverBulge = 1.25;
constexpr double kWidestBulge = 0.01;

/// Boxes around parts of edges, so that those of long slanted edges are not around everything.
class EdgeBoxes {
 public:
  /// \param around  [border] how far the boxes reach from the edges
  EdgeBoxes(const Soup& soup, const std::vector<Index>& border, const std::vector<double>& around)
      : tree_(boxes(soup, border, around)) {}

  /// Calls visit(i) for the edges border[i] near a box, some of them several times, as long as it
  /// returns true.
  template <class Visit>
  void visit_near_while(const BoxTree::Box& box, Visit visit) const {
    tree_.visit_touching_while(box, [&](Index part) { return visit(edge_[part]); });
  }

 private:
  static double length(const Soup& soup, Index h) {
    return (soup.positions[soup.to(h)] - soup.positions[soup.from(h)]).norm();
  }

  std::vector<BoxTree::Box> boxes(const Soup& soup, const std::vector<Index>& border,
                                  const std::vector<double>& around) {
    constexpr double kParts = 4;  // of a mean edge
    double step = 0;
    for (const Index h : border) step += length(soup, h);
    step /= kParts * static_cast<double>(border.size());
    std::vector<BoxTree::Box> result;
    for (Index i = 0; i < static_cast<Index>(border.size()); ++i) {
      const Vec3& from = soup.positions[soup.from(border[i])];
      const Vec3 way = soup.positions[soup.to(border[i])] - from;
      const double parts = step > 0 ? std::max(1.0, std::ceil(way.norm() / step)) : 1;
      for (double k = 0; k < parts; ++k) {
        BoxTree::Box box(Vec3(from + k / parts * way));
        box.extend(Vec3(from + (k + 1) / parts * way));
        result.emplace_back(box.min().array() - around[i], box.max().array() + around[i]);
        edge_.push_back(i);
      }
    }
    return result;
  }

  std::vector<Index> edge_;
  BoxTree tree_;
};

/// What a vertex is near to.
struct Contact {
  Index edge;              ///< in the list of border edges
  double share;            ///< of the way along it
  double gap;              ///< the distance
  Index vertex = kNone;    ///< the end of the edge that it is near to, of one inside kNone
  bool is_curved = false;  ///< as far away as the border bulges there
};

class ContactSearch {
 public:
  ContactSearch(const Soup& soup, const std::vector<Index>& border, double diagonal)
      : soup_(soup),
        border_(border),
        diagonal_(diagonal),
        bulges_(find_bulges(soup, border)),
        boxes_(soup, border, reach_of(bulges_)),
        most_(most_around(soup, border, diagonal)) {}

  [[nodiscard]] BorderContacts run() const {
    const std::vector<Index> vertices = border_vertices();
    std::vector<std::vector<Contact>> found(vertices.size());
    tbb::parallel_for(std::size_t{0}, vertices.size(),
                      [&](std::size_t i) { found[i] = nearest_contacts(vertices[i]); });
    BorderContacts contacts;
    std::vector<std::pair<Index, Index>> close;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const Contact& contact : found[i]) {
        if (contact.vertex != kNone) {
          close.emplace_back(vertices[i], contact.vertex);
        } else {
          contacts.stops.push_back(
              {border_[contact.edge], contact.share, vertices[i], contact.is_curved});
        }
      }
    }
    contacts.place = places(std::move(close));
    std::sort(contacts.stops.begin(), contacts.stops.end(), [](const Stop& a, const Stop& b) {
      return std::tie(a.halfedge, a.share, a.vertex) < std::tie(b.halfedge, b.share, b.vertex);
    });
    leave_one_a_place(contacts);
    return contacts;
  }

 private:
  static std::vector<double> reach_of(const std::vector<Bulge>& bulges) {
    std::vector<double> reach;
    reach.reserve(bulges.size());
    for (const Bulge& bulge : bulges) reach.push_back(kOverBulge * bulge.height);
    return reach;
  }

  static std::vector<double> most_around(const Soup& soup, const std::vector<Index>& border,
                                         double diagonal) {
    std::vector<double> around = shortest_edges(soup, border);
    for (double& most : around) most = std::min(kWidest * diagonal, kGapOverEdge * most);
    return around;
  }

  [[nodiscard]] std::vector<Index> border_vertices() const {
    std::vector<Index> vertices;
    for (const Index h : border_) vertices.insert(vertices.end(), {soup_.from(h), soup_.to(h)});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  [[nodiscard]] std::vector<Contact> nearest_contacts(Index v) const {
    std::vector<Contact> found;
    const double reach = most_[v];
    const Vec3& p = soup_.positions[v];
    boxes_.visit_near_while(BoxTree::Box(p.array() - reach, p.array() + reach), [&](Index i) {
      const Contact contact = contact_with(v, i);
      if (!std::isinf(contact.gap)) found.push_back(contact);
      return found.size() <= kMany;
    });
    if (found.size() > kMany) return {};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contact& contact : found) nearest = std::min(nearest, contact.gap);
    const double farthest = std::max(kAsNear * nearest, kRounding * diagonal_);
    std::erase_if(found, [&](const Contact& contact) { return contact.gap > farthest; });
    std::sort(found.begin(), found.end(),
              [](const Contact& a, const Contact& b) { return a.edge < b.edge; });
    const auto is_same = [](const Contact& a, const Contact& b) { return a.edge == b.edge; };
    found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
    return found;
  }

  /// Of an infinite gap where there is none.
  [[nodiscard]] Contact contact_with(Index v, Index edge) const {
    const Contact none{edge, 0, std::numeric_limits<double>::infinity()};
    const Index h = border_[edge];
    const Index apex = soup_.faces[h / 3][(h % 3 + 2) % 3];
    if (v == soup_.from(h) || v == soup_.to(h) || v == apex) return none;
    const Vec3& p = soup_.positions[v];
    const Vec3& from = soup_.positions[soup_.from(h)];
    const Vec3 way = soup_.positions[soup_.to(h)] - from;
    Contact end = none;
    for (const Index w : {soup_.from(h), soup_.to(h)}) {
      const double gap = (soup_.positions[w] - p).norm();
      if (gap <= std::min(most_[v], most_[w]) && gap < end.gap) end = {edge, 0, gap, w};
    }
    if (end.vertex != kNone) return end;
    const double length = way.norm();
    const double share = (p - from).dot(way) / (length * length);
    if (!(share > 0 && share < 1)) return none;
    const Vec3 off = p - (from + share * way);
    const double gap = off.norm();
    const double highest = kGapOverEdge * height_over(soup_, h);
    const double most =
        std::min({most_[v], kGapOverEdge * share * length, kGapOverEdge * (1 - share) * length,
                  std::max(highest, kCoincident * diagonal_)});
    if (gap <= most) return {edge, share, gap};
    const bool is_curved = gap <= std::min(highest, kWidestBulge * diagonal_) &&
                           is_on_bulge(bulges_[edge], share, off);
    return is_curved ? Contact{edge, share, gap, kNone, true} : none;
  }

  static bool is_on_bulge(const Bulge& bulge, double share, const Vec3& off) {
    constexpr double kAlong = 0.9;  // cosine of 26 degrees
    const double gap = off.norm();
    return gap <= kOverBulge * 4 * share * (1 - share) * bulge.height &&
           off.dot(bulge.way) >= kAlong * gap;
  }

  /// Of vertices that are among the nearest of each other.
  [[nodiscard]] std::vector<Index> places(std::vector<std::pair<Index, Index>> close) const {
    std::sort(close.begin(), close.end());
    DisjointSets sets(soup_.vertex_count());
    for (const auto& [a, b] : close) {
      if (std::binary_search(close.begin(), close.end(), std::pair(b, a))) sets.unite(a, b);
    }
    std::vector<Index> place(soup_.positions.size());
    for (Index v = 0; v < soup_.vertex_count(); ++v) place[v] = sets.find(v);
    return place;
  }

  /// Removes stops in the same place as the one before or as an end of their edge.
  void leave_one_a_place(BorderContacts& contacts) const {
    std::vector<Stop> kept;
    for (const Stop& stop : contacts.stops) {
      const auto is_at = [&](Index v) { return contacts.place[stop.vertex] == contacts.place[v]; };
      if (is_at(soup_.from(stop.halfedge)) || is_at(soup_.to(stop.halfedge))) continue;
      const bool is_first = kept.empty() || kept.back().halfedge != stop.halfedge;
      if (is_first || !is_at(kept.back().vertex)) kept.push_back(stop);
    }
    contacts.stops = std::move(kept);
  }

  const Soup& soup_;
  const std::vector<Index>& border_;
  double diagonal_;
  std::vector<Bulge> bulges_;
  EdgeBoxes boxes_;
  std::vector<double> most_;  ///< [V] how far away a vertex is looked for
};

}  // namespace

BorderContacts find_border_contacts(const Soup& soup, const std::vector<Index>& border,
                                    double diagonal) {
  return ContactSearch(soup, border, diagonal).run();
}

}  // namespace strake::import

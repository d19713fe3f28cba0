#include "stages/refine/inlays.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "common/geometry/cell_error/compared_surfaces.h"
#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/inlay.h"
#include "stages/refine/thinning.h"

namespace strake {
namespace {

/// What inlays grow for.
struct Goal {
  bool uncrosses;     ///< faces that cross, too; these may stay, so inlays that do not help may go
  std::size_t cells;  ///< at most, in place of which an inlay may be
  int rounds;         ///< times at most that inlays grow
};
constexpr Goal kWithin = {false, 4000, 16};
constexpr Goal kUncrossed = {true, 1000, 16};
/// Cells in place of which an inlay for faces that cross may be, for each of these, and for few.
/// Along ragged boundaries it would grow as long as there is no other like its patch.
constexpr std::size_t kMostCellsPerFault = 75;
constexpr std::size_t kFewCells = 250;
/// Share of all cells that a component may have whose place an inlay takes altogether. Larger ones
/// should follow lines.
constexpr double kMostWhole = 0.1;
/// Faces of an inlay that are not worth it, for faces that cross: for each cell that goes, or as a
/// share of all cells, whatever is more.
constexpr std::size_t kMostFacesPerCell = 4;
constexpr double kMostFacesShare = 0.02;
/// Share of vertices that inlays for faces that cross may add without being thinned out more. What
/// a count allows is a little more.
constexpr double kMostAdded = 0.03;
/// Places of the input whose vertex is searched for over the surface. More are left bare by an
/// inlay that is wrong altogether; each search would go all over what is bare.
constexpr std::size_t kMostSearched = 1000;
/// Cells in all of places where no inlay could be cut, after which none grows for that any more.
constexpr std::size_t kMostInVain = 40000;
/// Times that inlays grow, for faces that cross, without fewer faults than ever before.
constexpr int kRoundsInVain = 4;
/// Where more cells are bad, it is not for single places.
constexpr std::size_t kMostBad = 3000;
/// Times that inlays are thinned out by the next distance, not by none, where they have faults.
constexpr int kMostThinnings = 12;
/// Times that inlays are thinned out less in vain: no fewer faces cross others.
constexpr int kThinningsInVain = 3;
/// Largest growth of the ball around a fault in which inlays are thinned out less.
constexpr double kLargestScale = 1024;
const Ball kEverywhere = {Vec3::Zero(), std::numeric_limits<double>::infinity()};

/// Where an inlay is to be.
struct Site {
  std::set<Index> cells;   ///< that it is to take the place of, at least
  std::size_t faults = 1;  ///< cells around which it was begun
  int rings = 0;           ///< of them, about
  int times_bad = 0;       ///< in turn
  Inlay inlay = {};
  std::size_t cut_for = 0;  ///< how many cells there were when it was cut
};

/// A result with inlays.
struct Inlaid {
  QuadMesh quads;
  std::vector<Index> site;  ///< [F] in whose inlay a face is; kNone: in none
  std::vector<Index> part;  ///< [F] its number there, or of the result without inlays
};

/// What is not as it should be.
struct Faults {
  std::vector<Index> faces;  ///< ascending
  bool is_beyond = false;    ///< whether anything is: a place of the input may be near no face
  [[nodiscard]] bool any() const { return is_beyond || !faces.empty(); }
};

class Inlays {
 public:
  /// \param proof, quads, crossing  kept by reference
  Inlays(ToleranceProof& proof, const QuadMesh& quads, CrossingPlaces& crossing, const Goal& goal)
      : proof_(proof),
        base_(quads),
        crossing_(crossing),
        goal_(goal),
        surfaces_(proof.input(), base_),
        lines_(surfaces_.mesh()),
        cutter_(surfaces_, base_, static_cast<std::size_t>(kMostWhole * base_.mesh.face_count())),
        is_given_up_(static_cast<std::size_t>(base_.mesh.face_count()), 0) {}

  /// Makes inlays over cells, and lets them grow; where that ends in vain those are back with which
  /// there were the fewest faults.
  /// \return whether there is no fault any more
  bool grow(const std::vector<Index>& cells) {
    Inlaid now{base_, {}, {}};
    now.part.resize(static_cast<std::size_t>(base_.mesh.face_count()));
    std::iota(now.part.begin(), now.part.end(), 0);
    now.site.assign(now.part.size(), kNone);
    Faults bad{cells, true};
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    std::vector<Site> best;
    int in_vain = 0;
    for (int round = 0; round < goal_.rounds && bad.any() && in_vain < kRoundsInVain; ++round) {
      if (!widen(now, bad.faces) || !cut() || sites_.empty()) break;
      now = with_inlays();
      bad = faults(now);
      if (!goal_.uncrosses) continue;
      in_vain = bad.faces.size() < fewest ? 0 : in_vain + 1;
      if (in_vain > 0) continue;
      fewest = bad.faces.size();
      best = sites_;
    }
    if (bad.any()) sites_ = std::move(best);
    return !bad.any();
  }

  /// Gives up the inlays that have faults, unless all together leave fewer faces that cross, and
  /// none beyond the tolerance. \param before  faces that cross without any
  void drop_bad_unless_fewer_cross(std::size_t before) {
    const std::vector<Site> all = sites_;
    drop_bad();
    const auto crossing = [&] { return crossing_.faces_of(with_inlays().quads.mesh).size(); };
    const std::size_t without_bad = crossing();
    std::vector<Site> good = std::exchange(sites_, all);
    const bool is_within = !beyond(with_inlays()).any();
    if (!is_within || crossing() >= std::min(without_bad, before)) sites_ = std::move(good);
  }

  /// Gives up the inlays that have faults.
  void drop_bad() {
    for (;;) {
      const Inlaid now = with_inlays();
      std::set<std::size_t> bad;
      for (const Index f : faults(now).faces) {
        for (const std::size_t s : sites_at(now, f)) bad.insert(s);
      }
      if (bad.empty()) return;
      std::vector<Site> good;
      for (std::size_t s = 0; s < sites_.size(); ++s) {
        if (!bad.contains(s)) good.push_back(std::move(sites_[s]));
      }
      sites_ = std::move(good);
    }
  }

  /// Thins inlays out by the least of some distances after which no faces cross and there are not
  /// many more vertices than without any; else by that after which the fewest cross, or of which
  /// the fewest vertices come. \pre as for `thin`
  /// \param distance  the first one; then twice as much, up to the tolerance
  void thin_from(double distance) {
    const std::vector<Site> whole = sites_;
    const auto most =
        static_cast<Index>((1 + kMostAdded) * static_cast<double>(base_.mesh.vertex_count()));
    using Price = std::pair<Index, std::size_t>;  // vertices too many, faces that cross
    Price least{std::numeric_limits<Index>::max(), 0};
    std::vector<Site> best;
    for (;;) {
      thin(distance);
      drop_large();
      const QuadMesh thinned = with_inlays().quads;
      const Price price{std::max(0, thinned.mesh.vertex_count() - most),
                        crossing_.faces_of(thinned.mesh).size()};
      if (price < least) {
        least = price;
        best = sites_;
      }
      if (price == Price{} || distance >= proof_.tolerance()) break;
      distance = std::min(2 * distance, proof_.tolerance());
      sites_ = whole;
    }
    sites_ = std::move(best);
  }

  /// Takes vertices out of inlays, fewer around faces that are beyond the tolerance or cross others
  /// then; of what is within it, that is taken of which the fewest cross. \pre none is beyond it
  /// \param distance  by which to thin out, at most the tolerance
  void thin(double distance) {
    std::vector<Thinning> thinnings;
    for (const Site& site : sites_) thinnings.emplace_back(surfaces_, lines_, site.inlay);
    std::vector<std::size_t> changed(sites_.size());
    std::iota(changed.begin(), changed.end(), 0);
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    std::vector<Site> best = sites_;
    int in_vain = 0;
    for (int time = 0; !changed.empty() && in_vain < kThinningsInVain; ++time) {
      for (const std::size_t s : changed) {
        sites_[s].inlay.faces = thinnings[s].faces(distance);
      }
      const Inlaid now = with_inlays();
      const Faults bad = beyond(now);
      std::vector<Index> crossing = crossing_.faces_of(now.quads.mesh);
      std::erase_if(crossing, [&](Index f) { return now.site[f] == kNone; });
      if (!bad.any() && crossing.size() < fewest) {
        fewest = crossing.size();
        best = sites_;
        in_vain = 0;
      } else if (!bad.any()) {
        ++in_vain;
      }
      const std::size_t levels = time < kMostThinnings ? 1 : Thinning::kLevels;
      changed =
          lessen(thinnings, balls_around(now, bad.faces), balls_around(now, crossing), levels);
      if (!changed.empty() || !bad.any()) continue;
      for (std::size_t s = 0; s < sites_.size(); ++s) {  // it is not known where
        if (thinnings[s].lessen({kEverywhere}, 1, levels)) changed.push_back(s);
      }
    }
    sites_ = std::move(best);
  }

  /// The result with the inlays there are.
  [[nodiscard]] Inlaid result() const { return with_inlays(); }

 private:
  /// What inlays grow for: faces beyond the tolerance, and those that cross if that is the goal.
  Faults faults(const Inlaid& inlaid) {
    Faults result = beyond(inlaid);
    if (!goal_.uncrosses) return result;
    const std::vector<Index> crossing = crossing_.faces_of(inlaid.quads.mesh);
    std::vector<Index> all;
    std::ranges::set_union(result.faces, crossing, std::back_inserter(all));
    return {std::move(all), result.is_beyond};
  }

  Faults beyond(const Inlaid& inlaid) {
    const auto excess = proof_.check(ComparedSurfaces(proof_.input(), inlaid.quads));
    std::set<Index> faces;
    const bool on_surface = excess.size() <= kMostSearched;
    for (const Target& t : cells_beyond(proof_.input()->mesh, inlaid.quads, excess, on_surface)) {
      faces.insert(t.face);
    }
    return {{faces.begin(), faces.end()}, !excess.empty()};
  }

  /// Sites in whose inlay a face is, or that it is beside.
  [[nodiscard]] std::vector<std::size_t> sites_at(const Inlaid& inlaid, Index face) const {
    if (inlaid.site[face] != kNone) return {static_cast<std::size_t>(inlaid.site[face])};
    std::vector<std::size_t> result;
    for (std::size_t s = 0; s < sites_.size(); ++s) {
      if (is_beside(inlaid.part[face], sites_[s])) result.push_back(s);
    }
    return result;
  }

  /// Whether a cell has a vertex on the outline of an inlay.
  [[nodiscard]] bool is_beside(Index cell, const Site& site) const {
    const auto is_of_outline = [&](Index v) {
      return std::ranges::find(site.inlay.outline, v) != site.inlay.outline.end();
    };
    return std::ranges::any_of(base_.mesh.face(cell), is_of_outline);
  }

  /// Gives up the inlays that have many faces for what they take the place of.
  void drop_large() {
    const auto few = static_cast<std::size_t>(kMostFacesShare * base_.mesh.face_count());
    std::erase_if(sites_, [&](const Site& site) {
      return site.inlay.faces.size() > std::max(few, kMostFacesPerCell * site.inlay.cells.size());
    });
  }

  void widen(Site& site) const {
    cutter_.add_ring(site.cells);
    ++site.rings;
  }

  /// Lets sites grow where faces are at their outline, and by half all around where faces are only
  /// further inside; adds one around each face that is in none. \return whether any may grow
  bool widen(const Inlaid& inlaid, const std::vector<Index>& faces) {
    std::vector<char> is_bad(sites_.size(), 0);
    std::vector<std::set<Index>> grown(sites_.size());
    std::vector<Index> cells;
    for (const Index f : faces) {
      if (inlaid.site[f] == kNone) {
        if (is_given_up_[inlaid.part[f]] == 0) cells.push_back(inlaid.part[f]);
        continue;
      }
      const Inlay& inlay = sites_[inlaid.site[f]].inlay;
      is_bad[inlaid.site[f]] = 1;
      for (const Index v : inlay.faces[inlaid.part[f]]) {
        if (static_cast<std::size_t>(v) >= inlay.outline.size()) continue;
        cutter_.add_around(inlay.outline[v], grown[inlaid.site[f]]);
      }
    }
    bool may_grow = false;
    for (std::size_t s = 0; s < grown.size(); ++s) {
      Site& site = sites_[s];
      site.times_bad = is_bad[s] != 0 ? site.times_bad + 1 : 0;
      may_grow |= is_bad[s] != 0 && !site.inlay.outline.empty();  // else it is all there is
      if (is_bad[s] != 0 && grown[s].empty()) {
        for (int ring = site.rings / 2; ring >= 0; --ring) widen(site);
      }
      for (int ring = 1; ring < site.times_bad; ++ring) cutter_.add_ring(grown[s]);
      site.cells.merge(grown[s]);
    }
    for (const Index cell : cells) {
      sites_.push_back({.cells = {cell}});
      widen(sites_.back());
    }
    return !cells.empty() || may_grow;
  }

  /// Whether a site is large for the faces that cross for which it is.
  [[nodiscard]] bool is_out_of_proportion(const Site& site) const {
    return goal_.uncrosses &&
           site.cells.size() > std::max(kFewCells, kMostCellsPerFault * site.faults);
  }

  /// Cuts the inlay of a site, which grows as long as there is none.
  std::optional<Inlay> cut_growing(Site& site) {
    if (is_out_of_proportion(site)) return std::nullopt;
    std::optional<Inlay> inlay = cutter_.cut(site.cells);
    for (std::size_t before = 0; !inlay && site.cells.size() > before;) {
      before = site.cells.size();
      cells_in_vain_ += before;
      widen(site);
      if (is_out_of_proportion(site) || site.cells.size() > goal_.cells ||
          cells_in_vain_ > kMostInVain) {
        break;
      }
      inlay = cutter_.cut(site.cells);
    }
    return inlay;
  }

  /// Cuts the inlays of all sites, which grow where that takes it; no two of them touch. Sites are
  /// given up where there is none, if faces that cross may stay.
  /// \return false where they may not
  bool cut() {
    do {
      for (Site& site : sites_) {
        if (site.cells.size() == site.cut_for) continue;
        if (std::optional<Inlay> inlay = cut_growing(site)) {
          site.inlay = std::move(*inlay);
          site.cut_for = site.cells.size();
        } else if (!goal_.uncrosses) {
          return false;
        } else {
          for (const Index cell : site.cells) is_given_up_[cell] = 1;
          site.cells.clear();
        }
      }
      std::erase_if(sites_, [](const Site& site) { return site.cells.empty(); });
    } while (merge());
    return true;
  }

  /// Joins sites whose inlays have a vertex in common. \return whether there were any
  bool merge() {
    std::vector<Index> site_of(base_.mesh.positions.size(), kNone);
    std::vector<Site> merged;
    for (Site& site : sites_) {
      std::set<Index> others;
      for (const Index cell : site.inlay.cells) {
        for (const Index v : base_.mesh.face(cell)) {
          if (site_of[v] != kNone) others.insert(site_of[v]);
        }
      }
      std::set<Index> inlaid(site.inlay.cells.begin(), site.inlay.cells.end());
      for (const Index s : others) {
        Site& other = merged[s];
        site.faults += other.faults;
        site.rings = std::max(site.rings, other.rings);
        site.cells.merge(other.cells);
        inlaid.insert(other.inlay.cells.begin(), other.inlay.cells.end());
        other.cells.clear();
        site.cut_for = 0;
      }
      site.inlay.cells.assign(inlaid.begin(), inlaid.end());
      for (const Index cell : site.inlay.cells) {
        for (const Index v : base_.mesh.face(cell)) site_of[v] = static_cast<Index>(merged.size());
      }
      merged.push_back(std::move(site));
    }
    std::erase_if(merged, [](const Site& site) { return site.cells.empty(); });
    const bool any = merged.size() < sites_.size();
    sites_ = std::move(merged);
    return any;
  }

  /// Thins inlays out less around faces beyond the tolerance, in as large balls as it takes, and
  /// around faces that cross others, which they may have done before.
  /// \param beyond, crossing  [sites]
  /// \param levels            changes to smaller distances
  /// \return the inlays for which that changes anything
  static std::vector<std::size_t> lessen(std::vector<Thinning>& thinnings,
                                         const std::vector<std::vector<Ball>>& beyond,
                                         const std::vector<std::vector<Ball>>& crossing,
                                         std::size_t levels) {
    std::vector<std::size_t> changed;
    for (std::size_t s = 0; s < thinnings.size(); ++s) {
      bool is_less = thinnings[s].lessen(crossing[s], 1, levels);
      for (double scale = 1; !is_less && scale <= kLargestScale; scale *= 2) {
        is_less = thinnings[s].lessen(beyond[s], scale, levels);
      }
      if (is_less) changed.push_back(s);
    }
    return changed;
  }

  /// [sites] around faces of their inlays, and beside these.
  [[nodiscard]] std::vector<std::vector<Ball>> balls_around(const Inlaid& inlaid,
                                                            const std::vector<Index>& faces) const {
    std::vector<std::vector<Ball>> result(sites_.size());
    for (const Index f : faces) {
      const Ball ball = ball_around(inlaid, f);
      for (const std::size_t s : sites_at(inlaid, f)) result[s].push_back(ball);
    }
    return result;
  }

  /// Around a face, through its farthest corner.
  [[nodiscard]] Ball ball_around(const Inlaid& inlaid, Index face) const {
    const PolyMesh& mesh = inlaid.quads.mesh;
    Ball ball{Vec3::Zero(), 0};
    for (const Index v : mesh.face(face)) ball.middle += mesh.positions[v];
    ball.middle /= static_cast<double>(mesh.face(face).size());
    for (const Index v : mesh.face(face)) {
      ball.radius = std::max(ball.radius, (mesh.positions[v] - ball.middle).norm());
    }
    ball.middle -= surfaces_.mesh().origin;
    return ball;
  }

  [[nodiscard]] Inlaid with_inlays() const {
    Inlaid result;
    result.quads.mesh_id = base_.mesh_id;
    QuadMesh& quads = result.quads;
    quads.mesh.positions = base_.mesh.positions;
    quads.provenance = base_.provenance;
    std::vector<char> goes(static_cast<std::size_t>(base_.mesh.face_count()), 0);
    for (const Site& site : sites_) {
      for (const Index f : site.inlay.cells) goes[f] = 1;
    }
    const auto add_face = [&](std::span<const Index> face, Index site, Index part) {
      quads.mesh.add_face(face);
      result.site.push_back(site);
      result.part.push_back(part);
    };
    for (Index f = 0; f < base_.mesh.face_count(); ++f) {
      if (goes[f] == 0) add_face(base_.mesh.face(f), kNone, f);
    }
    for (std::size_t s = 0; s < sites_.size(); ++s) {
      const Inlay& inlay = sites_[s].inlay;
      std::vector<Index> number = inlay.outline;
      for (const SurfacePoint& point : inlay.points) {
        number.push_back(quads.mesh.vertex_count());
        quads.mesh.positions.push_back(place_of(surfaces_.mesh(), point) + surfaces_.mesh().origin);
        quads.provenance.face.push_back(point.face);
        quads.provenance.barycentric.push_back(point.barycentric);
        quads.provenance.lines.push_back({kNone, kNone});
      }
      for (std::size_t i = 0; i < inlay.faces.size(); ++i) {
        const auto& [a, b, c] = inlay.faces[i];
        add_face(std::array{number[a], number[b], number[c]}, static_cast<Index>(s),
                 static_cast<Index>(i));
      }
    }
    drop_unused_vertices(quads);
    return result;
  }

  ToleranceProof& proof_;
  const QuadMesh& base_;
  CrossingPlaces& crossing_;
  Goal goal_;
  ComparedSurfaces surfaces_;
  SurfaceLines lines_;
  InlayCutter cutter_;
  std::vector<Site> sites_;
  std::size_t cells_in_vain_ = 0;
  std::vector<char> is_given_up_;  ///< [F] 1: of a site that could not be cut
};

}  // namespace

bool inlay_beyond(ToleranceProof& proof, const std::vector<Excess>& excess,
                  CrossingPlaces& crossing, QuadMesh& quads) {
  std::vector<Index> cells;
  for (const Target& target : cells_beyond(proof.input()->mesh, quads, excess, true)) {
    cells.push_back(target.face);
  }
  if (cells.size() > kMostBad) return false;
  Inlays inlays(proof, quads, crossing, kWithin);
  const bool is_within = inlays.grow(cells);
  if (is_within) {
    inlays.thin(proof.tolerance());
    quads = inlays.result().quads;
  }
  return is_within;
}

std::vector<char> inlay_crossing(ToleranceProof& proof, CrossingPlaces& crossing, double thinned_by,
                                 QuadMesh& quads) {
  const std::vector<Index> cells = crossing.faces_of(quads.mesh);
  if (cells.empty() || cells.size() > kMostBad) return {};
  Inlays inlays(proof, quads, crossing, kUncrossed);
  if (!inlays.grow(cells)) inlays.drop_bad_unless_fewer_cross(cells.size());
  inlays.thin_from(thinned_by);
  Inlaid result = inlays.result();
  if (!proof.check(ComparedSurfaces(proof.input(), result.quads)).empty()) return {};
  if (crossing.faces_of(result.quads.mesh).size() >= cells.size()) return {};
  quads = std::move(result.quads);
  std::vector<char> is_of_inlay(quads.mesh.positions.size(), 0);
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    if (result.site[f] == kNone) continue;
    for (const Index v : quads.mesh.face(f)) is_of_inlay[v] = 1;
  }
  return is_of_inlay;
}

}  // namespace strake

#include "stages/refine/inlays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/geometry/cell_error/compared_surfaces.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/inlaid.h"
#include "stages/refine/inlay.h"
#include "stages/refine/thinning.h"

namespace strake {
namespace {

/// What inlays grow for.
struct Goal {
  bool uncrosses;  ///< faces that cross, too; these may stay, so inlays that do not help may go
  InlayLimits limits;
};
/// Cells in place of which an inlay for faces that cross may be, for each of these, and for few.
/// Along ragged boundaries it would grow as long as there is no other like its patch.
constexpr std::size_t kMostCellsPerFault = 75;
constexpr std::size_t kFewCells = 250;
/// Share of all cells that a component may have whose place an inlay takes altogether. Larger ones
/// should follow lines.
constexpr double kMostWhole = 0.1;
/// Cells in all of places where no inlay could be cut, after which none grows for that any more.
constexpr std::size_t kMostInVain = 40000;
/// Inlays that are cut at the same time, before these are added up.
constexpr std::size_t kCutAtOnce = 16;
/// Times that inlays grow, for faces that cross, without fewer faults than ever before.
constexpr int kInlaysInVain = 4;

/// Where an inlay is to be.
struct Site {
  std::set<Index> cells;   ///< that it is to take the place of, at least
  std::size_t faults = 1;  ///< cells around which it was begun
  int rings = 0;           ///< of them, about
  int times_bad = 0;       ///< in turn
  Inlay inlay = {};
  std::size_t cut_for = 0;  ///< how many cells there were when it was cut
  std::size_t in_vain = 0;  ///< cells in all of places where it could not be cut the last time
};

/// Inlays that grow until a result is as it should be with them.
class Inlays {
 public:
  /// \param host  kept by reference
  Inlays(const InlayHost& host, const Goal& goal)
      : host_(host),
        base_(host.quads()),
        goal_(goal),
        cutter_(host.surfaces(), base_,
                static_cast<std::size_t>(kMostWhole * base_.mesh.face_count())),
        is_given_up_(static_cast<std::size_t>(base_.mesh.face_count()), 0) {}

  /// Makes inlays over cells, and lets them grow; where that ends in vain those are back with which
  /// there were the fewest faults.
  /// \return whether there is no fault any more
  bool grow(const std::vector<Index>& cells) {
    Inlaid now{base_, {}, {}};
    now.part.resize(static_cast<std::size_t>(base_.mesh.face_count()));
    std::iota(now.part.begin(), now.part.end(), 0);
    now.inlay.assign(now.part.size(), kNone);
    Faults bad{cells, true};
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    std::vector<Site> best;
    int in_vain = 0;
    for (int round = 0; round < goal_.limits.rounds && bad.any() && in_vain < kInlaysInVain;
         ++round) {
      if (!widen(now, bad.faces) || !cut() || sites_.empty()) break;
      now = inlaid();
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
  /// none beyond the tolerance.
  /// \param before  faces that cross without any
  void drop_bad_unless_fewer_cross(std::size_t before) {
    const std::vector<Site> all = sites_;
    drop_bad();
    const auto crossing = [&] { return host_.crossing(inlaid()).size(); };
    const std::size_t without_bad = crossing();
    std::vector<Site> good = std::exchange(sites_, all);
    const bool is_within = !host_.beyond(inlaid()).any();
    if (!is_within || crossing() >= std::min(without_bad, before)) sites_ = std::move(good);
  }

  /// Gives up the inlays that have faults.
  void drop_bad() {
    for (;;) {
      const std::vector<Inlay> all = inlays();
      const Inlaid now = host_.with(all);
      std::set<std::size_t> bad;
      for (const Index f : faults(now).faces) {
        for (const std::size_t s : host_.inlays_at(all, now, f)) bad.insert(s);
      }
      if (bad.empty()) return;
      std::vector<Site> good;
      for (std::size_t s = 0; s < sites_.size(); ++s) {
        if (!bad.contains(s)) good.push_back(std::move(sites_[s]));
      }
      sites_ = std::move(good);
    }
  }

  [[nodiscard]] std::vector<Inlay> inlays() const {
    std::vector<Inlay> result;
    for (const Site& site : sites_) result.push_back(site.inlay);
    return result;
  }

 private:
  [[nodiscard]] Inlaid inlaid() const { return host_.with(inlays()); }

  /// What inlays grow for: faces beyond the tolerance, and those that cross if that is the goal.
  Faults faults(const Inlaid& inlaid) {
    Faults result = host_.beyond(inlaid);
    if (!goal_.uncrosses) return result;
    const std::vector<Index> crossing = host_.crossing(inlaid);
    std::vector<Index> all;
    std::ranges::set_union(result.faces, crossing, std::back_inserter(all));
    return {std::move(all), result.is_beyond};
  }

  void widen(Site& site) const {
    cutter_.add_ring(site.cells);
    ++site.rings;
  }

  /// Lets sites grow where faces are at their outline, and by half all around where faces are only
  /// further inside; adds one around each face that is in none.
  /// \return whether any may grow
  bool widen(const Inlaid& inlaid, const std::vector<Index>& faces) {
    std::vector<char> is_bad(sites_.size(), 0);
    std::vector<std::set<Index>> grown(sites_.size());
    std::vector<Index> cells;
    for (const Index f : faces) {
      if (inlaid.inlay[f] == kNone) {
        if (is_given_up_[inlaid.part[f]] == 0) cells.push_back(inlaid.part[f]);
        continue;
      }
      const Inlay& inlay = sites_[inlaid.inlay[f]].inlay;
      is_bad[inlaid.inlay[f]] = 1;
      for (const Index v : inlay.faces[inlaid.part[f]]) {
        if (static_cast<std::size_t>(v) >= inlay.outline.size()) continue;
        cutter_.add_around(inlay.outline[v], grown[inlaid.inlay[f]]);
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

  /// Cuts the inlay of a site, which grows as long as there is none. \return whether there is one
  bool cut_growing(Site& site) const {
    site.in_vain = 0;
    if (is_out_of_proportion(site)) return false;
    std::optional<Inlay> inlay = cutter_.cut(site.cells);
    for (std::size_t before = 0; !inlay && site.cells.size() > before;) {
      before = site.cells.size();
      site.in_vain += before;
      widen(site);
      if (is_out_of_proportion(site) || site.cells.size() > goal_.limits.cells ||
          cells_in_vain_ + site.in_vain > kMostInVain) {
        break;
      }
      inlay = cutter_.cut(site.cells);
    }
    if (!inlay) return false;
    site.inlay = *std::move(inlay);
    site.cut_for = site.cells.size();
    return true;
  }

  /// Cuts the inlays of all sites, which grow where that takes it; no two of them touch. Sites are
  /// given up where there is none, if faces that cross may stay.
  /// \return false where they may not
  bool cut() {
    do {
      std::vector<Site*> left;
      for (Site& site : sites_) {
        if (site.cells.size() != site.cut_for) left.push_back(&site);
      }
      for (std::size_t first = 0; first < left.size(); first += kCutAtOnce) {
        const std::span some =
            std::span(left).subspan(first, std::min(kCutAtOnce, left.size() - first));
        std::vector<std::uint8_t> is_cut(some.size());
        tbb::parallel_for(std::size_t{0}, some.size(),
                          [&](std::size_t i) { is_cut[i] = cut_growing(*some[i]) ? 1 : 0; });
        for (std::size_t i = 0; i < some.size(); ++i) {
          cells_in_vain_ += some[i]->in_vain;
          if (is_cut[i] != 0) continue;
          if (!goal_.uncrosses) return false;
          for (const Index cell : some[i]->cells) is_given_up_[cell] = 1;
          some[i]->cells.clear();
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

  const InlayHost& host_;
  const QuadMesh& base_;
  Goal goal_;
  InlayCutter cutter_;
  std::vector<Site> sites_;
  std::size_t cells_in_vain_ = 0;
  std::vector<char> is_given_up_;  ///< [F] 1: of a site that could not be cut
};

}  // namespace

bool inlay_beyond(ToleranceProof& proof, const std::vector<Excess>& excess,
                  CrossingPlaces& crossing, QuadMesh& quads, const InlayLimits& limits) {
  std::vector<Index> cells;
  for (const Target& target : cells_beyond(proof.input()->mesh, quads, excess, true)) {
    cells.push_back(target.face);
  }
  if (cells.size() > limits.places) return false;
  const InlayHost host(proof, quads, crossing);
  Inlays growing(host, {false, limits});
  if (!growing.grow(cells)) return false;
  std::vector<Inlay> inlays = growing.inlays();
  thin(host, proof.tolerance(), inlays);
  quads = host.with(inlays).quads;
  return true;
}

std::vector<char> inlay_crossing(ToleranceProof& proof, CrossingPlaces& crossing, double thinned_by,
                                 QuadMesh& quads, const InlayLimits& limits) {
  const std::vector<Index> cells = crossing.faces_of(quads.mesh);
  if (cells.empty() || cells.size() > limits.places) return {};
  const InlayHost host(proof, quads, crossing);
  Inlays growing(host, {true, limits});
  if (!growing.grow(cells)) growing.drop_bad_unless_fewer_cross(cells.size());
  std::vector<Inlay> inlays = growing.inlays();
  thin_from(host, thinned_by, inlays);
  Inlaid result = host.with(inlays);
  if (!proof.check(ComparedSurfaces(proof.input(), result.quads)).empty()) return {};
  if (crossing.faces_of(result.quads.mesh).size() >= cells.size()) return {};
  quads = std::move(result.quads);
  std::vector<char> is_of_inlay(quads.mesh.positions.size(), 0);
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    if (result.inlay[f] == kNone) continue;
    for (const Index v : quads.mesh.face(f)) is_of_inlay[v] = 1;
  }
  return is_of_inlay;
}

}  // namespace strake

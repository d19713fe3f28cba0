#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/geometry/samples/sample_designs.h"

namespace strake {
namespace {

// The bracket: a base plate with rounded corners and a rounded upper rim, four chamfered bolt
// holes, a boss with a chamfered bore and a cross hole, blended into the plate, and a rib.
constexpr double kHalfLength = 55, kHalfWidth = 35, kTop = 14;
constexpr double kCornerRadius = 12, kRimRadius = 4;
constexpr double kHoleX = 40, kHoleY = 21, kHoleRadius = 5.5, kChamfer = 2;
constexpr double kBossRadius = 18, kBossTop = 52, kFilletRadius = 6, kBoreRadius = 11;
constexpr double kRibHalfWidth = 4, kRibTip = 46;  // its top falls at 45 degrees to (tip, kTop)
constexpr double kCrossRadius = 4, kCrossHeight = 36;
/// Longest edge on a bend, in radians of the bend; and the radius from which on a bend is no reason
/// for smaller edges than elsewhere.
constexpr double kTurn = 0.4;
constexpr double kCalmRadius = 8;

using Curves = std::vector<Index>;

SurfaceBuilder::CurveFunction segment(const Vec3& a, const Vec3& b) {
  return [=](double t) { return Vec3(a + t * (b - a)); };
}

SurfaceBuilder::CurveFunction arc(const Vec3& centre, double radius, double from, double to) {
  return [=](double t) {
    const double angle = from + t * (to - from);
    return Vec3(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0));
  };
}

class PartDesign {
 public:
  PartDesign(double size, SurfaceBuilder& builder) : size_(size), builder_(builder) {}

  void draw() {
    draw_rim();
    draw_bolt_holes();
    draw_bore();
    draw_boss_and_rib();
    add(plane_surface(Frame::along(Vec3::Zero(), -Vec3::UnitZ(), Vec3::UnitX())), size_, bottom_);
    add(plane_surface(Frame::along(Vec3(0, 0, kTop), Vec3::UnitZ(), Vec3::UnitX())), size_, top_);
  }

 private:
  /// Wanted edge length on a bend of the given radius.
  [[nodiscard]] double fine(double radius) const {
    return std::min(size_ * std::min(1.0, std::sqrt(radius / kCalmRadius)), kTurn * radius);
  }

  void add(const SurfacePtr& surface, double size, const Curves& curves) {
    builder_.add_patch(surface, size, curves, region_++);
  }

  Index circle(double radius, double z, const Vec3& centre, double spacing) {
    Frame frame;
    frame.origin = centre;
    return builder_.add_loop(circle_curve(frame, radius, z), spacing);
  }

  // Outline of the plate: at junction 2 k begins the arc of corner k, at 2 k + 1 it ends.
  static Vec3 corner_centre(int k, double z) {
    const double x = kHalfLength - kCornerRadius, y = kHalfWidth - kCornerRadius;
    return {k == 0 || k == 3 ? x : -x, k < 2 ? y : -y, z};
  }
  static double junction_angle(int j) { return (j / 2 + j % 2) * std::numbers::pi / 2; }
  static Vec3 junction_direction(int j) {
    return {std::cos(junction_angle(j)), std::sin(junction_angle(j)), 0};
  }
  static Vec3 junction(int j, double radius, double z) {
    return corner_centre(j / 2, z) + radius * junction_direction(j);
  }

  /// The eight curves of the outline at one height, `radius` around the corner centres.
  Curves outline(const std::array<Index, 8>& corners, double radius, double z, double spacing) {
    Curves curves;
    for (int j = 0; j < 8; ++j) {
      const int next = (j + 1) % 8;
      const auto at = j % 2 == 0 ? arc(corner_centre(j / 2, z), radius, junction_angle(j),
                                       junction_angle(j) + std::numbers::pi / 2)
                                 : segment(junction(j, radius, z), junction(next, radius, z));
      curves.push_back(builder_.add_curve(corners[j], corners[next], at, spacing));
    }
    return curves;
  }

  void draw_rim() {
    const double shoulder = kTop - kRimRadius, inner = kCornerRadius - kRimRadius;
    std::array<Index, 8> low{}, middle{}, high{};
    for (int j = 0; j < 8; ++j) {
      low[j] = builder_.add_corner(junction(j, kCornerRadius, 0));
      middle[j] = builder_.add_corner(junction(j, kCornerRadius, shoulder));
      high[j] = builder_.add_corner(junction(j, inner, kTop));
    }
    bottom_ = outline(low, kCornerRadius, 0, fine(kCornerRadius));
    const Curves belt = outline(middle, kCornerRadius, shoulder, fine(kRimRadius));
    top_ = outline(high, inner, kTop, fine(kRimRadius));
    Curves walls, rounds;
    for (int j = 0; j < 8; ++j) {
      const auto wall =
          segment(junction(j, kCornerRadius, 0), junction(j, kCornerRadius, shoulder));
      const auto round = [=](double t) {
        const double angle = t * std::numbers::pi / 2;
        return Vec3(junction(j, inner + kRimRadius * std::cos(angle),
                             shoulder + kRimRadius * std::sin(angle)));
      };
      walls.push_back(builder_.add_curve(low[j], middle[j], wall, fine(kCornerRadius)));
      rounds.push_back(builder_.add_curve(middle[j], high[j], round, fine(kRimRadius)));
    }
    for (int j = 0; j < 8; ++j) {
      const int next = (j + 1) % 8;
      const Curves wall = {bottom_[j], walls[next], belt[j], walls[j]};
      const Curves round = {belt[j], rounds[next], top_[j], rounds[j]};
      const Vec3 centre = corner_centre(j / 2, shoulder);
      if (j % 2 == 0) {
        const Frame frame = Frame::along(centre, Vec3::UnitZ(), Vec3::UnitX());
        add(cylinder_surface(frame, kCornerRadius, Side::away), fine(kCornerRadius), wall);
        add(torus_surface(frame, inner, kRimRadius, false, Side::away), fine(kRimRadius), round);
      } else {
        const Vec3 outwards = junction_direction(j);
        const Frame upright = Frame::along(junction(j, kCornerRadius, 0), outwards, Vec3::UnitZ());
        add(plane_surface(upright), size_, wall);
        const Frame along = Frame::along(junction(j, inner, shoulder),
                                         Vec3::UnitZ().cross(outwards), outwards + Vec3::UnitZ());
        add(cylinder_strip(along, kRimRadius, Side::away), fine(kRimRadius), round);
      }
    }
  }

  /// A bore along z from z = 0 up to a chamfer that ends at z = `top`. \return its upper rim
  Index draw_bore_with_chamfer(const Vec3& centre, double radius, double top) {
    const double spacing = fine(radius);
    const Index low = circle(radius, 0, centre, spacing);
    const Index middle = circle(radius, top - kChamfer, centre, spacing);
    const Index high = circle(radius + kChamfer, top, centre, spacing);
    Frame frame;
    frame.origin = centre;
    bore_curves_ = {low, middle};
    bore_ = cylinder_surface(frame, radius, Side::towards);
    frame.origin.z() = top - kChamfer;
    add(cone_surface(frame, radius, 1, Side::towards), spacing, {middle, high});
    bottom_.push_back(low);
    return high;
  }

  void draw_bolt_holes() {
    for (const double x : {-kHoleX, kHoleX}) {
      for (const double y : {-kHoleY, kHoleY}) {
        top_.push_back(draw_bore_with_chamfer(Vec3(x, y, 0), kHoleRadius, kTop));
        add(bore_, fine(kHoleRadius), bore_curves_);
      }
    }
  }

  /// The bore of the boss, the cross hole that opens into it, and the ring on top of the boss.
  void draw_bore() {
    const Index inner = draw_bore_with_chamfer(Vec3::Zero(), kBoreRadius, kBossTop);
    const auto cross_rim = [](double radius) {
      return [=](double t) {
        const double angle = 2 * std::numbers::pi * t;
        const double y = kCrossRadius * std::cos(angle);
        return Vec3(-std::sqrt(radius * radius - y * y), y,
                    kCrossHeight + kCrossRadius * std::sin(angle));
      };
    };
    const Index inside = builder_.add_loop(cross_rim(kBoreRadius), fine(kCrossRadius));
    cross_outside_ = builder_.add_loop(cross_rim(kBossRadius), fine(kCrossRadius));
    bore_curves_.push_back(inside);
    add(bore_, fine(kBoreRadius), bore_curves_);
    const Frame cross =
        Frame::along(Vec3(-kBossRadius, 0, kCrossHeight), -Vec3::UnitX(), Vec3::UnitZ());
    add(cylinder_surface(cross, kCrossRadius, Side::towards), fine(kCrossRadius),
        {inside, cross_outside_});
    boss_rim_ = circle(kBossRadius, kBossTop, Vec3::Zero(), fine(kBossRadius));
    const Frame lid = Frame::along(Vec3(0, 0, kBossTop), Vec3::UnitZ(), Vec3::UnitX());
    add(plane_surface(lid), size_, {inner, boss_rim_});
  }

  // The rib stands on the plate, leans on the boss, and cuts a notch into its fillet.
  static constexpr double kFoot = kBossRadius + kFilletRadius, kNeckHeight = kTop + kFilletRadius;
  static constexpr double kApex = kTop + kRibTip;  ///< the top of the rib is x + z = kApex

  /// The curves of the rib, each twice where it has two sides: y > 0 first.
  struct Rib {
    std::array<Index, 2> on_foot, on_neck, on_boss, tip;  ///< corners
    std::array<Index, 2> blend, rise, ground, slope;      ///< along fillet, boss, plate, top
    Index front, crown;                                   ///< across, at the tip and the boss
  };

  Rib draw_rib() {
    Rib rib{};
    const double w = kRibHalfWidth, spacing = fine(kFilletRadius);
    const double boss_x = std::sqrt(kBossRadius * kBossRadius - w * w);
    const double foot_x = std::sqrt(kFoot * kFoot - w * w);
    const auto straight = [&](Index from, Index to, const Vec3& a, const Vec3& b) {
      return builder_.add_curve(from, to, segment(a, b), spacing);
    };
    for (std::size_t side = 0; side < 2; ++side) {
      const double y = side == 0 ? w : -w;
      const Vec3 foot(foot_x, y, kTop), neck(boss_x, y, kNeckHeight);
      const Vec3 boss(boss_x, y, kApex - boss_x), tip(kRibTip, y, kTop);
      rib.on_foot[side] = builder_.add_corner(foot);
      rib.on_neck[side] = builder_.add_corner(neck);
      rib.on_boss[side] = builder_.add_corner(boss);
      rib.tip[side] = builder_.add_corner(tip);
      const auto toric = [=](double t) {
        const double angle = t * std::numbers::pi / 2;
        const double r = kFoot - kFilletRadius * std::sin(angle);
        return Vec3(std::sqrt(r * r - w * w), y, kNeckHeight - kFilletRadius * std::cos(angle));
      };
      rib.blend[side] = builder_.add_curve(rib.on_foot[side], rib.on_neck[side], toric, spacing);
      rib.rise[side] = straight(rib.on_neck[side], rib.on_boss[side], neck, boss);
      rib.ground[side] = straight(rib.on_foot[side], rib.tip[side], foot, tip);
      rib.slope[side] = straight(rib.tip[side], rib.on_boss[side], tip, boss);
    }
    rib.front = straight(rib.tip[0], rib.tip[1], Vec3(kRibTip, w, kTop), Vec3(kRibTip, -w, kTop));
    const double half_turn = std::asin(w / kBossRadius);
    const auto crown = [=](double t) {
      const double angle = half_turn * (1 - 2 * t), x = kBossRadius * std::cos(angle);
      return Vec3(x, kBossRadius * std::sin(angle), kApex - x);
    };
    rib.crown = builder_.add_curve(rib.on_boss[0], rib.on_boss[1], crown, spacing);
    return rib;
  }

  void draw_boss_and_rib() {
    const Rib rib = draw_rib();
    // A circle around the boss, open where the rib stands.
    const auto around = [&](const std::array<Index, 2>& ends, double radius, double z) {
      const double from = std::asin(kRibHalfWidth / radius);
      return builder_.add_curve(ends[0], ends[1],
                                arc(Vec3(0, 0, z), radius, from, 2 * std::numbers::pi - from),
                                fine(kFilletRadius));
    };
    const Index foot = around(rib.on_foot, kFoot, kTop);
    const Index neck = around(rib.on_neck, kBossRadius, kNeckHeight);

    Frame frame;
    frame.origin.z() = kNeckHeight;
    add(torus_surface(frame, kFoot, kFilletRadius, true, Side::towards), fine(kFilletRadius),
        {foot, neck, rib.blend[0], rib.blend[1]});
    add(cylinder_surface(frame, kBossRadius, Side::away), fine(kBossRadius),
        {neck, rib.rise[0], rib.rise[1], rib.crown, boss_rim_, cross_outside_});
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 outwards = side == 0 ? Vec3::UnitY() : Vec3(-Vec3::UnitY());
      const Frame flank = Frame::along(kRibHalfWidth * outwards, outwards, Vec3::UnitX());
      add(plane_surface(flank), size_,
          {rib.ground[side], rib.slope[side], rib.rise[side], rib.blend[side]});
    }
    const Frame ramp = Frame::along(Vec3(kRibTip, 0, kTop), Vec3(1, 0, 1), Vec3::UnitY());
    add(plane_surface(ramp), size_, {rib.slope[0], rib.slope[1], rib.front, rib.crown});
    top_.insert(top_.end(), {foot, rib.ground[0], rib.ground[1], rib.front});
  }

  double size_;
  SurfaceBuilder& builder_;
  Index region_ = 0;
  Curves bottom_, top_;  ///< rims of the two large flats
  SurfacePtr bore_;      ///< of the bore drawn last, and its rims
  Curves bore_curves_;
  Index cross_outside_ = kNone, boss_rim_ = kNone;
};

}  // namespace

void design_part(double size, SurfaceBuilder& builder) { PartDesign(size, builder).draw(); }

}  // namespace strake

// burr verify shapes - the proxy of six unknowns on bones for which force, torque and place of a tool
// are known in closed form. Formulas and bars: docs/understand/touch_tools.md, "Six unknowns".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "beside_one_sphere.h"
#include "burr/haptics/six/six_proxy.h"
#include "burr/math/rotation.h"
#include "burr/math/turn.h"
#include "burr/phantom/build.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"

namespace burr::app {
namespace {

using haptics::SixTouch;
using math::Pose;
using math::Quat;
using math::Vec3;
using tool::Role;
using tool::ShapeKind;

constexpr double kMm = 1e-3;
constexpr double kStiffness = 1000;  // k_t [N/m]
constexpr double kTurning = 0.3;     // k_r [N m/rad]
constexpr double kFillet = 1 * kMm;  // of every rim: at least four voxels

// A turn about an axis of the shape's frame.
Quat turn_about(const Vec3& axis, double angle) {
  Quat q;
  q.w() = std::cos(angle / 2);
  q.vec() = std::sin(angle / 2) * axis.normalized();
  return q;
}

// The lattice is turned against everything else, so that no face lies along it.
Quat lattice() {
  return math::product(turn_about({0, 0, 1}, 0.31),
                       math::product(turn_about({0, 1, 0}, 0.23), turn_about({1, 0, 0}, 0.17)));
}

// A bone in voxels of `h`, in a cube of the half edge `half` about the origin.
struct Bone {
  Bone(const phantom::Depth& depth, double h, double half)
      : bone(phantom::bone_from_distance(turned_grid(h, half), {}, depth)),
        surface(*bone, {}, 2, progress()) {}
  static volume::Grid turned_grid(double h, double half) {
    volume::Grid grid = phantom::box_grid(Vec3::Constant(-half), Vec3::Constant(half), h);
    grid.frame.q = lattice();
    grid.frame.p = grid.frame.q * grid.frame.p;
    return grid;
  }
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
};

tool::Tool one_part(const tool::Shape& shape) {
  tool::Tool tool;
  static_cast<void>(tool::add_part(tool, {shape, {}, Role::cuts}));
  return tool;
}

// From `above` straight to `to` in 0.2 s, then held until it has come to rest.
SixTouch press(const Bone& bone, const tool::Tool& tool, const Pose& to, const Vec3& above) {
  haptics::SixProxy proxy(bone.surface, tool, {.lever = std::sqrt(kTurning / kStiffness)},
                          {to.p + above, to.q});
  SixTouch touch;
  for (int n = 0; n <= 300; ++n) {
    const double left = std::max(0.0, 1 - n / 200.0);
    touch = proxy.step({to.p + left * above, to.q});
  }
  return touch;
}

Vec3 torque_of(const SixTouch& touch) { return kTurning * touch.turn; }

// e_h: how far the place of a contact may be off.
double place_error(double h) { return std::max(0.01 * kMm, 0.06 * h); }

std::string at(const char* what, double h) { return fmt::format("{}.{:.0f}um", what, h * 1e6); }

// c_z = a, F = k_t delta, no torque.
void lying_cylinder(VerifyReport::Part& part, double h) {
  const Bone bone(phantom::slab(), h, 9 * kMm);
  const double a = 2 * kMm, delta = 0.5 * kMm;
  const tool::Tool tool = one_part({ShapeKind::cylinder, a - 0.3 * kMm, 0, 3 * kMm, 0.3 * kMm});
  double force = 0, torque = 0;
  for (const double yaw : {0.0, 0.6, 1.3}) {
    const Quat q = math::product(turn_about({0, 0, 1}, yaw), turn_about({0, 1, 0}, M_PI / 2));
    const SixTouch touch =
        press(bone, tool, {{0.1 * kMm, 0.2 * kMm, a - delta}, q}, {0, 0, 2 * kMm});
    force = std::max(force, (kStiffness * touch.stretch - Vec3(0, 0, kStiffness * delta)).norm());
    torque = std::max(torque, torque_of(touch).norm());
  }
  part.at_most(at("cylinder-on-plane.force-error", h), 0.01 * kStiffness * delta, force, "N");
  part.at_most(at("cylinder-on-plane.torque", h), 0.02e-3, torque, "N m");
}

// N = delta / (1/k_t + l^2/k_r), torque N l, on a rim of radius kFillet.
void lever_on_rim(VerifyReport::Part& part, double h) {
  const Bone bone(phantom::capsule({0, -30 * kMm, 0}, {0, 30 * kMm, 0}, kFillet), h, 7 * kMm);
  const double a = 1.2 * kMm, delta = 0.5 * kMm;
  const tool::Tool tool = one_part({ShapeKind::capsule, 0, 0, 40 * kMm, a});
  const Quat along_x = turn_about({0, 1, 0}, M_PI / 2);
  double force = 0, lever = 0;
  for (const double l : {0.0, 5 * kMm, 15 * kMm, 30 * kMm}) {
    const SixTouch touch =
        press(bone, tool, {{-l, 0, kFillet + a - delta}, along_x}, {0, 0, 2 * kMm});
    const double n = delta / (1 / kStiffness + l * l / kTurning);
    const double stiff = n / delta;  // of the two springs in a row
    // in metres at the contact, so that a soft lever does not flatter
    force = std::max(force, std::abs(kStiffness * touch.stretch.z() - n) / stiff);
    if (l > 0) lever = std::max(lever, std::abs(-torque_of(touch).y() - n * l) / (stiff * l));
  }
  part.at_most(at("lever-on-rim.place-by-force", h), place_error(h), force, "m");
  part.at_most(at("lever-on-rim.place-by-torque", h), place_error(h), lever, "m");
}

// A box pressed delta into a plane and tilted by beta: flat, with F = k_t delta and torque k_r beta,
// as long as k_r beta <= k_t delta x_e; beyond that it stands on its edge, where V is least.
void tilted_box(VerifyReport::Part& part, double h) {
  const Bone bone(phantom::slab(), h, 9 * kMm);
  const double delta = 1 * kMm, rounding = 0.3 * kMm, half = 4.25 * kMm, thick = 0.5 * kMm;
  const tool::Tool tool = one_part({ShapeKind::box, half - rounding, 2 * kMm, thick, rounding});
  double flat_turn = 0, flat_force = 0, flat_torque = 0;
  for (const double beta : {0.0, 5e-3, 10e-3}) {
    const SixTouch touch =
        press(bone, tool, {{0, 0, thick + rounding - delta}, turn_about({0, 1, 0}, beta)},
              {0, 0, 2.5 * kMm});
    flat_turn = std::max(flat_turn, (touch.turn + Vec3(0, beta, 0)).norm());
    flat_force =
        std::max(flat_force, std::abs(kStiffness * touch.stretch.z() - kStiffness * delta));
    flat_torque = std::max(flat_torque, std::abs(torque_of(touch).y() + kTurning * beta));
  }
  part.at_most(at("box-flat.turn-error", h), 0.1e-3, flat_turn, "rad");
  part.at_most(at("box-flat.force-error", h), 0.01 * kStiffness * delta, flat_force, "N");
  part.at_most(at("box-flat.torque-error", h), 0.02e-3, flat_torque, "N m");

  // on its edge: lift of c over the flat place, by the tilt A: x_e sin A - (thick)(1 - cos A)
  const double beta = 30e-3, edge = half - rounding;
  double best = 0, least = 1e9;
  for (int n = 0; n <= 300'000; ++n) {
    const double tilt = n * 1e-7;
    const double lift = edge * std::sin(tilt) - thick * (1 - std::cos(tilt));
    const double v = 0.5 * kStiffness * (delta + lift) * (delta + lift) +
                     0.5 * kTurning * (beta - tilt) * (beta - tilt);
    if (v >= least) continue;
    least = v;
    best = tilt;
  }
  const SixTouch touch =
      press(bone, tool, {{0, 0, thick + rounding - delta}, turn_about({0, 1, 0}, beta)},
            {0, 0, 2.5 * kMm});
  part.near(at("box-on-edge.tilt", h), best, beta - touch.turn.norm(), 0.1e-3, "rad");
}

// A disc of radius R and thickness t, turned in a slot of width w:
//     2 ((R - rho) sin psi + (t/2 - rho) cos psi + rho) = w
void disc_in_slot(VerifyReport::Part& part, double h) {
  const double w = 1.2 * kMm, radius = 4 * kMm, thick = 1 * kMm, rho = 0.3 * kMm;
  const auto bone_depth = [w](const Vec3& p) { return std::abs(p.x()) - w / 2; };
  const Bone bone(bone_depth, h, 7 * kMm);
  const tool::Tool tool = one_part({ShapeKind::cylinder, radius - rho, 0, thick / 2 - rho, rho});
  double low = 0, high = 0.3;
  for (int n = 0; n < 60; ++n) {
    const double psi = 0.5 * (low + high);
    const double width =
        2 * ((radius - rho) * std::sin(psi) + (thick / 2 - rho) * std::cos(psi) + rho);
    (width < w ? low : high) = psi;
  }
  const Quat across = turn_about({0, 1, 0}, M_PI / 2);  // its axis along x
  haptics::SixProxy proxy(bone.surface, tool, {.lever = std::sqrt(kTurning / kStiffness)},
                          {Vec3::Zero(), across});
  SixTouch touch;
  const double beta = low + 10e-3;
  for (int n = 0; n <= 300; ++n)
    touch =
        proxy.step({Vec3::Zero(),
                    math::product(turn_about({0, 0, 1}, beta * std::min(1.0, n / 200.0)), across)});
  const double psi = beta - touch.turn.norm();
  part.at_most(at("disc-in-slot.place-of-rim", h), place_error(h), radius * std::abs(psi - low),
               "m");
  part.at_most(at("disc-in-slot.stray-force", h), 0.02, kStiffness * touch.stretch.norm(), "N");
}

// A hole of radius b through a plate of thickness `thick` (0: endless downwards from z = 0), its rims
// rounded by kFillet.
phantom::Depth hole(double b, double thick) {
  return [b, thick](const Vec3& p) {
    const double across = b + kFillet - p.head<2>().norm();
    const double along = thick > 0 ? std::abs(p.z()) - (thick / 2 - kFillet) : p.z() + kFillet;
    return kFillet - std::min(std::max(across, along), 0.0) -
           std::hypot(std::max(across, 0.0), std::max(along, 0.0));
  };
}

// A peg of radius a in a hole of radius b and length D, turned until it jams:
//     (a + f) + (D/2 - f) sin A = (b + f) cos A
// Beyond that a pure couple k_r (beta - A), of two forces s = (D - 2 f) cos A + 2 (b + f) sin A apart.
void peg_in_hole(VerifyReport::Part& part, double h) {
  const double a = 1.5 * kMm, b = 1.65 * kMm, deep = 6 * kMm, f = kFillet;
  const Bone bone(hole(b, deep), h, 7 * kMm);
  const tool::Tool tool = one_part({ShapeKind::cylinder, a - 0.3 * kMm, 0, 6 * kMm, 0.3 * kMm});
  double low = 0, high = 0.3;
  for (int n = 0; n < 60; ++n) {
    const double tilt = 0.5 * (low + high);
    (a + f + (deep / 2 - f) * std::sin(tilt) < (b + f) * std::cos(tilt) ? low : high) = tilt;
  }
  haptics::SixProxy proxy(bone.surface, tool, {.lever = std::sqrt(kTurning / kStiffness)}, {});
  SixTouch touch;
  const double beta = low + 10e-3;
  for (int n = 0; n <= 300; ++n)
    touch = proxy.step({Vec3::Zero(), turn_about({0, 1, 0}, beta * std::min(1.0, n / 200.0))});
  const double tilt = beta - touch.turn.norm();
  const double apart = (deep - 2 * f) * std::cos(tilt) + 2 * (b + f) * std::sin(tilt);
  const double load = torque_of(touch).norm() / apart;
  double worst = 0, sum = 0;
  for (int c = 0; c < touch.active; ++c)
    sum += kStiffness * touch.contacts[static_cast<std::size_t>(c)].load;
  worst =
      std::abs(sum - 2 * load) / (2 * load);  // a rim may hold by several places beside each other
  part.at_most(at("peg-in-hole.place-of-rim", h), place_error(h), deep * std::abs(tilt - low) / 2,
               "m");
  part.at_most(at("peg-in-hole.stray-force", h), 0.02, kStiffness * touch.stretch.norm(), "N");
  part.at_most(at("peg-in-hole.forces-of-couple", h), 0.02, worst, "");
}

// A burr of radius r in a canal of radius b, leaning with its shaft of radius a against the rim:
//     (b + f - c_x) cos A - (-f - c_z) sin A = a + f,   c_x = -(b - r)
// where c_z makes V least. The load of the shaft is N_2 = torque / lever, that of the head
// N_1 = F_x + N_2 cos A.
void burr_in_canal(VerifyReport::Part& part, double h) {
  const double r = 1.8 * kMm, a = 1 * kMm, b = 2.2 * kMm, f = kFillet;
  const Bone bone(hole(b, 0), h, 12 * kMm);
  tool::Tool tool = one_part({ShapeKind::ball, 0, 0, 0, r});
  static_cast<void>(tool::add_part(
      tool,
      {{ShapeKind::capsule, 0, 0, 10 * kMm, a}, {{0, 0, 10 * kMm}, Quat::Identity()}, Role::rubs}));
  const double x = -(b - r);
  const Vec3 hand(x - 0.3 * kMm, 0, -9 * kMm);
  const auto tilt_at = [&](double z) {  // of the shaft that touches rim and, by the ball, wall
    double low = 0, high = 0.6;
    for (int n = 0; n < 60; ++n) {
      const double tilt = 0.5 * (low + high);
      ((b + f - x) * std::cos(tilt) - (-f - z) * std::sin(tilt) > a + f ? low : high) = tilt;
    }
    return low;
  };
  const double beta = tilt_at(hand.z()) + 20e-3;
  double best = 0, least = 1e9;
  for (double z = hand.z() - 0.3 * kMm; z < hand.z() + 0.3 * kMm; z += 0.02e-6) {
    const double left = beta - tilt_at(z), up = z - hand.z();
    const double v = kStiffness * up * up + kTurning * left * left;
    if (v >= least) continue;
    least = v;
    best = z;
  }
  const double tilt = tilt_at(best);
  haptics::SixProxy proxy(bone.surface, tool, {.lever = std::sqrt(kTurning / kStiffness)},
                          {{0, 0, hand.z()}, Quat::Identity()});
  SixTouch touch;
  for (int n = 0; n <= 400; ++n) {
    const double there = std::min(1.0, n / 300.0);
    touch = proxy.step({{there * hand.x(), 0, hand.z()}, turn_about({0, 1, 0}, there * beta)});
  }
  const double felt = beta - touch.turn.norm(), z = hand.z() + touch.stretch.z();
  const double lever = (b + f - x) * std::sin(felt) + (-f - z) * std::cos(felt);
  const double shaft = torque_of(touch).norm() / lever;
  const double head = kStiffness * touch.stretch.x() + shaft * std::cos(felt);
  double by_part[2] = {0, 0};
  for (int c = 0; c < touch.active; ++c) {
    const haptics::SixContact& contact = touch.contacts[static_cast<std::size_t>(c)];
    by_part[contact.part] += kStiffness * contact.load;
  }
  const double long_arm = -f - hand.z();
  part.at_most(at("burr-in-canal.place-of-rim", h), place_error(h),
               long_arm * std::abs(felt - tilt), "m");
  part.near(at("burr-in-canal.load-of-head", h), head, by_part[0], 0.02 * head, "N");
  part.near(at("burr-in-canal.load-of-shaft", h), shaft, by_part[1], 0.02 * shaft, "N");
}

// Force and torque are the sums of the contacts'; on a loop of poses the hand's work comes back.
void wrench_and_energy(VerifyReport::Part& part, double h) {
  const Bone bone(phantom::groove(M_PI / 5), h, 9 * kMm);
  tool::Burr burr;
  burr.radius = 1.5 * kMm;
  const double lever2 = kTurning / kStiffness;
  haptics::SixProxy proxy(bone.surface, tool::burr_with_shaft(burr), {.lever = std::sqrt(lever2)},
                          {{0, 0, 9 * kMm}, Quat::Identity()});
  double worst = 0, work = 0, most = 0;
  Pose last;
  SixTouch before;
  constexpr int kDown = 400, kLoop = 4000;
  for (int n = 0; n <= kDown + 2 * kLoop; ++n) {
    const double down = std::min(1.0, 1.0 * n / kDown);
    const double t = 2 * M_PI * std::max(0, n - kDown) / kLoop;
    const Pose hand{{0.4 * kMm * std::sin(t), 1 * kMm * std::sin(t),
                     (9 - 6.8 * down - 0.2 * (1 - std::cos(t))) * kMm},
                    turn_about({1, 0.3, 0}, 0.2 * std::sin(t))};
    const SixTouch touch = proxy.step(hand);
    if (n > kDown + kLoop) {  // the trapezium rule
      const Vec3 way = hand.p - last.p;
      const Vec3 turn = math::rotation_vector(math::product(hand.q, last.q.conjugate()));
      work -= 0.5 * kStiffness *
              ((touch.stretch + before.stretch).dot(way) +
               lever2 * (touch.turn + before.turn).dot(turn));
      most = std::max(most, 0.5 * kStiffness *
                                (touch.stretch.squaredNorm() + lever2 * touch.turn.squaredNorm()));
    }
    if (n >= kDown && touch.active > 0 && touch.moves < 12) {
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
      for (int a = 0; a < touch.active; ++a) {
        const haptics::SixContact& contact = touch.contacts[static_cast<std::size_t>(a)];
        force += contact.load * contact.normal;
        torque += contact.load * contact.lever;
      }
      worst = std::max({worst, (force - touch.stretch).norm(),
                        (torque - lever2 * touch.turn).norm() / std::sqrt(lever2)});
    }
    last = hand;
    before = touch;
  }
  part.at_most(at("balance.force-of-contacts", h), 1e-9, worst, "m");
  part.at_most(at("energy.closed-loop", h), 0.001 * most, std::abs(work), "J");
}

// A box on a slope under a load straight down: it slides if and only if tan > mu. By steps of the slope:
// the steepest on which it holds, and the least on which it slides, over mu.
void box_on_slope(VerifyReport::Part& part, double h) {
  const tool::Tool box = one_part({ShapeKind::box, 2.2 * kMm, 1.7 * kMm, 0.7 * kMm, 0.3 * kMm});
  for (const double mu : {0.2, 0.5})
    for (const double share : {0.98, 1.02}) {
      const double slope = std::atan(share * mu);
      const Vec3 up(std::sin(slope), 0, std::cos(slope));
      const Bone bone(phantom::slab(up), h, 9 * kMm);
      const Quat along = turn_about({0, 1, 0}, slope);
      haptics::SixProxy proxy(bone.surface, box, {.lever = std::sqrt(kTurning / kStiffness)},
                              {3 * kMm * up, along});
      proxy.set_friction({mu, mu});
      for (int n = 0; n <= 250; ++n)
        static_cast<void>(proxy.step({(1 + std::max(0.0, 2 - n / 100.0)) * kMm * up, along}));
      const Vec3 rest = proxy.pose().p;
      for (int n = 0; n < 4000; ++n)
        static_cast<void>(
            proxy.step({proxy.pose().p - Vec3(0, 0, 0.5 * kMm * std::min(1.0, n / 500.0)), along}));
      const double went = (proxy.pose().p - rest).norm();
      const std::string scene = fmt::format("box-on-slope-mu{}", mu);
      if (share < 1)
        part.at_most(at((scene + ".holds-at-98").c_str(), h), 0.02 * kMm, went, "m");
      else
        part.at_least(at((scene + ".slides-at-102").c_str(), h), 0.1 * kMm, went, "m");
    }
}

// A disc of radius R pressed flat with N and spun about its normal: M = 2 mu N R / 3 where it begins to
// slide and while it slides.
void spun_disc(VerifyReport::Part& part, double h) {
  const Bone bone(phantom::slab(), h, 9 * kMm);
  const double mu = 0.3, slides = 0.27, delta = 1 * kMm, thick = 1 * kMm;
  for (const double radius : {2 * kMm, 3.5 * kMm}) {
    const tool::Tool disc = one_part({ShapeKind::cylinder, radius, 0, 0.7 * kMm, 0.3 * kMm});
    haptics::SixProxy proxy(bone.surface, disc, {.lever = std::sqrt(kTurning / kStiffness)},
                            {{0, 0, thick + 2 * kMm}, Quat::Identity()});
    proxy.set_friction({mu, slides});
    const auto hand = [&](int n, double turn) {
      const double down = std::min(1.0, n / 200.0);
      return Pose{{0, 0, thick + 2 * kMm - down * (2 * kMm + delta)},
                  turn_about({0, 0, 1}, turn + 1e-12)};
    };
    SixTouch touch;
    for (int n = 0; n <= 250; ++n) touch = proxy.step(hand(n, 0));
    double held = 0, began = 0, sum = 0;
    for (int n = 0; n < 4000; ++n) {
      touch = proxy.step(hand(250, 4e-6 * n));
      const double torque = -torque_of(touch).z();
      if (began == 0 && !touch.stuck) began = held;
      held = torque;
      if (n >= 3000) sum += torque / 1000;
    }
    const double truth = 2 * mu * kStiffness * delta * radius / 3;
    const std::string scene = fmt::format("disc-spun-{}mm", radius / kMm);
    part.near(at((scene + ".begins-to-slide").c_str(), h), truth, began, 0.05 * truth, "N m");
    part.near(at((scene + ".slides").c_str(), h), slides / mu * truth, sum, 0.05 * truth, "N m");
  }
}

// The tools that are pushed against a thin plate: four of one part, and two of two.
struct Named {
  const char* name;
  tool::Tool tool;
};
std::vector<Named> tools_against_a_plate() {
  const tool::Shape blade{ShapeKind::box, 0.2 * kMm, 2 * kMm, 2 * kMm, 0.15 * kMm},
      flame{ShapeKind::vesica, 1 * kMm, 0, 3 * kMm, 0.3 * kMm},
      chisel{ShapeKind::wedge, 1 * kMm, 2 * kMm, 6 * kMm, 0.15 * kMm},
      wheel{ShapeKind::cylinder, 2.5 * kMm, 0, 0.25 * kMm, 0.15 * kMm};
  tool::Tool blade_and_flame = one_part(blade), chisel_and_wheel = one_part(chisel);
  static_cast<void>(
      tool::add_part(blade_and_flame, {flame, {{0, 0, 4 * kMm}, Quat::Identity()}, Role::cuts}));
  static_cast<void>(tool::add_part(
      chisel_and_wheel,
      {wheel, {{0, 3 * kMm, 1 * kMm}, turn_about({1, 0, 0}, M_PI / 2)}, Role::cuts}));
  return {{"blade", one_part(blade)},           {"chisel", one_part(chisel)},
          {"flame", one_part(flame)},           {"wheel", one_part(wheel)},
          {"blade-and-flame", blade_and_flame}, {"chisel-and-wheel", chisel_and_wheel}};
}

// A plate of 0.6 mm: the tool stays on its side.
void thin_plate(VerifyReport::Part& part, const char* name, const tool::Tool& tool, int ticks) {
  const double h = 0.25 * kMm;
  const Vec3 up = Vec3(0.2, 0.3, 1).normalized();
  const Bone bone(phantom::plate(0.6 * kMm, up), h, 16 * kMm);  // wider than the hand goes
  haptics::SixProxy proxy(bone.surface, tool, {}, {7 * kMm * up, Quat::Identity()});
  int wrong = 0, touched = 0;
  for (int n = 0; n < ticks; ++n) {
    const double t = n * 1e-3;
    // 100 mm/s and 3 rad/s, through the plate and back, and every 2 s a jump
    const double jump = n / 2000 % 2 == 0 ? 0 : 3 * kMm;
    const Vec3 at(4 * kMm * std::sin(11 * t) + jump, 4 * kMm * std::sin(7.3 * t),
                  6 * kMm * std::sin(12 * t));
    const SixTouch touch =
        proxy.step({at, turn_about({1, std::sin(t), 0.4}, 1.2 * std::sin(2.5 * t))});
    touched += touch.active > 0 ? 1 : 0;
    bool beyond = false;
    for (int p = 0; p < tool.count; ++p) {
      const tool::Part& one = tool.parts[static_cast<std::size_t>(p)];
      const Pose& pose = touch.world_from_tool;
      const Quat back = math::product(pose.q, one.tool_from_part.q).conjugate();
      beyond |= up.dot(pose * one.tool_from_part.p) - tool::support(one.shape, back * -up) < 0;
    }
    wrong += beyond ? 1 : 0;
  }
  const std::string scene = fmt::format("thin-plate-{}", name);
  part.at_most(at((scene + ".ticks-on-the-wrong-side").c_str(), h), 0, wrong, "");
  part.at_least(at((scene + ".ticks-in-contact").c_str(), h), 0.25 * ticks, touched, "");
}

void shapes(const Verify& verify, VerifyReport::Part& part) {
  for (const double h : verify.quick ? std::vector<double>{0.25 * kMm}
                                     : std::vector<double>{0.25 * kMm, 0.125 * kMm}) {
    const std::function<void(VerifyReport::Part&, double)> all[] = {
        lying_cylinder, lever_on_rim, tilted_box,        disc_in_slot, peg_in_hole,
        burr_in_canal,  box_on_slope, wrench_and_energy, spun_disc};
    for (const auto& one : all) {
      if (interrupted()) return;
      one(part, h);
    }
  }
  const int ticks = verify.quick ? 4000 : 1'000'000;
  for (const Named& one : tools_against_a_plate()) {
    if (interrupted()) return;
    // two parts of one tool: half as many, as a million for both pairs
    thin_plate(part, one.name, one.tool, one.tool.count == 1 ? ticks : ticks / 2);
  }
  beside_one_sphere(part, ticks);
}

const VerifyPart part{
    15, "shapes", "Tools of several parts",
    "A tool that has a place and a turn rests on bones for which force, torque and place are "
    "known, slides where its friction ends, and is braked by it when it spins; the spring has 1 "
    "N/mm and 0.3 N m/rad, the lattice is turned. Times are not judged here: "
    "bench/results/tool.md has those of every tool.",
    shapes};

}  // namespace
}  // namespace burr::app

// burr verify mechanics - chips, drag and spindle: the effect of cutting on the burr and on the
// hand.
#include <cmath>
#include <numbers>

#include "burr/device/simulated_hand.h"
#include "burr/edit/laws/chip_law.h"
#include "burr/phantom/build.h"
#include "burr/rt/flags.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"
#include "verify.h"

namespace burr::app {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3, kRadius = 2 * kMm, kRpm = 2 * std::numbers::pi / 60;
constexpr double kUncut = 1e18;  // bone that cannot be cut, so that the contact stays  [J/m^3]

std::unique_ptr<volume::Bone> slab(double cutting_energy) {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-6 * kMm), Vec3::Constant(6 * kMm), 0.25 * kMm),
      phantom::bone_that_costs(cutting_energy), phantom::slab(), 256);
}

// A rigid hand with its shaft along +x presses straight down with 1 N per millimetre, for some
// time.
struct Pressed {
  Vec3 force = Vec3::Zero();  // mean of the last 0.2 s
  tick::TickRow last;
  std::uint32_t flags = 0;
};
Pressed press(tick::ServoSettings servo, double newton) {
  device::HandPath path;
  for (const auto& [t, z] : {std::pair{0.0, 1 * kMm}, std::pair{0.8, 1 * kMm},
                             std::pair{1.2, -newton * kMm}, std::pair{3.0, -newton * kMm}}) {
    device::PathPoint point;
    point.t = t;
    point.world_from_tool.q = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY());
    point.world_from_tool.p = {0, 0, kRadius + z};
    path.points.push_back(point);
  }
  device::ArmSettings rigid;
  rigid.stiffness = INFINITY;
  sim::SessionSettings settings;
  settings.servo = servo;
  settings.servo.burr.radius = kRadius;
  settings.servo.friction_turning = 0;  // only the drag
  settings.servo.limit.user_force = 10;
  device::DeviceSpec strong;
  strong.peak_force = 10;
  strong.continuous_force = 10;
  NoProgress quiet;
  auto session = sim::Session::make(
      slab(kUncut), std::make_unique<device::SimulatedHand>(path, rigid, strong), settings, quiet);
  Pressed out;
  if (!session) return out;
  for (int n = 0; n < 2900; ++n) {
    out.last = (*session)->servo().tick(false);
    (*session)->servo().publish();
    out.flags |= out.last.contact.flags;
    if (n >= 2700) out.force += out.last.contact.force / 200;
  }
  return out;
}

// James et al. 2013: bovine cortical bone, resultants of 8 to 11 N on a kerf of 0.7 mm; as specific
// energies in docs/understand/cutting.md, "Chips".
void chips(VerifyReport::Part& part) {
  const volume::CuttingForce force = volume::Tissue{}.force;
  const auto energy = [&](double chip) {
    return force.chip_tangential +
           force.edge_tangential * (1 - std::exp(-chip / force.edge_onset)) / chip;
  };
  part.near("chips.specific_energy_10um", 0.86, 1e-9 * energy(10e-6), 0.15, "J/mm3");
  part.near("chips.specific_energy_2.5um", 3, 1e-9 * energy(2.5e-6), 0.4, "J/mm3");
  Line law{"burr", {}, {}}, seen{"measured", {10, 2.5}, {0.86, 3}, false, true};
  for (double t = 0.1e-6; t < 60e-6; t *= 1.1) {
    law.x.push_back(1e6 * t);
    law.y.push_back(1e-9 * energy(t));
  }
  part.plot(
      {"What a cubic millimetre of cortical bone costs, by how thick the chips are. Points: "
       "James et al. 2013. Thin chips cost more, for each pays for its edge; below the "
       "edge's bluntness of a micrometre the cost levels off (our assumption).",
       1,
       {{"specific cutting energy", "chip [um]", "energy [J/mm3]", {law, seen}, true, true}}});

  // the two laws compared, for a contact at the burr's side, its belly and its pole
  const auto bone = slab(1e9);
  const tool::Burr burr = {.radius = kRadius};
  const edit::RemovalSettings settings;
  const Vec3 centre(0, 0, kRadius - 0.1 * kMm), up = Vec3::UnitZ();
  edit::Chips chips(*bone);
  Axes rate{
      "by force", "push [N]", "removed [mm3/s]", {{"energy", {}, {}, true}, {"chips", {}, {}}}};
  Axes axis{"by direction of the shaft, 1 N",
            "shaft to normal [deg]",
            "removed [mm3/s]",
            {{"energy", {}, {}, true}, {"chips", {}, {}}}};
  const auto both = [&](double push, double angle, Axes& into, double x) {
    const edit::Spin spin = {Vec3(std::sin(angle), 0, std::cos(angle)), 40000 * kRpm};
    const double one =
        edit::energy_law(push, spin, kRadius, volume::Tissue{}.cutting_friction, up, 1, settings)
            .energy /
        1e9 * 1e9;
    const double two = 1e9 * chips.step(burr, centre, up, push, spin, 1, settings).energy / 1e9;
    into.lines[0].x.push_back(x);
    into.lines[0].y.push_back(one);
    into.lines[1].x.push_back(x);
    into.lines[1].y.push_back(two);
    return two;
  };
  for (double push = 0.1; push <= 5; push += 0.1) both(push, std::numbers::pi / 2, rate, push);
  double pole = 0, side = 0;
  for (int degrees = 0; degrees <= 90; degrees += 5) {
    const double now = both(1, degrees * std::numbers::pi / 180, axis, degrees);
    if (degrees == 0) pole = now;
    side = now;
  }
  part.at_least("chips.side_cuts_better_than_pole", 2, side / pole, "times");
  part.plot(
      {"A burr of 4 mm at 40 000 rpm, 0.1 mm deep in a plane of cortical bone. The energy law "
       "is a straight line; by chips a heavier hand is paid better, since thicker chips "
       "cost less. Both cut worst with the pole.",
       2,
       {rate, axis}});
}

void drag(VerifyReport::Part& part) {
  tick::ServoSettings settings;
  const double mu = volume::Tissue{}.cutting_friction;
  const Vec3 forward = press(settings, 1).force;
  part.near("drag.over_push", mu, forward.y() / forward.z(), 0.01, "");
  part.at_most("drag.along_the_shaft", 0.01, std::abs(forward.x()), "N");
  settings.burr.kind = tool::BurrKind::diamond;
  const Vec3 diamond = press(settings, 1).force;
  part.near("drag.diamond", mu / 4, diamond.y() / diamond.z(), 0.01, "");
  settings.spindle_rad_s *= -1;
  part.near("drag.backwards", -diamond.y(), press(settings, 1).force.y(), 1e-3, "N");
  settings = {};
  settings.removal.law = edit::RemovalLaw::chips;
  const Pressed toothed = press(settings, 1);
  part.at_least("drag.by_chips", 0.3, toothed.force.y() / toothed.force.z(), "of the push");
}

void spindle(const Verify& verify, VerifyReport::Part& part) {
  tick::ServoSettings settings;
  settings.motor.torque = 2e-3;
  settings.motor.friction = 0;
  settings.motor.inertia = 5e-8;  // small, so that the final speed is reached in time
  const double mu = volume::Tissue{}.cutting_friction, full = settings.spindle_rad_s;
  Line measured{"measured", {}, {}, false, true}, theory{"formula", {}, {}, true};
  double worst = 0;
  for (const double newton : {0.5, 1.0, 1.5, 2.0, 2.4, 2.8, 3.0}) {
    if (verify.quick && newton != 1.0 && newton != 3.0) continue;
    const Pressed out = press(settings, newton);
    const double push = out.force.z(), torque = mu * push * kRadius;
    const double expected = torque < settings.motor.torque
                                ? full * (1 - settings.motor.droop * torque / settings.motor.torque)
                                : 0;
    worst = std::max(worst, std::abs(out.last.spindle_rad_s - expected) / full);
    measured.x.push_back(push);
    measured.y.push_back(out.last.spindle_rad_s / full);
    theory.x.push_back(push);
    theory.y.push_back(expected / full);
    if (newton == 3.0)
      part.at_least("spindle.stalls_and_says_so", 1,
                    (out.flags & rt::kFlagStalled) != 0 && out.last.spindle_rad_s == 0 ? 1 : 0, "");
  }
  part.at_most("spindle.droop", 0.005, worst, "of full speed");
  part.plot(
      {"A motor of 2 mN m under the torque mu F r of a burr of 4 mm: it gives way by a tenth, "
       "and beyond 2.5 N it stands.",
       1,
       {{"speed under load", "push [N]", "of full speed", {theory, measured}}}});
}

void mechanics(const Verify& verify, VerifyReport::Part& part) {
  chips(part);
  drag(part);
  spindle(verify, part);
}

const VerifyPart part{
    35, "mechanics", "Chips, drag, spindle",
    "The cutting energy of the chips law compared with measurements on bone; the pull of the bone "
    "on a turning burr; the spindle under load, stalled, and turning backwards.",
    mechanics};

}  // namespace
}  // namespace burr::app

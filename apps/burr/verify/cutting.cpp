// burr verify cutting - holes of known shape, and laws that must be linear.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/volume/volume_of.h"
#include "verify.h"
#include "workbench.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kMm = 1e-3, kR = 2 * kMm;
// docs/understand/cutting_truths.md, "Ground truths": 4 mm^3/s per newton, a hand of 0.2 N/mm, for
// 1.5 s
constexpr device::ArmSettings kSoft{.mass = 0.1, .damping = 10, .stiffness = 200};
constexpr double kSoftEnergy = 0.838e9, kSoftTarget = 4e-3, kSoftSeconds = 1.5;
constexpr device::ArmSettings kFirm{.mass = 0.1, .damping = 20, .stiffness = 500};

volume::Grid block(double h, const Vec3& half) { return phantom::box_grid(-half, half, h); }

double cap(double depth) { return M_PI * depth * depth * (kR - depth / 3); }  // [m^3]

// Presses straight into a plane with the arm's force of about 0.6 N, for about a second.
struct Plunge {
  double depth = 0, removed = 0, really = 0, mean_force = 0, steady_force = 0;
  edit::Ledger ledger;
  std::vector<Workbench::Row> rows;
};
Plunge plunge(double h, const WorkSettings& settings, double energy, double target, double seconds,
              const device::ArmSettings& arm = kFirm) {
  Workbench bench(phantom::slab(), block(h, Vec3(4, 4, 5) * kMm), phantom::bone_that_costs(energy),
                  settings);
  const double before = volume::volume_of(bench.bone());
  Plunge out;
  out.rows = bench.work(path_through({{0, {0, 0, kR + 0.5 * kMm}},
                                      {0.3, {0, 0, kR - target}},
                                      {0.3 + seconds, {0, 0, kR - target}}}),
                        arm, true);
  out.really = before - volume::volume_of(bench.bone());
  out.ledger = bench.ledger();
  out.removed = out.ledger.removed;
  out.depth = kR - out.rows.back().proxy.z();
  double sum = 0;
  int count = 0;
  for (const auto& row : out.rows) {
    if (row.push <= 0) continue;
    sum += row.push;
    ++count;
  }
  out.mean_force = sum / count;
  out.steady_force = out.rows.back().push;
  return out;
}

Plunge soft(double h, const WorkSettings& settings) {
  return plunge(h, settings, kSoftEnergy, kSoftTarget, kSoftSeconds, kSoft);
}

void holes(const Verify& verify, VerifyReport::Part& part) {
  // ---- plunge: depth and volume of a cap
  for (const double h_mm : verify.quick ? std::vector<double>{0.25} : std::vector{0.5, 0.25, 0.2}) {
    const Plunge one = soft(h_mm * kMm, {.radius = kR});
    const double tolerance = (h_mm <= 0.25 ? 0.01 : 0.025) * one.depth + 0.1 * h_mm * kMm;
    double low = 0, high = kR;
    for (int n = 0; n < 60; ++n)
      (cap((low + high) / 2) < one.removed ? low : high) = (low + high) / 2;
    const std::string which = fmt::format("plunge.h{}", h_mm);
    part.near(which + ".depth_of_its_volume", 1e3 * low, 1e3 * one.depth, 1e3 * tolerance, "mm");
    part.near(which + ".ledger_is_the_field", 1, one.really / one.removed, 1e-3, "");
    const edit::Ledger& l = one.ledger;
    part.at_most(which + ".ledger_balances", 1e-6,
                 std::abs(l.asked - l.removed - l.debt - l.not_cut) / l.asked, "");
  }

  // ---- slot and scallop: a rigid hand at a fixed depth, with enough power
  const double h = 0.2 * kMm, deep = 0.2 * kMm, feed = 5 * kMm;
  constexpr device::ArmSettings kRigid{.mass = 0.1, .damping = 10, .stiffness = INFINITY};
  {
    Workbench bench(phantom::slab(), block(h, Vec3(10, 4, 4) * kMm), phantom::bone_that_costs(1e8),
                    {.radius = kR, .spindle = 20000});
    const double z = kR - deep;
    const auto rows = bench.work(path_through({{0, {-6 * kMm, 0, kR + 1 * kMm}},
                                               {0.2, {-6 * kMm, 0, z}},
                                               {0.6, {-6 * kMm, 0, z}},
                                               {3.0, {6 * kMm, 0, z}}}),
                                 kRigid, true);
    const double d = depth_of_hole(bench.bone(), 0, 0, 0);
    const double area = kR * kR * std::acos(1 - d / kR) - (kR - d) * std::sqrt(2 * kR * d - d * d);
    const auto at = [&](double t) { return rows[static_cast<std::size_t>(t * 1000)].removed; };
    const double rate = (at(2.6) - at(1.4)) / 1.2;
    part.near("slot.rate_is_area_times_feed", 1e9 * area * feed, 1e9 * rate, 0.03e9 * area * feed,
              "mm3/s");
    part.near("slot.depth", 1e3 * deep, 1e3 * d, 0.1e3 * h + 0.06, "mm");
  }
  {
    // the ridge lies over a row of voxel centres: the field cannot hold a sharp ridge between them
    const double step = 1 * kMm, down = 0.3 * kMm, y0 = -step / 2 + h / 2, y1 = y0 + step;
    Workbench bench(phantom::slab(), block(h, Vec3(8, 5, 4) * kMm), phantom::bone_that_costs(1e8),
                    {.radius = kR, .spindle = 20000});
    const double z = kR - down;
    (void)bench.work(path_through({{0, {-5 * kMm, y0, kR + 1 * kMm}},
                                   {0.2, {-5 * kMm, y0, z}},
                                   {0.6, {-5 * kMm, y0, z}},
                                   {2.6, {5 * kMm, y0, z}},
                                   {2.8, {5 * kMm, y0, kR + 2 * kMm}},
                                   {3.0, {5 * kMm, y1, kR + 2 * kMm}},
                                   {3.2, {5 * kMm, y1, z}},
                                   {3.6, {5 * kMm, y1, z}},
                                   {5.6, {-5 * kMm, y1, z}}}),
                     kRigid, true);
    const double valley =
        0.5 * (depth_of_hole(bench.bone(), 0, y0, 0) + depth_of_hole(bench.bone(), 0, y1, 0));
    const double ridge = depth_of_hole(bench.bone(), 0, h / 2, 0);
    part.near("scallop.height", 1e3 * (kR - std::sqrt(kR * kR - step * step / 4)),
              1e3 * (valley - ridge), 0.1e3 * h, "mm");
  }
}

void laws(VerifyReport::Part& part) {
  // ---- the same hand at other tick rates and with other voxels
  const double h = 0.25 * kMm;
  const Plunge usual = soft(h, {.radius = kR});
  for (const double rate : {500.0, 4000.0}) {
    const Plunge other = soft(h, {.rate_hz = rate, .radius = kR});
    const std::string which = fmt::format("rate{:.0f}", rate);
    part.near(which + ".volume", 1, other.removed / usual.removed, 0.005, "of that at 1 kHz");
    part.near(which + ".depth", 1, other.depth / usual.depth, 0.005, "of that at 1 kHz");
    part.near(which + ".mean_force", 1, other.mean_force / usual.mean_force, 0.01,
              "of that at 1 kHz");
  }
  const Plunge fine = soft(0.125 * kMm, {.radius = kR});
  part.near("voxel.volume", 1, usual.removed / fine.removed, 0.01, "of that at half the voxel");
  part.near("voxel.force", 1, usual.steady_force / fine.steady_force, 0.02,
            "of that at half the voxel");

  // ---- from the recorded forces: linear in push and speed, inverse to the energy per volume
  const auto share = [&](const WorkSettings& settings, double energy, double target) {
    const Plunge one = plunge(h, settings, energy, target, 0.4);
    double asked = 0;  // mu F w r / u, from the recorded forces
    for (const auto& row : one.rows)
      asked += volume::Tissue{}.cutting_friction * row.push * settings.spindle * settings.radius /
               energy / settings.rate_hz;
    return (one.removed + one.ledger.debt + one.ledger.not_cut) / asked;
  };
  for (const double target : {0.5, 1.0, 2.0})
    part.near(fmt::format("law.push_{}mm", target), 1, share({.radius = kR}, 2e9, target * kMm),
              0.02, "of mu F w r / u");
  for (const double speed : {1000.0, 2000.0, 8000.0})
    part.near(fmt::format("law.speed_{:.0f}", speed), 1,
              share({.radius = kR, .spindle = speed}, 2e9, 1 * kMm), 0.02, "of mu F w r / u");
  for (const double energy : {0.5e9, 1e9, 10e9})
    part.near(fmt::format("law.energy_{}", energy * 1e-9), 1,
              share({.radius = kR}, energy, 1 * kMm), 0.02, "of mu F w r / u");
  {
    WorkSettings weak{.radius = kR};
    weak.removal.max_power = 1;
    const Plunge one = plunge(h, weak, 2e9, 2 * kMm, 0.4);
    double most = 0;
    for (std::size_t n = 1; n < one.rows.size(); ++n)
      most = std::max(most, (one.rows[n].energy - one.rows[n - 1].energy) * weak.rate_hz);
    part.at_most("law.power", 1 + 1e-9, most, "W");
  }
  {
    const Plunge still = plunge(h, {.radius = kR, .spindle = 0}, 2e9, 1 * kMm, 0.2);
    part.at_most("law.no_speed_no_cut", 0, 1e9 * still.really, "mm3");
  }
}

// Can the hand feel how often material is removed? 30 times a second compared with every tick.
void removal_loop(const Verify& verify, VerifyReport::Part& part) {
  const double h = 0.25 * kMm;
  Plot plot{
      "Force in a slot while bone is removed in every tick, and 30 times a second: at 30 Hz "
      "every frame is felt as a blow.",
      2,
      {}};
  const double seconds = verify.quick ? 1.0 : 2.0, feed = 10 * kMm;
  std::array<double, 2> step{}, wave30{}, mean{};
  double at_voxels = 0;
  for (int n = 0; n < 2; ++n) {
    WorkSettings settings{.radius = kR};
    settings.carve_every = n == 0 ? 1 : 33;
    Workbench bench(phantom::slab(), block(h, Vec3(16, 4, 4) * kMm), phantom::bone_that_costs(2e9),
                    settings);
    const double z = kR - 1 * kMm;
    const auto rows =
        bench.work(path_through({{0, {-11 * kMm, 0, kR + 0.5 * kMm}},
                                 {0.3, {-11 * kMm, 0, z}},
                                 {0.5, {-11 * kMm, 0, z}},
                                 {0.5 + seconds, {-11 * kMm + feed * seconds, 0, z}}}),
                   kFirm, true);
    std::vector<double> force;
    Line line{n == 0 ? "every tick" : "30 Hz", {}, {}};
    Vec3 last = Vec3::Zero();
    for (const auto& row : rows) {
      if (row.t > 0.8) {
        step[static_cast<std::size_t>(n)] =
            std::max(step[static_cast<std::size_t>(n)], (row.force - last).norm());
        force.push_back(row.force.norm());
        mean[static_cast<std::size_t>(n)] += row.force.norm();
        line.x.push_back(row.t);
        line.y.push_back(row.force.norm());
      }
      last = row.force;
    }
    mean[static_cast<std::size_t>(n)] /= static_cast<double>(force.size());
    wave30[static_cast<std::size_t>(n)] =
        wave_at(force, 1000, 1000.0 / 33) / mean[static_cast<std::size_t>(n)];
    if (n == 0) at_voxels = wave_at(force, 1000, feed / h) / mean[0];
    Axes spectrum{line.legend + ": spectrum", "frequency [Hz]", "part of the mean force", {{}}};
    for (double f = 5; f < 200; f += 0.5) {
      spectrum.lines[0].x.push_back(f);
      spectrum.lines[0].y.push_back(wave_at(force, 1000, f) / mean[static_cast<std::size_t>(n)]);
    }
    plot.axes.push_back({line.legend, "time [s]", "force [N]", {line}});
    plot.axes.push_back(std::move(spectrum));
  }
  part.plot(std::move(plot));
  part.at_most("step.every_tick", 0.01 * std::max(1.0, mean[0]), step[0], "N");
  part.at_most("spectrum.30Hz", 0.02, wave30[0], "of the mean");
  part.at_most("spectrum.voxel_crossing", 0.02, at_voxels, "of the mean");
  // the baseline must fail as predicted
  part.at_least("step.30Hz_removal", 3 * step[0], step[1], "N");
  part.at_least("spectrum.30Hz_removal", 3 * wave30[0], wave30[1], "of the mean");
}

void cutting(const Verify& verify, VerifyReport::Part& part) {
  holes(verify, part);
  laws(part);
  removal_loop(verify, part);
}

const VerifyPart part{
    30, "cutting", "Cutting",
    "Holes whose volume is known by formula; the same hand motion at other tick rates and in other "
    "voxel sizes; the energy law compared with the forces that were felt; and the effect on the "
    "hand of removal 30 times a second, as in the thesis.",
    cutting};

}  // namespace
}  // namespace burr::app

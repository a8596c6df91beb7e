// burr verify heat - the temperature grid compared with exact solutions of the heat equation.
#include <cmath>
#include <numbers>

#include "burr/phantom/build.h"
#include "burr/thermal/dose.h"
#include "burr/thermal/heat_grid.h"
#include "verify.h"

namespace burr::app {
namespace {

using math::Vec3;
using thermal::HeatGrid;
using thermal::HeatSettings;

constexpr double kPi = std::numbers::pi;

// Bone everywhere in the box and half a metre around it.
std::unique_ptr<volume::Bone> solid(const Vec3& half, double voxel) {
  return phantom::bone_from_distance(phantom::box_grid(-half, half, voxel), {},
                                     phantom::box(Vec3::Constant(0.5)));
}

// A constant half watt in the middle of a large block: T = P / (4 pi k R) when it is steady near
// the source.
void point_source(const Verify& verify, VerifyReport::Part& part) {
  const double cell = 1e-3, half = 20e-3, seconds = verify.quick ? 400 : 1200;
  const HeatSettings settings{.cell = cell, .longest_step = 1};
  const auto bone = solid(Vec3::Constant(half), cell);
  math::Aabb box;
  box.extend(Vec3::Constant(-half + 2 * cell));
  box.extend(Vec3::Constant(half - 2 * cell));
  HeatGrid heat(*bone, box, settings);
  const math::Ijk middle = heat.cell_at(Vec3::Constant(0.1 * cell));
  const Vec3 at = heat.centre(middle);
  constexpr double kEach = 0.5, kWatt = 0.5;
  for (double t = 0; t < seconds; t += kEach) {
    heat.deposit(at, 0, kWatt * kEach);
    heat.advance(kEach);
  }
  const double k = settings.bone.conductivity;
  Line measured{"measured", {}, {}, false, true}, theory{"P / (4 pi k R)", {}, {}, true};
  for (int n = 2; n < 16; ++n) {
    const double r = n * cell;
    const double rise = heat.temperature_c(middle + math::Ijk(n, 0, 0)) - settings.start_c;
    measured.x.push_back(1e3 * r);
    measured.y.push_back(rise);
    theory.x.push_back(1e3 * r);
    theory.y.push_back(kWatt / (4 * kPi * k * r));
  }
  // in the difference of two distances, the effect of the cold walls nearly cancels
  const auto drop = [&](int a, int b) {
    return heat.temperature_c(middle + math::Ijk(a, 0, 0)) -
           heat.temperature_c(middle + math::Ijk(b, 0, 0));
  };
  const double right = kWatt / (4 * kPi * k) * (1 / (5 * cell) - 1 / (10 * cell));
  part.near("point_source.drop_5_to_10mm", right, drop(5, 10), 0.05 * right, "K");
  part.plot(
      {"Half a watt in the middle of a block of 40 mm whose walls stay at 37 degrees: the rise "
       "over the infinite solid's P / (4 pi k R), lower by what the walls take.",
       1,
       {{"point source", "distance [mm]", "rise [K]", {measured, theory}}}});
}

// A heat flux into the end of a long column without losses: 2 q sqrt(t / (pi k rho c)).
void half_space(VerifyReport::Part& part) {
  constexpr double kFlux = 2000, kSeconds = 20, kEach = 0.02;
  const double cell = 1e-3;
  const HeatSettings settings{.cell = cell, .longest_step = kEach};
  const Vec3 half(cell, cell, 15e-3);
  const auto bone = solid(half, cell);
  math::Aabb all;
  all.extend(-half);
  all.extend(half);
  HeatGrid heat(*bone, all, settings);
  for (double t = 0; t < kSeconds - kEach / 2; t += kEach) {
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        heat.deposit({x * cell, y * cell, -half.z() + 0.5 * cell}, 0, kFlux * cell * cell * kEach);
    heat.advance(kEach);
  }
  const math::Ijk end = heat.cell_at({0.5 * cell, 0.5 * cell, -half.z() + 0.5 * cell});
  const double k = settings.bone.conductivity;
  const double right = 2 * kFlux * std::sqrt(kSeconds / (kPi * k * settings.bone.capacity()));
  const double seen = heat.temperature_c(end) - settings.start_c + kFlux * cell / 2 / k;
  part.near("half_space", right, seen, 0.03 * right, "K");
}

void heat(const Verify& verify, VerifyReport::Part& part) {
  point_source(verify, part);
  half_space(part);
  part.near("cem43.47C_60s", 16, thermal::cem43_rate(47), 1e-9, "min");
  part.near("cem43.50C_30s", 64, 0.5 * thermal::cem43_rate(50), 1e-9, "min");
  part.cannot(
      "that a real burr warms bone by this much; the constants are the middle of the published "
      "ranges");
}

const VerifyPart part{
    65, "heat", "Heat",
    "The coarse grid of temperatures against a point source and a half-space under "
    "constant flux (Carslaw and Jaeger), and the dose CEM43 (Sapareto and Dewey 1984) "
    "at the thresholds quoted for bone.",
    heat};

}  // namespace
}  // namespace burr::app

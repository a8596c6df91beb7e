// thermal/heat_settings.h - how bone warms up: its constants, where the heat goes, and the resolution of
// the computation.
//
// Units: SI; names of temperatures in degrees Celsius end in `_c`. All values are defaults to be
// calibrated: measured values of bone differ by a factor of two.
#pragma once

#include <vector>

#include "burr/volume/tissue.h"

namespace burr::thermal {

struct Material {
  double conductivity = 0.55;                                                     // k    [W/(m K)]
  double density = 1950;                                                          // rho  [kg/m^3]
  double specific_heat = 1260;                                                    // c    [J/(kg K)]
  [[nodiscard]] double capacity() const { return density * specific_heat; }       // [J/(m^3 K)]
  [[nodiscard]] double diffusivity() const { return conductivity / capacity(); }  // [m^2/s]
};

struct TissueMaterial {
  volume::TissueId tissue = 0;
  Material material;
};

// Share of a burr's power that stays in the bone; the rest leaves with chips, mist and burr.
struct HeatShare {
  double flute = 0.25;   // chips carry most of it away: 0.1 .. 0.4                    [-]
  double diamond = 0.5;  // fine dust carries less                                     [-]
  double rubbing = 0.5;  // nothing is removed; the other half goes into the burr      [-]
};

struct HeatSettings {
  // k: 0.55 +- 0.02 bovine cortical (Lee et al. 2018), 0.3 fresh human femur, 0.8 saturated equine;
  // rho 1900-2000, c 1100-1400: together alpha = 2.2e-7 m^2/s
  Material bone = {};
  // nerve, dura, marrow: mostly water (magnitudes of the IT'IS tissue tables)
  Material soft = {.conductivity = 0.5, .density = 1050, .specific_heat = 3600};
  std::vector<TissueMaterial> special = {};  // tissues that differ from both

  double start_c = 37;  // of all bone at the start; beyond the box at all times         [deg C]

  // The coolant wets the surface that is open to the air around the burr. Dry air takes 5-25 W/(m^2
  // K), a hundredth of that: neglected.
  double coolant_c = 22;       // saline at room temperature, 20 .. 26                   [deg C]
  double coolant_film = 2000;  // h_c of a film of running water, 1000 .. 5000    [W/(m^2 K)]
  double wet_radius = 8e-3;    // of the ball that is wetted                             [m]

  HeatShare heat_share = {};
  double heat_ball_ratio = 0.5;  // heated ball's radius over the burr's; at least one cell  [-]

  double cell = 1e-3;          // longest edge of a cell: a power of two of voxels below it    [m]
  double longest_step = 0.05;  // largest time step, if stability allows more            [s]
  double warm_c = 47;  // bone above it counts as warm (Eriksson & Albrektsson 1983)     [deg C]
};

}  // namespace burr::thermal

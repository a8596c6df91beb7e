// thermal/settings.h - how bone warms: its constants, where the heat goes, how finely it is
// counted.
//
// Units: SI; temperatures in degrees Celsius say so by `_c`. All are defaults to calibrate:
// measured values of bone scatter by a factor of two.
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

// A burr's share of its power that stays in the bone; the rest leaves with chips, mist and burr.
struct StayingShare {
  double flute = 0.25;   // chips carry most away: 0.1 .. 0.4                          [-]
  double diamond = 0.5;  // fine dust carries less                                     [-]
  double rubbing = 0.5;  // nothing is removed; the burr takes the other half          [-]
};

struct HeatSettings {
  // k 0.55 +- 0.02 bovine cortical (Lee et al. 2018), 0.3 fresh human femur, 0.8 saturated equine;
  // rho 1900-2000, c 1100-1400: together alpha = 2.2e-7 m^2/s
  Material bone = {};
  // nerve, dura, marrow: mostly water (the order of the IT'IS tissue tables)
  Material soft = {.conductivity = 0.5, .density = 1050, .specific_heat = 3600};
  std::vector<TissueMaterial> special = {};  // tissues that differ from both

  double start_c = 37;  // of all bone at the start, and beyond the box for ever         [deg C]

  // The coolant wets what lies open to the air around the burr. Dry air takes 5-25 W/(m^2 K), a
  // hundredth of that: counted as nothing.
  double coolant_c = 22;       // saline from the room, 20 .. 26                         [deg C]
  double coolant_film = 2000;  // h_c of a film of running water, 1000 .. 5000    [W/(m^2 K)]
  double wet_radius = 8e-3;    // of the ball that is wetted                             [m]

  StayingShare stays = {};
  double spread = 0.5;  // heated ball over the burr's radius; at least one cell         [-]

  double cell = 1e-3;          // edge of a cell at most: the power of two of voxels below it  [m]
  double longest_step = 0.05;  // of time, where stability would allow more              [s]
  double warm_c = 47;  // bone above it counts as warm (Eriksson & Albrektsson 1983)     [deg C]
};

}  // namespace burr::thermal

// thermal/heat_summary.h - how warm it is and was, in few numbers: per tissue, and where the heat went.
//
//     spent = chips + missed + into           chips: the part that did not stay in the bone
//     into  = stored + convected + conducted + removed      up to rounding of a double
//
// Energies are counted from the starting temperature: bone that is cut while cooler than that takes
// a negative amount with it. Plain values, to be copied through rt::Latest.
#pragma once

#include <array>
#include <cstdint>

#include "burr/math/vec3.h"
#include "burr/volume/tissue.h"

namespace burr::thermal {

// All in J.
struct HeatLedger {
  double spent = 0;      // by the burr
  double missed = 0;     // deposited where there was no bone, or outside the box
  double into = 0;       // put into the bone
  double stored = 0;     // still there
  double convected = 0;  // to the coolant
  double conducted = 0;  // out of the box, into the bone around it
  double removed = 0;    // left with bone that was cut
};

// One tissue, over all cells that hold some of it.
struct TissueHeat {
  bool there = false;    // the tissue exists, or existed
  double now_c = 0;      // warmest                                     [deg C]
  double ever_c = 0;     // warmest ever, including what was cut [deg C]
  double cem43_min = 0;  // largest dose, including what was cut [min]
  double warm_m3 = 0;    // now above HeatSettings::warm_c              [m^3]
};

struct HeatSummary {
  std::int64_t time_ns = 0;                 // of the servo's rows
  std::uint64_t rows = 0;                   // processed so far
  double hottest_c = 0;                     // of all cells at present [deg C]
  math::Vec3 hottest = math::Vec3::Zero();  // centre of that cell, world [m]
  HeatLedger ledger;
  std::array<TissueHeat, 256> tissue;  // by TissueId; [0] stays empty
};

}  // namespace burr::thermal

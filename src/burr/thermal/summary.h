// thermal/summary.h - how warm it is and was, said in few numbers: per tissue, and where the heat
// went.
//
//     spent = chips + missed + into           chips: what did not stay
//     into  = stored + convected + conducted + removed      to rounding of a double
//
// Energies are counted from the starting temperature: bone cut while cooler than at the start takes
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
  double missed = 0;     // meant for bone where there was none, or outside the box
  double into = 0;       // put into the bone
  double stored = 0;     // still there
  double convected = 0;  // to the coolant
  double conducted = 0;  // out of the box, into the bone around it
  double removed = 0;    // went with bone that was cut
};

// Of one tissue, over the cells that hold some of it.
struct TissueHeat {
  bool there = false;    // there is some, or was
  double now_c = 0;      // warmest                                     [deg C]
  double ever_c = 0;     // warmest ever, of what was cut meanwhile too [deg C]
  double cem43_min = 0;  // largest dose, of what was cut meanwhile too [min]
  double warm_m3 = 0;    // now above HeatSettings::warm_c              [m^3]
};

struct HeatSummary {
  std::int64_t time_ns = 0;                 // of the servo's rows
  std::uint64_t rows = 0;                   // worked on so far
  double hottest_c = 0;                     // of all cells now  [deg C]
  math::Vec3 hottest = math::Vec3::Zero();  // its centre, world  [m]
  HeatLedger ledger;
  std::array<TissueHeat, 256> tissue;  // by TissueId; [0] stays empty
};

}  // namespace burr::thermal

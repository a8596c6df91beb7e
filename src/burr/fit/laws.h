// fit/laws.h - estimates the constants of the cutting laws from a force log, with 95 % intervals.
//
//     level 1   F_t = mu_c F_n                 P = u MRR
//     level 2   F_t = K_tc A + K_te L          F_n = K_rc A + K_re L         A = MRR / v
//
// F_t, F_n: tangential and normal force; P: power into the bone, or F_t v; v: speed of the teeth;
// MRR: volume removed per second; A: chip area; L: engaged length of edge. Units: SI. Thread: any.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/fit/force_log.h"

namespace burr::fit {

struct Fitted {
  const char* key;     // as in a table of materials: "cutting_energy_J_mm3"
  double value, half;  // SI; value +- half is the 95 % interval
  std::size_t rows;    // used for it
  double residual;     // standard deviation around the law, in residual_unit
  const char* residual_unit;
};

struct MaterialFit {
  std::string material;                // "": the log does not name it
  std::size_t rows = 0, left_out = 0;  // left out: rows in which nothing was cut
  std::vector<Fitted> constants;
  // a sentence for each constant (or two) that was not found
  std::vector<std::string> undetermined;
};

// Below this force nothing is cut.  [N]
inline constexpr double kLeastPush = 0.05;

// One fit for each material of the log.
[[nodiscard]] std::vector<MaterialFit> fit_laws(const ForceLog& log);

}  // namespace burr::fit

// fit/force_log.h - measurements made while milling, one row per moment: forces, speed, removal.
// From CSV (docs/use/fit.md) or from burr's recordings (fit/recorded_log.h).
//
//     Result<ForceLog> log = fit::read_force_log("bench.csv");
//
// Units: SI inside; the file's columns have their units in their names. Thread: any.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::fit {

struct ForceRow {
  double time = 0;     // [s]
  double normal = 0;   // force of the burr on the bone, along the contact normal   [N]
  double speed = 0;    // of the burr                                              [rad/s]
  double radius = 0;   // effective: distance of the cutting teeth from the axis   [m]
  double removal = 0;  // volume removed per second                                [m^3/s]
  std::optional<double> tangential;  // force along the motion of the teeth        [N]
  std::optional<double> power;       // that goes into the bone                    [W]
  std::optional<double> edge;        // mean engaged length of cutting edge        [m]
  std::size_t material = 0;          // in ForceLog::materials
};

struct ForceLog {
  std::vector<std::string> materials;  // "": the log does not name it
  std::vector<ForceRow> rows;
  std::vector<std::string> notices;

  // Index of the material in `materials`; adds it if it is new.
  [[nodiscard]] std::size_t material(std::string_view name);
  // Appends the rows of the other log.
  void append(const ForceLog& other);
};

[[nodiscard]] Result<ForceLog> read_force_log(const std::string& path);
// file: name of the file in error messages
[[nodiscard]] Result<ForceLog> parse_force_log(std::string_view text, std::string_view file);

}  // namespace burr::fit

// fit/force_log.h - what was measured while something was milled, one row a moment: forces, speed,
// removal. From CSV (docs/fit.md) or from our own recordings (fit/recorded_log.h).
//
//     Result<ForceLog> log = fit::read_force_log("bench.csv");
//
// Units: SI inside; the columns of the file carry theirs. Thread: any.
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
  double radius = 0;   // effective: of the teeth that cut, about the burr's axis  [m]
  double removal = 0;  // volume removed a second                                  [m^3/s]
  std::optional<double> tangential;  // force along the teeth's way                [N]
  std::optional<double> power;       // that goes into the bone                    [W]
  std::optional<double> edge;        // mean engaged length of cutting edge        [m]
  std::size_t material = 0;          // in ForceLog::materials
};

struct ForceLog {
  std::vector<std::string> materials;  // "": the log does not say
  std::vector<ForceRow> rows;
  std::vector<std::string> notices;

  // The material's place in `materials`, made where it is new.
  [[nodiscard]] std::size_t material(std::string_view name);
  // The other log's rows after ours.
  void append(const ForceLog& other);
};

[[nodiscard]] Result<ForceLog> read_force_log(const std::string& path);
// `file`: the name for the error's sentence
[[nodiscard]] Result<ForceLog> parse_force_log(std::string_view text, std::string_view file);

}  // namespace burr::fit

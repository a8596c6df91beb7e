// apps/burr/commands/summary.h - the result of a session on one page: pictures, figures, no names.
//
// Plain data in, a folder of files out. Contains no patient name, id, date or path: `what` is the
// program's own name for the bone ("temporal-bone", "NIfTI scan"), never a file's name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"

namespace burr::app {

using workshop::losses;
using workshop::TissueLoss;

struct Summary {
  std::string what;  // the bone, in the program's words
  math::Ijk size = {0, 0, 0};
  double voxel = 0;        // [m]
  double burr_radius = 0;  // [m]
  double rpm = 0;
  std::string task;    // lines: what was to be done; empty: no case
  std::string hand;    // "simulated hand, pocket", "mouse"
  double seconds = 0;  // of simulated time
  double rate_hz = 0;
  std::uint64_t ticks = 0;
  bool realtime = false;
  double removed = 0, asked = 0, not_cut = 0, added = 0;  // [m^3]
  double peak_force = 0, mean_force = 0;                  // [N]
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  std::uint64_t late = 0, missed = 0;
  std::string flags;  // as text; empty: none
  std::uint64_t bone_hash = 0;
  std::vector<TissueLoss> tissues;                            // only those that changed
  std::vector<std::pair<std::string, std::string>> pictures;  // file in the page's folder, caption
  std::string recording;                                      // file in the page's folder, or empty
};

// folder/summary.html
[[nodiscard]] Status write_summary(const Summary& summary, const std::filesystem::path& folder);

// One page of plain text with the same figures, for a terminal.
[[nodiscard]] std::string summary_text(const Summary& summary);

}  // namespace burr::app

// thermal/heating.h - from the servo's rows to temperatures, in steps of simulated time.
//
//     thermal::Heating heating(*bone, work, {});
//     for (const HeatRow& row : rows)
//       if (heating.take(row)) show(heating.summary());
//
// What comes out depends on the rows and on the bone as it is when they are worked on, never on how
// fast that happens: same rows, same bits, here or in worker.h, as long as the bone is cut at the
// same rows. Thread: any one, never the servo's.
#pragma once

#include <cstdint>

#include "burr/thermal/heat_grid.h"
#include "burr/thermal/rows.h"
#include "burr/thermal/settings.h"
#include "burr/thermal/summary.h"

namespace burr::thermal {

inline constexpr std::int64_t kHeatStepNs = 50'000'000;  // rows within it heat at its beginning
inline constexpr int kStepsPerSummary = 2;               // ten summaries a second
// A row later than this after the one before: the session slept, or the row is wrong. Only so much
// time passes for the bone, so that a wrong number is not worked on for hours.
inline constexpr std::int64_t kLongestGapNs = 60'000'000'000;

class Heating {
 public:
  // Before the session: adds a watcher to the bone. work: world  [m]
  Heating(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings);

  // True: there is a newer summary.
  bool take(const HeatRow& row);

  // As of the last full tenth of a second.
  [[nodiscard]] const HeatSummary& summary() const { return summary_; }
  // Makes it as of now.
  const HeatSummary& sum_up();
  [[nodiscard]] HeatGrid& grid() { return grid_; }

 private:
  void start_over(std::int64_t time_ns);
  [[nodiscard]] bool pass(std::int64_t time_ns);

  HeatSettings settings_;
  HeatGrid grid_;
  bool begun_ = false;
  std::int64_t now_ns_ = 0;   // all before it is done
  std::int64_t skip_ns_ = 0;  // of the rows' time, not passed for the bone
  int steps_ = 0;             // since the last summary
  double spent_ = 0;          // [J]
  std::uint64_t rows_ = 0;
  HeatSummary summary_;
};

}  // namespace burr::thermal

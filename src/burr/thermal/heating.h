// thermal/heating.h - computes temperatures from the servo's rows, in steps of simulated time.
//
//     thermal::Heating heating(*bone, work, {});
//     for (const HeatRow& row : rows)
//       if (heating.take(row)) show(heating.summary());
//
// The result depends on the rows and on the bone at the time when they are processed, never on the
// speed of processing: the same rows give the same bits, here or in heat_worker.h, if the bone is cut at
// the same rows. Thread: any one, never the servo's.
#pragma once

#include <cstdint>

#include "burr/thermal/heat_grid.h"
#include "burr/thermal/heat_rows.h"
#include "burr/thermal/heat_settings.h"
#include "burr/thermal/heat_summary.h"

namespace burr::thermal {

inline constexpr std::int64_t kHeatStepNs = 50'000'000;  // rows within a step heat at its beginning
inline constexpr int kStepsPerSummary = 2;               // ten summaries a second
// Longest time between two rows. A longer gap means that the session slept or the row is wrong;
// only this much time then passes for the bone, so that a wrong number does not cost hours of
// computing.
inline constexpr std::int64_t kLongestGapNs = 60'000'000'000;

class Heating {
 public:
  // Construct before the session: adds a watcher to the bone. work: box, world  [m]
  Heating(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings);

  // Processes a row. True: there is a newer summary.
  bool take(const HeatRow& row);

  // The summary of the last full tenth of a second.
  [[nodiscard]] const HeatSummary& summary() const { return summary_; }
  // Computes the summary for the present moment.
  const HeatSummary& sum_up();
  [[nodiscard]] HeatGrid& grid() { return grid_; }

 private:
  void start_over(std::int64_t time_ns);
  [[nodiscard]] bool pass(std::int64_t time_ns);

  HeatSettings settings_;
  HeatGrid grid_;
  bool begun_ = false;
  std::int64_t now_ns_ = 0;   // everything before it is done
  std::int64_t skip_ns_ = 0;  // time of the rows that did not pass for the bone
  int steps_ = 0;             // since the last summary
  double spent_ = 0;          // [J]
  std::uint64_t rows_ = 0;
  HeatSummary summary_;
};

}  // namespace burr::thermal

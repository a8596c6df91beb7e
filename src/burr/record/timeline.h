// record/timeline.h - a whole session on one line: when bone was cut, how hard the hand was pushed,
// what was requested for, and where the work was.
//
//     auto line = timeline_of(**player, progress);        // one pass over all ticks
//     line->force_in(12.0, 12.1)                          // the most of that tenth of a second
//
// Force is kept as the largest of each of a fixed number of parts of the session: a peak of one
// tick is seen however long the session was.
// Thread: one. Memory: fixed, and the strokes and commands.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/record/player.h"
#include "burr/tick/rows.h"
#include "burr/tool/state.h"

namespace burr::record {

// Bone was cut or material added, with pauses shorter than kPause.
struct Stroke {
  double begin_s = 0, end_s = 0;
};

struct TimelineEvent {
  double t_s = 0;
  tick::Command command;
  bool refused = false;  // a change of burr that the servo had no room for
};

// The tool in the hand, from t_s on.
struct TimelineTool {
  double t_s = 0;
  tool::ToolState tool;
};

struct Timeline {
  static constexpr std::size_t kParts = 4096;
  static constexpr double kPause = 0.3;  // within a stroke  [s]

  double seconds = 0;
  std::vector<Stroke> strokes;        // in order, apart by more than kPause
  std::vector<float> force;           // (kParts) the largest of each part  [N]
  std::vector<TimelineEvent> events;  // what people requested, in order
  std::vector<TimelineTool> tools;    // the first tick's, then each change
  double peak_force = 0;              // [N]
  struct Work {
    math::Vec3 at, outward;  // the burr's centre; unit, out of the bone, or along the shaft
  };
  std::optional<Work> work;  // where it first cut; none: it never did

  // the largest force from one moment to another; of the part they lie in if that is longer
  [[nodiscard]] double force_in(double from_s, double to_s) const;
  // the tool at t; before the first tick that one's
  [[nodiscard]] tool::ToolState tool_at(double t_s) const;
  // the stroke at t, or the next one before or after it: its begin; none: there is none
  [[nodiscard]] std::optional<double> stroke_after(double t_s) const;
  [[nodiscard]] std::optional<double> stroke_before(double t_s) const;
};

// Built tick by tick, in order.
class TimelineMaker {
 public:
  TimelineMaker(double rate_hz, std::uint64_t end_tick);
  void add(const Step& step);
  [[nodiscard]] Timeline finish();

 private:
  double rate_hz_;
  std::uint64_t end_tick_;
  Timeline line_;
  std::optional<edit::Ledger> before_;
};

// Error: interrupted.
[[nodiscard]] Result<Timeline> timeline_of(Player& player, Progress& progress);

}  // namespace burr::record

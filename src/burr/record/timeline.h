// record/timeline.h - a summary of a whole session over time: when bone was cut, how large the
// force on the hand was, what was requested, and where the work was.
//
//     auto line = timeline_of(**player, progress);  // one pass over all ticks
//     line->force_in(12.0, 12.1)                    // largest force in that 0.1 s
//
// The session is divided into a fixed number of parts; of each the largest force is kept, so a peak
// of one tick is seen however long the session was.
// Thread: one. Memory: fixed, plus the strokes and commands.
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

// Cutting or adding material, with pauses shorter than kPause.
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
  static constexpr double kPause = 0.3;  // longest pause within a stroke [s]

  double seconds = 0;
  std::vector<Stroke> strokes;        // in order, apart by more than kPause
  std::vector<float> force;           // (kParts) the largest of each part [N]
  std::vector<TimelineEvent> events;  // what users requested, in order
  std::vector<TimelineTool> tools;    // the first tick's, then each change
  double peak_force = 0;              // [N]
  struct Work {
    math::Vec3 at, outward;  // the burr's centre; unit vector out of the bone, or along the shaft
  };
  std::optional<Work> work;  // where it first cut; none: it never cut

  // Largest force between two moments; if they lie in one part, that part's largest force.
  [[nodiscard]] double force_in(double from_s, double to_s) const;
  // The tool at t; before the first tick the tool of the first tick.
  [[nodiscard]] tool::ToolState tool_at(double t_s) const;
  // The beginning of the stroke at t, or of the next one after or before it; none: there is none.
  [[nodiscard]] std::optional<double> stroke_after(double t_s) const;
  [[nodiscard]] std::optional<double> stroke_before(double t_s) const;
};

// Builds a Timeline tick by tick, in order.
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

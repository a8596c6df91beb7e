// tick/shed.h - what the servo puts off when the machine is too slow, in fixed steps; the force on
// the hand is touched last.
//
//     none -> picture -> mesh -> removal in 2, 4, 8 slices -> touch in fewer moves
//
//     ShedGovernor governor(period_ns);
//     each tick:  servo.set_shed(governor.shed());  tick ...;
//                 governor.note(wall_ns, late_ns, missed);
//
// Picture and mesh are drawn and made less often: other threads read Session::shed(). A step that
// changes the tick itself is recorded as a command (tick/rows.h, CommandKind::shed), so that a
// replay does the same without a clock. It goes up within a few hundredths of a second, down one
// step a second at most, and more slowly after a step down that had to be taken back.
// Thread: servo. A pure function of the durations that it is given. Memory: none.
#pragma once

#include <cstdint>

#include "burr/rt/rt.h"

namespace burr::tick {

enum class Shed : std::uint8_t {
  none,
  picture,    // drawn at most ten times a second
  mesh,       // ... and the surface follows the cut more slowly
  removal_2,  // ... and each tick cuts half of the bricks that the burr is in, in turn
  removal_4,  // ... a quarter
  removal_8,  // ... an eighth
  touch,      // ... and the burr may lag behind a fast hand
};
inline constexpr int kShedSteps = 7;

// Number of time slices over which the bricks are cut and their surface is made again.
[[nodiscard]] constexpr int slices_of(Shed shed) BURR_RT {
  return shed >= Shed::removal_8   ? 8
         : shed == Shed::removal_4 ? 4
         : shed == Shed::removal_2 ? 2
                                   : 1;
}

// "nothing", "the picture" ...: what is put off.
[[nodiscard]] const char* name(Shed shed) noexcept;

struct ShedSettings {
  double work_share = 0.6;  // of the period a tick may take, from its begin to its end
  double late_share = 0.5;  // of the period it may begin late
  // The tick has priority over everything else (SCHED_FIFO). Then a late tick is caused by the
  // computer itself, or by the host of a virtual machine, and not by work that could be put off:
  // only the duration of the tick counts.
  bool has_realtime_priority = false;
  double often = 0.25;      // share of the last ticks over either, from which on it is too much
  double seldom = 0.02;     // ... up to which it is not
  double memory = 0.02;     // over how long that share is taken                      [s]
  double calm = 1.0;        // without trouble before a step down                     [s]
  double calm_most = 16.0;  // ... after steps down that had to be taken back         [s]
};

class ShedGovernor {
 public:
  explicit ShedGovernor(std::int64_t period_ns, const ShedSettings& settings = {});

  // One tick took `wall_ns` from begin to end and began `late_ns` after its time; `missed` periods
  // were left out before it.
  void note(std::int64_t wall_ns, std::int64_t late_ns, std::int64_t missed) BURR_RT;

  [[nodiscard]] Shed shed() const BURR_RT { return shed_; }
  [[nodiscard]] Shed most() const BURR_RT { return most_; }  // ever

 private:
  ShedSettings settings_;
  double period_s_;
  Shed shed_ = Shed::none, most_ = Shed::none;
  double share_ = 0;       // of ticks that were over, smoothed
  double heavy_ = 0;       // ... by their own work
  double since_step_ = 0;  // since the last step up or down                         [s]
  double calm_for_ = 0;    // [s]
  double calm_wanted_;     // [s]
  bool stepped_down_ = false;
};

}  // namespace burr::tick

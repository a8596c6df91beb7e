// workshop/sound_tracker.h - turns the rows of a session into the input of the sound synthesis.
//
// A row holds the volume removed since the start. The rate of removal is the difference of two rows
// that are at least 10 ms apart, because single ticks may cut bricks alternately.
// Thread: one. Allocates nothing after construction.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/sound/sound_state.h"
#include "burr/tick/rows.h"
#include "burr/tick/servo.h"
#include "burr/tool/cutter.h"
#include "burr/tool/shaped_tool.h"

namespace burr::workshop {

class SoundTracker {
 public:
  // Distance from a point to the nearest structure to spare  [m]; empty: there is none.
  using ToSpare = std::function<double(const math::Vec3&)>;

  // second: the tool of the other hand; nullptr: none that sounds.
  explicit SoundTracker(const tick::ServoSettings& settings, ToSpare to_spare = {},
                        const tool::ShapedTool* second = nullptr);

  // row: the newest row, or the next one of a recording; rows may be skipped. second: of the other
  // hand, at about the same time. The warning is that of the nearer tool.
  [[nodiscard]] const sound::SoundState& update(const tick::TickRow& row,
                                                const tick::TickRow* second = nullptr);
  // What the other hand's tool sounds like; nullptr: it has none, or there was no row of it.
  [[nodiscard]] const sound::SoundState* second() const {
    return other_ && other_->before_ ? &other_->now_ : nullptr;
  }

 private:
  struct Sums {
    std::uint64_t tick = 0;
    double removed = 0, energy = 0;
  };

  // A tool that is no round burr.
  struct Tool {
    int teeth = 0;
    tool::Drive drive = tool::Drive::turning;
    std::vector<math::Vec3> places;  // on its cutting parts, in its frame [m]
  };
  [[nodiscard]] double distance_of(const tick::TickRow& row, const Tool* tool) const;

  int teeth_ = 0;  // of a cutting burr
  std::vector<Tool> tools_;
  double rate_hz_;
  ToSpare to_spare_;
  std::optional<Sums> before_;
  sound::SoundState now_;
  std::unique_ptr<SoundTracker> other_;  // of the other hand
};

}  // namespace burr::workshop

// workshop/traces.h - what milling left on the bone at a moment of a recording, told as a window
// looking on would have seen it (render/wound.h).
//
//     Traces traces(player);
//     traces.until(t).show(wound);
//
// Thread: the player's.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/record/player.h"
#include "burr/render/wound.h"
#include "burr/tick/rows.h"

namespace burr::workshop {

class Traces {
 public:
  struct StatusLine {
    bool anew = false;  // what was seen before does not count
    std::vector<render::Wound::Tick> ticks;
    void show(render::Wound& wound) const;
  };

  explicit Traces(record::Player& player);

  // All that happened since the moment asked before, up to t [s], which is no earlier.
  [[nodiscard]] StatusLine until(double t);
  // The same for any t: a jump back, or far ahead, is told from a minute before t, in larger steps.
  [[nodiscard]] StatusLine seek(double t);

 private:
  void begin(double t);
  void tell(double t, std::uint64_t every, StatusLine& told);
  [[nodiscard]] double time_of(const tick::TickRow& row) const;

  record::Player& player_;
  record::StepCursor steps_;
  record::Step step_;
  bool ahead_ = false;  // step_ is the next one to be told
  double asked_ = 0;    // [s]
};

}  // namespace burr::workshop

// workshop/traces.h - fresh cuts, water, dust and blood on the bone (render/wound.h) at any moment
// of a recording, as the window showed them during the session.
//
//     Traces traces(player);
//     traces.until(t).show(wound);
//
// Thread: that of the player.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/record/player.h"
#include "burr/render/wound.h"
#include "burr/tick/rows.h"

namespace burr::workshop {

class Traces {
 public:
  // A suction tube in the other hand.
  struct Suction {
    std::size_t after = 0;  // so many of the ticks
    math::Vec3 mouth;
    double radius = 0, seconds = 0;
  };
  struct Changes {
    bool anew = false;  // forget what was shown before
    std::vector<render::Wound::Tick> ticks;
    std::vector<Suction> sucked;  // in order
    struct Beside {
      std::size_t after = 0;  // so many of the ticks
      render::Wound::Tick tick;
    };
    std::vector<Beside> beside;  // a tool that cuts in the other hand; in order
    void append(const Changes& later);
    void show(render::Wound& wound) const;
  };

  explicit Traces(record::Player& player);

  // What happened since the previous call, up to t  [s]; t must not decrease.
  [[nodiscard]] Changes until(double t);
  // The same for any t. After a jump back or far ahead it starts a minute before t, in larger
  // steps.
  [[nodiscard]] Changes seek(double t);

 private:
  void begin(double t);
  void collect(double t, std::uint64_t every, Changes& changes);
  [[nodiscard]] double time_of(const tick::TickRow& row) const;

  record::Player& player_;
  record::StepCursor steps_;
  record::Step step_;
  bool ahead_ = false;  // step_ has not been used yet
  double asked_ = 0;    // time of the previous call  [s]
};

}  // namespace burr::workshop

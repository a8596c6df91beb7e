// workshop/hearing.h - from the rows of a session to what is to be heard of it.
//
// A row says what was removed since the start; how fast is the difference of two, over at least
// 10 ms: in a single tick bricks may be cut in turn.
// Thread: one. Memory: none after it was made.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "burr/math/vec3.h"
#include "burr/sound/heard.h"
#include "burr/tick/rows.h"
#include "burr/tick/servo.h"

namespace burr::workshop {

class Hearing {
 public:
  // From a point to the nearest structure to spare [m]; empty: there is none.
  using ToSpare = std::function<double(const math::Vec3&)>;

  explicit Hearing(const tick::ServoSettings& settings, ToSpare to_spare = {});

  // The newest row, or the next one of a recording; rows may be left out.
  [[nodiscard]] const sound::Heard& hear(const tick::TickRow& row);

 private:
  struct Account {
    std::uint64_t tick = 0;
    double removed = 0, energy = 0;
  };

  int teeth_ = 0;  // of a cutting burr
  double rate_hz_;
  ToSpare to_spare_;
  std::optional<Account> before_;
  sound::Heard now_;
};

}  // namespace burr::workshop

// tick/flag_words.h - the flags of a tick (rt/flags.h) as sentences, for messages and reports.
//
// Thread: any but the servo. Memory: the sentences.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/rt/flags.h"

namespace burr::tick {

// Without the flags that every good session raises: start ramp, waiting for it, slew, guard.
[[nodiscard]] constexpr std::uint32_t worth_telling(std::uint32_t flags) {
  return flags & ~(rt::kFlagRamp | rt::kFlagWaiting | rt::kFlagSlewLimited | rt::kFlagGuarded);
}

// One sentence for each flag that is set; it names the remedy where there is one.
[[nodiscard]] std::vector<std::string> words(std::uint32_t flags);

}  // namespace burr::tick

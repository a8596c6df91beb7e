// scenario/fade.h - the rule by which guidance becomes less from attempt to attempt.
//
//     const auto fade = fade_of("2,alternate:4,off");
//     guided(*fade, 1), (*fade, 2)             true: full guidance in two attempts
//     guided(*fade, 3) ... (*fade, 6)          false, true, false, true: every second one of four
//     guided(*fade, 7)                         false, from here on
//     guided(*fade, 8, true)                   true: two falling marks bring it back for one attempt
//
// Pure functions. Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace burr::scenario {

struct Fade {
  struct Part {
    std::uint32_t attempts = 0;
    bool alternate = false;  // every second attempt is guided, not the first one
  };
  std::vector<Part> parts;
  bool after = false;  // of all later attempts
};

// Numbers of attempts, each at most 1000 and perhaps behind "alternate:", then "on" or "off".
// nullopt: the text is not such a rule.
[[nodiscard]] std::optional<Fade> fade_of(std::string_view text);

// attempt: from 1; 0, an attempt that nobody counts, is guided. marks_fell: the marks of the two
// attempts before this one fell.
[[nodiscard]] bool guided(const Fade& fade, std::uint32_t attempt, bool marks_fell = false);

}  // namespace burr::scenario

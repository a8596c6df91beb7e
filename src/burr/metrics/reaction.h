// metrics/reaction.h - how soon the learner answers a cue that has nothing to do with the operation: a
// measure of the load on the mind. Off unless a session asks: no part of burr shows such cues yet.
//
//     reaction   time from a `question` of /course whose name begins with "cue" to the `answer` to it
//     load       median reaction / the learner's own median at rest - 1
//
// A cue without an answer within 10 s, or before the next cue, was missed. Units: s. Thread: any.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "burr/metrics/measured.h"
#include "burr/record/course.h"

namespace burr::metrics {

inline constexpr double kCueMissed = 10;      // [s]
inline constexpr std::size_t kLeastCues = 5;  // answered

struct Cue {
  double shown = 0;                // [s]
  std::optional<double> answered;  // [s]; none: missed
};
[[nodiscard]] std::vector<Cue> cues_of(std::span<const record::CourseEvent> course, double rate_hz);

struct Reaction {
  std::size_t cues = 0, missed = 0;
  double median = 0;           // of the answered ones [s]
  std::optional<double> load;  // 0.26: a quarter slower than at rest; none: no rest is known
};
// at_rest: the learner's own median without an operation [s]. Not assessable: fewer than kLeastCues answers.
[[nodiscard]] Assessed<Reaction> reaction_of(std::span<const Cue> cues,
                                             std::optional<double> at_rest);

}  // namespace burr::metrics

#include "burr/metrics/reaction.h"

#include <string>

#include "burr/metrics/median.h"

namespace burr::metrics {

std::vector<Cue> cues_of(std::span<const record::CourseEvent> course, double rate_hz) {
  std::vector<Cue> cues;
  std::string open;  // the name of the last cue; empty: answered
  for (const record::CourseEvent& event : course) {
    const double t = static_cast<double>(event.tick) / rate_hz;
    if (event.kind == record::CourseKind::question && event.what.starts_with("cue")) {
      cues.push_back({t, std::nullopt});
      open = event.what;
    }
    if (event.kind != record::CourseKind::answer || open.empty() || event.what != open) continue;
    if (t - cues.back().shown <= kCueMissed) cues.back().answered = t;
    open.clear();
  }
  return cues;
}

Assessed<Reaction> reaction_of(std::span<const Cue> cues, std::optional<double> at_rest) {
  Reaction out;
  out.cues = cues.size();
  std::vector<double> times;
  for (const Cue& cue : cues) {
    if (cue.answered)
      times.push_back(*cue.answered - cue.shown);
    else
      ++out.missed;
  }
  if (times.size() < kLeastCues)
    return NotAssessable{"the recording holds fewer than five answered cues"};
  out.median = median(times);
  if (at_rest && *at_rest > 0) out.load = out.median / *at_rest - 1;
  return out;
}

}  // namespace burr::metrics

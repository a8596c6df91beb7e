#include "burr/report/time_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "burr/record/course.h"
#include "burr/words/words.h"

namespace burr::report {

using words::say;
using words::spoken;
using words::Word;
using words::word;

namespace {

using record::CourseKind;

constexpr std::size_t kParts = 600;

std::optional<ReportLine::Event> event_of(const record::CourseEvent& event, double at_s) {
  switch (event.kind) {
    case CourseKind::warning:
      return ReportLine::Event{at_s, word(Word::report_event_warning), Tone::bad};
    case CourseKind::help_shown:
      return ReportLine::Event{at_s, word(Word::report_event_help), Tone::open};
    case CourseKind::pause:
      return ReportLine::Event{at_s, word(Word::report_event_pause), Tone::none};
    case CourseKind::complication:
      return ReportLine::Event{at_s, word(Word::report_event_complication), Tone::bad};
    case CourseKind::question:
      return ReportLine::Event{at_s, word(Word::report_event_question), Tone::open};
    case CourseKind::continued:
      return ReportLine::Event{at_s, word(Word::report_event_continued), Tone::none};
    case CourseKind::done:
      return ReportLine::Event{at_s, word(Word::report_event_done), Tone::good};
    default:
      return std::nullopt;
  }
}

void add_course(const Scored& scored, ReportLine& line) {
  const record::Player& player = *scored.judged.player;
  std::map<std::string, double, std::less<>> begun;
  const auto end_step = [&](const std::string& id, double end_s) {
    const auto found = begun.find(id);
    const scenario::Step* step = scored.judged.lesson.step(id);
    const std::string title = step != nullptr ? step->title.in(spoken().code) : id;
    line.steps.push_back(
        {found != begun.end() ? found->second : end_s, end_s, title.empty() ? id : title, id});
    if (found != begun.end()) begun.erase(found);
  };
  for (const record::CourseEvent& event : player.course()) {
    const double at_s = static_cast<double>(event.tick) / player.info().rate_hz;
    if (event.kind == CourseKind::step_begun || event.kind == CourseKind::step_reopened)
      begun[event.what] = at_s;
    if (event.kind == CourseKind::step_done) end_step(event.what, at_s);
    if (auto shown = event_of(event, at_s)) {
      shown->kind = record::word_of(event.kind);
      line.events.push_back(std::move(*shown));
    }
  }
  while (!begun.empty()) end_step(std::string(begun.begin()->first), line.seconds);
}

// The nearest first; then those that the burr was never near. What is not known is left out.
std::string nearest_of(const scoring::Shown& shown) {
  std::vector<std::pair<std::string, metrics::Nearness>> known;
  for (const metrics::NearnessOf& one : shown.nearness)
    if (one.found) known.emplace_back(one.name, *one.found);
  std::stable_sort(known.begin(), known.end(),
                   [](const auto& a, const auto& b) { return a.second.least < b.second.least; });
  std::string text, never;
  for (const auto& [name, near] : known) {
    if (1e3 * near.least >= kFarthestMm)
      never += (never.empty() ? "" : ", ") + name;
    else
      text += (text.empty() ? "" : "; ") +
              say(Word::report_nearest_one, name, 1e3 * near.least, near.least_at);
  }
  if (never.empty()) return text;
  return text + (text.empty() ? "" : "; ") + say(Word::report_nearest_never, kFarthestMm, never);
}

}  // namespace

ReportLine time_line_of(const Scored& scored) {
  ReportLine line;
  line.seconds = scored.judged.player->seconds();
  const float none = std::numeric_limits<float>::quiet_NaN();
  line.force_n.assign(kParts, none);
  line.nearest_mm.assign(kParts, none);
  line.diameter_mm.assign(kParts, none);
  line.diamond.assign(kParts, false);
  line.cutting.assign(kParts, false);
  for (const metrics::TrackSample& sample : scored.score.shown.track.samples) {
    const double share = line.seconds > 0 ? sample.t / line.seconds : 0;
    const auto n = std::min(kParts - 1, static_cast<std::size_t>(std::max(0.0, share * kParts)));
    const auto force = static_cast<float>(sample.force);
    const auto near = static_cast<float>(std::min(1e3 * sample.d, kFarthestMm));
    line.force_n[n] = std::isnan(line.force_n[n]) ? force : std::max(line.force_n[n], force);
    line.nearest_mm[n] = std::isnan(line.nearest_mm[n]) ? near : std::min(line.nearest_mm[n], near);
    line.diameter_mm[n] = static_cast<float>(2e3 * sample.radius);
    line.diamond[n] = sample.diamond;
    line.cutting[n] = line.cutting[n] || sample.cutting();
  }
  add_course(scored, line);
  line.nearest = nearest_of(scored.score.shown);
  return line;
}

}  // namespace burr::report

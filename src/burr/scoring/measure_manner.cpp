#include <limits>
#include <string_view>

#include "burr/metrics/process.h"
#include "burr/metrics/stroke_direction.h"
#include "burr/metrics/strokes.h"
#include "burr/metrics/tube_course.h"
#include "burr/scoring/measure.h"

namespace burr::scoring {
namespace {

metrics::Mark at_least(double value, double least) {
  return {value >= least, true, value, least, 0};
}

Outcome strokes(const Item& item, const metrics::Process& process) {
  const double from = item.limit("from_mm");
  const auto far =
      from > 0 ? metrics::figures_of(process.strokes, from, std::numeric_limits<double>::infinity())
               : metrics::figures_of(process.strokes);
  if (!far) return not_assessable(item, far.reason());
  return decided(item, at_least(far->median_length, item.limit("least_mm")),
                 from > 0 ? "median length of a stroke far from what is to be spared"
                          : "median length of a stroke",
                 true);
}

Outcome stroke_direction(const Item& item, const metrics::Process& process,
                         const scenario::CaseLesson& lesson) {
  const auto along = metrics::stroke_direction(
      process.strokes, metrics::Course{lesson.landmark(item.along)->points});
  if (!along) return not_assessable(item, along.reason());
  return decided(item, at_least(along->along_share, item.limit("share")),
                 "share of the strokes near it that run along it", true);
}

Outcome coolant(const Item& item, const metrics::Process& process) {
  if (process.times.cutting <= 0) return not_assessable(item, "nothing was removed");
  return decided(item,
                 at_least(process.times.irrigated / process.times.cutting, item.limit("share")),
                 "share of the cutting time with coolant on", true);
}

metrics::Mark at_most(double value, double most) { return {value <= most, true, value, most, 0}; }

Outcome economy(const Item& item, const Figures& figures) {
  const auto& outside = figures.economy.outside_share;
  if (!outside) return not_assessable(item, outside.reason());
  return decided(item, at_most(*outside, item.limit("share")),
                 "share removed outside of what the steps ask for", false);
}

Outcome shaft(const Item& item, const Figures& figures) {
  if (!figures.shaft) return not_assessable(item, figures.shaft.reason());
  return decided(item, at_most(figures.shaft->seconds, item.limit("most_s")),
                 "time that the shaft rested on bone", false);
}

Outcome dwell(const Item& item, const Figures& figures) {
  if (!figures.dwell) return not_assessable(item, figures.dwell.reason());
  Outcome out = decided(item, at_most(figures.dwell->longest, item.limit("most_s")),
                        "longest stay of a turning burr in one place", false);
  if (figures.dwell->longest > 0) out.place = figures.dwell->place;
  return out;
}

Outcome motor_load(const Item& item, const Figures& figures) {
  if (!figures.motor) return not_assessable(item, figures.motor.reason());
  return decided(item, at_most(figures.motor->slowed / figures.motor->contact, item.limit("share")),
                 "share of the contact with a slowed spindle", false);
}

Outcome reaction(const Item& item, const Figures& figures) {
  if (!figures.reaction) return not_assessable(item, figures.reaction.reason());
  return decided(item, at_most(figures.reaction->median, item.limit("most_s")),
                 "median time to answer a cue", false);
}

}  // namespace

std::optional<Outcome> measure_manner(const Item& item, const metrics::Process& process,
                                      const Figures& figures, const scenario::CaseLesson& lesson) {
  const std::string_view how = item.how->name;
  if (how == "economy") return economy(item, figures);
  if (how == "shaft") return shaft(item, figures);
  if (how == "dwell") return dwell(item, figures);
  if (how == "motor_load") return motor_load(item, figures);
  if (how == "reaction") return reaction(item, figures);
  if (how == "strokes") return strokes(item, process);
  if (how == "stroke_direction") return stroke_direction(item, process, lesson);
  if (how == "coolant") return coolant(item, process);
  return {};
}

}  // namespace burr::scoring

#include <limits>
#include <string_view>

#include "burr/metrics/course.h"
#include "burr/metrics/process.h"
#include "burr/metrics/stroke_direction.h"
#include "burr/metrics/strokes.h"
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
                         const scenario::Lesson& lesson) {
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

}  // namespace

std::optional<Outcome> measure_manner(const Item& item, const metrics::Process& process,
                                      const scenario::Lesson& lesson) {
  const std::string_view how = item.how->name;
  if (how == "strokes") return strokes(item, process);
  if (how == "stroke_direction") return stroke_direction(item, process, lesson);
  if (how == "coolant") return coolant(item, process);
  return {};
}

}  // namespace burr::scoring

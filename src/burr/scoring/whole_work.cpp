#include "burr/scoring/whole_work.h"

#include <fmt/core.h>

#include <algorithm>

#include "burr/base/printable.h"
#include "burr/metrics/filled.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/removed.h"
#include "burr/scoring/reference.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {
namespace {

// The part of which least is done, if that is too little.
NoMark part_not_done(Workpiece& scene, const ReferencePlan& plan) {
  NoMark none;
  const auto look = [&none](const std::string& part, double share) {
    if (share >= metrics::kLeastWork || (none && share >= none.share)) return;
    none = {NoMark::Why::part, part, std::max(0.0, share), 0};
  };
  for (const ReferencePlan::Part& part : plan.remove)
    if (const auto gone = metrics::removed_of(scene.before(), scene.after(), part.region, {}))
      look(part.name, gone->share);
  for (const ReferencePlan::Part& part : plan.fill)
    if (const auto full = metrics::filled_of(scene.before(), scene.after(), part.region, {}))
      look(part.name, full->share);
  return none;
}

// What was added farther than kBeside from the regions to fill [m^3].
double added_elsewhere(Workpiece& scene, const ReferencePlan& plan, double added) {
  if (plan.fill.empty()) return added;
  const auto full =
      metrics::filled_of(scene.before(), scene.after(), all_of(plan.fill), {.grown = kBeside});
  return full ? full->beside : added;
}

}  // namespace

std::string text_of(const NoMark& none) {
  const double most = 100 * kMostElsewhere;
  switch (none.why) {
    case NoMark::Why::none:
      return {};
    case NoMark::Why::part:
      return fmt::format("of the part \"{}\" {:.0f} % is done, less than {:.0f} %",
                         base::printable(none.part), 100 * none.share, 100 * metrics::kLeastWork);
    case NoMark::Why::gone:
      return fmt::format(
          "{:.0f} mm3 of bone are gone elsewhere than planned, {:.0f} % of the planned volume "
          "(most: {:.0f} %)",
          1e9 * none.elsewhere, 100 * none.share, most);
    case NoMark::Why::added:
      return fmt::format(
          "{:.0f} mm3 of bone were added elsewhere than planned, {:.0f} % of the planned volume "
          "(most: {:.0f} %)",
          1e9 * none.elsewhere, 100 * none.share, most);
  }
  return {};
}

NoMark why_no_mark(Workpiece& scene) {
  const auto& reference = scene.lesson().reference;
  if (!reference || reference->remove.empty()) return {};
  const ReferencePlan plan = reference_plan_of(scene);
  const auto gone =
      metrics::removed_of(scene.before(), scene.after(), all_of(plan.remove), {.grown = kBeside});
  if (!gone) return {};
  if (gone->lost > kMostElsewhere * gone->bone)
    return {NoMark::Why::gone, {}, gone->lost / gone->bone, gone->lost};
  const double added = added_elsewhere(scene, plan, gone->added);
  if (added > kMostElsewhere * gone->bone)
    return {NoMark::Why::added, {}, added / gone->bone, added};
  return part_not_done(scene, plan);
}

}  // namespace burr::scoring

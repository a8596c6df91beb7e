#include "burr/scoring/score.h"

#include <fmt/core.h>

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "burr/base/printable.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/solidity.h"
#include "burr/record/course.h"
#include "burr/scoring/measure.h"
#include "burr/scoring/show_regions.h"
#include "burr/scoring/whole_work.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {
namespace {

void read_ending(const record::Player* player, Score& out) {
  const auto ending = player != nullptr ? player->ending() : std::nullopt;
  out.unfinished = ending != record::Ending::declared_done;
  const bool cut_off = player != nullptr && !player->finished();
  out.ending = ending    ? record::word_of(*ending)
               : cut_off ? "cut off"
                         : "the recording does not say how it ended";
}

// An item is earned by the work of its own part, not by that of the case.
void look_at_own_parts(const Rubric& rubric, Workpiece& scene, std::span<Outcome> outcomes) {
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    const Item& item = rubric.items[n];
    Outcome& outcome = outcomes[n];
    if (item.earned_by.empty() || outcome.verdict != Verdict::met) continue;
    const auto& gone = scene.removed(item.earned_by);
    if (!gone || gone->share >= metrics::kLeastWork) continue;
    outcome.verdict = Verdict::unmet;
    outcome.earned = false;
    outcome.reason = fmt::format("only {:.0f} % of \"{}\" is done", 100 * gone->share,
                                 base::printable(item.earned_by));
  }
}

}  // namespace

Result<Score> score(const Rubric& rubric, const scenario::CaseLesson& lesson,
                    const volume::Bone& before, const volume::Bone& after, record::Player* player,
                    Progress& progress) {
  if (!metrics::same_grid(before, after))
    return error("the bone before and the bone after are not the same bone: their grids differ");
  Workpiece scene(before, after, lesson, progress);
  Score out;
  std::optional<RecordingPass> pass;
  if (player != nullptr) {
    pass.emplace(rubric, scene, *player);
    if (scene.stopped()) return error(Trouble::interrupted, "stopped");
    pass->start(progress);
  }
  for (std::size_t n = 0; n < rubric.items.size(); ++n) {
    const Item& item = rubric.items[n];
    progress.report(static_cast<double>(n) / static_cast<double>(rubric.items.size()),
                    "measuring the bone");
    if (progress.cancelled() || scene.stopped()) return error(Trouble::interrupted, "stopped");
    out.outcomes.push_back(pass && needs_recording(item) ? Outcome() : measure_bone(item, scene));
  }
  if (pass) {
    auto process = pass->finish(progress);
    if (!process) return process.error();
    auto recorded = measure_recording(rubric, scene, *player, *std::move(process), out.shown);
    std::size_t next = 0;
    for (std::size_t n = 0; n < rubric.items.size(); ++n)
      if (needs_recording(rubric.items[n])) out.outcomes[n] = std::move(recorded[next++]);
  }
  look_at_own_parts(rubric, scene, out.outcomes);
  apply_requires(rubric, out.outcomes);
  out.product = total_of(rubric, out.outcomes, Part::product);
  out.process = total_of(rubric, out.outcomes, Part::process);
  out.no_mark = why_no_mark(scene);
  if (out.no_mark) out.product.points = out.process.points = std::nullopt;
  out.worked = scene.worked();
  show_regions(rubric, scene, out.shown);
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  read_ending(player, out);
  return out;
}

}  // namespace burr::scoring

#include "burr/scoring/score.h"

#include <cstddef>
#include <optional>
#include <utility>

#include "burr/metrics/solidity.h"
#include "burr/record/course.h"
#include "burr/scoring/measure.h"
#include "burr/scoring/show_regions.h"
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
  apply_requires(rubric, out.outcomes);
  out.product = total_of(rubric, out.outcomes, Part::product);
  out.process = total_of(rubric, out.outcomes, Part::process);
  out.worked = scene.worked();
  show_regions(rubric, scene, out.shown);
  if (scene.stopped()) return error(Trouble::interrupted, "stopped");
  read_ending(player, out);
  return out;
}

}  // namespace burr::scoring

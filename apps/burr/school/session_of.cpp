#include "school/session_of.h"

#include <fmt/format.h>

#include <sys/stat.h>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "burr/base/printable.h"
#include "burr/base/version.h"
#include "burr/record/rename_and_sync.h"
#include "burr/report/self_marks.h"
#include "burr/school/forget.h"
#include "burr/school/statements.h"
#include "burr/school/store.h"
#include "burr/school/uuid.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/workshop/allowed.h"

namespace burr::app {
namespace {

using scoring::Item;
using scoring::Outcome;
using scoring::Part;
using scoring::Verdict;

// rate: ticks a second  [Hz]
std::string evidence_of(const Item& item, const Outcome& outcome, double rate) {
  nlohmann::ordered_json row;
  row["measure"] = item.how->name;
  row["calibrated"] = item.calibrated;
  row["gate"] = item.gate;
  row["borderline"] = outcome.borderline;
  row["earned"] = outcome.earned;
  if (!outcome.reason.empty()) row["reason"] = outcome.reason;
  if (outcome.value) {
    row["what"] = outcome.what;
    row["error"] = outcome.error;
    row["at_least"] = outcome.at_least;
  }
  if (outcome.place) row["place_m"] = {outcome.place->x(), outcome.place->y(), outcome.place->z()};
  if (outcome.tick) {
    row["tick"] = *outcome.tick;
    row["at_s"] = static_cast<double>(*outcome.tick) / rate;
  }
  return row.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

school::ItemRecord item_of(const Item& item, const Outcome& outcome, double rate) {
  school::ItemRecord out;
  out.id = item.id;
  out.result = scoring::word_of(outcome.verdict);
  out.value = outcome.value;
  if (outcome.value) {
    out.threshold = outcome.threshold;
    out.margin =
        outcome.at_least ? *outcome.value - outcome.threshold : outcome.threshold - *outcome.value;
  }
  out.evidence_json = evidence_of(item, outcome, rate);
  return out;
}

school::ScoreRecord score_of(const report::Scored& scored, Part part, const scoring::Total& total) {
  school::ScoreRecord out;
  out.part = scoring::word_of(part);
  out.total = total.points;
  out.assessable_weight = 1 - total.not_assessable;
  out.made_ms = school::now_ms();
  const scoring::Rubric& rubric = scored.judged.rubric;
  for (std::size_t n = 0; n < rubric.items.size(); ++n) {
    const Outcome& outcome = scored.score.outcomes[n];
    if (rubric.items[n].part != part) continue;
    out.items.push_back(item_of(rubric.items[n], outcome, scored.judged.player->info().rate_hz));
    if (rubric.items[n].gate && outcome.verdict == Verdict::unmet && outcome.earned)
      ++out.gates_broken;
  }
  return out;
}

const char* word_of(report::SelfMark mark) {
  switch (mark) {
    case report::SelfMark::met:
      return "met";
    case report::SelfMark::unmet:
      return "unmet";
    case report::SelfMark::unknown:
      break;
  }
  return "unknown";
}

// Help takes part in these modes as long as the case's rule lets it.
bool guided(const record::Identity& identity, const scenario::CaseLesson& lesson) {
  const bool helps =
      identity.mode == record::Mode::learn || identity.mode == record::Mode::practise;
  return helps && workshop::guided_in(identity, lesson.feedback);
}

// When the file was written last, which is when the session ended.
std::int64_t ended_ms(const std::string& file) {
  struct stat about = {};
  if (::stat(file.c_str(), &about) != 0) return school::now_ms();
  return std::int64_t{1000} * about.st_mtim.tv_sec + about.st_mtim.tv_nsec / 1'000'000;
}

std::string shown(const std::string& recording) {
  return base::printable(std::filesystem::path(recording).filename().string());
}

// Simulates the session again. True: all of it is the same. False: that cannot be told here, because ticks are missing,
// a law of one's own took part, or another build recorded it and comes out differently. Error: it is not what happened.
Result<bool> replayed(record::Player& player, std::unique_ptr<volume::Bone> bone,
                      Progress& progress) {
  const record::SessionInfo& info = player.info();
  if (!sim::check_law(info, nullptr, player.path())) return false;
  const auto outcome = sim::replay(player, std::move(bone), progress);
  if (!outcome) return outcome.error();
  if (outcome->gaps > 0) return false;
  if (!outcome->first_different_tick) return true;
  if (info.build != base::build() || info.burr_version != base::version()) return false;
  return error(
      fmt::format("{}: comes out differently at tick {} ({}), so it is not what happened, and "
                  "is not entered; use the original file",
                  shown(player.path()), *outcome->first_different_tick, outcome->difference));
}

}  // namespace

school::SessionRecord record_of(const report::Scored& scored) {
  const record::Player& player = *scored.judged.player;
  const record::SessionInfo& info = player.info();
  const scoring::Rubric& rubric = scored.judged.rubric;
  school::SessionRecord out;
  const scenario::Case& work = scored.judged.work;
  out.work_case = {record::hex(scenario::text_hash(work.text)), work.name, work.text,
                   scored.judged.lesson.format, 0};
  if (info.work_case) out.work_case.hash = record::hex(info.work_case->text_hash);
  out.rubric = {record::hex(rubric.text_hash), rubric.name, rubric.text, rubric.version,
                std::count_if(rubric.items.begin(), rubric.items.end(),
                              [](const Item& item) { return item.calibrated; })};
  out.scored_by = base::version();
  out.seconds = player.seconds();
  const record::Identity identity = info.identity.value_or(record::Identity());
  out.learner = identity.learner;
  out.mode = record::word_of(identity.mode);
  out.guided = guided(identity, scored.judged.lesson);
  out.finished = !scored.score.unfinished;
  out.attempt = identity.attempt;
  if (const auto device = info.words.find("device"); device != info.words.end())
    out.device = device->second;
  if (const auto most = info.numbers.find("device_peak_force_n"); most != info.numbers.end())
    out.device_max_n = most->second;
  out.voxel_um = 1e6 * info.volume.grid.voxel;
  out.engine = info.burr_version;
  for (const record::SessionInfo& part : player.continued())
    if (!part.goes_on_with.empty()) out.goes_on_with.push_back(part.goes_on_with);
  for (const auto& [part, total] : {std::pair{Part::product, &scored.score.product},
                                    std::pair{Part::process, &scored.score.process}})
    if (total->items > 0) out.scores.push_back(score_of(scored, part, *total));
  out.metrics.push_back({"removed_share_of_target", "1", scored.score.worked});
  out.metrics.push_back({"moved_pieces", "1", static_cast<double>(scored.pieces.size())});
  const auto& steps = scored.judged.lesson.steps;
  for (const scoring::DoneStep& done : scored.score.shown.steps)
    if (done.number > 0 && done.number <= steps.size())
      out.metrics.push_back(
          {std::string(school::kStepDone) + steps[done.number - 1].id, "s", done.t});
  for (const auto& [item, mark] : report::recorded_self_marks(player, rubric))
    out.self_marks.push_back({item, word_of(mark)});
  return out;
}

Result<school::SessionRecord> session_of(const std::string& recording, const std::string& learner,
                                         const std::string& rubric,
                                         const scenario::BoneRecipe& volume, Progress& progress) {
  const std::string name = shown(recording);
  if (record::being_written(recording))
    return error(Trouble::interrupted,
                 fmt::format("{}: this session still goes on; enter it afterwards", name));
  auto judged = report::judged_by(recording, rubric);
  if (!judged) return judged.error();
  const auto& identity = judged->player->info().identity;
  const std::string said = identity ? identity->learner : std::string();
  if (said.empty() && learner.empty())
    return error(Trouble::usage, fmt::format("{}: the recording does not say whose it is", name));
  if (!said.empty() && !learner.empty() && said != learner)
    return error(Trouble::usage,
                 fmt::format("{}: the recording says that it is {}'s, not {}'s", name,
                             base::printable(said), base::printable(learner)));
  auto seal = school::seal_of(recording, judged->player->info());
  if (!seal) return seal.error();
  auto made = report::scored(std::move(*judged), volume, progress);
  if (!made) return made.error();
  school::SessionRecord record = record_of(*made);
  record.learner = said.empty() ? learner : said;
  const auto hash = school::sha1_of_file(recording);
  if (!hash) return hash.error();
  record.recording_hash = *hash;
  record.recording_uri = school::uri_of(recording);
  record.started_ms = ended_ms(recording) - static_cast<std::int64_t>(1000 * record.seconds);
  record.seal = std::move(*seal);
  const auto same = replayed(*made->judged.player, std::move(made->before), progress);
  if (!same) return same.error();
  record.replayed = *same;
  // what the ticks say at the end
  if (const auto last = made->judged.player->tick_at(record.seconds); last) {
    record.metrics.push_back(
        {"removed", "mm^3", 1e9 * (last->ledger.removed - last->ledger.undone)});
    record.metrics.push_back({"added", "mm^3", 1e9 * last->ledger.added});
  }
  return record;
}

}  // namespace burr::app

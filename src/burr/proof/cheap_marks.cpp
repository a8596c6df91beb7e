#include "burr/proof/cheap_marks.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>

#include "burr/base/printable.h"
#include "burr/proof/scripted_session.h"
#include "burr/proof/tricks.h"
#include "burr/report/scored.h"
#include "burr/workshop/prepare.h"

namespace burr::proof {
namespace {

namespace fs = std::filesystem;

// A folder for recordings, gone with its content at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code nobody_asks;
    std::string name = (fs::temp_directory_path(nobody_asks) / "burr_tricks_XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~ScratchFolder() {
    std::error_code nobody_asks;
    if (!folder_.empty()) fs::remove_all(folder_, nobody_asks);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return folder_; }

 private:
  fs::path folder_;
};

PartMark mark_of_total(const scoring::Total& total) {
  return {static_cast<double>(total.met), static_cast<double>(total.assessable), total.points};
}

CheapMark mark_of_trick(const Tried& tried) {
  CheapMark mark;
  mark.name = tried.name;
  mark.how = tried.how;
  mark.product = mark_of_total(tried.product);
  mark.no_mark = scoring::text_of(tried.no_mark);
  for (const scoring::Outcome& one : tried.outcomes)
    if (one.verdict == scoring::Verdict::met) mark.earned.push_back(one.id);
  return mark;
}

struct Sessions {
  const std::string& rubric;
  const scenario::Case& work;
  const scenario::BoneRecipe& recipe;
  const fs::path& folder;

  [[nodiscard]] Result<CheapMark> mark(const std::string& name, const std::string& how,
                                       const ScriptedSession& session, Progress& progress) const {
    const std::string file = (folder / "session.mcap").string();
    if (const Status made = record_scripted(work, recipe, session, file, progress); !made)
      return made.error();
    auto judged = report::judged_by(file, rubric);
    if (!judged) return judged.error();
    const auto scored = report::scored(std::move(*judged), {}, progress);
    if (!scored) return scored.error();
    const auto part = [&scored](scoring::Part of) {
      return mark_of_total(scoring::total_of(scored->judged.rubric, scored->score.outcomes, of));
    };
    CheapMark mark;
    mark.name = name;
    mark.how = how;
    mark.product = part(scoring::Part::product);
    mark.process = part(scoring::Part::process);
    mark.no_mark = scoring::text_of(scored->score.no_mark);
    for (const scoring::Outcome& one : scored->score.outcomes)
      if (one.verdict == scoring::Verdict::met) mark.earned.push_back(one.id);
    std::error_code nobody_asks;
    fs::remove(file, nobody_asks);
    return mark;
  }
};

struct EarlyEnd {
  const char *name, *how;
  bool works;
  double seconds;
};
constexpr EarlyEnd kEarly[] = {
    {"rests for 30 s", "the hand rests beside the bone, and the work is declared done", false, 30},
    {"leaves after 15 s", "an expert declares the work done after 15 s", true, 15},
    {"leaves after 60 s", "an expert declares the work done after 60 s", true, 60},
};

void add(PartMark& sum, const PartMark& one, double share) {
  sum.met += share * one.met;
  sum.items += share * one.items;
  sum.points =
      one.points && sum.points ? std::optional(*sum.points + share * *one.points) : std::nullopt;
}

// The mean of careless surgeons.
Result<CheapMark> careless_mark(const Sessions& sessions, const CheapSettings& settings,
                                Progress& progress) {
  CheapMark mean;
  mean.name = "careless surgeons";
  mean.product.points = 0;
  mean.process = mean.product;
  for (int n = 0; n < settings.careless; ++n) {
    const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(n);
    ScriptedSession session;
    session.skill = surgeon::drawn(surgeon::skill_of(surgeon::Level::careless), seed);
    session.seed = seed;
    const auto one = sessions.mark("", "", session, progress);
    if (!one) return one.error();
    add(mean.product, one->product, 1.0 / settings.careless);
    add(*mean.process, *one->process, 1.0 / settings.careless);
  }
  return mean;
}

bool reaches(const PartMark& trick, const PartMark& careless) {
  if (careless.share() > 0 && trick.share() >= careless.share()) return true;
  return trick.points && careless.points && *careless.points > 0 &&
         *trick.points >= *careless.points;
}

// What tells that a scripted surgeon has no way to do the case, from any other trouble.
bool cannot_be_done(const Error& trouble) { return trouble.trouble == Trouble::data; }

void compare(CheapMarks& marks) {
  for (CheapMark& one : marks.tricks)
    one.beats =
        marks.careless && one.no_mark.empty() &&
        (reaches(one.product, marks.careless->product) ||
         (one.process && one.process->met > 0 && reaches(*one.process, *marks.careless->process)));
  std::stable_sort(
      marks.tricks.begin(), marks.tricks.end(), [](const CheapMark& a, const CheapMark& b) {
        return std::tuple(a.no_mark.empty(), a.product.points.value_or(0), a.product.share()) >
               std::tuple(b.no_mark.empty(), b.product.points.value_or(0), b.product.share());
      });
}

}  // namespace

Result<CheapMarks> cheap_marks(const std::string& rubric_place, const scenario::Case& work,
                               const scenario::BoneRecipe& recipe, const CheapSettings& settings,
                               Progress& progress) {
  const auto rubric = scoring::read_rubric(rubric_place);
  if (!rubric) return rubric.error();
  const auto lesson = report::lesson_for(work, *rubric);
  if (!lesson) return lesson.error();
  if (!lesson->reference || lesson->reference->remove.empty())
    return error(Trouble::data,
                 fmt::format("{}: the case \"{}\" has no [reference] with regions to remove, from "
                             "which cheap ways to a mark are made; add it to the case",
                             rubric->file, base::printable(work.name)));
  const scenario::BoneRecipe whole = workshop::recipe_of(work, recipe);
  const auto tried =
      try_tricks(*rubric, *lesson, whole, 2 * work.burr.radius, settings.seed, progress);
  if (!tried) return tried.error();
  CheapMarks marks;
  for (const Tried& one : *tried) marks.tricks.push_back(mark_of_trick(one));
  const ScratchFolder scratch;
  if (scratch.path().empty())
    return error(Trouble::io, fmt::format("{}: no folder can be made there; set TMPDIR to a "
                                          "folder in which you may write",
                                          fs::temp_directory_path().string()));
  const Sessions sessions{rubric_place, work, recipe, scratch.path()};
  auto careless = careless_mark(sessions, settings, progress);
  if (!careless && !cannot_be_done(careless.error())) return careless.error();
  marks.sessions = careless ? settings.careless : 0;
  if (!careless) marks.why_none = careless.error().text;
  if (careless) marks.careless = std::move(*careless);
  for (const EarlyEnd& early : kEarly) {
    if (early.works && !marks.careless) continue;
    ScriptedSession session;
    session.seed = settings.seed;
    session.seconds = early.seconds;
    session.leaves = true;
    if (early.works) session.skill = surgeon::skill_of(surgeon::Level::expert);
    auto mark = sessions.mark(early.name, early.how, session, progress);
    if (!mark) return mark.error();
    marks.tricks.push_back(std::move(*mark));
  }
  compare(marks);
  return marks;
}

}  // namespace burr::proof

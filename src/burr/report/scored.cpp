#include "burr/report/scored.h"

#include <fmt/core.h>

#include <utility>

#include "burr/base/printable.h"
#include "burr/record/chain.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"

namespace burr::report {
namespace {

// The case of the recording; without one, the case of the rubric.
Result<scenario::Case> case_of(const record::Player& player, const std::string& rubric) {
  if (player.info().work_case) return record::case_of(player.info());
  if (rubric.empty())
    return error(Trouble::usage, "the recording names no case; name one as `rubric`");
  const auto read = scoring::read_rubric(rubric);
  if (!read) return read.error();
  return scenario::read_case(read->case_source);
}

Status is_for(const scoring::Rubric& rubric, const scenario::Case& work, const char* whose) {
  if (rubric.case_name == work.name) return fine();
  return error(Trouble::usage,
               fmt::format("{} is a rubric for the case \"{}\", but {} \"{}\"", rubric.file,
                           base::printable(rubric.case_name), whose, base::printable(work.name)));
}

}  // namespace

Status rubric_fits(const scenario::Case& work) {
  if (work.rubric.empty() || work.rubric == scenario::kOwnFile) return fine();
  const auto rubric = scoring::read_rubric(work.rubric);
  if (!rubric) return rubric.error();
  if (const Status same = is_for(*rubric, work, "the case that names it is"); !same) return same;
  const auto lesson = lesson_for(work, *rubric);
  return lesson ? fine() : lesson.error();
}

Result<scenario::CaseLesson> lesson_for(const scenario::Case& work, const scoring::Rubric& rubric) {
  auto lesson = workshop::placed_lesson(work);
  if (!lesson) return lesson.error();
  if (const Status fits = scoring::check(rubric, *lesson); !fits) return fits.error();
  return lesson;
}

Result<Judged> judged_by(const std::string& recording, const std::string& rubric) {
  auto player = record::Player::open(recording);
  if (!player) return player.error();
  auto work = case_of(**player, rubric);
  if (!work) return work.error();
  auto read = scoring::read_rubric(rubric.empty() ? work->name : rubric);
  if (!read) return read.error();
  if (const Status same = is_for(*read, *work, "the recording is of"); !same) return same.error();
  auto lesson = lesson_for(*work, *read);
  if (!lesson) return lesson.error();
  return Judged{std::move(*player), std::move(*work), std::move(*read), std::move(*lesson)};
}

Result<Scored> scored(Judged judged, const scenario::BoneRecipe& volume, Progress& progress) {
  record::Player& player = *judged.player;
  if (const Status whole = record::check_chain(player, progress); !whole) return whole.error();
  auto before = workshop::bone_of(player, volume, progress);
  if (!before) return before.error();
  auto after = volume::copy_of(**before);
  auto moved = moved_pieces_of(player, *after, &judged.lesson);
  if (!moved) return moved.error();
  std::unique_ptr<volume::Bone> put_back;
  if (!moved->pieces.empty()) put_back = moved->store.with_pieces_back(*after);
  auto score = scoring::score(judged.rubric, judged.lesson, **before, put_back ? *put_back : *after,
                              &player, progress);
  if (!score) return score.error();
  return Scored{std::move(judged), std::move(*before), std::move(after), std::move(*score),
                std::move(moved->pieces)};
}

}  // namespace burr::report

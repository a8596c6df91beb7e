#include "burr/proof/known_bone.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/scoring/reference.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/other_bone.h"
#include "burr/workshop/prepare.h"

namespace burr::proof {

Result<KnownBone> KnownBone::make(const KnownBoneSettings& settings, Progress& progress) {
  auto work = scenario::read_case(settings.case_name);
  if (!work) return work.error();
  if (Status taken = workshop::take_bone(*work, settings.bone_number); !taken) return taken.error();
  KnownBone known;
  auto rubric = scoring::read_rubric(settings.rubric.empty() ? work->name : settings.rubric);
  if (!rubric) return rubric.error();
  known.rubric_ = std::move(*rubric);
  known.judge_only([](const scoring::Item& item) { return !scoring::needs_recording(item); });
  auto lesson = workshop::placed_lesson(*work);
  if (!lesson) return lesson.error();
  known.lesson_ = std::move(*lesson);
  known.places_ = places_of(known.lesson_);
  scenario::BoneRecipe recipe;
  recipe.voxel_mm = settings.voxel_mm;
  for (auto* bone : {&known.before_, &known.after_}) {
    auto made = workshop::open_bone(workshop::recipe_of(*work, recipe), progress);
    if (!made) return made.error();
    *bone = std::move(made->bone);
  }
  return known;
}

void KnownBone::judge_only(const std::function<bool(const scoring::Item&)>& wanted) {
  std::erase_if(rubric_.items, [&](const scoring::Item& item) { return !wanted(item); });
  for (scoring::Item& item : rubric_.items)
    if (rubric_.item(item.needs) == nullptr) item.needs.clear();
}

Status KnownBone::cut(std::string_view shapes, Progress& progress) {
  const auto work = read_work(shapes, places_);
  if (!work) return work.error();
  return cut(*work, progress);
}

Status KnownBone::cut(const Work& work, Progress& progress, const std::vector<std::string>& only) {
  CutBone made(*after_, *before_);
  made.restore();
  if (Status cut = made.cut(work); !cut) return cut;
  return look(progress, only);
}

Status KnownBone::cut_reference(Progress& progress) {
  CutBone(*after_, *before_).restore();
  if (Status cut = scoring::cut_to_reference(*after_, *before_, lesson_, progress); !cut)
    return cut;
  return look(progress);
}

const scoring::Outcome* KnownBone::outcome(std::string_view id) const {
  for (const scoring::Outcome& one : score_.outcomes)
    if (one.id == id) return &one;
  return nullptr;
}

Status KnownBone::look(Progress& progress, const std::vector<std::string>& only) {
  scoring::Rubric rubric = rubric_;
  std::vector<std::string> wanted = only;
  for (std::size_t n = 0; n < wanted.size(); ++n)
    if (const scoring::Item* item = rubric.item(wanted[n]); item != nullptr && !item->needs.empty())
      wanted.push_back(item->needs);
  if (!only.empty())
    std::erase_if(rubric.items, [&](const scoring::Item& item) {
      return std::find(wanted.begin(), wanted.end(), item.id) == wanted.end();
    });
  auto made = scoring::score(rubric, lesson_, *before_, *after_, nullptr, progress);
  if (!made) return made.error();
  score_ = std::move(*made);
  return fine();
}

}  // namespace burr::proof

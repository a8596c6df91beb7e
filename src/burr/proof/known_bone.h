// proof/known_bone.h - the bone of a built-in case, cut by a line of shapes (known_shape.h) and scored by the case's own rubric without
// a recording. It asks whether a score is right: the right value follows from the numbers in the line.
//
//     auto jaw = proof::KnownBone::make({.case_name = "jaw"}, progress);
//     Status done = jaw->cut("cyl on implant_axis -5 0 0 on implant_axis 10 0 0 2", progress);
//     jaw->outcome("bed.width")->value;  jaw->score().product.points
//
// Items that need a recording are left out, and what requires such an item is looked at alone.
// Thread: one at a time. Memory: two bones.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/proof/cut.h"
#include "burr/proof/known_shape.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"
#include "burr/volume/bone.h"

namespace burr::proof {

struct KnownBoneSettings {
  std::string case_name = {};
  double voxel_mm = 0;            // 0: the case's
  std::uint32_t bone_number = 0;  // as of `--bone`; 0: the case's own bone
  std::string rubric = {};        // empty: the case's
};

class KnownBone {
 public:
  // Errors: those of reading a case and making its bone.
  [[nodiscard]] static Result<KnownBone> make(const KnownBoneSettings& settings,
                                              Progress& progress);

  // Cuts the untouched bone by this and nothing else, and scores it. Errors: of read_work(), of score().
  [[nodiscard]] Status cut(std::string_view shapes, Progress& progress);
  // only: ids of the items to be judged, with those that they require; empty: all.
  [[nodiscard]] Status cut(const Work& work, Progress& progress,
                           const std::vector<std::string>& only = {});
  // The result that the case calls its reference.
  [[nodiscard]] Status cut_reference(Progress& progress);

  [[nodiscard]] const scoring::Score& score() const { return score_; }
  // nullptr: the rubric has no such item that the bone decides.
  [[nodiscard]] const scoring::Outcome* outcome(std::string_view id) const;
  [[nodiscard]] const scoring::Rubric& rubric() const { return rubric_; }
  // The items that are judged from now on; the others are left out.
  void judge_only(const std::function<bool(const scoring::Item&)>& wanted);
  [[nodiscard]] const volume::Bone& before() const { return *before_; }
  [[nodiscard]] const volume::Bone& after() const { return *after_; }
  [[nodiscard]] const scenario::CaseLesson& lesson() const { return lesson_; }
  [[nodiscard]] const Places& places() const { return places_; }

 private:
  [[nodiscard]] Status look(Progress& progress, const std::vector<std::string>& only = {});

  scoring::Rubric rubric_;
  scenario::CaseLesson lesson_;
  Places places_;
  std::unique_ptr<volume::Bone> before_, after_;
  scoring::Score score_;
};

}  // namespace burr::proof

// What a rubric asks for must lie in what its case allows. A surgeon without errors cuts to the end of the plan:
// all that the steps ask for, less the margins to what must stay whole, as far as it is reached straight
// from where the surgeon is.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/rubric.h"
#include "burr/surgeon/plan.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"

namespace burr::scoring {
namespace {

// The plans of all steps, without any error of perception.
surgeon::FieldGrid whole_plan(const volume::Bone& bone, const scenario::CaseLesson& lesson,
                              const surgeon::Believed& seen) {
  const surgeon::Spare spare = surgeon::spare_of(bone.grid(), lesson, seen, 0);
  surgeon::FieldGrid all(bone.grid());
  for (const scenario::Step& step : lesson.steps) {
    if (step.region.empty()) continue;
    const surgeon::FieldGrid goal = surgeon::goal_of(
        *lesson.region(step.region), surgeon::approach_of(lesson, step), seen, spare);
    for (std::size_t n = 0; n < all.nodes(); ++n)
      all.value[n] = std::max(all.value[n], goal.value[n]);
  }
  return all;
}

// Share of the bone in a region that the plan holds.
double share_of(const volume::Bone& bone, const surgeon::Believed::Depth& region,
                const surgeon::FieldGrid& plan) {
  const volume::Grid& grid = bone.grid();
  double in = 0, planned = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        if (bone.field(i, j, k) < volume::kIso) continue;
        const math::Vec3 p = grid.world_from_grid(math::Vec3(i, j, k));
        if (region(p) < 0) continue;
        in += 1;
        planned += plan.at(p) >= 0 ? 1 : 0;
      }
  return planned / std::max(in, 1.0);
}

TEST(Plan, OfTheTemporalBoneHoldsWhatItsRubricAsksFor) {
  const auto work = scenario::read_case("temporal-bone");
  const auto rubric = read_rubric("temporal-bone");
  ASSERT_TRUE(work && rubric);
  auto read = scenario::lesson_of(*work);
  ASSERT_TRUE(read);
  const auto lesson =
      scenario::place(std::move(*read), workshop::landmarks_of(*work), "temporal-bone.toml");
  ASSERT_TRUE(lesson) << lesson.error().text;
  scenario::BoneRecipe coarse;
  coarse.voxel_mm = 0.5;
  NoProgress quiet;
  const auto made = workshop::open_bone(workshop::recipe_of(*work, coarse), quiet);
  ASSERT_TRUE(made) << made.error().text;
  const volume::Bone& bone = *made->bone;
  const auto seen = surgeon::Believed::make(bone, *lesson, 0, 1, quiet);
  ASSERT_TRUE(seen);
  const surgeon::FieldGrid plan = whole_plan(bone, *lesson, *seen);
  int looked_at = 0;
  for (const Item& item : rubric->items) {
    const std::string how(item.how->name);
    if (how != "removed" && how != "kept") continue;
    SCOPED_TRACE(item.id);
    ++looked_at;
    const double share = share_of(bone, seen->region(*lesson->region(item.region)), plan);
    // a tenth of the plan may stay in corners that no burr reaches
    if (how == "removed") {
      EXPECT_GT(0.9 * share, item.limit("share"));
    } else {
      EXPECT_LT(share, item.limit("share"));
    }
  }
  EXPECT_EQ(looked_at, 7);
}

}  // namespace
}  // namespace burr::scoring

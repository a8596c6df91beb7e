// A scripted surgeon fills a place whose shape is known: a pad on the flat face of a block. Without walls
// around it some material spreads beside it.
#include "burr/surgeon/fill_work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "burr/people/random_stream.h"
#include "burr/sim/session.h"
#include "burr/surgeon/plan.h"
#include "burr/surgeon/surgeon.h"
#include "burr/tool/state.h"
#include "surgeon/surgeon_bone.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr double kVoxelMm = 0.3;

scenario::CaseLesson pad_lesson() {
  scenario::CaseLesson lesson = block_lesson();
  scenario::CaseRegion& region = lesson.regions.front();
  scenario::Shape& box = region.add.front();
  box.a.at = Vec3(0, -2, 0.2) * kMm;  // 1 mm high, on the face at z = 0
  box.size = Vec3(4, 4, 1.6) * kMm;
  lesson.steps.front().adds = true;
  lesson.reference.reset();
  return lesson;
}

struct Filled {
  std::size_t planned = 0, full = 0, beside = 0, cut = 0;  // voxels
  bool declared = false, adds = false;
  [[nodiscard]] double share() const {
    return static_cast<double>(full) / static_cast<double>(planned);
  }
};

// slack: material so near outside is not beside [m]
Filled operate(const Skill& skill, double seconds, double slack) {
  NoProgress quiet;
  const scenario::CaseLesson lesson = pad_lesson();
  auto bone = block_with_vein(kVoxelMm);
  const auto before = block_with_vein(kVoxelMm);
  tool::Burr burr;
  burr.radius = 1 * kMm;
  auto surgeon = Surgeon::make(*bone, lesson, burr, Vec3::Zero(), skill, 1, 1000, quiet);
  EXPECT_TRUE(surgeon.ok());
  sim::SessionSettings settings;
  settings.servo.burr = burr;
  settings.servo.spindle_rad_s = 6000;
  auto made = sim::Session::make(std::move(bone), (*surgeon)->take_hand(), settings, quiet);
  EXPECT_TRUE(made.ok());
  sim::Session& session = **made;
  Filled done;
  session.set_between_ticks(
      [&] {
        const Consulted consulted = (*surgeon)->consult(session.bone());
        if (consulted.burr)
          session.command({tick::CommandKind::burr_radius, consulted.burr->radius});
        if (consulted.adds) {
          session.command(
              {tick::CommandKind::tool_mode,
               static_cast<double>(*consulted.adds ? tool::Mode::add : tool::Mode::cut)});
          done.adds = *consulted.adds;
        }
        for (const SurgeonNote& note : consulted.notes)
          done.declared = done.declared || note.kind == NoteKind::done;
      },
      kConsultTicks);
  session.run(seconds, quiet);

  const auto depth = [](const Vec3& p) {
    const Vec3 far = (p - Vec3(0, -2, 0.2) * kMm).cwiseAbs() - Vec3(2, 2, 0.8) * kMm;
    return -far.maxCoeff();
  };
  const math::Ijk size = before->grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        const bool was = before->field(i, j, k) >= volume::kIso,
                   is = session.bone().field(i, j, k) >= volume::kIso;
        if (was && !is) ++done.cut;
        const double deep = depth(before->grid().world_from_grid(Vec3(i, j, k)));
        if (!was && is && deep < -slack) ++done.beside;
        if (was || deep < 0) continue;
        ++done.planned;
        if (is) ++done.full;
      }
  EXPECT_GT(done.planned, 300U);
  return done;
}

Skill faultless() {
  Skill skill;
  skill.perception = skill.tremor = skill.drift = skill.force_noise = 0;
  return skill;
}

TEST(FillWork, WithoutFaultsThePadIsFilledAndLittleLiesBesideIt) {
  const Filled done = operate(faultless(), 60, 0.3 * kMm);
  EXPECT_TRUE(done.adds);
  EXPECT_GT(done.share(), 0.4);
  EXPECT_LT(static_cast<double>(done.beside), 0.15 * static_cast<double>(done.planned));
  EXPECT_EQ(done.cut, 0U);
}

TEST(FillWork, WhoStopsEarlyLeavesMoreEmpty) {
  Skill hasty = faultless();
  hasty.unfinished = 0.5;
  const Filled early = operate(hasty, 60, 0.3 * kMm);
  EXPECT_TRUE(early.declared);
  const Filled whole = operate(faultless(), 60, 0.3 * kMm);
  EXPECT_LT(early.share(), whole.share() - 0.05);
}

struct Planned {
  std::unique_ptr<volume::Bone> bone = block_with_vein(0.5);
  scenario::CaseLesson lesson = pad_lesson();
  Believed believed;
  Spare spare;
  Filling filling;
  Planned() {
    NoProgress quiet;
    auto made = Believed::make(*bone, lesson, 0, 1, quiet);
    EXPECT_TRUE(made.ok());
    believed = std::move(*made);
    spare = spare_of(bone->grid(), lesson, believed, 0);
    filling = filling_of(lesson.regions.front(), believed, spare, Vec3::UnitZ());
  }
};

// A margin is bone that is left over a structure when bone is cut away; who fills a gap beside it must
// only not enter it.
TEST(FillWork, ReachesUpToWhatIsSparedAndNotIntoIt) {
  Planned planned;
  scenario::Shape& box = planned.lesson.regions.front().add.front();
  box.a.at = Vec3(0, 1, -2) * kMm;  // the trough over the vein
  box.size = Vec3(10, 8, 4) * kMm;
  const Filling filling =
      filling_of(planned.lesson.regions.front(), planned.believed, planned.spare, Vec3::UnitZ());
  const Vec3 beside(0, 0, -3.2 * kMm), within(0, 0, -3.8 * kMm);  // the vein begins at -3.5 mm
  EXPECT_LT(planned.spare.free.at(beside), 0);
  EXPECT_GT(filling.gap.at(beside), 0.1 * kMm);
  EXPECT_LT(filling.gap.at(within), 0);
}

// A stroke that began elsewhere on its line could begin on ground that is full already, and never come
// down to the place.
TEST(FillWork, AStrokeBeginsOverThePlaceThatItIsFor) {
  const Planned planned;
  FillWork work(*planned.bone, planned.lesson.steps.front(), planned.filling, Vec3::UnitZ(),
                faultless(), 2 * kMm);
  people::RandomStream random(1, 1);
  int strokes = 0;
  for (int n = 0; n < 20; ++n) {
    const auto next = work.next(*planned.bone, Vec3(0, 0, 5 * kMm), {}, random);
    if (!next) continue;
    ++strokes;
    const Vec3 off = next->stroke.start - next->at;
    EXPECT_LT(std::hypot(off.x(), off.y()), 1e-9);
  }
  EXPECT_GT(strokes, 5);
}

}  // namespace
}  // namespace burr::surgeon

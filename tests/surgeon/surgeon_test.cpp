// Whole sessions of scripted surgeons on a block whose answer is known.
#include "burr/surgeon/surgeon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/sim/session.h"
#include "burr/volume/volume_of.h"
#include "surgeon/surgeon_bone.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr double kVoxelMm = 0.3, kWhole = 500, kPart = 60;  // [s]

struct Done {
  double left = 1;               // share of the plan's voxels that are still bone
  std::size_t of_the_stone = 0;  // voxels that were cut
  double into_the_vein = -1;     // deepest place of the burr in the vein [m]
  bool declared = false;
  std::vector<std::string> steps;
  std::uint64_t ticks = 0, hash = 0;
  int burrs = 0, eyes = 0;
};

Done operate(const Skill& skill, std::uint64_t seed, double seconds) {
  NoProgress quiet;
  const scenario::CaseLesson lesson = block_lesson();
  auto bone = block_with_vein(kVoxelMm);
  const auto before = block_with_vein(kVoxelMm);
  tool::Burr burr;
  burr.radius = 1.5 * kMm;
  auto surgeon = Surgeon::make(*bone, lesson, burr, Vec3::Zero(), skill, seed, 1000, quiet);
  EXPECT_TRUE(surgeon.ok());
  sim::SessionSettings settings;
  settings.servo.burr = burr;
  settings.servo.spindle_rad_s = 6000;
  auto made = sim::Session::make(std::move(bone), (*surgeon)->take_hand(), settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  sim::Session& session = **made;
  Done done;
  session.set_between_ticks(
      [&] {
        const Consulted consulted = (*surgeon)->consult(session.bone());
        if (consulted.burr) {
          session.command({tick::CommandKind::burr_kind,
                           consulted.burr->kind == tool::BurrKind::diamond ? 1.0 : 0.0});
          session.command({tick::CommandKind::burr_radius, consulted.burr->radius});
          ++done.burrs;
        }
        if (consulted.eye) ++done.eyes;
        for (const SurgeonNote& note : consulted.notes) {
          done.declared = done.declared || note.kind == NoteKind::done;
          if (note.kind == NoteKind::step_done) done.steps.push_back(note.step);
        }
        tick::TickRow row;
        if (session.view(row) && row.spindle_rad_s > 300)
          done.into_the_vein =
              std::max(done.into_the_vein, kVein(row.contact.proxy) + session.burr_radius());
      },
      kConsultTicks);
  session.run(seconds, quiet);
  done.ticks = session.outcome().ticks;
  done.hash = session.bone().content_hash();

  const auto believed = Believed::make(*before, lesson, 0, 1, quiet);
  const Spare spare = spare_of(before->grid(), lesson, *believed, 0);
  const FieldGrid goal = goal_of(lesson.regions.front(), approach_of(lesson), *believed, spare);
  std::size_t planned = 0, there = 0;
  const math::Ijk size = before->grid().size;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) {
        if (before->field(i, j, k) < volume::kIso) continue;
        const bool gone = session.bone().field(i, j, k) < volume::kIso;
        if (before->tissue(i, j, k) == 2) done.of_the_stone += gone ? 1 : 0;
        if (goal.at(before->grid().world_from_grid(Vec3(i, j, k))) < 0.5 * kMm) continue;
        ++planned;
        there += gone ? 0 : 1;
      }
  EXPECT_GT(planned, 1000U);
  done.left = static_cast<double>(there) / static_cast<double>(planned);
  return done;
}

Skill faultless() {
  Skill skill;
  skill.perception = skill.tremor = skill.drift = skill.force_noise = 0;
  return skill;
}

TEST(Surgeon, WithoutFaultsThePlanIsRemovedAndWhatIsSparedIsWhole) {
  const Done done = operate(faultless(), 1, kWhole);
  EXPECT_TRUE(done.declared);
  EXPECT_EQ(done.steps, std::vector<std::string>{"trough"});
  EXPECT_LT(done.left, 0.05);
  EXPECT_EQ(done.of_the_stone, 0U);
  EXPECT_LT(done.into_the_vein, -0.4 * kMm);  // 1 mm of bone was to be left over it
  EXPECT_GT(done.burrs, 0);
  EXPECT_GT(done.eyes, 10);
}

TEST(Surgeon, TheSameSeedGivesTheSameSessionAndAnotherSeedAnother) {
  const Skill skill = skill_of(Level::average);
  const Done one = operate(skill, 5, kPart), same = operate(skill, 5, kPart),
             other = operate(skill, 6, kPart);
  EXPECT_EQ(one.ticks, same.ticks);
  EXPECT_EQ(one.hash, same.hash);
  EXPECT_NE(one.hash, other.hash);
}

TEST(Surgeon, WhoStopsEarlyLeavesMore) {
  Skill hasty = faultless();
  hasty.unfinished = 0.4;
  const Done early = operate(hasty, 1, kWhole), whole = operate(faultless(), 1, kWhole);
  EXPECT_TRUE(early.declared);
  EXPECT_LT(early.ticks, whole.ticks);
  EXPECT_GT(early.left, whole.left + 0.1);
}

// What calls a surgeon: before the first tick and every n-th, not in real time.
TEST(Surgeon, IsCalledBetweenTicksButNeverInRealTime) {
  for (const bool realtime : {false, true}) {
    NoProgress quiet;
    sim::SessionSettings settings;
    settings.servo.burr.radius = 1.5 * kMm;
    settings.realtime = realtime;
    auto made = sim::Session::make(
        block_with_vein(0.5),
        std::make_unique<SurgeonHand>(Skill{}, 1e-3, 1, Vec3(0, 0, 20 * kMm), Vec3::UnitZ()),
        settings, quiet);
    ASSERT_TRUE(made.ok());
    std::vector<std::uint64_t> called;
    (*made)->set_between_ticks([&] { called.push_back((*made)->ticks()); }, 10);
    (*made)->run(0.025, quiet);
    EXPECT_EQ(called,
              realtime ? std::vector<std::uint64_t>{} : (std::vector<std::uint64_t>{0, 10, 20}));
  }
}

TEST(Surgeon, RefusesACaseWithNothingToDo) {
  NoProgress quiet;
  const auto bone = block_with_vein(0.5);
  scenario::CaseLesson lesson = block_lesson();
  lesson.steps.clear();
  const auto made = Surgeon::make(*bone, lesson, {}, Vec3::Zero(), {}, 1, 1000, quiet);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().text,
            "the case has no step with a region, so a scripted surgeon has nothing to do; add "
            "[[step]] with region (docs/use/cases.md)");
}

}  // namespace
}  // namespace burr::surgeon

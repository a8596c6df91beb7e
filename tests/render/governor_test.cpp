// What is left out of the picture when the machine is too slow, with the test's own clock.
#include "burr/render/governor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace burr::render {
namespace {

// A machine: frame time at each step, at rest and moving.
struct Machine {
  double rest[FrameGovernor::kSteps], moving[FrameGovernor::kSteps];
};
constexpr Machine kFast = {{1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, {2e-3, 2e-3, 2e-3, 2e-3, 2e-3}};
constexpr Machine kSlow = {{0.05, 0.03, 0.02, 0.018, 0.015}, {0.5, 0.4, 0.06, 0.05, 0.03}};

class Loop {
 public:
  Loop(FrameGovernor& governor, const Machine& machine) : governor_(governor), machine_(machine) {}
  // draws frames for this time
  void run(double seconds, bool moving, double redrawn = 1) {
    for (const double end = now_ + seconds; now_ < end;) {
      if (moving) orbit(camera_, 0.01, 0);
      quality_ = governor_.begin(camera_, now_);
      const auto at = static_cast<std::size_t>(governor_.step());
      const double took = governor_.moving() ? machine_.moving[at] : machine_.rest[at];
      governor_.end(redrawn > 0 ? took : 1e-4, redrawn, now_);
      now_ += std::max(took, 1.0 / 60);
    }
  }
  [[nodiscard]] const Quality& quality() const { return quality_; }
  void on(const Machine& machine) { machine_ = machine; }

 private:
  FrameGovernor& governor_;
  Machine machine_;
  Camera camera_;
  Quality quality_;
  double now_ = 0;
};

bool whole(const Quality& q) {
  return q.ambient_occlusion && !q.ambient_occlusion_later && q.coarse_px == 0 &&
         q.coarse_still_px == 0 && q.scale == 1;
}

TEST(FrameGovernor, LeavesNothingOutOnAFastMachine) {
  FrameGovernor governor(false);
  Loop loop(governor, kFast);
  loop.run(5, true);
  EXPECT_TRUE(whole(loop.quality()));
  loop.run(5, false);
  EXPECT_TRUE(whole(loop.quality()));
  EXPECT_TRUE(loop.quality().refine);
  EXPECT_EQ(governor.frames()[1] + governor.frames()[2] + governor.frames()[4], 0U);
}

TEST(FrameGovernor, GoesAsFarAsItMustAndNoFarther) {
  FrameGovernor governor(false);
  Loop loop(governor, kSlow);
  loop.run(4, true);
  EXPECT_EQ(governor.step(), 4);
  EXPECT_FALSE(loop.quality().ambient_occlusion);
  EXPECT_EQ(loop.quality().coarse_px, 3);
  EXPECT_EQ(loop.quality().scale, 0.75);
  EXPECT_FALSE(loop.quality().refine) << "nothing is made good while the eye moves";
  // the eye rests: other frames, other steps, all samples again
  loop.run(4, false);
  EXPECT_EQ(governor.step(), 2);
  EXPECT_EQ(loop.quality().scale, 1);
  EXPECT_TRUE(loop.quality().ambient_occlusion_later);
  EXPECT_EQ(loop.quality().coarse_still_px, 1);
  EXPECT_TRUE(loop.quality().refine);
  for (const Quality& q : {loop.quality()}) {
    EXPECT_LE(q.coarse_px, 3);
    EXPECT_LE(q.coarse_still_px, 1);
    EXPECT_GE(q.scale, 0.75);
  }
}

TEST(FrameGovernor, ComesBackWhenThereIsRoomAndWaitsLongerWhenThatFailed) {
  FrameGovernor governor(false);
  Loop loop(governor, kSlow);
  loop.run(10, true);
  ASSERT_EQ(governor.step(), 4);
  loop.on(kFast);
  loop.run(20, true);
  EXPECT_EQ(governor.step(), 0);
  EXPECT_TRUE(whole(loop.quality()));

  // a machine with time to spare at one step and too little at the one before: it tries less and
  // less often
  constexpr Machine kEdge = {{0.05, 0.005, 0.005, 0.005, 0.005}, {0.1, 0.005, 0.005, 0.005, 0.005}};
  FrameGovernor other(false);
  Loop edge(other, kEdge);
  edge.run(120, true);
  const auto before = other.frames()[0];
  edge.run(120, true);
  const auto after = other.frames()[0] - before;
  EXPECT_GT(before, after);
  EXPECT_LT(after, 30U);
}

TEST(FrameGovernor, LearnsNothingFromFramesInWhichNothingWasDrawn) {
  FrameGovernor governor(false);
  Loop loop(governor, kSlow);
  loop.run(5, false, 0);
  EXPECT_EQ(governor.step(), 0);
  EXPECT_EQ(governor.frames()[0], 0U);
}

TEST(FrameGovernor, BeginsLowWhereTheProcessorDrawsAndCanBeHeldBack) {
  FrameGovernor software(true);
  Loop loop(software, kSlow);
  loop.run(0.1, true);
  EXPECT_GE(software.step(), 2) << "the first turn of a large bone would stand still";

  GovernorSettings settings;
  settings.most = 0;
  FrameGovernor never(true, settings);
  Loop full(never, kSlow);
  full.run(5, true);
  EXPECT_TRUE(whole(full.quality()));
}

TEST(FrameGovernor, NamesEveryStep) {
  for (int step = 0; step < FrameGovernor::kSteps; ++step)
    EXPECT_STRNE(FrameGovernor::name(step), "");
}

}  // namespace
}  // namespace burr::render

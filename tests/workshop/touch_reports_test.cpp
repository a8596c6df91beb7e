// What people met while they touched a scan (../shared/data/reports/touch): the hand must not feel
// steps that it does not make itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "burr/device/simulated_hand.h"
#include "burr/haptics/force_steps.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "burr/workshop/open_bone.h"
#include "support/data.h"

namespace burr::workshop {
namespace {

struct Felt {
  haptics::ForceSteps steps{1000};
  int touching = 0;
  double low = INFINITY, high = -INFINITY;  // places of the burr in contact, along z [m]
};

// A firm hand along a path of the reports, spindle off, as `burr mill SCAN --path PATH` does it.
Felt felt(const std::string& scan, const std::string& path, double burr_mm, bool margin = true) {
  const std::filesystem::path folder = test::data_dir() / "reports" / "touch";
  NoProgress quiet;
  scenario::BoneRecipe recipe;
  recipe.source = (folder / scan).string();
  recipe.margin = margin;
  Felt out;
  auto opened = open_bone(recipe, quiet);
  EXPECT_TRUE(opened) << opened.error().text;
  const auto way = surgeon::read_path((folder / path).string());
  EXPECT_TRUE(way) << way.error().text;
  if (!opened || !way) return out;
  volume::IsoVertices surface(*opened->bone, {}, 2, quiet);
  device::SimulatedHand hand(*way, {});
  EXPECT_TRUE(hand.open());
  tick::ServoSettings settings;
  settings.burr.radius = 0.5e-3 * burr_mm;
  if (!margin) settings.slip_m_s = 0;  // recordings from before the margin have no such limit
  tick::Servo servo(*opened->bone, surface, hand, settings);
  for (int n = 0; n < 1000 * way->duration(); ++n) {
    const tick::TickRow& row = servo.tick(false);
    servo.publish();
    out.steps.add(row.hand.world_from_tool.p, row.contact.force);
    if (!row.contact.touching) continue;
    ++out.touching;
    out.low = std::min(out.low, row.contact.proxy.z());
    out.high = std::max(out.high, row.contact.proxy.z());
  }
  return out;
}

// Before: 69 ticks of more than 0.05 N, up to 0.14 N; the burr bobbed by 0.14 mm.
TEST(TouchReports, AFaceThatTheBorderCutsIsAFaceAsAnyOther) {
  BURR_NEEDS_DATA("reports/touch/full.nrrd");
  const Felt cut = felt("full.nrrd", "face_full.csv", 5),
             air = felt("padded.nrrd", "face_padded.csv", 5);
  EXPECT_EQ(cut.touching, air.touching);
  EXPECT_GT(cut.touching, 1500);
  EXPECT_LT(cut.steps.most(), 0.01);
  EXPECT_LT(air.steps.most(), 0.01);
  EXPECT_LT(cut.high - cut.low, 5e-6);
  EXPECT_NEAR(cut.low, 8.5e-3, 5e-6);  // the face is at z = 6 mm
  EXPECT_NEAR(cut.low, air.low, 5e-6);
}

TEST(TouchReports, AnOldRecordingsBoneBreaksOffAsItDid) {
  BURR_NEEDS_DATA("reports/touch/full.nrrd");
  EXPECT_GT(felt("full.nrrd", "face_full.csv", 5, false).steps.most(), 0.1);
}

// Before: it stuck, then leapt by 0.94 N in a tick. It rests on the two rims of the slot, and the
// load of both, up to 40 times the push, counted for friction.
TEST(TouchReports, ABurrInASlotOfItsOwnWidthDoesNotLeap) {
  BURR_NEEDS_DATA("reports/touch/slot4.0.nrrd");
  const Felt slot = felt("slot4.0.nrrd", "slot_along.csv", 4);
  EXPECT_GT(slot.touching, 2500);
  EXPECT_LT(slot.steps.most(), 0.05);
}

}  // namespace
}  // namespace burr::workshop

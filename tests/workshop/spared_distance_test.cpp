// Distance to what must be spared, in words and in a recording.
#include "burr/workshop/spared_distance.h"

#include <gtest/gtest.h>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/case.h"
#include "burr/workshop/spared.h"

namespace burr::workshop {
namespace {

volume::TissueTable table() {
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "facial nerve", .kind = volume::TissueKind::soft});
  tissues.tissues.push_back({.name = "dura", .kind = volume::TissueKind::soft, .spare = true});
  return tissues;
}

TEST(SparedDistance, ACaseNamesWhatToSpareElseTheTableDoes) {
  EXPECT_EQ(to_spare(table(), {}), Tissues{3});
  EXPECT_EQ(to_spare(table(), {"facial nerve"}), Tissues{2});
  EXPECT_EQ(to_spare(table(), {"dura", "facial nerve"}), (Tissues{3, 2}));
  // what the bone lacks is left out here, and refused where the case is opened
  EXPECT_EQ(to_spare(table(), {"dura", "chorda\x1b[2J"}), Tissues{3});
  scenario::Case work;
  work.spare = {"dura", "chorda\x1b[2J"};
  const Status fits = scenario::check_tissues(work, table());
  ASSERT_FALSE(fits);
  EXPECT_NE(fits.error().text.find("chorda"), std::string::npos) << fits.error().text;
  EXPECT_EQ(fits.error().text.find('\x1b'), std::string::npos);
}

TEST(SparedDistance, ARecordingKeepsIt) {
  record::SessionInfo info;
  info.volume.tissues = table();
  info.volume.grid = phantom::cube_grid(20e-3, 16);
  EXPECT_EQ(read_spared(info), Tissues{3}) << "one without the word: what is marked";
  for (const Tissues& spared : {Tissues{2, 3}, Tissues{}, Tissues{3}}) {
    record::SessionInfo one = info;
    write_spared(spared, one);
    EXPECT_TRUE(record::check(one)) << "no word that a recording refuses";
    const auto again = record::session_from_json(record::to_json(one), "s.mcap");
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_EQ(read_spared(*again), spared);
  }
  info.words["spare"] = "2 700 3";
  EXPECT_EQ(read_spared(info), Tissues{2}) << "up to what cannot be";
  info.words["spare"] = "-1 nonsense";
  EXPECT_EQ(read_spared(info), Tissues{});
}

TEST(SparedDistance, SaysWhatIsNearAndHowFar) {
  // a ball of bone of 6 mm, all of which must be spared
  auto bone =
      phantom::bone_from_distance(phantom::cube_grid(20e-3, 80), {}, phantom::ball(6e-3), 0);
  NoProgress quiet;
  const auto spared_distance = SparedDistance::make(*bone, {1}, quiet);
  ASSERT_TRUE(spared_distance);
  const math::Vec3 centre = {0, 0, 9e-3};
  const auto distances = spared_distance->distances();
  ASSERT_TRUE(distances);
  EXPECT_NEAR(distances(centre), 3e-3, 0.2e-3);
  const auto near = spared_distance->nearest(centre);
  ASSERT_TRUE(near);
  EXPECT_EQ(near->name, "bone");
  EXPECT_EQ(near->distance, distances(centre));
  EXPECT_FALSE(spared_distance->nearest({0, 0, 1})) << "beyond the reach";

  const auto nothing = SparedDistance::make(*bone, {}, quiet);
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(nothing->distances()) << "nothing to ask";
  EXPECT_FALSE(nothing->nearest(centre));
}

}  // namespace
}  // namespace burr::workshop

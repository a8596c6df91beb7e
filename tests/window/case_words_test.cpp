// What the commands about cases and recordings say.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/diary.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "commands/case_new.h"
#include "commands/session_lines.h"
#include "record/made_up.h"
#include "shared/counted.h"

namespace burr::app {
namespace {

TEST(Words, OfCountsAreOneOrMany) {
  EXPECT_EQ(counted(0, "region"), "0 regions");
  EXPECT_EQ(counted(1, "region"), "1 region");
  EXPECT_EQ(counted(2, "region"), "2 regions");
  EXPECT_EQ(counted(1, "label is", "labels are"), "1 label is");
  EXPECT_EQ(counted(3, "label is", "labels are"), "3 labels are");
}

volume::TissueTable named(const std::vector<std::string>& names) {
  volume::TissueTable table;
  table.tissues = {{.name = "air", .kind = volume::TissueKind::air}};
  for (const std::string& name : names) table.tissues.push_back({.name = name});
  return table;
}

TEST(Words, ANewCaseNeedsANameForEachLabel) {
  EXPECT_TRUE(check_label_names(named({"bone", "nerve"})));
  const Status twice = check_label_names(named({"bone", "nerve", "vein", "nerve"}));
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().text,
            "labels 2 and 4 are both called \"nerve\", and a case tells labels apart by their "
            "names; rename it in the program that drew it, or give names with --tissues");
  const Status none = check_label_names(named({"bone", ""}));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text.find("label 2 has no name, and"), 0U) << none.error().text;
}

TEST(Words, ANewCaseIsACase) {
  auto bone =
      phantom::bone_from_distance(phantom::cube_grid(20e-3, 32), {}, phantom::ball(8e-3), 8);
  const NewCase made = new_case(*bone, "phantom:block", {});
  const auto read = scenario::parse_case(made.text, "my.toml");
  EXPECT_TRUE(read) << read.error().text << "\n" << made.text;
  EXPECT_EQ(made.text.find("e+"), std::string::npos) << made.text;
}

// A recording without mode, learner and shaft, but with a course.
TEST(Words, HowItEndedIsSaidEvenIfSomethingElseIsMissing) {
  BURR_SEEDED(random, 26);
  const record::test::Folder folder;
  const auto bone = record::test::any_bone(random);
  record::Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", record::test::info_of(*bone, random)).ok());
  record::Diary diary(recorder, 1000);
  diary.end(0, record::Ending::broke_off);
  ASSERT_TRUE(recorder.finish());
  const auto player = record::Player::open(folder / "s.mcap");
  ASSERT_TRUE(player) << player.error().text;
  const std::string text = session_text(**player);
  EXPECT_NE(text.find("ended: broke off; 0 views, no steps, help or warnings"), std::string::npos)
      << text;
  EXPECT_NE(text.find("does not hold mode, learner and attempt"), std::string::npos) << text;
}

}  // namespace
}  // namespace burr::app

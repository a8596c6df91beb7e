// The case of a session in its recording: to the byte, without a path, and a change is noticed.
#include <gtest/gtest.h>

#include <string>

#include "burr/record/player.h"
#include "burr/scenario/case.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

SessionInfo info_with(const scenario::Case& work) {
  SessionInfo info;
  info.volume.grid.size = {8, 8, 8};
  info.volume.grid.voxel = 1e-3;
  info.work_case = case_info(work);
  return info;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(RecordedCase, HoldsTextHashTargetsAndSpareOfEveryBuiltInCase) {
  for (const std::string& name : scenario::built_in_cases()) {
    SCOPED_TRACE(name);
    const auto work = scenario::read_case(name);
    ASSERT_TRUE(work) << work.error().text;
    const SessionInfo info = info_with(*work);
    ASSERT_TRUE(check(info).ok()) << check(info).error().text;
    const auto read = session_from_json(to_json(info), "x.mcap");
    ASSERT_TRUE(read) << read.error().text;
    ASSERT_TRUE(read->work_case.has_value());
    const CaseInfo& back = *read->work_case;
    EXPECT_EQ(back.name, name);
    EXPECT_EQ(back.text, work->text);
    EXPECT_EQ(back.text_hash, scenario::text_hash(work->text));
    EXPECT_EQ(back.spare, work->spare);
    ASSERT_EQ(back.targets.size(), work->targets.size());
    for (std::size_t n = 0; n < back.targets.size(); ++n) {
      EXPECT_EQ(back.targets[n].tissue, work->targets[n].tissue);
      EXPECT_EQ(back.targets[n].goal, work->targets[n].goal);
      EXPECT_EQ(back.targets[n].share, work->targets[n].share);
    }
    EXPECT_TRUE(back.unchanged());
    const auto again = case_of(back);
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_EQ(again->description, work->description);
    EXPECT_EQ(again->phantom, work->phantom);
  }
}

// The session was on another bone than the text of its case names: landmarks are those of that bone.
TEST(RecordedCase, IsOnTheBoneOfTheSession) {
  const auto work = scenario::read_case("tooth");
  ASSERT_TRUE(work);
  SessionInfo info = info_with(*work);
  const auto phantom_of = [&](const std::string& source) {
    info.volume.recipe.source = source;
    const auto read = case_of(info);
    return read ? read->phantom : read.error().text;
  };
  EXPECT_EQ(phantom_of("phantom:tooth?graded,bone=2"), "tooth?graded,bone=2");
  EXPECT_EQ(phantom_of("phantom:tooth?graded"), "tooth?graded");
  // a volume, or another phantom than that of the case: the text counts
  EXPECT_EQ(phantom_of(""), "tooth?graded");
  EXPECT_EQ(phantom_of("phantom:jaw"), "tooth?graded");
}

TEST(RecordedCase, TheHashIsFnv1aOfTheText) {
  EXPECT_EQ(scenario::text_hash(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(scenario::text_hash("foobar"), 0x85944171f73967e8ULL);
}

TEST(RecordedCase, AChangeIsNoticedWhereTheFileIsOpened) {
  const auto work = scenario::read_case("temporal-bone");
  ASSERT_TRUE(work);
  const burr::test::Folder folder;
  const auto notices = [&](const SessionInfo& info) {
    const std::string path = folder / "s.mcap";
    Recorder recorder(1000);
    EXPECT_TRUE(recorder.start(path, info).ok());
    EXPECT_TRUE(recorder.finish().ok());
    const auto player = Player::open(path);
    EXPECT_TRUE(player) << player.error().text;
    std::string all;
    if (player)
      for (const std::string& one : (*player)->notices()) all += one;
    return all;
  };
  SessionInfo info = info_with(*work);
  EXPECT_EQ(notices(info).find("was changed"), std::string::npos);
  info.work_case->text = with(info.work_case->text, "share = 0.6", "share = 0.1");
  EXPECT_NE(notices(info).find("was changed"), std::string::npos) << "the text has another hash";
  info = info_with(*work);
  info.work_case->spare.pop_back();
  EXPECT_NE(notices(info).find("was changed"), std::string::npos) << "the text spares more";
  info = info_with(*work);
  info.work_case->targets[0].share = 0.5;
  EXPECT_NE(notices(info).find("was changed"), std::string::npos) << "the text asks for more";
}

TEST(RecordedCase, AnOlderRecordingHasNone) {
  SessionInfo info = info_with(*scenario::read_case("jaw"));
  info.work_case.reset();
  const std::string text = to_json(info);
  EXPECT_EQ(text.find("\"case\""), std::string::npos);
  const auto read = session_from_json(text, "old.mcap");
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_FALSE(read->work_case.has_value());
}

TEST(RecordedCase, WhatIsBrokenIsNamed) {
  const SessionInfo info = info_with(*scenario::read_case("jaw"));
  for (const char* field : {"text_hash", "text", "targets", "spare", "name"}) {
    const std::string text =
        with(to_json(info), "\"" + std::string(field) + "\":", "\"not_there\":");
    const auto read = session_from_json(text, "x.mcap");
    if (field == std::string("name")) continue;  // tissues have a name too
    ASSERT_FALSE(read) << field;
    EXPECT_NE(read.error().text.find("case." + std::string(field)), std::string::npos)
        << read.error().text;
  }
}

TEST(RecordedCase, ThePathOfAnOwnVolumeStaysAtHome) {
  const std::string text =
      "title = \"Own\"\n# above\nvolume = \"\"\"/home/anna/\\\n  svensson.nrrd\"\"\"  # beside\n"
      "[burr]\ndiameter_mm = 4\nrpm = 60000\n[[spare]]\ntissue = \"nerve\"";
  const auto work = scenario::parse_case(text, "own.toml");
  ASSERT_TRUE(work) << work.error().text;
  EXPECT_EQ(work->volume, "/home/anna/svensson.nrrd");
  EXPECT_EQ(work->text,
            "title = \"Own\"\n# above\nvolume = \"own file\"\n"
            "[burr]\ndiameter_mm = 4\nrpm = 60000\n[[spare]]\ntissue = \"nerve\"");
  SessionInfo info = info_with(*work);
  EXPECT_TRUE(check(info).ok());
  EXPECT_EQ(to_json(info).find("svensson"), std::string::npos);
  EXPECT_TRUE(info.work_case->unchanged());
  info.work_case->text = text;
  EXPECT_FALSE(check(info).ok()) << "a path must not reach the disk";
  scenario::Case named = *work;
  named.name = "1.2.840.113619.2";
  EXPECT_EQ(case_info(named).name, "own") << "a UID must not be recorded";
}

}  // namespace
}  // namespace burr::record

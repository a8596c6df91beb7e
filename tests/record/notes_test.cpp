// What the user saw and did, and which session it was: to the bit, in order, private, and no trouble
// for a reader that does not know it.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "burr/base/progress.h"
#include "burr/math/rotation.h"
#include "burr/record/diary.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/record/repair.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using namespace test;

constexpr CourseKind kAllKinds[] = {
    CourseKind::step_begun, CourseKind::step_done,    CourseKind::step_reopened,
    CourseKind::help_shown, CourseKind::help_hidden,  CourseKind::warning,
    CourseKind::question,   CourseKind::answer,       CourseKind::pause,
    CourseKind::resume,     CourseKind::complication, CourseKind::self_mark,
    CourseKind::done,       CourseKind::reopened,     CourseKind::ended,
    CourseKind::continued};

double number(Random& random) { return std::normal_distribution<double>(0, 1)(random); }

View any_view(std::uint64_t tick, Random& random) {
  const math::Quat q =
      math::Quat(number(random), number(random), number(random), number(random)).normalized();
  const auto flag = [&random] { return random() % 2 == 0; };
  View view;
  view.tick = tick;
  view.eye = {number(random), number(random), number(random)};
  view.right = q * math::Vec3::UnitX();
  view.up = q * math::Vec3::UnitY();
  view.back = q * math::Vec3::UnitZ();
  view.field_of_view = std::abs(number(random));
  view.magnification = magnification_of(1.0 / 3 + std::abs(number(random)));
  view.see_through = 1.0 / 3;
  view.colours = flag();
  view.slices = flag();
  view.panels = flag();
  view.two_eyes = flag();
  return view;
}

CourseEvent any_event(std::uint64_t tick, Random& random) {
  CourseEvent event{tick, kAllKinds[random() % std::size(kAllKinds)], "step-1", "sigmoid sinus",
                    "übermäßig"};
  if (event.kind == CourseKind::ended) event.value = word_of(Ending::time_up);
  return event;
}

SessionInfo someone(Random& random, const volume::Bone& bone) {
  SessionInfo info = info_of(bone, random);
  info.identity =
      Identity{Mode::practise, "kestrel-27", 3, 0, random(), labels_hash(bone), {"facial nerve"}};
  info.shaft = Shaft{1.2e-3, 1.0 / 7};
  return info;
}

// A session of `ticks`, with a view every 150 ticks and an event every 77.
struct Noted {
  SessionInfo info;
  std::vector<View> views;
  std::vector<CourseEvent> events;
};
Noted record_notes(const std::string& path, std::uint64_t ticks, Random& random, bool finish = true,
                   Recorder* other = nullptr) {
  Noted truth;
  const auto bone = any_bone(random);
  truth.info = someone(random, *bone);
  Recorder own(1000);
  Recorder& recorder = other != nullptr ? *other : own;
  EXPECT_TRUE(recorder.start(path, truth.info).ok());
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    recorder.wait_for_room();
    EXPECT_TRUE(recorder.ticks().push(any_tick(tick, random)));
    if (tick % 150 == 0) {
      truth.views.push_back(any_view(tick, random));
      EXPECT_TRUE(recorder.note(truth.views.back()).ok());
    }
    if (tick % 77 == 0) {
      truth.events.push_back(any_event(tick, random));
      EXPECT_TRUE(recorder.note(truth.events.back()).ok());
    }
  }
  if (finish) {
    const auto done = recorder.finish();
    EXPECT_TRUE(done) << done.error().text;
    EXPECT_EQ(done->views, truth.views.size());
    EXPECT_EQ(done->events, truth.events.size());
    EXPECT_TRUE(done->whole());
  }
  return truth;
}

TEST(Notes, ViewCourseAndIdentityComeBackToTheBit) {
  BURR_SEEDED(random, 20261126);
  const Folder folder;
  const Noted truth = record_notes(folder / "s.mcap", 5000, random);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_EQ((*player)->views(), truth.views);
  EXPECT_EQ((*player)->course(), truth.events);
  EXPECT_EQ((*player)->info().identity, truth.info.identity);
  EXPECT_EQ((*player)->info().shaft, truth.info.shaft);
  EXPECT_EQ((*player)->lacks(), "");
  EXPECT_TRUE((*player)->notices().empty());
  EXPECT_EQ((*player)->end_tick(), 5000U);
}

TEST(Notes, AllKindsEndingsAndModesHaveAWordOfTheirOwn) {
  std::set<std::string> words;
  for (const CourseKind kind : kAllKinds) words.insert(word_of(kind));
  EXPECT_EQ(words.size(), std::size(kAllKinds));
  for (const Ending ending : {Ending::declared_done, Ending::time_up, Ending::broke_off})
    EXPECT_EQ(ending_of(word_of(ending)), ending);
  for (const Mode mode : {Mode::free, Mode::learn, Mode::practise, Mode::exam})
    EXPECT_EQ(mode_of(word_of(mode)), mode);
  EXPECT_FALSE(ending_of("finished"));
  EXPECT_FALSE(mode_of("Exam"));
}

// The times of the chunks must not go back, whatever the ticks of the notes: the player finds ticks
// by them.
TEST(Notes, ANoteOfAnEarlierTickPutsNoChunkOutOfOrder) {
  BURR_SEEDED(random, 5);
  const Folder folder;
  const auto bone = any_bone(random);
  Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", someone(random, *bone)).ok());
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    recorder.wait_for_room();
    ASSERT_TRUE(recorder.ticks().push(any_tick(tick, random)));
    if (tick % 500 == 499) {
      while (recorder.written_ticks() <= tick)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ASSERT_TRUE(recorder.note(any_view(1, random)).ok());
      ASSERT_TRUE(recorder.note(CourseEvent{tick + 1000000, CourseKind::pause, "page"}).ok());
    }
  }
  ASSERT_TRUE(recorder.finish());
  const auto reader = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(reader) << reader.error().text;
  std::uint64_t last = 0;
  for (const auto& chunk : (*reader)->chunks()) {
    EXPECT_GE(chunk.start_ns, last);
    last = chunk.end_ns;
  }
  EXPECT_LE(last, 2999000000U) << "a note is not later than the last tick";
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_EQ((*player)->views().size(), 6U);
  EXPECT_EQ((*player)->course().size(), 6U);
}

// A reader that does not know a channel: today's, with two channels and fields of tomorrow.
TEST(Notes, AReaderPassesOverChannelsThatItDoesNotKnow) {
  BURR_SEEDED(random, 6);
  const Folder folder;
  const Noted truth = record_notes(folder / "s.mcap", 1500, random);
  auto known = Player::open(folder / "s.mcap");
  ASSERT_TRUE(known);
  const auto from = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(from);
  McapWriter to;
  ASSERT_TRUE(to.open(folder / "t.mcap", "t.mcap").ok());
  for (const mcap::Schema& schema : (*from)->schemas()) ASSERT_TRUE(to.add(schema).ok());
  for (mcap::Channel channel : (*from)->channels()) {
    if (channel.topic == kViews.name || channel.topic == kCourse.name)
      channel.topic = "/of_tomorrow" + channel.topic;
    ASSERT_TRUE(to.add(channel).ok());
  }
  for (std::size_t i = 0; i < (*from)->chunks().size(); ++i) {
    const auto chunk = (*from)->read_chunk(i);
    const auto packed = (*from)->read_packed(i);
    ASSERT_TRUE(chunk && packed);
    mcap::MessageIndexes indexes;
    for (const McapMessage& message : chunk->messages)
      indexes[message.channel].emplace_back(message.time_ns, message.offset);
    ASSERT_TRUE(to.add_chunk((*from)->chunks()[i], chunk->crc, *packed, indexes).ok());
  }
  ASSERT_TRUE(to.finish().ok());

  auto player = Player::open(folder / "t.mcap");
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_TRUE((*player)->notices().empty());
  EXPECT_TRUE((*player)->views().empty());
  EXPECT_TRUE((*player)->course().empty());
  StepCursor a = (*known)->steps(), b = (*player)->steps();
  Step step, other;
  std::size_t ticks = 0;
  for (; a.next(step); ++ticks) {
    ASSERT_TRUE(b.next(other));
    expect_same(step.row, other.row);
  }
  EXPECT_EQ(ticks, 1500U);
  EXPECT_NE((*player)->lacks().find("what the user saw"), std::string::npos);
}

TEST(Notes, AnOlderRecordingSaysWhatItLacks) {
  BURR_SEEDED(random, 8);
  const Folder folder;
  const auto bone = any_bone(random);
  Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", info_of(*bone, random)).ok());  // no identity
  ASSERT_TRUE(recorder.finish());
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_FALSE((*player)->info().identity);
  EXPECT_FALSE((*player)->ending());
  EXPECT_EQ((*player)->lacks(), (folder / "s.mcap") +
                                    ": the recording does not hold mode, learner and attempt, "
                                    "the size of the shaft; an older burr, or another program, "
                                    "wrote it");
  EXPECT_TRUE((*player)->has_course()) << "how it ended is known all the same";
}

// A copy of a file that is still written is what a kill would leave.
TEST(Notes, AKilledSessionKeepsThemAndHasNoEnd) {
  BURR_SEEDED(random, 9);
  const Folder folder;
  Recorder recorder(1000);
  Noted truth = record_notes(folder / "s.mcap", 2000, random, false, &recorder);
  const auto wait_for = [&recorder](std::uint64_t ticks) {
    while (recorder.written_ticks() < ticks)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  wait_for(2000);
  for (std::uint64_t tick = 2000; tick < 2010; ++tick)  // one chunk more, to be torn
    EXPECT_TRUE(recorder.ticks().push(any_tick(tick, random)));
  wait_for(2010);
  std::vector<std::uint8_t> bytes = bytes_of_file(folder / "s.mcap");
  EXPECT_TRUE(recorder.finish());
  std::erase_if(truth.events, [](const auto& one) { return one.kind == CourseKind::ended; });
  bytes.resize(bytes.size() - 3);  // and the last chunk is torn
  write_file(folder / "killed.mcap", bytes);

  const auto examine = [&](const std::string& path) {
    auto player = Player::open(path);
    ASSERT_TRUE(player) << player.error().text;
    const std::vector<View> views = (*player)->views();
    ASSERT_GT(views.size(), truth.views.size() / 2);
    for (std::size_t n = 0; n < views.size(); ++n) EXPECT_EQ(views[n], truth.views[n]);
    std::vector<CourseEvent> course = (*player)->course();
    std::erase_if(course, [](const auto& one) { return one.kind == CourseKind::ended; });
    ASSERT_GT(course.size(), truth.events.size() / 2);
    for (std::size_t n = 0; n < course.size(); ++n) EXPECT_EQ(course[n], truth.events[n]);
    EXPECT_EQ((*player)->info().identity, truth.info.identity);
  };
  examine(folder / "killed.mcap");
  NoProgress quiet;
  const auto report = repair(folder / "killed.mcap", folder / "mended.mcap", quiet);
  ASSERT_TRUE(report) << report.error().text;
  examine(folder / "mended.mcap");
}

TEST(Notes, APseudonymIsNoName) {
  for (const char* good : {"kestrel-27", "a1b", "p-0427", "learner12345"})
    EXPECT_TRUE(check_pseudonym(good).ok()) << good;
  for (const char* bad :
       {"", "ab", "anna", "Anna Svensson", "anna.svensson@hospital.se", "Anna7", "19800312-1234",
        "p19800312", "anna-b1980-03-12", "a1-2-3-4-5-6", "7-kestrel", "a1/b", "../a1", "käthe-1",
        "kestrel-27-of-the-north-wing"}) {
    const Status said = check_pseudonym(bad);
    ASSERT_FALSE(said.ok()) << bad;
    EXPECT_NE(said.error().text.find("kestrel-27"), std::string::npos);
    if (std::string(bad).size() > 2) {
      EXPECT_EQ(said.error().text.find(bad), std::string::npos) << "the name is not repeated";
    }
  }
}

TEST(Notes, WhatIsPrivateNeverReachesTheDisk) {
  BURR_SEEDED(random, 10);
  const Folder folder;
  const auto bone = any_bone(random);
  SessionInfo info = someone(random, *bone);
  info.identity->learner = "Anna Svensson";
  EXPECT_FALSE(check(info).ok());
  info.identity->learner = "";
  EXPECT_TRUE(check(info).ok()) << "nobody need say who";
  info.identity->case_hash = 7;
  EXPECT_FALSE(check(info).ok()) << "there is no case of that hash";
  info.identity->case_hash = 0;

  Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", info).ok());
  for (const std::string& text :
       {std::string("/home/anna/scan"), std::string("1.2.840.113619.2.55"),
        std::string("anna@hospital.se"), std::string("a\x1b[2J"), std::string(121, 'x')}) {
    EXPECT_FALSE(recorder.note(CourseEvent{0, CourseKind::question, text}).ok()) << text;
    EXPECT_FALSE(recorder.note(CourseEvent{0, CourseKind::question, "q", text}).ok()) << text;
    EXPECT_FALSE(recorder.note(CourseEvent{0, CourseKind::answer, "q", "", text}).ok()) << text;
  }
  EXPECT_FALSE(recorder.note(CourseEvent{0, CourseKind::ended, "", "", "well"}).ok());
  View view = any_view(0, random);
  view.eye.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(recorder.note(view).ok());
  view = any_view(0, random);
  view.up *= 2;
  EXPECT_FALSE(recorder.note(view).ok());
  ASSERT_TRUE(recorder.finish());
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player);
  EXPECT_TRUE((*player)->course().empty());
  EXPECT_TRUE((*player)->views().empty());
}

TEST(Notes, LabelsHaveAHashOfTheirOwn) {
  BURR_SEEDED(random, 11);
  const auto bone = any_bone(random);
  const std::uint64_t before = labels_hash(*bone);
  volume::BrickField cut = {};
  volume::BrickIndex brick = 0;
  while (bone->brick_field(brick) == nullptr || bone->is_uniform(brick)) ++brick;
  bone->write_brick(brick, cut);
  EXPECT_EQ(labels_hash(*bone), before) << "milling changes no label";
  const math::Ijk at = bone->brick_ijk(brick);
  const volume::TissueId was = bone->tissue(at.x(), at.y(), at.z());
  bone->set_tissue(at.x(), at.y(), at.z(), static_cast<volume::TissueId>(was == 1 ? 2 : 1));
  EXPECT_NE(labels_hash(*bone), before);
}

// ---- the diary

struct Written {
  Folder folder;
  Recorder recorder{1000};
  Written() {
    Random random(12);
    const auto bone = any_bone(random);
    EXPECT_TRUE(recorder.start(folder / "s.mcap", someone(random, *bone)).ok());
    for (std::uint64_t tick = 0; tick < 2000; ++tick)
      EXPECT_TRUE(recorder.ticks().push(any_tick(tick, random)));
  }
  std::unique_ptr<Player> read() {
    EXPECT_TRUE(recorder.finish());
    auto player = Player::open(folder / "s.mcap");
    EXPECT_TRUE(player) << player.error().text;
    return std::move(*player);
  }
};

std::vector<std::string> words_of(const std::vector<CourseEvent>& course) {
  std::vector<std::string> words;
  for (const CourseEvent& one : course)
    words.push_back(std::to_string(one.tick) + " " + word_of(one.kind) + " " + one.what +
                    one.where + one.value);
  return words;
}

TEST(Diary, WritesAViewWhenItChangedAndAtMostTenTimesASecond) {
  BURR_SEEDED(random, 13);
  Written file;
  Diary diary(file.recorder, 1000);
  View view = any_view(0, random);
  for (std::uint64_t tick = 0; tick < 2000; tick += 16) {
    view.tick = tick;
    if (tick >= 512 && tick < 1024) view.eye.x() += 1e-3;  // it moves for half a second
    diary.look({.view = view});
  }
  diary.end(1999, Ending::broke_off);
  const auto player = file.read();
  const std::vector<View> views = player->views();
  ASSERT_GE(views.size(), 6U);
  EXPECT_LE(views.size(), 7U);
  for (std::size_t n = 1; n < views.size(); ++n) EXPECT_GE(views[n].tick, views[n - 1].tick + 100);
  EXPECT_EQ(views.back().eye, view.eye) << "where it came to rest is kept";
  EXPECT_EQ(player->ending(), Ending::broke_off);
}

TEST(Diary, KeepsTheLastViewOfASessionThatEndsInAMove) {
  BURR_SEEDED(random, 14);
  Written file;
  Diary diary(file.recorder, 1000);
  View view = any_view(1900, random);
  diary.look({.view = view});
  view.tick = 1950;
  view.panels = !view.panels;
  diary.look({.view = view});
  diary.end(1960, Ending::time_up);
  EXPECT_EQ(file.read()->views().back(), view);
}

TEST(Diary, AWarningIsKeptEvenIfTheNameOfTheStructureIsNot) {
  Written file;
  Diary diary(file.recorder, 1000);
  for (const std::string& name :
       {std::string("1.2.840.113619.2.55"), std::string(200, 'n'), std::string("facial nerve")}) {
    Sight sight;
    sight.near = name;
    diary.look(sight);
    sight.near = "";
    diary.look(sight);
  }
  const std::vector<std::string> want = {"0 warning neara structure", "0 warning neara structure",
                                         "0 warning nearfacial nerve"};
  EXPECT_EQ(words_of(file.read()->course()), want);
}

TEST(Diary, TellsHelpsWarningsAndPausesOnce) {
  Written file;
  Diary diary(file.recorder, 1000);
  Sight sight;
  const auto look = [&](std::uint64_t tick) {
    sight.view.tick = tick;
    diary.look(sight);
  };
  sight.helps = {"labels", "task"};
  look(0);
  look(10);
  sight.helps = {"labels"};
  sight.near = "facial nerve";
  look(20);
  look(30);
  sight.near = "";
  sight.paused = "page";
  look(40);
  sight.paused = "stopped";
  look(50);
  sight.paused = "";
  sight.near = "facial nerve";
  look(60);
  diary.declare_done(70, true);
  diary.declare_done(71, true);
  diary.declare_done(80, false);
  diary.declare_done(90, true);
  diary.end(100, Ending::broke_off);
  diary.end(101, Ending::time_up);
  sight.helps.clear();
  look(110);
  const auto player = file.read();
  const std::vector<std::string> want = {"0 help_shown labels",    "0 help_shown task",
                                         "20 help_hidden task",    "20 warning nearfacial nerve",
                                         "40 pause page",          "50 resume page",
                                         "50 pause stopped",       "60 warning nearfacial nerve",
                                         "60 resume stopped",      "70 done ",
                                         "80 reopened ",           "90 done ",
                                         "100 ended declared done"};
  EXPECT_EQ(words_of(player->course()), want);
  EXPECT_EQ(player->ending(), Ending::declared_done) << "who declared it done did not break off";
}

}  // namespace
}  // namespace burr::record

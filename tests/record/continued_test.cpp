// A recording that goes on: what two sessions gave to the recorder comes out as one, to the bit.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "burr/record/chain.h"
#include "burr/record/diary.h"
#include "burr/record/earlier_part.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/record/repair.h"
#include "burr/tick/tick_hash.h"
#include "record/forged.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using namespace test;

// A sum of numbers that are none would compare with nothing.
tick::TickRow plain_tick(std::uint64_t tick, Random& random) {
  tick::TickRow row = any_tick(tick, random);
  const auto number = [&random] { return std::normal_distribution<double>(0, 1)(random); };
  row.ledger = {number(), number(), number(), number(), number(), number(), number(), number()};
  return row;
}

// Goes on with the file, as a session does whose servo counts from 0.
Truth go_on(const std::string& path, std::uint64_t count, volume::Bone& bone, Random& random,
            bool finish = true) {
  Truth truth;
  auto player = Player::open(path);
  EXPECT_TRUE(player) << player.error().text;
  auto part = (*player)->earlier_part();
  EXPECT_TRUE(part) << part.error().text;
  part->sha1 = std::string(40, 'a');
  truth.info = info_of(bone, random);
  auto recorder = std::make_unique<Recorder>(1000);
  const Status started = recorder->start(path, truth.info, nullptr, {}, &*part);
  EXPECT_TRUE(started.ok()) << started.error().text;
  Diary diary(*recorder, 1000);
  for (std::uint64_t tick = 0; tick < count; ++tick) {
    recorder->wait_for_room();
    if (tick % 40 == 7) {
      truth.commands.push_back({tick, {tick::CommandKind::stiffness, any(random)}});
      EXPECT_TRUE(recorder->commands().push(truth.commands.back()));
    }
    for (const tick::BrickRow& row : nibble(bone, tick, random)) {
      truth.bricks.push_back(row);
      EXPECT_TRUE(recorder->bricks().push(row));
    }
    truth.ticks.push_back(plain_tick(tick, random));
    EXPECT_TRUE(recorder->ticks().push(truth.ticks.back()));
  }
  diary.end(count > 0 ? count - 1 : 0, Ending::broke_off);
  if (finish) {
    const auto account = recorder->finish();
    EXPECT_TRUE(account.ok()) << account.error().text;
    truth.account = *account;
  }
  // counted on, as the file says it
  const std::uint64_t first = part->ticks;
  std::uint64_t last = part->hand.hash;
  for (tick::TickRow& row : truth.ticks) {
    row.tick += first;
    row.ledger = part->hand.ledger + row.ledger;
    row.hash = last = tick::tick_hash(row, last);
  }
  for (tick::CommandRow& row : truth.commands) row.tick += first;
  for (tick::BrickRow& row : truth.bricks) row.tick += first;
  return truth;
}

void append(Truth& to, const Truth& more) {
  to.ticks.insert(to.ticks.end(), more.ticks.begin(), more.ticks.end());
  to.commands.insert(to.commands.end(), more.commands.begin(), more.commands.end());
  to.bricks.insert(to.bricks.end(), more.bricks.begin(), more.bricks.end());
}

void expect_all(Player& player, const Truth& truth) {
  ASSERT_EQ(player.end_tick(), truth.ticks.size());
  StepCursor steps = player.steps();
  std::size_t tick = 0, command = 0;
  for (Step step; steps.next(step); ++tick) {
    ASSERT_LT(tick, truth.ticks.size());
    expect_same(step.row, truth.ticks[tick]);
    EXPECT_EQ(step.gap, player.begins_part(tick)) << tick;
    command += step.commands.size();
  }
  EXPECT_EQ(tick, truth.ticks.size());
  EXPECT_EQ(command, truth.commands.size());
  BrickCursor bricks = player.bricks();
  std::size_t brick = 0;
  for (tick::BrickRow row; bricks.next(row); ++brick) {
    ASSERT_LT(brick, truth.bricks.size());
    ASSERT_EQ(row.tick, truth.bricks[brick].tick);
    ASSERT_EQ(row.brick, truth.bricks[brick].brick);
    ASSERT_EQ(std::memcmp(&row.field, &truth.bricks[brick].field, sizeof row.field), 0);
  }
  EXPECT_EQ(brick, truth.bricks.size());
}

// The first part, with plain numbers in its account.
Truth first_part(const std::string& path, std::uint64_t count, volume::Bone& bone, Random& random,
                 bool embed) {
  Truth truth;
  truth.info = info_of(bone, random);
  Recorder recorder(1000);
  EXPECT_TRUE(recorder.start(path, truth.info, embed ? &bone : nullptr).ok());
  std::uint64_t last = 0;
  for (std::uint64_t tick = 0; tick < count; ++tick) {
    recorder.wait_for_room();
    for (const tick::BrickRow& row : nibble(bone, tick, random)) {
      truth.bricks.push_back(row);
      EXPECT_TRUE(recorder.bricks().push(row));
    }
    truth.ticks.push_back(plain_tick(tick, random));
    truth.ticks.back().hash = last = tick::tick_hash(truth.ticks.back(), last);
    EXPECT_TRUE(recorder.ticks().push(truth.ticks.back()));
  }
  EXPECT_TRUE(recorder.finish());
  return truth;
}

TEST(Continued, SeveralPartsAreOneRecordingToTheBit) {
  BURR_SEEDED(random, 20261130);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  const auto bone = any_bone(random);
  auto shown = any_bone(random);  // of another seed: replaced below
  Truth all = first_part(path, 25'000, *bone, random, true);
  const std::uint64_t after_first = bone->content_hash();
  const Truth second = go_on(path, 12'000, *bone, random);
  const std::uint64_t after_second = bone->content_hash();
  const Truth third = go_on(path, 300, *bone, random);
  append(all, second);
  append(all, third);

  auto player = Player::open(path);
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_TRUE((*player)->finished());
  EXPECT_TRUE((*player)->notices().empty()) << (*player)->notices().front();
  expect_all(**player, all);
  ASSERT_EQ((*player)->continued().size(), 2U);
  EXPECT_EQ((*player)->continued()[0].first_tick, 25'000U);
  EXPECT_EQ((*player)->continued()[1].first_tick, 37'000U);
  EXPECT_EQ((*player)->continued()[0].goes_on_with, std::string(40, 'a'));
  EXPECT_EQ((*player)->continued()[0].volume.content_hash, after_first);
  EXPECT_EQ((*player)->info().first_tick, 0U);

  // the bone of any moment, in any order
  auto embedded = (*player)->embedded_bone();
  ASSERT_TRUE(embedded) << embedded.error().text;
  for (const auto& [t, hash] : {std::pair{36.999, after_second},
                                {24.999, after_first},
                                {1e9, bone->content_hash()},
                                {24.999, after_first}}) {
    const Status there = (*player)->bone_at(t, **embedded);
    ASSERT_TRUE(there) << there.error().text;
    EXPECT_EQ((*embedded)->content_hash(), hash) << t;
  }
  EXPECT_EQ((*player)->ending(), Ending::broke_off);
  std::size_t came_back = 0;
  for (const CourseEvent& event : (*player)->course())
    if (event.kind == CourseKind::continued) ++came_back;
  EXPECT_EQ(came_back, 2U);
}

TEST(Continued, APartThatWasKilledLeavesAFileThatIsRepairedAndContinued) {
  BURR_SEEDED(random, 20261201);
  const Folder folder;
  const std::string path = folder / "s.mcap", torn = folder / "torn.mcap";
  const auto bone = any_bone(random);
  Truth all = first_part(path, 3000, *bone, random, false);
  const Truth second = go_on(path, 3000, *bone, random);
  append(all, second);
  // as after a kill: without summary and footer
  std::vector<std::uint8_t> bytes = bytes_of_file(path);
  bytes.resize(bytes.size() - 3000);
  write_file(torn, bytes);
  auto player = Player::open(torn);
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_FALSE((*player)->finished());
  EXPECT_EQ((*player)->continued().size(), 1U);
  const std::uint64_t kept = (*player)->end_tick();
  EXPECT_GT(kept, 3000U);
  auto part = (*player)->earlier_part();
  ASSERT_TRUE(part) << part.error().text;
  EXPECT_EQ(part->ticks, kept);

  Truth cut = all;
  cut.ticks.resize(kept);
  const auto later = [kept](const auto& row) { return row.tick >= kept; };
  std::erase_if(cut.commands, later);
  std::erase_if(cut.bricks, later);
  {
    Recorder recorder(1000);
    const Status started = recorder.start(torn, info_of(*bone, random), nullptr, {}, &*part);
    ASSERT_TRUE(started.ok()) << started.error().text;
    tick::TickRow row = plain_tick(0, random);
    ASSERT_TRUE(recorder.ticks().push(row));
    ASSERT_TRUE(recorder.finish());
    row.tick = kept;
    row.ledger = part->hand.ledger + row.ledger;
    row.hash = tick::tick_hash(row, part->hand.hash);
    cut.ticks.push_back(row);
  }
  auto again = Player::open(torn);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_TRUE((*again)->finished());
  EXPECT_EQ((*again)->ending(), std::nullopt) << "it came back after the end";
  expect_all(**again, cut);
  NoProgress quiet;
  const auto report = repair(torn, torn, quiet);
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_TRUE(report->was_whole);
  EXPECT_EQ(report->ticks, kept + 1);
}

// What check_chain() says of a copy that somebody changed; "": nothing was found.
std::string found_in(const std::string& path, const std::function<bool(tick::TickRow&)>& change,
                     const char* topic = kTicks.name) {
  const std::string copy = path + ".copy";
  std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
  forge(copy, change, topic);
  const auto player = Player::open(copy);
  EXPECT_TRUE(player) << player.error().text;
  NoProgress quiet;
  const Status whole = check_chain(**player, quiet);
  return whole ? "" : whole.error().text;
}

TEST(Continued, TheChainGoesOnOverEachJointSoThatForgingIsFoundOnBothSides) {
  BURR_SEEDED(random, 20261204);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  const auto bone = any_bone(random);
  static_cast<void>(first_part(path, 300, *bone, random, false));
  static_cast<void>(go_on(path, 200, *bone, random));
  static_cast<void>(go_on(path, 200, *bone, random));
  EXPECT_EQ(found_in(path, [](tick::TickRow&) { return true; }), "") << "nobody changed it";
  for (const std::uint64_t at : {0U, 299U, 300U, 301U, 450U, 499U, 500U, 699U}) {
    const auto changed = [&](const auto& change) {
      return found_in(path, [&](tick::TickRow& row) {
        if (row.tick == at) change(row);
        return true;
      });
    };
    const std::string wanted = "tick " + std::to_string(at) + " was changed";
    for (const std::string& said : {changed([](tick::TickRow& row) { row.contact.force.x() = 17; }),
                                    changed([](tick::TickRow& row) { row.ledger.removed = 17; }),
                                    changed([](tick::TickRow& row) { row.hash ^= 1U; })})
      EXPECT_NE(said.find(wanted), std::string::npos) << said;
  }
  // the last ticks before a joint, or the first ones behind it, taken out
  for (const std::uint64_t from : {290U, 300U}) {
    const std::string said = found_in(
        path, [&](tick::TickRow& row) { return row.tick < from || row.tick >= from + 10; });
    EXPECT_NE(said.find("the ticks before " + std::to_string(from + 10) + " are missing"),
              std::string::npos)
        << said;
  }
}

// The other hand has a chain and a ledger of its own.
TEST(Continued, TheSecondHandIsCountedOnToo) {
  BURR_SEEDED(random, 20261205);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  const auto bone = any_bone(random);
  SessionInfo info = info_of(*bone, random);
  info.second.emplace().device = "a second hand";
  double removed = 0;
  std::shared_ptr<const EarlierPart> earlier;
  for (int part = 0; part < 3; ++part) {
    Recorder recorder(1000, 8192, false, true);
    const Status started = recorder.start(path, info, nullptr, {}, earlier.get());
    ASSERT_TRUE(started) << started.error().text;
    std::uint64_t last = 0, second_last = 0;
    for (std::uint64_t tick = 0; tick < 100; ++tick) {
      tick::TickRow row = plain_tick(tick, random), second = plain_tick(tick, random);
      second.ledger.removed = static_cast<double>(tick);
      row.hash = last = tick::tick_hash(row, last);
      second.hash = second_last = tick::tick_hash(second, second_last);
      ASSERT_TRUE(recorder.second()->push(second));
      ASSERT_TRUE(recorder.ticks().push(row));
    }
    removed += 99;
    ASSERT_TRUE(recorder.finish());
    auto player = Player::open(path);
    ASSERT_TRUE(player) << player.error().text;
    const auto step = (*player)->step_at(1e9);
    ASSERT_TRUE(step && step->second);
    EXPECT_EQ(step->second->tick, static_cast<std::uint64_t>(100 * part + 99));
    EXPECT_EQ(step->second->ledger.removed, removed);
    auto next = (*player)->earlier_part();
    ASSERT_TRUE(next) << next.error().text;
    earlier = std::make_shared<const EarlierPart>(std::move(*next));
  }
  EXPECT_EQ(found_in(path, [](tick::TickRow&) { return true; }), "");
  const std::string said = found_in(
      path,
      [](tick::TickRow& row) {
        if (row.tick == 150) row.contact.force.x() = 17;
        return true;
      },
      kSecond.name);
  EXPECT_NE(said.find("tick 150 of the second hand was changed"), std::string::npos) << said;
}

TEST(Continued, WhatReadersCouldNotKnowIsRefusedAndTheFileStays) {
  BURR_SEEDED(random, 20261202);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  const auto bone = any_bone(random);
  static_cast<void>(first_part(path, 500, *bone, random, false));
  const auto before = bytes_of_file(path);
  auto player = Player::open(path);
  ASSERT_TRUE(player);
  auto part = (*player)->earlier_part();
  ASSERT_TRUE(part);
  const auto refused = [&](const SessionInfo& info, double rate, bool second, const char* why) {
    Recorder recorder(rate, 8192, false, second);
    const Status started = recorder.start(path, info, nullptr, {}, &*part);
    ASSERT_FALSE(started.ok()) << why;
    EXPECT_EQ(started.error().trouble, Trouble::usage);
    EXPECT_NE(started.error().text.find(why), std::string::npos) << started.error().text;
    EXPECT_EQ(bytes_of_file(path), before);
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  };
  SessionInfo info = info_of(*bone, random);
  refused(info, 4000, false, "it had 1000 ticks a second and would have 4000 now");
  info.second.emplace();
  refused(info, 1000, true, "it had no second hand and has one now");
  info.second.reset();
  info.tools.emplace_back().name = "saw";
  refused(info, 1000, false, "its tools are not those of now");
}

TEST(Continued, ARecordingThatWasNeverContinuedKeepsItsBytes) {
  BURR_SEEDED(random, 20261203);
  const auto bone = any_bone(random);
  const std::string text = to_json(info_of(*bone, random));
  EXPECT_EQ(text.find("continued"), std::string::npos);
}

}  // namespace
}  // namespace burr::record

#include "burr/record/recorder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "burr/record/player.h"
#include "burr/record/schema.h"
#include "record/made_up.h"
#include "support/rt_guard.h"

namespace burr::record {
namespace {

using namespace test;

void expect_same_rows(Player& player, const Truth& truth) {
  ASSERT_EQ(player.end_tick(), truth.ticks.size());
  StepCursor steps = player.steps();
  Step step;
  std::size_t tick = 0, command = 0;
  while (steps.next(step)) {
    ASSERT_LT(tick, truth.ticks.size());
    expect_same(step.row, truth.ticks[tick]);
    EXPECT_FALSE(step.gap);
    for (const tick::Command& got : step.commands) {
      ASSERT_LT(command, truth.commands.size());
      EXPECT_EQ(truth.commands[command].tick, step.row.tick);
      EXPECT_EQ(truth.commands[command].command.kind, got.kind);
      const double want = truth.commands[command].command.value;
      EXPECT_TRUE(std::isnan(want) ? std::isnan(got.value)
                                   : std::bit_cast<std::uint64_t>(want) ==
                                         std::bit_cast<std::uint64_t>(got.value));
      ++command;
    }
    ++tick;
  }
  EXPECT_EQ(tick, truth.ticks.size());
  EXPECT_EQ(command, truth.commands.size());

  BrickCursor bricks = player.bricks();
  tick::BrickRow row;
  std::size_t brick = 0;
  while (bricks.next(row)) {
    ASSERT_LT(brick, truth.bricks.size());
    const tick::BrickRow& want = truth.bricks[brick++];
    ASSERT_EQ(row.tick, want.tick);
    ASSERT_EQ(row.brick, want.brick);
    ASSERT_EQ(std::memcmp(&row.field, &want.field, sizeof row.field), 0);
    ASSERT_EQ(row.has_tissue, want.has_tissue);
    if (row.has_tissue) {
      ASSERT_EQ(row.tissue, want.tissue);
    }
  }
  EXPECT_EQ(brick, truth.bricks.size());
}

TEST(Recorder, WhatGoesInComesOutToTheBit) {
  BURR_SEEDED(random, 20260901);
  const Folder folder;
  for (const double rate_hz : {500.0, 1000.0, 10000.0}) {
    const auto bone = any_bone(random);
    const std::string path = folder / "s.mcap";
    const Truth truth = record_any(path, 3000, rate_hz, *bone, random);
    EXPECT_TRUE(truth.account.whole());
    EXPECT_EQ(truth.account.ticks, 3000U);
    EXPECT_EQ(truth.account.bytes, std::filesystem::file_size(path));
    auto player = Player::open(path);
    ASSERT_TRUE(player.ok()) << player.error().text;
    EXPECT_TRUE((*player)->finished());
    EXPECT_TRUE((*player)->notices().empty());
    EXPECT_DOUBLE_EQ((*player)->seconds(), 3000 / rate_hz);
    expect_same_rows(**player, truth);
  }
}

TEST(Recorder, TheSessionIsDescribedToTheBit) {
  BURR_SEEDED(random, 7);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_any(folder / "s.mcap", 10, 1000, *bone, random);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok()) << player.error().text;
  const SessionInfo& info = (*player)->info();
  EXPECT_EQ(info.seed, truth.info.seed);
  EXPECT_EQ(info.numbers, truth.info.numbers);
  EXPECT_EQ(info.words, truth.info.words);
  EXPECT_EQ(info.volume.content_hash, truth.info.volume.content_hash);
  EXPECT_EQ(info.volume.source_fingerprint, truth.info.volume.source_fingerprint);
  EXPECT_EQ(info.volume.format, truth.info.volume.format);
  EXPECT_TRUE(info.volume.recipe == truth.info.volume.recipe);
  EXPECT_EQ(info.volume.recipe.reserve_bricks, truth.info.volume.recipe.reserve_bricks);
  EXPECT_EQ(info.volume.grid.size, truth.info.volume.grid.size);
  EXPECT_EQ(info.volume.grid.voxel, truth.info.volume.grid.voxel);
  EXPECT_EQ(info.volume.grid.frame.p, truth.info.volume.grid.frame.p);
  EXPECT_EQ(info.volume.grid.frame.q.coeffs(), truth.info.volume.grid.frame.q.coeffs());
  ASSERT_EQ(info.volume.tissues.tissues.size(), 3U);
  EXPECT_EQ(info.volume.tissues[2].name, "facial nerve");
  EXPECT_TRUE(info.volume.tissues[2].spare);
  EXPECT_EQ(info.volume.tissues[2].colour, truth.info.volume.tissues[2].colour);
  EXPECT_FALSE(info.embedded);
  EXPECT_FALSE(info.build.empty());
}

TEST(Recorder, AMoveOfAPieceComesBackToTheBit) {
  tick::CommandRow row;
  row.tick = 77;
  row.command.kind = tick::CommandKind::move_piece;
  row.command.value = 3;
  row.command.move = {3,
                      {5, -6, 700},
                      {0.1, -1e-17, 1.0 / 3},
                      {0.6, 0, 1e-300, 0.8},
                      0xfedcba9876543210ULL,
                      0x0123456789abcdefULL,
                      0xffffffffffffffffULL,
                      true};
  tick::CommandRow back;
  ASSERT_TRUE(command_from_json(to_json(row), back)) << to_json(row);
  EXPECT_EQ(back.tick, row.tick);
  EXPECT_EQ(back.command.kind, row.command.kind);
  EXPECT_EQ(back.command.move, row.command.move);
  for (
      const char* broken :
      {R"({"tick":1,"kind":"move_piece","value":0})",
       R"({"tick":1,"kind":"move_piece","value":-1,"piece":{"seed":[1,2,3],"by_m":[0,0,0],"turn_xyzw":[0,0,0,1],"writes":1,"bricks":"0x1"}})",
       R"({"tick":1,"kind":"move_piece","value":0,"piece":{"seed":[1,2],"by_m":[0,0,0],"turn_xyzw":[0,0,0,1],"writes":1,"bricks":"0x1"}})",
       R"({"tick":1,"kind":"move_piece","value":0,"piece":{"seed":[1,2,9e9],"by_m":[0,0,0],"turn_xyzw":[0,0,0,1],"writes":1,"bricks":"0x1"}})",
       R"({"tick":1,"kind":"move_piece","value":0,"piece":{"seed":[1,2,3],"by_m":[0,0,0],"turn_xyzw":[0,0,0,1],"writes":-1,"bricks":"0x1"}})",
       R"({"tick":1,"kind":"move_piece","value":0,"piece":{"seed":[1,2,3],"by_m":[0,0,0],"turn_xyzw":[0,0,0,1],"writes":1,"bricks":"0xyz"}})"})
    EXPECT_FALSE(command_from_json(broken, back)) << broken;
}

TEST(Recorder, EveryFieldOfATickHasAColumn) {
  // a member of the structs without a column would be lost silently: the sizes must add up
  tick::TickRow row;
  std::size_t fields = sizeof row.tick + sizeof row.spindle_rad_s + sizeof row.cutting_nm +
                       sizeof row.cutting_w + sizeof row.took_us + sizeof row.late_us +
                       sizeof row.hash;
  fields += sizeof(edit::Ledger);       // doubles only, no padding
  fields += sizeof(device::HandState);  // has 3 byte of padding after `valid`
  fields += sizeof(haptics::Contact);   // 3 byte after `touching`
  fields += sizeof(tool::ToolState);    // 3 byte after `irrigated`
  fields += sizeof(tick::PieceRow);     // 4 byte after `state`
  fields += sizeof(tick::LawRow);
  EXPECT_EQ(fields, sizeof(tick::TickRow))
      << "a new field in TickRow: add its column in tick_columns.cpp";
  EXPECT_EQ(tick_columns_size(), sizeof(tick::TickRow) - 3 - 3 - 3 - 4)
      << "a new field in HandState, Contact, Ledger, ToolState or PieceRow: add its column in "
         "tick_columns.cpp";
}

TEST(Recorder, AToolThatStaysCostsAMessageOneValueAColumn) {
  BURR_SEEDED(random, 22);
  std::vector<tick::TickRow> rows;
  for (std::uint64_t tick = 0; tick < 10; ++tick) rows.push_back(any_tick(tick, random));
  const auto size = [&rows] {
    BytesOut message;
    encode_ticks(rows, message);
    std::vector<tick::TickRow> back;
    EXPECT_TRUE(decode_ticks(message.span(), back));
    EXPECT_EQ(back.size(), rows.size());
    for (std::size_t n = 0; n < back.size(); ++n) expect_same(back[n], rows[n]);
    return message.size();
  };
  const std::size_t same = size();
  rows[9].tool.irrigated = !rows[9].tool.irrigated;
  const std::size_t changed = size();
  EXPECT_EQ(changed - same, 9 * (8 + 8 + 4 * 5 + 1U)) << "then each row has its own";
}

TEST(Recorder, ToolsThatCannotBeMakeAMessageMalformed) {
  BURR_SEEDED(random, 23);
  const tick::TickRow good = any_tick(0, random);
  std::vector<tick::TickRow> odd(8, good);
  odd[0].tool.radius = -1e-3;
  odd[1].tool.radius = std::numeric_limits<double>::quiet_NaN();
  odd[2].tool.radius = 1;
  odd[3].tool.full_speed = std::numeric_limits<double>::infinity();
  odd[4].tool.kind = static_cast<tool::BurrKind>(2);
  odd[5].tool.mode = static_cast<tool::Mode>(5);
  odd[6].tool.mode = static_cast<tool::Mode>(-1);
  odd[7].tool.mirror_axis = 3;
  for (std::size_t n = 0; n < odd.size(); ++n) {
    BytesOut message;
    encode_ticks({&odd[n], 1}, message);
    std::vector<tick::TickRow> back = {good};
    EXPECT_FALSE(decode_ticks(message.span(), back)) << n;
    EXPECT_EQ(back.size(), 1U) << "nothing is appended";
  }
}

TEST(Recorder, ThePushesOfATickNeitherAllocateNorLock) {
  Random random(1);
  const auto bone = any_bone(random);
  const Folder folder;
  Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", info_of(*bone, random)).ok());
  const tick::TickRow tick = any_tick(0, random);
  const tick::BrickRow brick{.tick = 0, .brick = 3};
  {
    const burr::test::RtGuard guard;
    for (int i = 0; i < 100; ++i) {
      recorder.commands().push({});
      recorder.bricks().push(brick);
      recorder.ticks().push(tick);
    }
    EXPECT_EQ(guard.allocations(), 0);
    EXPECT_EQ(guard.locks(), 0);
  }
  EXPECT_TRUE(recorder.finish().ok());
}

TEST(Recorder, RowsThatFindTheRingFullAreCountedInTheFile) {
  Random random(2);
  const auto bone = any_bone(random);
  const Folder folder;
  Recorder recorder(1000, 64);
  // before start() nobody empties the rings: they hold 4 s of ticks, rounded up to 4096
  for (std::uint64_t tick = 0; tick < 5000; ++tick) recorder.ticks().push(any_tick(tick, random));
  for (int i = 0; i < 100; ++i) recorder.bricks().push({.tick = 1, .brick = i % 7});
  for (int i = 0; i < 1030; ++i) recorder.commands().push({});
  ASSERT_TRUE(recorder.start(folder / "s.mcap", info_of(*bone, random)).ok());
  // the recorder goes on afterwards, with a visible gap
  while (recorder.ticks().size() > 0) std::this_thread::yield();
  recorder.ticks().push(any_tick(5000, random));
  const auto account = recorder.finish();
  ASSERT_TRUE(account.ok()) << account.error().text;
  EXPECT_EQ(account->dropped_ticks, 5000U - 4096U);
  EXPECT_EQ(account->dropped_bricks, 36U);
  EXPECT_EQ(account->dropped_commands, 6U);
  EXPECT_FALSE(account->whole());

  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok()) << player.error().text;
  EXPECT_EQ((*player)->dropped_ticks(), 5000U - 4096U);
  EXPECT_EQ((*player)->dropped_bricks(), 36U);
  EXPECT_EQ((*player)->dropped_commands(), 6U);
  EXPECT_EQ((*player)->notices().size(), 1U);
  StepCursor steps = (*player)->steps();
  Step step;
  int gaps = 0;
  std::uint64_t rows = 0;
  for (; steps.next(step); ++rows) gaps += step.gap ? 1 : 0;
  EXPECT_EQ(rows, 4097U);
  EXPECT_EQ(gaps, 1);
}

TEST(Recorder, AnOlderRecordingIsReplacedOnlyByANewOneThatBegan) {
  Random random(3);
  const auto bone = any_bone(random);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  record_any(path, 100, 1000, *bone, random);
  const auto before = bytes_of_file(path);
  {
    SessionInfo bad = info_of(*bone, random);
    bad.words["source"] = "/home/somebody/ct";
    Recorder recorder(1000);
    EXPECT_FALSE(recorder.start(path, bad).ok());
  }
  EXPECT_EQ(bytes_of_file(path), before);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.mcap"}) << "nothing half-written is left";
  record_any(path, 200, 1000, *bone, random);
  auto player = Player::open(path);
  ASSERT_TRUE(player.ok());
  EXPECT_EQ((*player)->end_tick(), 200U);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.mcap"});
}

TEST(Recorder, WhatAnotherUsersBurrLeftWhenItWasKilledIsNoHindrance) {
  if (::getuid() != 0) GTEST_SKIP() << "only root can be two users";
  const Folder folder;
  const std::string path = folder / "s.mcap";
  std::filesystem::permissions(std::filesystem::path(path).parent_path(),
                               std::filesystem::perms::all);
  std::ofstream(path + ".part") << "half a recording";
  std::filesystem::permissions(path + ".part", std::filesystem::perms(0644));
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(10);
    Random random(1);
    const auto bone = any_bone(random);
    Recorder recorder(1000, 8192, false);
    ::_exit(recorder.start(path, info_of(*bone, random)) ? 0 : 11);
  }
  int state = 0;
  ASSERT_EQ(::waitpid(child, &state, 0), child);
  EXPECT_TRUE(WIFEXITED(state));
  EXPECT_EQ(WEXITSTATUS(state), 0);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(Recorder, TwoCannotWriteTheSameFile) {
  Random random(4);
  const auto bone = any_bone(random);
  const Folder folder;
  Recorder one(1000), two(1000);
  ASSERT_TRUE(one.start(folder / "s.mcap", info_of(*bone, random)).ok());
  const Status second = two.start(folder / "s.mcap", info_of(*bone, random));
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().trouble, Trouble::io);
  EXPECT_TRUE(one.finish().ok());
}

TEST(Recorder, AFolderThatIsNotThereIsNamed) {
  Random random(5);
  const auto bone = any_bone(random);
  const Folder folder;
  Recorder recorder(1000);
  const Status started = recorder.start(folder / "no/such/s.mcap", info_of(*bone, random));
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error().trouble, Trouble::io);
  EXPECT_NE(started.error().text.find("no/such/s.mcap"), std::string::npos);
}

TEST(Recorder, AFullDiskIsSaidAndTheSessionGoesOn) {
  BURR_SEEDED(random, 9);
  const auto bone = any_bone(random);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  // no file of this process may grow beyond this; in place of a full disk
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 4'000'000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Recorder recorder(1000);
  std::atomic<int> told = 0;
  const Status started =
      recorder.start(path, info_of(*bone, random), nullptr, [&told](const Error&) { ++told; });
  for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
    recorder.wait_for_room();  // must not wait for ever
    recorder.ticks().push(any_tick(tick, random));
  }
  const auto account = recorder.finish();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_DFL);
  ASSERT_TRUE(started.ok()) << started.error().text;
  ASSERT_FALSE(account.ok());
  EXPECT_EQ(account.error().trouble, Trouble::io);
  EXPECT_NE(account.error().text.find(path), std::string::npos) << account.error().text;
  EXPECT_FALSE(recorder.status().ok());
  EXPECT_EQ(told, 1) << "at once, and once";
  EXPECT_EQ(recorder.stats().written_ticks + recorder.stats().dropped_ticks, 20'000U);
  // what was written before is there and ends cleanly
  auto player = Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  EXPECT_FALSE((*player)->finished());
  EXPECT_EQ((*player)->lost_bytes(), 0U);
  EXPECT_EQ((*player)->end_tick(), recorder.stats().written_ticks);
  EXPECT_GT((*player)->end_tick(), 100U);
}

TEST(Recorder, AFileThatIsRemovedOrReplacedMeanwhileIsNoticedEvenAtTheVeryEnd) {
  BURR_SEEDED(random, 10);
  const auto bone = any_bone(random);
  for (const bool replaced : {false, true}) {
    const Folder folder;
    Recorder recorder(1000);
    ASSERT_TRUE(recorder.start(folder / "s.mcap", info_of(*bone, random)).ok());
    for (std::uint64_t tick = 0; tick < 100; ++tick) recorder.ticks().push(any_tick(tick, random));
    while (recorder.written_ticks() < 100)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::filesystem::remove(folder / "s.mcap");
    if (replaced) write_file(folder / "s.mcap", {1, 2, 3});
    const auto account = recorder.finish();
    ASSERT_FALSE(account.ok()) << "said to be whole, and lies in no folder";
    EXPECT_NE(account.error().text.find("was removed"), std::string::npos) << account.error().text;
  }
}

TEST(Recorder, PathsUidsAndNumbersThatAreNoneAreRefused) {
  Random random(6);
  const auto bone = any_bone(random);
  const Folder folder;
  const auto refused = [&](auto&& spoil) {
    SessionInfo info = info_of(*bone, random);
    spoil(info);
    Recorder recorder(1000);
    return !recorder.start(folder / "s.mcap", info).ok();
  };
  EXPECT_TRUE(refused([](SessionInfo& info) { info.words["from"] = "/home/somebody/ct"; }));
  EXPECT_TRUE(refused([](SessionInfo& info) { info.words["from"] = "C:\\ct"; }));
  EXPECT_TRUE(refused([](SessionInfo& info) {
    info.volume.recipe.series = "1.2.840.113619.2.55.3.604688119.971";
  }));
  EXPECT_TRUE(refused([](SessionInfo& info) { info.numbers["x"] = std::nan(""); }));
  EXPECT_TRUE(refused([](SessionInfo& info) { info.volume.recipe.source = "/home/somebody/ct"; }));
  EXPECT_TRUE(refused([](SessionInfo& info) { info.volume.recipe.iso = 1.0 / 0.0; }));
  EXPECT_FALSE(refused([](SessionInfo&) {}));
}

// A session as sim would give it to the recorder: the unpacked file has no identifier anywhere
// either.
TEST(Recorder, TheFileHoldsNoPathUserOrDate) {
  BURR_SEEDED(random, 8);
  const auto bone = any_bone(random);
  const Folder folder;
  record_any(folder / "Johanna_Doering.mcap", 500, 1000, *bone, random, true);
  auto reader = McapReader::open(folder / "Johanna_Doering.mcap");
  ASSERT_TRUE(reader.ok());
  std::string everything;
  const auto file = bytes_of_file(folder / "Johanna_Doering.mcap");
  everything.assign(file.begin(), file.end());
  for (std::size_t c = 0; c < (*reader)->chunks().size(); ++c) {
    const auto chunk = (*reader)->read_chunk(c);
    ASSERT_TRUE(chunk.ok());
    everything.append(chunk->bytes.begin(), chunk->bytes.end());
  }
  // long words: three letters stand in a file of 130 kB by chance once in a hundred times
  std::vector<std::string> words = {"Johanna", "Doering", folder.str(), "/tmp/", "/home/"};
  for (const char* name : {"USER", "LOGNAME", "HOME", "HOSTNAME", "PWD"})
    if (const char* value = std::getenv(name); value != nullptr && std::strlen(value) > 4)
      words.emplace_back(value);
  for (const std::string& word : words) EXPECT_EQ(everything.find(word), std::string::npos) << word;
  // no wall clock: every log time is within the session
  for (const auto& chunk : (*reader)->chunks()) EXPECT_LT(chunk.end_ns, 1'000'000'000U);
}

}  // namespace
}  // namespace burr::record

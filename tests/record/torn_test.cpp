// Files that are cut off, damaged or falsified: they open, say what is missing, and never crash.
// For what a kill leaves behind see tests/sim/killed_test.cpp.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "burr/record/player.h"
#include "burr/record/repair.h"
#include "burr/record/schema.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using namespace test;
using Bytes = std::vector<std::uint8_t>;

// A short session in many small chunks, as in a session in real time.
Truth record_in_chunks(const std::string& path, int chunks, std::uint64_t ticks_each,
                       volume::Bone& bone, Random& random, bool embed = false) {
  Truth truth;
  truth.info = info_of(bone, random);
  Recorder recorder(1000);
  const Status started = recorder.start(path, truth.info, embed ? &bone : nullptr);
  EXPECT_TRUE(started.ok());
  std::uint64_t tick = 0;
  for (int c = 0; c < chunks; ++c) {
    for (std::uint64_t i = 0; i < ticks_each; ++i, ++tick) {
      for (const tick::BrickRow& row : nibble(bone, tick, random)) {
        truth.bricks.push_back(row);
        recorder.bricks().push(row);
      }
      truth.ticks.push_back(any_tick(tick, random));
      recorder.ticks().push(truth.ticks.back());
    }
    // wait until these are taken, so that the next ones make a chunk of their own
    while (recorder.ticks().size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(recorder.finish().ok());
  return truth;
}

// Checks that the player's ticks are the first of the truth, without a gap. Returns how many.
std::uint64_t expect_beginning(Player& player, const Truth& truth) {
  StepCursor steps = player.steps();
  Step step;
  std::uint64_t tick = 0;
  while (steps.next(step)) {
    EXPECT_FALSE(step.gap);
    if (tick >= truth.ticks.size() || step.row.hash != truth.ticks[tick].hash) {
      ADD_FAILURE() << "tick " << tick << " is not what was recorded";
      break;
    }
    ++tick;
  }
  EXPECT_EQ(player.end_tick(), tick);
  return tick;
}

TEST(Torn, AtEveryByteOfTheLastChunkItOpensWithAllTheRest) {
  BURR_SEEDED(random, 21);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_in_chunks(folder / "s.mcap", 4, 6, *bone, random);
  const Bytes whole = bytes_of_file(folder / "s.mcap");
  auto reader = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(reader.ok());
  // the last chunk with ticks; after it come its indexes, the event, the account and the summary
  const std::uint16_t ticks = *(*reader)->channels_of(kTicks.name).begin();
  const mcap::ChunkAt* last = nullptr;
  for (const auto& chunk : (*reader)->chunks())
    if (chunk.index_offsets.contains(ticks)) last = &chunk;
  ASSERT_NE(last, nullptr);
  const std::uint64_t body_end = last->offset + last->length;
  ASSERT_GE((*reader)->chunks().size(), 4U);

  const std::string torn = folder / "torn.mcap";
  std::uint64_t before = 0;
  for (std::uint64_t size = last->offset; size < whole.size(); ++size) {
    // every byte of the chunk and its indexes; every 7th of the summary
    if (size > body_end + last->index_length + 64 && size % 7 != 0) continue;
    write_file(torn, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    auto player = Player::open(torn);
    ASSERT_TRUE(player.ok()) << size << ": " << player.error().text;
    EXPECT_FALSE((*player)->finished());
    EXPECT_FALSE((*player)->notices().empty());
    const std::uint64_t kept = expect_beginning(**player, truth);
    if (size == last->offset) before = kept;
    EXPECT_EQ(kept, size >= body_end ? truth.ticks.size() : before) << "cut at " << size;
    if (HasFailure()) break;
  }
  EXPECT_EQ(before, 18U);
}

TEST(Torn, InItsBeginningItIsRefusedInOneSentence) {
  BURR_SEEDED(random, 22);
  const Folder folder;
  const auto bone = any_bone(random);
  record_in_chunks(folder / "s.mcap", 1, 5, *bone, random);
  const Bytes whole = bytes_of_file(folder / "s.mcap");
  for (const std::size_t size : {0UL, 5UL, 8UL, 20UL, 100UL, 1000UL}) {
    write_file(folder / "torn.mcap",
               Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    const auto player = Player::open(folder / "torn.mcap");
    ASSERT_FALSE(player.ok());
    EXPECT_EQ(player.error().trouble, Trouble::data);
    EXPECT_NE(player.error().text.find("torn.mcap"), std::string::npos);
  }
  EXPECT_EQ(Player::open(folder / "nothing.mcap").error().trouble, Trouble::io);
  EXPECT_EQ(Player::open(folder.str()).error().trouble, Trouble::io);
}

// The summary of a recording knows nothing of damage in its middle: the player says what is lost.
TEST(Torn, InItsMiddleTheHoleIsNamedAndTheRestIsPlayedAndRepaired) {
  BURR_SEEDED(random, 29);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_in_chunks(folder / "s.mcap", 10, 50, *bone, random);
  Bytes bytes = bytes_of_file(folder / "s.mcap");
  std::uint64_t at = 0;
  {
    auto player = Player::open(folder / "s.mcap");
    ASSERT_TRUE(player.ok());
    EXPECT_TRUE((*player)->holes().empty());
    auto reader = McapReader::open(folder / "s.mcap");
    ASSERT_TRUE(reader.ok());
    const std::uint16_t ticks = *(*reader)->channels_of(kTicks.name).begin();
    for (const auto& chunk : (*reader)->chunks())
      if (chunk.index_offsets.contains(ticks) && chunk.start_ns / 1'000'000 == 250)
        at = chunk.offset + chunk.length / 2;
  }
  ASSERT_GT(at, 0U);
  for (std::uint64_t byte = at; byte < at + 40; ++byte) bytes[byte] ^= 0x5A;
  write_file(folder / "hole.mcap", bytes);

  NoProgress progress;
  ASSERT_TRUE(repair(folder / "hole.mcap", folder / "repaired.mcap", progress).ok());
  for (const char* name : {"hole.mcap", "repaired.mcap"}) {
    auto player = Player::open(folder / name);
    ASSERT_TRUE(player.ok()) << player.error().text;
    std::uint64_t played = 0, gaps = 0;
    StepCursor steps = (*player)->steps();
    for (Step step; steps.next(step); ++played) {
      gaps += step.gap ? 1 : 0;
      EXPECT_EQ(step.row.hash, truth.ticks[step.row.tick].hash);
    }
    EXPECT_EQ(played, 450U) << name;
    EXPECT_EQ(gaps, 1U) << name;
    EXPECT_EQ((*player)->end_tick(), 500U) << name;
    if (std::string(name) == "repaired.mcap") continue;
    ASSERT_EQ((*player)->holes().size(), 1U);
    EXPECT_EQ((*player)->holes()[0].first, 250U);
    EXPECT_EQ((*player)->holes()[0].end, 300U);
    bool named = false;
    for (const std::string& notice : (*player)->notices())
      named = named || notice.find("from 0.250 s to 0.300 s: 50 ticks") != std::string::npos;
    EXPECT_TRUE(named);
  }
}

TEST(Repair, GivesAWholeFileWithTheSameContent) {
  BURR_SEEDED(random, 23);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_in_chunks(folder / "s.mcap", 5, 20, *bone, random, true);
  const Bytes whole = bytes_of_file(folder / "s.mcap");
  auto reader = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(reader.ok());
  const auto& chunk = (*reader)->chunks()[4];
  NoProgress progress;

  const std::string torn = folder / "torn.mcap";
  write_file(torn, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(
                                                            chunk.offset + chunk.length - 3)));
  std::uint64_t kept = 0;
  {
    auto player = Player::open(torn);
    ASSERT_TRUE(player.ok());
    kept = expect_beginning(**player, truth);
  }
  const auto report = repair(torn, torn, progress);
  ASSERT_TRUE(report.ok()) << report.error().text;
  EXPECT_FALSE(report->was_whole);
  EXPECT_EQ(report->ticks, kept);
  EXPECT_EQ(report->lost_bytes, chunk.length - 3);
  EXPECT_EQ(report->notices.size(), 1U);
  EXPECT_EQ(report->kept_bytes, std::filesystem::file_size(torn));
  auto player = Player::open(torn);
  ASSERT_TRUE(player.ok());
  EXPECT_TRUE((*player)->finished());
  EXPECT_TRUE((*player)->notices().empty());
  EXPECT_EQ(expect_beginning(**player, truth), kept);
  EXPECT_TRUE((*player)->embedded_bone(0).ok());
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"s.mcap", "torn.mcap"}));

  // a second time, and a file that was complete: nothing is changed
  const Bytes repaired = bytes_of_file(torn);
  for (const std::string& path : {torn, folder / "s.mcap"}) {
    const auto again = repair(path, path, progress);
    ASSERT_TRUE(again.ok());
    EXPECT_TRUE(again->was_whole);
  }
  EXPECT_EQ(bytes_of_file(torn), repaired);
  EXPECT_EQ(bytes_of_file(folder / "s.mcap"), whole);
}

TEST(Repair, KeepsTheTornFileWhenAskedToWriteElsewhere) {
  BURR_SEEDED(random, 24);
  const Folder folder;
  const auto bone = any_bone(random);
  record_in_chunks(folder / "s.mcap", 2, 20, *bone, random);
  Bytes bytes = bytes_of_file(folder / "s.mcap");
  bytes.resize(bytes.size() - 1);
  write_file(folder / "s.mcap", bytes);
  NoProgress progress;
  const auto report = repair(folder / "s.mcap", folder / "whole.mcap", progress);
  ASSERT_TRUE(report.ok()) << report.error().text;
  EXPECT_EQ(bytes_of_file(folder / "s.mcap"), bytes);
  EXPECT_TRUE((*Player::open(folder / "whole.mcap"))->finished());
}

TEST(Repair, LeavesAFileAloneThatIsStillBeingRecorded) {
  BURR_SEEDED(random, 25);
  const Folder folder;
  const auto bone = any_bone(random);
  Recorder recorder(1000);
  ASSERT_TRUE(recorder.start(folder / "s.mcap", info_of(*bone, random)).ok());
  NoProgress progress;
  const auto report = repair(folder / "s.mcap", folder / "s.mcap", progress);
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.error().text.find("right now"), std::string::npos);
  // but it may be read meanwhile
  EXPECT_TRUE(Player::open(folder / "s.mcap").ok());
  EXPECT_TRUE(recorder.finish().ok());
}

TEST(Repair, StopsWhenAskedAndChangesNothing) {
  BURR_SEEDED(random, 26);
  class Stop final : public Progress {
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  };
  const Folder folder;
  const auto bone = any_bone(random);
  record_in_chunks(folder / "s.mcap", 2, 20, *bone, random);
  Bytes bytes = bytes_of_file(folder / "s.mcap");
  bytes.resize(bytes.size() - 1);
  write_file(folder / "s.mcap", bytes);
  Stop stop;
  const auto report = repair(folder / "s.mcap", folder / "s.mcap", stop);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().trouble, Trouble::interrupted);
  EXPECT_EQ(bytes_of_file(folder / "s.mcap"), bytes);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"s.mcap"});
}

TEST(Damaged, InTheMiddleTheRestIsKeptAndTheHoleIsNamed) {
  BURR_SEEDED(random, 27);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_in_chunks(folder / "s.mcap", 6, 20, *bone, random);
  const Bytes whole = bytes_of_file(folder / "s.mcap");
  auto reader = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(reader.ok());
  const auto chunk = (*reader)->chunks()[3];
  ASSERT_GT((*reader)->chunks().size(), 5U);

  // its content; its length; its kind; with and without the summary
  for (const std::uint64_t at : {chunk.offset + 60, chunk.offset + 3, chunk.offset}) {
    for (const bool torn : {false, true}) {
      Bytes bytes = whole;
      bytes[at] ^= 0x55;
      if (torn) bytes.resize(bytes.size() - 20);
      const std::string path = folder / "damaged.mcap";
      write_file(path, bytes);
      auto player = Player::open(path);
      ASSERT_TRUE(player.ok()) << player.error().text;
      StepCursor steps = (*player)->steps();
      Step step;
      std::uint64_t rows = 0;
      int gaps = 0;
      for (; steps.next(step); ++rows) {
        gaps += step.gap ? 1 : 0;
        EXPECT_EQ(step.row.hash, truth.ticks[step.row.tick].hash);
      }
      EXPECT_EQ(gaps, 1) << at;
      EXPECT_LT(rows, truth.ticks.size());
      EXPECT_GE(rows, truth.ticks.size() - 40);
      EXPECT_EQ((*player)->end_tick(), truth.ticks.size());
      EXPECT_FALSE((*player)->notices().empty());

      NoProgress progress;
      const auto report = repair(path, folder / "repaired.mcap", progress);
      ASSERT_TRUE(report.ok()) << report.error().text;
      EXPECT_EQ(report->ticks, rows);
      EXPECT_GT(report->lost_bytes, 0U);
      auto again = Player::open(folder / "repaired.mcap");
      ASSERT_TRUE(again.ok());
      EXPECT_TRUE((*again)->finished());
    }
  }
}

TEST(Damaged, RandomBytesNeverCrashNorMakeUsTakeWhatTheyPromise) {
  const std::uint64_t seed = 28;
  BURR_SEEDED(random, seed);
  const Folder folder;
  const auto bone = any_bone(random);
  record_in_chunks(folder / "s.mcap", 3, 8, *bone, random, true);
  const Bytes whole = bytes_of_file(folder / "s.mcap");
  const std::string path = folder / "mutated.mcap";
  NoProgress progress;

  rusage before{};
  ::getrusage(RUSAGE_SELF, &before);
  int opened = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = whole;
    for (std::uint64_t n = 1 + random() % 8; n > 0; --n) {
      // half of the changes where the structure is: at the beginning and the end
      std::size_t at = random() % bytes.size();
      if (random() % 4 == 0)
        at = bytes.size() - 1 - random() % std::min<std::size_t>(2000, bytes.size());
      if (random() % 4 == 0) at = random() % 200;
      switch (random() % 3) {
        case 0:
          bytes[at] = static_cast<std::uint8_t>(random());
          break;
        case 1:
          bytes[at] = 0xFF;
          break;
        default:
          for (std::size_t i = at; i < std::min(at + 8, bytes.size()); ++i) bytes[i] = 0xFF;
      }
    }
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    write_file(path, bytes);
    auto player = Player::open(path);
    if (!player.ok()) {
      EXPECT_FALSE(player.error().text.empty());
      continue;
    }
    ++opened;
    StepCursor steps = (*player)->steps();
    Step step;
    while (steps.next(step)) {
    }
    BrickCursor bricks = (*player)->bricks();
    tick::BrickRow row;
    while (bricks.next(row)) {
    }
    static_cast<void>((*player)->tick_at(0.01));
    if (round % 10 == 0) {
      static_cast<void>((*player)->embedded_bone(8));
      static_cast<void>((*player)->bone_at(0.01, *bone));
      static_cast<void>(repair(path, folder / "repaired.mcap", progress));
    }
  }
  EXPECT_GT(opened, 500);
  rusage after{};
  ::getrusage(RUSAGE_SELF, &after);
#if !defined(BURR_SANITIZED)
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 400'000) << "KiB";
#endif
}

}  // namespace
}  // namespace burr::record

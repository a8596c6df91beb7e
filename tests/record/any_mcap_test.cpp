// Recordings that other programs wrote again, in all the ways that the specification of MCAP allows:
// other_writer.py makes them, and what was recorded comes out of each to the bit.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/record/mcap/lz4_frame.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/player.h"
#include "burr/record/repair.h"
#include "record/made_up.h"
#include "support/test_places.h"

namespace burr::record {
namespace {

using namespace test;
using Bytes = std::vector<std::uint8_t>;

bool runs(const std::string& command) { return std::system((command + " >&2").c_str()) == 0; }

bool can_write() {
  return runs(
      "/usr/bin/python3 -c \"import ctypes; ctypes.CDLL('libzstd.so.1')\" 2>/dev/null && lz4 "
      "--version >/dev/null 2>&1");
}

void write_again(const std::string& from, const std::string& to, const std::string& choices) {
  ASSERT_TRUE(runs(fmt::format("/usr/bin/python3 '{}/tests/record/other_writer.py' '{}' '{}' {}",
                               burr::test::source_dir(), from, to, choices)))
      << choices;
}

// Everything in order, and states of the bone in the middle.
void expect_all(const std::string& path, const std::string& original, const Truth& truth) {
  auto player = Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  for (const std::string& notice : (*player)->notices()) ADD_FAILURE() << notice;
  EXPECT_TRUE((*player)->finished());
  EXPECT_EQ((*player)->first_tick(), 0U);
  EXPECT_EQ((*player)->end_tick(), truth.ticks.size());
  StepCursor steps = (*player)->steps();
  Step step;
  std::size_t ticks = 0, commands = 0;
  for (; steps.next(step); ++ticks) {
    ASSERT_LT(ticks, truth.ticks.size());
    expect_same(step.row, truth.ticks[ticks]);
    EXPECT_FALSE(step.gap);
    for (const tick::Command& command : step.commands) {
      ASSERT_LT(commands, truth.commands.size());
      EXPECT_EQ(truth.commands[commands].tick, ticks);
      EXPECT_EQ(truth.commands[commands].command.kind, command.kind);
      ++commands;
    }
  }
  EXPECT_EQ(ticks, truth.ticks.size());
  EXPECT_EQ(commands, truth.commands.size());
  BrickCursor bricks = (*player)->bricks();
  tick::BrickRow row;
  std::size_t changes = 0;
  for (; bricks.next(row); ++changes) {
    ASSERT_LT(changes, truth.bricks.size());
    EXPECT_EQ(row.tick, truth.bricks[changes].tick);
    EXPECT_EQ(row.brick, truth.bricks[changes].brick);
  }
  EXPECT_EQ(changes, truth.bricks.size());
  auto other = Player::open(original);
  ASSERT_TRUE(other.ok());
  for (const double t : {0.0, 3.1234, 11.5, 10.9, 0.7}) {
    const auto here = (*player)->embedded_bone(), there = (*other)->embedded_bone();
    ASSERT_TRUE(here.ok() && there.ok());
    ASSERT_TRUE((*player)->bone_at(t, **here).ok()) << t;
    ASSERT_TRUE((*other)->bone_at(t, **there).ok()) << t;
    EXPECT_EQ((*here)->content_hash(), (*there)->content_hash()) << t;
    const auto one = (*player)->step_at(t), two = (*other)->step_at(t);
    ASSERT_TRUE(one.ok() && two.ok());
    expect_same(one->row, two->row);
    EXPECT_EQ(one->commands.size(), two->commands.size()) << t;
  }
}

struct Original {
  Folder folder;
  std::string path = folder / "original.mcap";
  Truth truth;
};

void record_one(Original& original, Random& random) {
  const auto bone = any_bone(random);
  original.truth = record_any(original.path, 12'345, 1000, *bone, random, true);
}

// Played and repaired: the same to the bit, and whole.
void expect_read(const Original& original, const std::string& choices) {
  SCOPED_TRACE(choices);
  const std::string path = original.folder / "again.mcap";
  write_again(original.path, path, choices);
  expect_all(path, original.path, original.truth);
  NoProgress progress;
  const auto report = repair(path, path, progress);
  ASSERT_TRUE(report.ok()) << report.error().text;
  EXPECT_TRUE(report->was_whole);
  EXPECT_TRUE(report->notices.empty());
  EXPECT_EQ(report->ticks, original.truth.ticks.size());

  // without its end everything is still there, and what repair makes of it is whole
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 8);
  const auto mended = repair(path, original.folder / "mended.mcap", progress);
  ASSERT_TRUE(mended.ok()) << mended.error().text;
  EXPECT_FALSE(mended->was_whole);
  EXPECT_EQ(mended->ticks, original.truth.ticks.size());
  auto player = Player::open(original.folder / "mended.mcap");
  ASSERT_TRUE(player.ok()) << player.error().text;
  EXPECT_TRUE((*player)->finished());
  EXPECT_TRUE((*player)->notices().empty());
  EXPECT_EQ((*player)->end_tick(), original.truth.ticks.size());
}

TEST(AnyMcap, WhateverTheSpecificationAllowsIsPlayedToTheBit) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 71);
  Original original;
  record_one(original, random);
  for (const char* choices : {"",
                              "channels_from_0",
                              "no_chunks",
                              "no_chunks channels_from_0 no_summary",
                              "unknown",
                              "schemas_in_chunks",
                              "schemas_in_chunks no_summary_channels",
                              "no_summary",
                              "no_crc",
                              "no_chunk_index",
                              "no_message_index",
                              "no_message_index no_summary",
                              "shuffled_index",
                              "lz4",
                              "stored",
                              "two_frames",
                              "two_channels",
                              "chunk_per_topic",
                              "two_channels chunk_per_topic chunk_bytes=700",
                              "in_order chunk_bytes=3000",
                              "in_order no_chunks",
                              "chunk_bytes=90000000",
                              "no_chunks unknown two_channels"})
    expect_read(original, choices);
}

TEST(AnyMcap, AnyChoicesTogether) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 72);
  Original original;
  record_one(original, random);
  const std::vector<std::string> all = {"channels_from_0",
                                        "no_chunks",
                                        "unknown",
                                        "schemas_in_chunks",
                                        "no_summary",
                                        "no_crc",
                                        "no_chunk_index",
                                        "no_message_index",
                                        "shuffled_index",
                                        "two_channels",
                                        "chunk_per_topic",
                                        "in_order",
                                        "lz4",
                                        "stored",
                                        "two_frames",
                                        "no_summary_channels",
                                        "chunk_bytes=700",
                                        "chunk_bytes=20000"};
  for (int round = 0; round < 12; ++round) {
    std::string choices;
    for (const std::string& choice : all)
      if (random() % 4 == 0) choices += choice + " ";
    // without chunks there is nothing for schemas to stand in
    if (choices.find("no_chunks") != std::string::npos)
      if (const auto at = choices.find("schemas_in_chunks"); at != std::string::npos)
        choices.erase(at, std::string("schemas_in_chunks ").size());
    expect_read(original, choices);
  }
}

// Where the first record of a kind begins, at or after `from`, that is longer than `least`; outside of chunks.
std::size_t record_after(const Bytes& bytes, std::size_t from, mcap::Kind kind,
                         std::uint64_t least = 0) {
  std::size_t at = mcap::kMagic.size();
  for (std::uint64_t length = 0;; at += mcap::kRecordHead + length) {
    std::memcpy(&length, &bytes.at(at + 1), sizeof length);
    if (at >= from && bytes[at] == static_cast<std::uint8_t>(kind) && length > least) return at;
  }
}
std::size_t message_after(const Bytes& bytes, std::size_t from) {
  return record_after(bytes, from, mcap::Kind::message);
}

// Damage costs what lies there, however the file is written: what follows is found again.
TEST(AnyMcap, ADamagedPartCostsOnlyItself) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 76);
  Original original;
  record_one(original, random);
  for (const char* choices :
       {"chunk_bytes=20000", "no_chunks", "stored chunk_bytes=20000", "lz4 chunk_bytes=20000",
        "no_chunks channels_from_0 unknown", "chunk_bytes=20000 no_message_index no_summary"}) {
    SCOPED_TRACE(choices);
    const std::string path = original.folder / "again.mcap", to = original.folder / "mended.mcap";
    write_again(original.path, path, choices);
    const Bytes whole = bytes_of_file(path);
    for (int round = 0; round < 5; ++round) {
      Bytes bytes = whole;
      std::size_t at = bytes.size() / 2 + random() % (bytes.size() / 3);
      // outside of chunks no checksum covers a message, but the next one is found by its length
      if (std::string(choices).find("no_chunks") != std::string::npos)
        at = message_after(bytes, at);
      std::uint64_t damaged = 0;  // the whole message
      std::memcpy(&damaged, &bytes[at + 1], sizeof damaged);
      damaged += mcap::kRecordHead;
      for (std::size_t n = 0; n < 20; ++n) bytes[at + n] ^= 0x5A;
      write_file(path, bytes);
      NoProgress progress;
      const auto report = repair(path, to, progress);
      ASSERT_TRUE(report.ok()) << report.error().text;
      EXPECT_FALSE(report->was_whole) << at;
      // a keyframe's message is 2.3 MB long
      EXPECT_LT(report->lost_bytes, 4'000'000U) << at;
      if (std::string(choices) == "no_chunks") {
        EXPECT_EQ(report->lost_bytes, damaged) << at;
      }
      EXPECT_GE(report->ticks + 300, original.truth.ticks.size()) << at;
      auto player = Player::open(to);
      ASSERT_TRUE(player.ok()) << player.error().text;
      EXPECT_TRUE((*player)->finished());
      StepCursor steps = (*player)->steps();
      Step step;
      std::size_t ticks = 0;
      for (; steps.next(step); ++ticks) expect_same(step.row, original.truth.ticks[step.row.tick]);
      EXPECT_EQ(ticks, report->ticks);
    }
  }
}

// Bricks hold many zeros, and small numbers between them: such bytes of a damaged message look like the
// head of an empty chunk, of a message or of a record of an unknown kind. None is taken for one.
TEST(AnyMcap, BytesOfADamagedMessageAreNoRecords) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 77);
  Original original;
  record_one(original, random);
  const std::string path = original.folder / "again.mcap", to = original.folder / "mended.mcap";
  write_again(original.path, path, "no_chunks");
  const Bytes whole = bytes_of_file(path);
  for (const int kind : {0x05, 0x06, 0x07, 0x0F, 0x28, 0xA0}) {
    SCOPED_TRACE(kind);
    Bytes bytes = whole;
    const std::size_t at =
        record_after(bytes, bytes.size() / 2, mcap::Kind::message, std::uint64_t{10'000});
    std::uint64_t damaged = 0;
    std::memcpy(&damaged, &bytes[at + 1], sizeof damaged);
    for (std::size_t n = 0; n < 20; ++n) bytes[at + n] ^= 0x5A;
    std::fill_n(&bytes[at + 100], 2000, std::uint8_t{0});
    for (const std::size_t n : {std::size_t{300}, std::size_t{349}, std::size_t{398}}) {
      bytes[at + n] =
          static_cast<std::uint8_t>(kind);  // three of them, each as long as the fields of a chunk
      bytes[at + n + 1] = 0x28;
    }
    write_file(path, bytes);
    NoProgress progress;
    const auto report = repair(path, to, progress);
    ASSERT_TRUE(report.ok()) << report.error().text;
    EXPECT_EQ(report->lost_bytes, mcap::kRecordHead + damaged);
  }
}

// No checksum covers an index of messages. Its times and places lie in the chunk before it, or it is damaged.
TEST(AnyMcap, ADamagedIndexOfMessagesIsNoticed) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 78);
  Original original;
  record_one(original, random);
  const std::string path = original.folder / "again.mcap", to = original.folder / "mended.mcap";
  write_again(original.path, path, "lz4 chunk_bytes=20000");
  const Bytes whole = bytes_of_file(path);
  // in the time and in the place of its first entry, and in the length of its entries
  for (const std::size_t field : {std::size_t{6}, std::size_t{14}, std::size_t{2}}) {
    SCOPED_TRACE(field);
    Bytes bytes = whole;
    const std::size_t at = record_after(bytes, bytes.size() / 2, mcap::Kind::message_index, 20);
    bytes[at + mcap::kRecordHead + field + 3] ^= 0x5A;
    write_file(path, bytes);
    NoProgress progress;
    const auto report = repair(path, to, progress);
    ASSERT_TRUE(report.ok()) << report.error().text;
    EXPECT_FALSE(report->was_whole);
    EXPECT_EQ(report->ticks, original.truth.ticks.size()) << "the chunk itself is whole";
  }
}

// Lengths have 64 bits. The file takes no place on the disk: it is a hole.
TEST(AnyMcap, RecordsOfMoreThan4GBAreSteppedOver) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 73);
  Original original;
  record_one(original, random);
  for (const char* what : {"attachment", "message", "chunk", "unknown"})
    for (const char* more : {"", "no_summary", "no_chunks"}) {
      const std::string choices = fmt::format("huge={} {}", what, more);
      SCOPED_TRACE(choices);
      const std::string path = original.folder / "huge.mcap";
      write_again(original.path, path, choices);
      struct stat about {};
      ASSERT_EQ(::stat(path.c_str(), &about), 0);
      ASSERT_GT(about.st_size, 5'000'000'000);
      if (about.st_blocks > 1'000'000) GTEST_SKIP() << "this file system has no holes";
      expect_all(path, original.path, original.truth);
      NoProgress progress;
      const auto report = repair(path, path, progress);
      ASSERT_TRUE(report.ok()) << report.error().text;
      EXPECT_TRUE(report->was_whole);
      EXPECT_EQ(report->ticks, original.truth.ticks.size());
    }
}

// What is too large to be looked at is copied as it is when the rest of its file is repaired.
TEST(AnyMcap, RepairKeepsWhatItCannotLookAt) {
  if (!can_write()) GTEST_SKIP() << "needs python3, libzstd.so.1 and lz4";
  BURR_SEEDED(random, 74);
  Original original;
  record_one(original, random);
  for (const char* what : {"attachment", "message", "chunk", "unknown"}) {
    SCOPED_TRACE(what);
    constexpr std::uint64_t kSize = mcap::kLargestChunk + 100'000;
    const std::string path = original.folder / "huge.mcap", to = original.folder / "mended.mcap";
    write_again(original.path, path, fmt::format("huge={} size={}", what, kSize));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 3);
    NoProgress progress;
    const auto report = repair(path, to, progress);
    ASSERT_TRUE(report.ok()) << report.error().text;
    EXPECT_FALSE(report->was_whole);
    EXPECT_EQ(report->ticks, original.truth.ticks.size());
    EXPECT_GT(report->kept_bytes, kSize);
    expect_all(to, original.path, original.truth);
    const auto again = repair(to, to, progress);
    ASSERT_TRUE(again.ok()) << again.error().text;
    EXPECT_TRUE(again->was_whole);
  }
}

// The program `lz4` packs, burr unpacks; damage is found or makes other bytes, and never more.
TEST(Lz4, WhatTheProgramLz4PackedComesBack) {
  if (!can_write()) GTEST_SKIP() << "needs lz4";
  BURR_SEEDED(random, 75);
  const Folder folder;
  for (const std::size_t size : {0UL, 1UL, 13UL, 70'000UL, 5'000'000UL})
    for (const char* how :
         {"-1", "-9 -BD", "-B4 -BX --no-frame-crc", "--content-size", "-12 -B4D"}) {
      Bytes bytes(size);
      std::uint8_t last = 0;
      for (auto& byte : bytes)
        byte = last = random() % 3 == 0 ? static_cast<std::uint8_t>(random()) : last;
      write_file(folder / "plain", bytes);
      ASSERT_TRUE(
          runs(fmt::format("lz4 -f -q {} '{}' '{}'", how, folder / "plain", folder / "packed")));
      Bytes packed = bytes_of_file(folder / "packed"), back;
      ASSERT_TRUE(unpack_lz4(packed, size, back)) << size << how;
      EXPECT_EQ(back, bytes);
      EXPECT_FALSE(unpack_lz4(packed, size + 1, back)) << "promises more than there is";
      if (size > 0) {
        EXPECT_FALSE(unpack_lz4(packed, size - 1, back)) << "promises less";
      }
      EXPECT_FALSE(unpack_lz4(ByteSpan(packed).first(packed.size() - 1), size, back))
          << "cut short";
      for (int round = 0; round < 200 && size < 100'000; ++round) {
        Bytes damaged = packed;
        damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
        const bool whole = unpack_lz4(damaged, size, back);
        EXPECT_TRUE(!whole || back.size() == size);
        EXPECT_LE(back.size(), size);
      }
    }
}

}  // namespace
}  // namespace burr::record

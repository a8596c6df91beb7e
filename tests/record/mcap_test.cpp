// The container, compared with the specification by a second parser that shares no code with the
// first, and with the MCAP project's own reader where it is installed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <zstd.h>

#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/mcap/packed.h"
#include "burr/record/schema.h"
#include "record/made_up.h"
#include "support/test_places.h"

namespace burr::record {
namespace {

using namespace test;
using Bytes = std::vector<std::uint8_t>;

// bit by bit, directly from the definition
std::uint32_t slow_crc(const std::uint8_t* p, std::size_t n) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t i = 0; i < n; ++i) {
    crc ^= p[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
  }
  return ~crc;
}

std::uint64_t number(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= static_cast<std::uint64_t>(bytes.at(at + i)) << (8 * i);
  return value;
}

struct Record {
  int kind = 0;
  std::size_t start = 0, content = 0, end = 0;
};

std::vector<Record> records_of(const Bytes& bytes, std::size_t at, std::size_t end) {
  std::vector<Record> found;
  while (at < end) {
    Record record;
    record.kind = bytes.at(at);
    record.start = at;
    record.content = at + 9;
    record.end = record.content + number(bytes, at + 1, 8);
    EXPECT_LE(record.end, end);
    if (record.end > end) break;
    found.push_back(record);
    at = record.end;
  }
  return found;
}

TEST(Crc32, IsTheOneOfZipAndPng) {
  EXPECT_EQ(crc32(as_bytes("123456789")), 0xCBF43926U);  // check value from the catalogue of CRCs
  BURR_SEEDED(random, 11);
  for (std::size_t size = 0; size < 70; ++size) {
    Bytes bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    EXPECT_EQ(crc32(bytes), slow_crc(bytes.data(), size));
    const std::size_t half = size / 2;
    const ByteSpan span(bytes);
    EXPECT_EQ(crc32(crc32(span.first(half)), span.subspan(half)), slow_crc(bytes.data(), size));
  }
}

TEST(Packed, ComesBackAndLiesAreFound) {
  BURR_SEEDED(random, 12);
  Packer packer;
  for (const std::size_t size : {0UL, 1UL, 1000UL, 3'000'000UL}) {
    Bytes bytes(size), packed, back;
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4);
    packer.pack(bytes, packed);
    ASSERT_TRUE(unpack(packed, size, back));
    EXPECT_EQ(back, bytes);
    EXPECT_FALSE(unpack(packed, size + 1, back)) << "promises more than there is";
    if (size > 0) {
      EXPECT_FALSE(unpack(packed, size - 1, back)) << "promises less";
    }
    EXPECT_FALSE(unpack(ByteSpan(packed).first(packed.size() - 1), size, back)) << "cut short";
    packed.push_back(0);
    EXPECT_FALSE(unpack(packed, size, back)) << "something follows";
  }
  // a header that promises 8 GiB over a few bytes takes hardly any memory
  Bytes packed, back;
  packer.pack(Bytes(100), packed);
  EXPECT_FALSE(unpack(packed, std::uint64_t{1} << 33, back));
  EXPECT_LT(back.capacity(), std::size_t{4} << 20);
}

TEST(Mcap, EveryByteIsWhereTheSpecificationWantsIt) {
  BURR_SEEDED(random, 13);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_any(folder / "s.mcap", 2500, 1000, *bone, random, true);
  const Bytes file = bytes_of_file(folder / "s.mcap");
  const Bytes magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
  ASSERT_GT(file.size(), 100U);
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), file.begin()));
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), file.end() - 8));

  // magic, Header first; Footer last, then magic
  const auto records = records_of(file, 8, file.size() - 8);
  ASSERT_FALSE(records.empty());
  EXPECT_EQ(records.front().kind, 0x01);
  ASSERT_EQ(records.back().kind, 0x02);
  const std::size_t footer = records.back().content;
  const std::uint64_t summary = number(file, footer, 8), offsets = number(file, footer + 8, 8);
  EXPECT_EQ(number(file, footer + 16, 4), slow_crc(&file[summary], footer + 16 - summary));

  std::map<std::uint64_t, Record> chunks, attachments, metadata;
  std::map<std::uint64_t, std::uint64_t> messages_by_channel;
  std::set<std::uint64_t> schemas, channels;
  std::uint64_t messages = 0, first = ~0ULL, last = 0;
  std::size_t at = 0;
  std::vector<std::pair<std::uint64_t, std::map<std::uint64_t, int>>> wanted_indexes;
  Bytes unpacked;
  for (; records[at].kind != 0x0F; ++at) {
    const Record& record = records[at];
    ASSERT_LT(record.start, summary);
    switch (record.kind) {
      case 0x01:
        EXPECT_EQ(at, 0U);
        break;
      case 0x03:
        EXPECT_TRUE(chunks.empty()) << "schemas come before what needs them";
        EXPECT_NE(number(file, record.content, 2), 0U) << "0 is not a schema";
        schemas.insert(number(file, record.content, 2));
        break;
      case 0x04:
        EXPECT_TRUE(schemas.contains(number(file, record.content + 2, 2)));
        channels.insert(number(file, record.content, 2));
        break;
      case 0x09: {
        attachments[record.start] = record;
        EXPECT_EQ(number(file, record.end - 4, 4),
                  slow_crc(&file[record.content], record.end - 4 - record.content));
        EXPECT_EQ(number(file, record.content, 8), 0U) << "no date";
        EXPECT_EQ(number(file, record.content + 8, 8), 0U) << "no date";
        break;
      }
      case 0x0C:
        metadata[record.start] = record;
        break;
      case 0x06: {
        chunks[record.start] = record;
        const std::uint64_t start = number(file, record.content, 8),
                            end = number(file, record.content + 8, 8),
                            size = number(file, record.content + 16, 8);
        ASSERT_EQ(number(file, record.content + 28, 4), 4U);
        ASSERT_EQ(std::string(&file[record.content + 32], &file[record.content + 36]), "zstd");
        ASSERT_EQ(number(file, record.content + 36, 8), record.end - record.content - 44);
        unpacked.resize(size);
        ASSERT_EQ(ZSTD_decompress(unpacked.data(), size, &file[record.content + 44],
                                  record.end - record.content - 44),
                  size);
        EXPECT_EQ(number(file, record.content + 24, 4), slow_crc(unpacked.data(), size));
        std::uint64_t lo = ~0ULL, hi = 0;
        for (const Record& inner : records_of(unpacked, 0, size)) {
          ASSERT_EQ(inner.kind, 0x05);
          const std::uint64_t channel = number(unpacked, inner.content, 2),
                              time = number(unpacked, inner.content + 6, 8);
          EXPECT_TRUE(channels.contains(channel));
          ++messages_by_channel[channel];
          ++messages;
          lo = std::min(lo, time);
          hi = std::max(hi, time);
        }
        EXPECT_EQ(start, lo);
        EXPECT_EQ(end, hi);
        first = std::min(first, lo);
        last = std::max(last, hi);
        break;
      }
      case 0x07: {
        ASSERT_FALSE(chunks.empty());
        ASSERT_EQ(number(file, record.content + 2, 4), record.end - record.content - 6);
        for (std::size_t entry = record.content + 6; entry < record.end; entry += 16) {
          const std::uint64_t offset = number(file, entry + 8, 8);
          ASSERT_EQ(unpacked.at(offset), 0x05);
          EXPECT_EQ(number(unpacked, offset + 9, 2), number(file, record.content, 2));
          EXPECT_EQ(number(unpacked, offset + 9 + 6, 8), number(file, entry, 8));
        }
        break;
      }
      default:
        FAIL() << "kind " << record.kind << " in the data section";
    }
  }
  EXPECT_EQ(attachments.size(), 1U);
  EXPECT_EQ(metadata.size(), 2U);
  EXPECT_GT(chunks.size(), 1U);

  // DataEnd ends the data section; its CRC covers everything before it
  EXPECT_EQ(records[at].end, summary);
  EXPECT_EQ(number(file, records[at].content, 4), slow_crc(file.data(), records[at].start));

  // the summary: each group together, with its SummaryOffset
  std::map<int, std::pair<std::uint64_t, std::uint64_t>> groups;
  std::size_t indexed_chunks = 0, statistics = 0;
  for (++at; records[at].kind != 0x0E; ++at) {
    const Record& record = records[at];
    auto [group, fresh] = groups.try_emplace(record.kind, record.start, 0);
    EXPECT_TRUE(fresh || group->second.first + group->second.second == record.start);
    group->second.second += record.end - record.start;
    if (record.kind == 0x08) {
      ++indexed_chunks;
      const std::uint64_t offset = number(file, record.content + 16, 8);
      ASSERT_TRUE(chunks.contains(offset));
      const Record& chunk = chunks[offset];
      EXPECT_EQ(number(file, record.content + 24, 8), chunk.end - chunk.start);
      EXPECT_EQ(number(file, record.content, 8), number(file, chunk.content, 8));
      EXPECT_EQ(number(file, record.content + 8, 8), number(file, chunk.content + 8, 8));
      const std::uint64_t map = number(file, record.content + 32, 4);
      std::uint64_t index_length = 0;
      for (std::size_t entry = 0; entry < map; entry += 10) {
        const std::uint64_t index = number(file, record.content + 36 + entry + 2, 8);
        ASSERT_EQ(file.at(index), 0x07);
        EXPECT_EQ(number(file, index + 9, 2), number(file, record.content + 36 + entry, 2));
        index_length += 9 + number(file, index + 1, 8);
      }
      EXPECT_EQ(number(file, record.content + 36 + map, 8), index_length);
    }
    if (record.kind == 0x0A) {
      EXPECT_TRUE(attachments.contains(number(file, record.content, 8)));
    }
    if (record.kind == 0x0D) {
      EXPECT_TRUE(metadata.contains(number(file, record.content, 8)));
    }
    if (record.kind == 0x0B) {
      ++statistics;
      EXPECT_EQ(number(file, record.content, 8), messages);
      EXPECT_EQ(number(file, record.content + 8, 2), schemas.size());
      EXPECT_EQ(number(file, record.content + 10, 4), channels.size());
      EXPECT_EQ(number(file, record.content + 14, 4), attachments.size());
      EXPECT_EQ(number(file, record.content + 18, 4), metadata.size());
      EXPECT_EQ(number(file, record.content + 22, 4), chunks.size());
      EXPECT_EQ(number(file, record.content + 26, 8), first);
      EXPECT_EQ(number(file, record.content + 34, 8), last);
      EXPECT_EQ(number(file, record.content + 42, 4), 10 * messages_by_channel.size());
      for (std::size_t i = 0; i < messages_by_channel.size(); ++i) {
        const std::size_t entry = record.content + 46 + 10 * i;
        EXPECT_EQ(number(file, entry + 2, 8), messages_by_channel[number(file, entry, 2)]);
      }
    }
  }
  EXPECT_EQ(indexed_chunks, chunks.size());
  EXPECT_EQ(statistics, 1U);
  EXPECT_EQ(records[at].start, offsets);
  for (; records[at].kind == 0x0E; ++at) {
    const auto group = groups.at(static_cast<int>(file[records[at].content]));
    EXPECT_EQ(number(file, records[at].content + 1, 8), group.first);
    EXPECT_EQ(number(file, records[at].content + 9, 8), group.second);
    groups.erase(static_cast<int>(file[records[at].content]));
  }
  EXPECT_TRUE(groups.empty());
  EXPECT_EQ(at, records.size() - 1) << "the footer follows";
}

TEST(Mcap, ALongRecordingTakesNoMoreMemoryThanAShortOne) {
  const Folder folder;
  const std::string path = folder / "long.mcap";
  constexpr std::size_t kChunks = 20'000;  // a quarter of an hour
  std::array<std::size_t, 3> held{};
  {
    McapWriter writer;
    ASSERT_TRUE(writer.open(path, path).ok());
    const auto schema = writer.add_schema("s", "jsonschema", "{}");
    ASSERT_TRUE(schema.ok());
    std::array<std::uint16_t, 3> channels{};
    for (std::size_t i = 0; i < channels.size(); ++i)
      channels[i] = *writer.add_channel(fmt::format("t{}", i), "json", *schema);
    for (std::uint64_t n = 0; n < kChunks; ++n) {
      for (std::size_t i = 0; i < channels.size(); ++i)
        if (n % (i + 1) == 0) writer.add_message(channels[i], 0, n, as_bytes("{}"));
      ASSERT_TRUE(writer.close_chunk().ok());
      if (n == 1000) held[0] = mallinfo2().uordblks;
    }
    held[1] = mallinfo2().uordblks;
    ASSERT_TRUE(writer.finish().ok());
  }
  EXPECT_LT(held[1], held[0] + 64 * 1024);
  // and the index at its end knows every chunk that a scan of the file finds
  const auto index = McapReader::open(path),
             scan = McapReader::open(path, McapReader::Trust::nothing);
  ASSERT_TRUE(index.ok() && scan.ok());
  ASSERT_EQ((*index)->chunks().size(), kChunks);
  ASSERT_EQ((*scan)->chunks().size(), kChunks);
  for (std::size_t n = 0; n < kChunks; ++n) {
    const mcap::ChunkAt &a = (*index)->chunks()[n], &b = (*scan)->chunks()[n];
    ASSERT_EQ(a.offset, b.offset);
    ASSERT_EQ(a.length, b.length);
    ASSERT_EQ(a.start_ns, n);
    ASSERT_EQ(a.end_ns, n);
    ASSERT_EQ(a.packed_size, b.packed_size);
    ASSERT_EQ(a.unpacked_size, b.unpacked_size);
    ASSERT_EQ(a.index_offsets, b.index_offsets);
    ASSERT_EQ(a.index_length, b.index_length);
    ASSERT_EQ(a.compression, b.compression);
  }
}

// A file of so many chunks of a made-up recording; copies: after how many of them a copy is made, "copy N".
void write_chunks(const std::string& path, int chunks, const std::set<int>& copies) {
  std::mt19937_64 random(17);  // the same chunks in every file
  McapWriter writer;
  ASSERT_TRUE(writer.open(path, path).ok());
  const auto schema = writer.add_schema("any", "jsonschema", "{}");
  const auto one = writer.add_channel("/one", "json", *schema),
             other = writer.add_channel("/other", "json", *schema);
  ASSERT_TRUE(one.ok() && other.ok());
  ASSERT_TRUE(writer.add_metadata("some", {{"key", "value"}}).ok());
  ASSERT_TRUE(writer.add_attachment("bone", "any", Bytes(100'000, 7)).ok());
  for (int n = 0; n < chunks; ++n) {
    for (std::uint32_t message = 0; message < 5; ++message) {
      Bytes data(random() % 3000);
      for (auto& byte : data) byte = static_cast<std::uint8_t>(random() % 8);
      writer.add_message(message % 2 == 0 ? *one : *other, message,
                         static_cast<std::uint64_t>(1000 * n) + message, data);
    }
    ASSERT_TRUE(writer.close_chunk().ok());
    const std::string copy = path + fmt::format(".copy{}", n + 1);
    if (copies.contains(n + 1)) {
      ASSERT_TRUE(writer.copy_to(copy, copy).ok());
    }
  }
  ASSERT_TRUE(writer.finish().ok());
}

TEST(Mcap, ACopyIsCompleteAndTheRecordingGoesOn) {
  const Folder folder;
  const std::string whole = folder / "whole.mcap", copied = folder / "copied.mcap";
  write_chunks(whole, 9, {});
  write_chunks(copied, 9, {1, 4, 9});
  EXPECT_EQ(bytes_of_file(copied), bytes_of_file(whole)) << "as if no copy had been made";
  for (const int chunks : {1, 4, 9}) {
    const std::string copy = copied + fmt::format(".copy{}", chunks),
                      alone = folder / fmt::format("alone{}.mcap", chunks);
    write_chunks(alone, chunks, {});
    EXPECT_EQ(bytes_of_file(copy), bytes_of_file(alone)) << "as if the recording had ended there";
    const auto read = McapReader::open(copy, McapReader::Trust::nothing);
    ASSERT_TRUE(read.ok());
    EXPECT_TRUE((*read)->finished());
  }
}

TEST(Mcap, ACopyThatCannotBeMadeHarmsNothing) {
  const Folder folder;
  const std::string path = folder / "s.mcap", nowhere = folder / "no folder/copy.mcap";
  McapWriter writer;
  ASSERT_TRUE(writer.open(path, path).ok());
  ASSERT_TRUE(writer.add_metadata("some", {{"key", "value"}}).ok());
  const Status made = writer.copy_to(nowhere, nowhere);
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().text.find(nowhere), std::string::npos) << made.error().text;
  ASSERT_TRUE(writer.finish().ok());
  const auto read = McapReader::open(path, McapReader::Trust::nothing);
  ASSERT_TRUE(read.ok());
  EXPECT_TRUE((*read)->finished());
}

TEST(Mcap, TheMcapProjectsOwnReaderAgrees) {
  BURR_SEEDED(random, 14);
  const Folder folder;
  const auto bone = any_bone(random);
  const Truth truth = record_any(folder / "s.mcap", 12'500, 1000, *bone, random, true);
  const std::string command = "node '" + burr::test::source_dir() +
                              "/tests/record/other_reader.cjs' '" + (folder / "s.mcap") + "' 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  std::array<char, 4096> block{};
  while (std::fgets(block.data(), static_cast<int>(block.size()), pipe) != nullptr)
    said += block.data();
  const int status = ::pclose(pipe);
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127)
    GTEST_SKIP() << "needs node with @mcap/core, @mcap/nodejs, fzstd, protobufjs: " << said;
  ASSERT_EQ(WEXITSTATUS(status), 0) << said;
  const auto out = nlohmann::json::parse(said);
  EXPECT_EQ(out["ticks"], truth.ticks.size());
  EXPECT_EQ(out["wishes"], truth.commands.size());
  EXPECT_EQ(out["bricks"], truth.bricks.size());
  EXPECT_EQ(out["session"], hex(truth.info.volume.content_hash));
  EXPECT_EQ(out["attachments"], 1);
  EXPECT_EQ(out["streamed"], out["statistics"]);
  EXPECT_EQ(out["messages"]["/bone/keyframes"], 1);
  const double x = truth.ticks.front().hand.world_from_tool.p.x();
  if (std::isfinite(x)) {
    EXPECT_EQ(out["first_x"], x);
  }
}

}  // namespace
}  // namespace burr::record

// record/mcap/mcap.h - types and constants of the MCAP container (mcap.dev/spec), for writer and
// reader.
//
//     magic | Header | Schema, Channel, Metadata, Attachment ...
//           | Chunk MessageIndex* ... | DataEnd
//           | summary: Schema, Channel, Statistics, indexes, SummaryOffset | Footer | magic
//
// A record is u8 kind, u64 length, content; all little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record::mcap {

inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Kind : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::uint64_t kRecordHead = 9;  // kind and length [byte]
inline constexpr std::uint64_t kFooter = kRecordHead + 20;
// of a chunk: start, end, unpacked size, crc, length of the compression's name
inline constexpr std::uint64_t kChunkFixed = 8 + 8 + 8 + 4 + 4;
// A larger chunk is stepped over and not read: other writers may make them, but its records must
// lie in memory.
inline constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 29;  // unpacked [byte]

using Pairs = std::map<std::string, std::string>;  // Metadata, channel metadata

struct Schema {
  std::uint16_t id = 0;
  std::string name, encoding, data;
};

struct Channel {
  std::uint16_t id = 0, schema = 0;  // 0 is a channel like any other, and no schema
  std::string topic, encoding;
  Pairs metadata;
};

// The position of a message: its time and its offset in the unpacked chunk.
using MessageAt = std::pair<std::uint64_t, std::uint64_t>;
using MessageIndexes = std::map<std::uint16_t, std::vector<MessageAt>>;  // by channel

struct ChunkAt {
  std::uint64_t start_ns = 0, end_ns = 0;                // of its messages' log_time
  std::uint64_t offset = 0, length = 0;                  // of the Chunk record in the file
  std::uint64_t packed_size = 0, unpacked_size = 0;      // of its records
  std::uint64_t index_length = 0;                        // of the MessageIndexes that follow
  std::string compression;                               // "zstd", "lz4" or ""
  std::map<std::uint16_t, std::uint64_t> index_offsets;  // channel -> its MessageIndex, or 0
  // messages that follow each other outside of any chunk: offset and length are those of their records
  bool bare = false;
};

struct RecordAt {
  std::uint64_t offset = 0, length = 0;
};

struct AttachmentAt {
  std::uint64_t offset = 0, length = 0;  // of the record
  std::uint64_t log_ns = 0, create_ns = 0, size = 0;
  std::string name, media_type;
};

struct MetadataAt {
  std::uint64_t offset = 0, length = 0;
  std::string name;
};

void put_record(BytesOut& out, Kind kind, ByteSpan content);
void put_pairs(BytesOut& out, const Pairs& pairs);
[[nodiscard]] bool get_pairs(BytesIn& in, Pairs& pairs);

}  // namespace burr::record::mcap

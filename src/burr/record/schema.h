// record/schema.h - the channels of a recording: their names, their schemas, and the conversion of
// rows to bytes and back.
//
// Ticks and bricks are Protocol Buffers (proto3), several rows in one message as packed columns.
// Their schema in the file is a FileDescriptorSet whose comments give the meaning and unit of each
// field, so that any MCAP or protobuf tool reads them without burr. The rest is JSON with JSON
// Schema. A field number is never reused: a field that is dropped leaves a gap, a new one takes a
// new number. docs/use/recording_fields.md is the table for readers.
// Thread: any; functions without state.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "burr/record/mcap/mcap_bytes.h"
#include "burr/tick/rows.h"

namespace burr::record {

inline constexpr int kFormatVersion = 1;

struct Topic {
  const char* name;             // "/ticks"
  const char* encoding;         // of messages
  const char* schema_name;      // "burr.Ticks"
  const char* schema_encoding;  // "protobuf" or "jsonschema"
};
inline constexpr Topic kSession = {"/session", "json", "burr.Session", "jsonschema"};
inline constexpr Topic kTicks = {"/ticks", "protobuf", "burr.Ticks", "protobuf"};
inline constexpr Topic kCommands = {"/wishes", "json", "burr.Wish", "jsonschema"};
inline constexpr Topic kEvents = {"/events", "json", "burr.Event", "jsonschema"};
inline constexpr Topic kChanges = {"/bone/changes", "protobuf", "burr.Bricks", "protobuf"};
inline constexpr Topic kKeyframes = {"/bone/keyframes", "protobuf", "burr.Bricks", "protobuf"};
// since 2026-11-26; older recordings have neither
inline constexpr Topic kViews = {"/view", "json", "burr.View", "jsonschema"};
inline constexpr Topic kCourse = {"/course", "json", "burr.Course", "jsonschema"};
// since 2026-11-27, and only where a second hand took part: its rows, as those of /ticks
inline constexpr Topic kSecond = {"/second", "protobuf", "burr.Ticks", "protobuf"};
inline constexpr std::array<Topic, 9> kTopics = {kSession,   kTicks, kCommands, kEvents, kChanges,
                                                 kKeyframes, kViews, kCourse,   kSecond};
inline constexpr const char* kBoneAttachment = "bone";
inline constexpr const char* kAccountName = "burr.account";  // metadata: counts of rows
inline constexpr const char* kBoneMediaType = "application/x-burr-bone";

// The text or bytes of a schema, as written in the file.
[[nodiscard]] std::string schema_data(std::string_view schema_name);

// ---- ticks (tick_columns.cpp)
void encode_ticks(std::span<const tick::TickRow> rows, BytesOut& out);
// Appends the rows of a message. False: malformed, nothing is appended.
[[nodiscard]] bool decode_ticks(ByteSpan message, std::vector<tick::TickRow>& rows);
// Bytes of a row that are written; for the test that no field is forgotten.
[[nodiscard]] std::size_t tick_columns_size();

// ---- commands (command_json.cpp)
[[nodiscard]] std::string to_json(const tick::CommandRow& row);
[[nodiscard]] bool command_from_json(std::string_view text, tick::CommandRow& row);

// ---- bricks (bricks.cpp)
// The content of a brick; tissue only where it differs from the bone as it was opened.
struct BrickContent {
  volume::BrickField field = {};
  std::array<volume::TissueId, volume::kBrickVoxels> tissue = {};
  bool has_tissue = false;
  [[nodiscard]] std::uint32_t crc() const;  // of field, then of tissue if there is one
};

// A message of /bone/changes (contents XORed with what they were before, zero the first time) or
// of /bone/keyframes (contents as they are).
struct Bricks {
  std::uint64_t batch = 0;            // changes: 1, 2, 3 ...; keyframe: the last batch it contains
  std::uint32_t part = 0, parts = 1;  // keyframe: several messages make one
  std::vector<std::uint64_t> tick;    // (n) the state is that after this tick
  std::vector<std::int32_t> brick;    // (n)
  std::vector<std::uint32_t> crc;     // (n) BrickContent::crc() after the change
  std::vector<BrickContent> content;  // (n)
};
void encode_bricks(const Bricks& bricks, BytesOut& out);
[[nodiscard]] bool decode_bricks(ByteSpan message, Bricks& bricks);

// to ^= change
void apply_xor(BrickContent& to, const BrickContent& change);

}  // namespace burr::record

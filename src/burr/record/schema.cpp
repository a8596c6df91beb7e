#include "burr/record/schema.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <type_traits>

#include "burr/record/course.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/session_info.h"
#include "burr/record/view.h"
#include "burr/tool/limits.h"

namespace burr::record {
namespace {

using nlohmann::json;

// ---- the part of Protocol Buffers that is needed here (protobuf.dev/programming-guides/encoding)

constexpr std::uint32_t kVarint = 0, kFixed64 = 1, kBlock = 2, kFixed32 = 5;

void put_varint(BytesOut& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.put(static_cast<std::uint8_t>(value | 0x80));
  out.put(static_cast<std::uint8_t>(value));
}
void put_tag(BytesOut& out, std::uint32_t field, std::uint32_t wire) {
  put_varint(out, (std::uint64_t{field} << 3) | wire);
}
void put_number(BytesOut& out, std::uint32_t field, std::uint64_t value) {
  put_tag(out, field, kVarint);
  put_varint(out, value);
}
void put_block(BytesOut& out, std::uint32_t field, ByteSpan bytes) {
  put_tag(out, field, kBlock);
  put_varint(out, bytes.size());
  out.raw(bytes);
}
void put_block(BytesOut& out, std::uint32_t field, std::string_view text) {
  put_block(out, field, as_bytes(text));
}

std::uint64_t get_varint(BytesIn& in) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = in.get<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if ((byte & 0x80U) == 0) return value;
  }
  in.take(std::numeric_limits<std::uint64_t>::max());  // too long: makes ok() false
  return 0;
}

// Calls found(field, number, block) for each field; false: malformed.
template <class Found>
bool each_field(ByteSpan message, Found&& found) {
  BytesIn in(message);
  while (in.ok() && !in.empty()) {
    const std::uint64_t tag = get_varint(in);
    std::uint64_t number = 0;
    ByteSpan block;
    switch (tag & 7U) {
      case kVarint:
        number = get_varint(in);
        break;
      case kFixed64:
        number = in.get<std::uint64_t>();
        break;
      case kBlock:
        block = in.take(get_varint(in));
        break;
      case kFixed32:
        number = in.get<std::uint32_t>();
        break;
      default:
        return false;
    }
    if (!in.ok() || !found(tag >> 3, number, block)) return false;
  }
  return in.ok();
}

// ---- columns

enum class Type : std::uint8_t { f64, f32, u64, u32, i64, i32, flag, number, bytes };

std::size_t width(Type type) {
  switch (type) {
    case Type::f64:
    case Type::u64:
    case Type::i64:
      return 8;
    case Type::f32:
    case Type::u32:
    case Type::i32:
      return 4;
    default:
      return 1;
  }
}

// FieldDescriptorProto.Type
std::uint64_t proto_type(Type type) {
  switch (type) {
    case Type::f64:
      return 1;  // double
    case Type::f32:
      return 2;  // float
    case Type::u64:
      return 6;  // fixed64
    case Type::u32:
      return 7;  // fixed32
    case Type::i64:
      return 16;  // sfixed64
    case Type::i32:
      return 15;  // sfixed32
    case Type::flag:
      return 8;  // bool
    case Type::number:
      return 4;  // uint64, once
    case Type::bytes:
      return 12;
  }
  return 12;
}

struct FieldText {
  std::uint32_t number;
  const char* name;
  Type type;
  const char* meaning;  // with the unit in brackets
};

struct TickColumn {
  FieldText text;
  void* (*in)(tick::TickRow& row);  // its place in a row
  bool rarely = false;              // changes rarely: one value where all rows of a message agree
  bool absent = false;              // left out where it is zero in all rows of a message
};

#define BURR_AT(member) [](tick::TickRow& row) -> void* { return &row.member; }
const TickColumn kTickColumns[] = {
    {{1, "tick", Type::u64, "0, 1, 2 ... of the session; time is tick / rate_hz [1]"},
     BURR_AT(tick)},
    {{2, "hand_x_m", Type::f64, "tip of the tool as read, world LPS [m]"},
     BURR_AT(hand.world_from_tool.p.x())},
    {{3, "hand_y_m", Type::f64, "[m]"}, BURR_AT(hand.world_from_tool.p.y())},
    {{4, "hand_z_m", Type::f64, "[m]"}, BURR_AT(hand.world_from_tool.p.z())},
    {{5, "hand_qx", Type::f64, "world_from_tool as a unit quaternion [1]"},
     BURR_AT(hand.world_from_tool.q.x())},
    {{6, "hand_qy", Type::f64, "[1]"}, BURR_AT(hand.world_from_tool.q.y())},
    {{7, "hand_qz", Type::f64, "[1]"}, BURR_AT(hand.world_from_tool.q.z())},
    {{8, "hand_qw", Type::f64, "[1]"}, BURR_AT(hand.world_from_tool.q.w())},
    {{9, "hand_vx_m_per_s", Type::f64, "velocity of the tip as the device reports it [m/s]"},
     BURR_AT(hand.velocity.x())},
    {{10, "hand_vy_m_per_s", Type::f64, "[m/s]"}, BURR_AT(hand.velocity.y())},
    {{11, "hand_vz_m_per_s", Type::f64, "[m/s]"}, BURR_AT(hand.velocity.z())},
    {{12, "pedal", Type::f64, "spindle command, 0..1 of the set speed [1]"}, BURR_AT(hand.pedal)},
    {{13, "buttons", Type::u32, "bit i: button i is down"}, BURR_AT(hand.buttons)},
    {{14, "hand_valid", Type::flag, "false: the device lost track"}, BURR_AT(hand.valid)},
    {{15, "proxy_x_m", Type::f64, "centre of the burr head, never inside bone, world LPS [m]"},
     BURR_AT(contact.proxy.x())},
    {{16, "proxy_y_m", Type::f64, "[m]"}, BURR_AT(contact.proxy.y())},
    {{17, "proxy_z_m", Type::f64, "[m]"}, BURR_AT(contact.proxy.z())},
    {{18, "normal_x", Type::f64, "unit, out of the bone; zero while nothing is touched [1]"},
     BURR_AT(contact.normal.x())},
    {{19, "normal_y", Type::f64, "[1]"}, BURR_AT(contact.normal.y())},
    {{20, "normal_z", Type::f64, "[1]"}, BURR_AT(contact.normal.z())},
    {{21, "force_x_n", Type::f64, "force on the hand, after all limits, world LPS [N]"},
     BURR_AT(contact.force.x())},
    {{22, "force_y_n", Type::f64, "[N]"}, BURR_AT(contact.force.y())},
    {{23, "force_z_n", Type::f64, "[N]"}, BURR_AT(contact.force.z())},
    {{41, "torque_x_nm", Type::f64,
      "torque on the hand about the tip, after all limits, world LPS [N m]"},
     BURR_AT(contact.torque.x())},
    {{42, "torque_y_nm", Type::f64, "[N m]"}, BURR_AT(contact.torque.y())},
    {{43, "torque_z_nm", Type::f64, "[N m]"}, BURR_AT(contact.torque.z())},
    {{52, "unsent_torque_x_nm", Type::f64,
      "torque of the contact about the tip that the device cannot show, world LPS; absent: 0 [N "
      "m]"},
     BURR_AT(contact.unsent_torque.x()),
     false,
     true},
    {{53, "unsent_torque_y_nm", Type::f64, "[N m]"},
     BURR_AT(contact.unsent_torque.y()),
     false,
     true},
    {{54, "unsent_torque_z_nm", Type::f64, "[N m]"},
     BURR_AT(contact.unsent_torque.z()),
     false,
     true},
    {{55, "turn_x_rad", Type::f64,
      "how the tool is turned away from the hand, a rotation vector, world LPS; absent: 0 [rad]"},
     BURR_AT(contact.turn.x()),
     false,
     true},
    {{56, "turn_y_rad", Type::f64, "[rad]"}, BURR_AT(contact.turn.y()), false, true},
    {{57, "turn_z_rad", Type::f64, "[rad]"}, BURR_AT(contact.turn.z()), false, true},
    {{24, "depth_m", Type::f64, "distance of hand and proxy [m]"}, BURR_AT(contact.depth)},
    {{25, "active", Type::i32, "number of constraints that the proxy rests on"},
     BURR_AT(contact.active)},
    {{26, "candidates", Type::i32, "number of contacts examined"}, BURR_AT(contact.candidates)},
    {{27, "touching", Type::flag, "the burr touches bone"}, BURR_AT(contact.touching)},
    {{28, "flags", Type::u32, "bits of rt/flags.h: why the force is not simply that of the spring"},
     BURR_AT(contact.flags)},
    {{29, "asked_m3", Type::f64, "volume asked for by the removal law since the start [m^3]"},
     BURR_AT(ledger.asked)},
    {{30, "removed_m3", Type::f64, "really removed [m^3]"}, BURR_AT(ledger.removed)},
    {{31, "debt_m3", Type::f64, "asked for, not yet removed [m^3]"}, BURR_AT(ledger.debt)},
    {{32, "not_cut_m3", Type::f64, "asked for, given up because the burr was blocked [m^3]"},
     BURR_AT(ledger.not_cut)},
    {{33, "added_m3", Type::f64, "deposited [m^3]"}, BURR_AT(ledger.added)},
    {{34, "cutting_energy_j", Type::f64, "energy spent on cutting since the start [J]"},
     BURR_AT(ledger.energy)},
    {{51, "undone_m3", Type::f64,
      "of the removed volume: brought back by undo and reset, and not redone [m^3]"},
     BURR_AT(ledger.undone)},
    {{70, "moved_m3", Type::f64,
      "lost where pieces were moved, below 0 gained: resampled, and overlap with other bone; undo "
      "takes it back; absent: 0 [m^3]"},
     BURR_AT(ledger.moved),
     false,
     true},
    // a piece that was lifted out of the bone
    {{71, "piece_state", Type::i32,
      "a piece was lifted out of the bone: 1 it lies, 2 this hand holds it, 3 the second hand; "
      "absent: 0, none"},
     BURR_AT(piece.state),
     false,
     true},
    {{72, "piece_x_m", Type::f64, "its centre, world LPS; absent: 0 [m]"},
     BURR_AT(piece.p.x()),
     false,
     true},
    {{73, "piece_y_m", Type::f64, "[m]"}, BURR_AT(piece.p.y()), false, true},
    {{74, "piece_z_m", Type::f64, "[m]"}, BURR_AT(piece.p.z()), false, true},
    {{75, "piece_qx", Type::f64,
      "its turn from where it came free, a unit quaternion; absent: 0 [1]"},
     BURR_AT(piece.turn[0]),
     false,
     true},
    {{76, "piece_qy", Type::f64, "[1]"}, BURR_AT(piece.turn[1]), false, true},
    {{77, "piece_qz", Type::f64, "[1]"}, BURR_AT(piece.turn[2]), false, true},
    {{78, "piece_qw", Type::f64, "[1]"}, BURR_AT(piece.turn[3]), false, true},
    // a law of one's own
    {{79, "law_state", Type::i64,
      "a law of one's own: 1 it acts, 2 it is off because it gave what cannot be; absent: 0, none, "
      "or it "
      "was not asked"},
     BURR_AT(law.state),
     false,
     true},
    {{80, "law_force_x_n", Type::f64,
      "its force on the hand, before guard and limits, world LPS; absent: 0 [N]"},
     BURR_AT(law.force.x()),
     false,
     true},
    {{81, "law_force_y_n", Type::f64, "[N]"}, BURR_AT(law.force.y()), false, true},
    {{82, "law_force_z_n", Type::f64, "[N]"}, BURR_AT(law.force.z()), false, true},
    {{83, "law_energy_j", Type::f64,
      "what it pays for cutting in this tick; below 0: burr's law decides; absent: 0 [J]"},
     BURR_AT(law.energy),
     false,
     true},
    {{84, "law_torque_nm", Type::f64, "torque of the bone on the burr, by it; absent: 0 [N m]"},
     BURR_AT(law.torque),
     false,
     true},
    {{35, "spindle_rad_per_s", Type::f64, "speed of the burr now [rad/s]"}, BURR_AT(spindle_rad_s)},
    {{39, "cutting_torque_nm", Type::f64, "torque of the bone on the burr [N m]"},
     BURR_AT(cutting_nm)},
    {{40, "cutting_power_w", Type::f64, "power that goes into the bone [W]"}, BURR_AT(cutting_w)},
    {{36, "took_us", Type::f32, "work of this tick, thread CPU time; not hashed [us]"},
     BURR_AT(took_us)},
    {{37, "late_us", Type::f32, "start after its due time; not hashed [us]"}, BURR_AT(late_us)},
    {{38, "hash", Type::u64, "hash of the tick's inputs, outcome and ledger"}, BURR_AT(hash)},
    // the tool in the hand
    {{44, "tool_kind", Type::i32,
      "burr in the hand after this tick's commands, obeyed or refused: 0 cutting, 1 diamond; "
      "columns 44 to 50 are not hashed, and a single value holds for every row of the message"},
     BURR_AT(tool.kind),
     true},
    {{45, "tool_radius_m", Type::f64, "radius of the burr's head; 0: not known [m]"},
     BURR_AT(tool.radius),
     true},
    {{46, "tool_mode", Type::i32, "0 cut, 1 add, 2 touch, 3 back to the original, 4 smooth"},
     BURR_AT(tool.mode),
     true},
    {{47, "tool_full_speed_rad_per_s", Type::f64,
      "speed of the spindle at full pedal; below 0: backwards [rad/s]"},
     BURR_AT(tool.full_speed),
     true},
    {{48, "coolant", Type::flag, "coolant runs over the burr"}, BURR_AT(tool.irrigated), true},
    {{49, "mirror_axis", Type::i32,
      "axis of the grid square to the mirror plane: 0 i, 1 j, 2 k; -1: no mirror"},
     BURR_AT(tool.mirror_axis),
     true},
    {{50, "mirror_half_voxel", Type::i32, "place of the mirror plane along that axis [voxel / 2]"},
     BURR_AT(tool.mirror_twice),
     true},
    {{58, "tool_number", Type::i32,
      "of the tool in the session's list `tools`; -1 or absent: the round burr"},
     BURR_AT(tool.number),
     true},
};
#undef BURR_AT

constexpr std::uint32_t kBatch = 1, kPart = 2, kParts = 3, kTick = 4, kBrick = 5, kCrc = 6,
                        kField = 7, kHasTissue = 8, kTissue = 9;
const FieldText kBrickFields[] = {
    {kBatch, "batch", Type::number,
     "changes: number of this message, 1, 2, 3 ...; keyframe: the last batch it contains"},
    {kPart, "part", Type::number, "keyframe: number of this message, from 0"},
    {kParts, "parts", Type::number, "keyframe: how many messages it has"},
    {kTick, "tick", Type::u64, "per brick: its state after this tick"},
    {kBrick, "brick", Type::i32,
     "per brick: bi + nbi * (bj + nbj * bk), where nb = ceil(grid size / 8)"},
    {kCrc, "crc", Type::u32,
     "per brick: CRC-32 of its whole content after the change, field then tissue"},
    {kField, "field", Type::bytes,
     "per brick 512 little-endian uint16, x fastest: 0 air .. 32768 surface .. 65535 solid. "
     "In /bone/changes XORed with the same brick's field before (zeros the first time)"},
    {kHasTissue, "has_tissue", Type::flag, "per brick: its tissue was changed by deposit"},
    {kTissue, "tissue", Type::bytes,
     "per brick with has_tissue 512 uint8: index into the session's tissues; XORed likewise"},
};

// One value for all rows of the message, where its columns are such.
bool agree(std::span<const tick::TickRow> rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](const tick::TickRow& row) { return row.tool == rows.front().tool; });
}

// A file may say anything.
bool possible(const tool::ToolState& tool) {
  constexpr int kLast = static_cast<int>(tool::kMostTools) - 1;
  constexpr double kWidest = 0.05;  // [m]
  const auto within = [](int value, int least, int most) {
    return value >= least && value <= most;
  };
  return tool.radius >= 0 && tool.radius <= kWidest && std::isfinite(tool.full_speed) &&
         within(static_cast<int>(tool.kind), 0, 1) &&
         within(static_cast<int>(tool.mode), 0, tool::kModes - 1) &&
         within(tool.mirror_axis, -1, 2) && within(tool.number, -1, kLast);
}

// ---- FileDescriptorSet (google/protobuf/descriptor.proto), written by hand

std::string descriptor(const char* message_name, std::span<const FieldText> fields) {
  BytesOut type;
  put_block(type, 1, std::string_view(message_name));
  for (const FieldText& text : fields) {
    const bool repeated = text.type != Type::number && text.type != Type::bytes;
    BytesOut field;
    put_block(field, 1, std::string_view(text.name));
    put_number(field, 3, text.number);
    put_number(field, 4, repeated ? 3 : 1);  // label
    put_number(field, 5, proto_type(text.type));
    put_block(type, 2, field.span());
  }
  // comments: path to the field [message_type, 0, field, i], an invented position, and the text
  BytesOut comments;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    BytesOut path, place, location;
    for (const std::uint64_t step : {std::uint64_t{4}, std::uint64_t{0}, std::uint64_t{2}})
      put_varint(path, step);
    put_varint(path, i);
    for (const std::uint64_t number : {i + 4, std::size_t{2}, std::size_t{40}})
      put_varint(place, number);
    put_block(location, 1, path.span());
    put_block(location, 2, place.span());
    put_block(location, 3, std::string_view(fields[i].meaning));
    put_block(comments, 1, location.span());
  }
  BytesOut file;
  put_block(file, 1, std::string("burr/") + message_name + ".proto");
  put_block(file, 2, std::string_view("burr"));
  put_block(file, 4, type.span());
  put_block(file, 9, comments.span());
  put_block(file, 12, std::string_view("proto3"));
  BytesOut set;
  put_block(set, 1, file.span());
  return std::string(as_text(set.span()));
}

// ---- JSON schemas

constexpr const char* kSessionSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Session",
 "description": "What the session was; once, before the first tick.",
 "type": "object",
 "properties": {
  "burr_version": {"type": "string"},
  "build": {"type": "string", "description": "compiler and kind; replay is to the bit on the same build"},
  "rate_hz": {"type": "number", "description": "ticks per second"},
  "seed": {"type": "string", "description": "hexadecimal, 64 bit"},
  "numbers": {"type": "object", "description": "settings; units are in the names", "additionalProperties": {"type": "number"}},
  "words": {"type": "object", "description": "settings in words", "additionalProperties": {"type": "string"}},
  "embedded": {"type": "boolean", "description": "the bone is in the attachment \"bone\""},
  "volume": {
   "type": "object",
   "description": "the bone the session began with",
   "properties": {
    "content_hash": {"type": "string", "description": "hexadecimal, of the bone before the first tick"},
    "source_fingerprint": {"type": "string", "description": "hexadecimal, of the file or folder it was read from; 0 if none"},
    "grid": {
     "type": "object",
     "properties": {
      "size": {"type": "array", "items": {"type": "integer"}, "description": "voxels along i, j, k"},
      "voxel_m": {"type": "number", "description": "edge of a voxel [m]"},
      "origin_m": {"type": "array", "items": {"type": "number"}, "description": "centre of voxel 0,0,0 in LPS [m]"},
      "axes_xyzw": {"type": "array", "items": {"type": "number"}, "description": "world_from_grid as a unit quaternion"}
     }
    },
    "tissues": {
     "type": "array",
     "description": "index is the tissue id of a voxel",
     "items": {
      "type": "object",
      "properties": {
       "name": {"type": "string"},
       "kind": {"enum": ["air", "soft", "solid"]},
       "colour_srgb": {"type": "array", "items": {"type": "number"}, "description": "0..1"},
       "cutting_energy_j_per_m3": {"type": "number", "description": "specific cutting energy [J/m^3]"},
       "friction": {"type": "number", "description": "of a standing burr"},
       "cutting_friction": {"type": "number", "description": "tangential over normal force of a cut"},
       "cutting_force": {"type": "object", "description": "of the chips law", "additionalProperties": {"type": "number"}},
       "spare": {"type": "boolean", "description": "must not be cut"},
       "bleeds": {"type": "number", "description": "where it is opened: 0 not, 1 as a vessel; a picture only"},
       "label": {"type": "integer", "description": "value in the file it came from"}
      }
     }
    },
    "has_intensity": {"type": "boolean"},
    "format": {"type": "string", "description": "of the file; formula for a phantom"},
    "recipe": {
     "type": "object",
     "description": "how the bone was made; lengths in mm, levels in HU or the file's unit; no paths",
     "properties": {
      "source": {"type": "string", "description": "phantom:NAME, or empty: the user's file"},
      "series": {"type": "string", "description": "#2 as burr info lists them, or own: by its UID"},
      "spacing_mm": {"type": "array", "items": {"type": "number"}, "description": "instead of the file's"},
      "region": {"type": "array", "items": {"type": "integer"}, "description": "voxels of the file, first and last: i0, i1, j0, j1, k0, k1"},
      "allow_missing": {"type": "boolean", "description": "made though slices could not be read, or are not there"},
      "as_it_is": {"type": "boolean", "description": "made though the scan contradicts itself or is no CT"},
      "voxel_mm": {"type": "number", "description": "0: the finest axis"},
      "iso": {"type": "number", "description": "level of the surface"},
      "smooth": {"type": "number", "description": "noise removed; below 0: as measured"},
      "labels": {"type": "string", "description": "own: a table of the user's"},
      "materials": {"type": "string", "description": "own: a table of the user's"},
      "memory_mb": {"type": "number"},
      "keep": {"type": "object", "description": "which separate parts of the bone were kept; absent: all", "properties": {"largest": {"type": "integer", "description": "so many of the largest"}, "at_mm": {"type": "array", "items": {"type": "array", "items": {"type": "number"}}, "description": "and the parts at these points, LPS"}}},
      "drop_islands_mm3": {"type": "number", "description": "smaller parts were removed; absent: none"},
      "read_seconds": {"type": "number"},
      "read_memory_mb": {"type": "number"},
      "reserve_bricks": {"type": "integer", "description": "room for deposits"},
      "bone_law": {"type": "integer", "description": "by which law bone was made of a scan; absent: 1"},
      "margin": {"type": "boolean", "description": "layers of air where the scan's border cuts bone; absent: false"},
      "check_values": {"type": "boolean", "description": "the header's word on the values is checked, and the level of a scan without HU is estimated; absent: false"},
      "check_scan": {"type": "boolean", "description": "what should be there was compared with what is there, and inverted values were turned; absent: false"}
     }
    }
   }
  },
  "identity": {
   "type": "object",
   "description": "which session this is; no names",
   "properties": {
    "mode": {"enum": ["free", "learn", "practise", "exam"], "description": "what the session was for"},
    "learner": {"type": "string", "description": "a pseudonym; absent: nobody said who"},
    "attempt": {"type": "integer", "description": "of this learner at this case, from 1; 0: not counted"},
    "case_hash": {"type": "string", "description": "hexadecimal, the text_hash of the case; 0: no case"},
    "rubric_hash": {"type": "string", "description": "hexadecimal, of the rubric that was shown; 0: none"},
    "labels_hash": {"type": "string", "description": "hexadecimal, of the tissue of every voxel and the tissues' names"},
    "accepted_labels": {"type": "array", "items": {"type": "string"}, "description": "structures whose labels the user accepted in spite of their faults; absent: none"}
   }
  },
  "shaft": {
   "type": "object",
   "description": "of the tool, behind the head",
   "properties": {"radius_m": {"type": "number"}, "length_m": {"type": "number"}}
  },
  "second": {
   "type": "object",
   "description": "the other hand; absent: there was none. Its rows are in /second, where tool_number 0 is its tool and the ledger is its own share",
   "properties": {
    "numbers": {"type": "object", "description": "settings; units are in the names", "additionalProperties": {"type": "number"}},
    "device": {"type": "string"},
    "tools": {"type": "array", "description": "one tool, as in tools; empty: a ball that never cuts"}
   }
  },
  "tools": {
   "type": "array",
   "description": "tools other than the round burr that the session could take; lengths in m",
   "items": {"type": "object", "properties": {
    "name": {"type": "string"},
    "parts": {"type": "array", "items": {"type": "object", "properties": {
     "shape": {"enum": ["ball", "capsule", "cylinder", "frustum", "vesica", "box", "wedge", "half_shell", "tube", "grid"]},
     "sizes_m": {"type": "array", "items": {"type": "number"}, "description": "a, b, c and the rounding"},
     "grid": {"type": "object", "description": "only of a grid, whose a is the edge of a cell; docs/understand/touch_tools.md", "properties": {
      "size": {"type": "array", "items": {"type": "integer"}, "description": "nodes along x, y, z"},
      "phi": {"type": "array", "items": {"type": "integer"}, "description": "distances in cells / 256, below 0 inside; x changes fastest"}}},
     "at_m": {"type": "array", "items": {"type": "number"}},
     "turn_xyzw": {"type": "array", "items": {"type": "number"}, "description": "tool_from_part"},
     "role": {"enum": ["cuts", "rubs", "seen"]}}}},
    "cutter": {"type": "object", "description": "how it moves; units are in the names"}}}
  },
  "case": {
   "type": "object",
   "description": "the case of the session",
   "properties": {
    "name": {"type": "string"},
    "text": {"type": "string", "description": "TOML; the path of a volume replaced by: own file"},
    "text_hash": {"type": "string", "description": "FNV-1a, 64 bits, of text"},
    "targets": {"type": "array", "items": {"type": "object", "properties": {"tissue": {"type": "string"}, "goal": {"enum": ["open", "expose", "remove"]}, "share": {"type": "number"}}}},
    "spare": {"type": "array", "items": {"type": "string"}}
   }
  }
 }
})";

constexpr const char* kCommandSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Wish",
 "description": "A command that the servo took at the start of a tick.",
 "type": "object",
 "properties": {
  "tick": {"type": "integer"},
  "kind": {"enum": ["spindle_speed", "burr_radius", "stiffness", "user_force", "tool_mode", "undo", "redo", "reset", "friction", "load", "touch_method", "removal_law", "irrigation", "mirror_i", "mirror_j", "mirror_k", "mirror_off", "burr_kind", "tool", "move_piece", "lift_piece", "shift_piece", "let_go", "leave_piece", "take_splinter"]},
  "value": {"type": ["number", "string"], "description": "spindle_speed rad/s; burr_radius m; stiffness N/m; user_force N; tool_mode 0 cut, 1 add, 2 touch, 3 back to the original, 4 smooth; friction scale; touch_method 0 constraint, 1 thesis, 2 thesis-literal, 3 voxel-springs, 4 samples, 5 triangles, 6 penalty, 7 shaft; removal_law 0 energy, 1 thesis, 2 chips; irrigation 0 off, 1 on; mirror_i, mirror_j, mirror_k place of the plane along that axis of the grid, voxels; burr_kind 0 cutting, 1 diamond; tool number in tools, -1 the round burr; move_piece and lift_piece number of the piece, 0 the first that was moved; \"nan\", \"inf\", \"-inf\" as strings"},
  "piece": {"type": "object", "description": "of move_piece, lift_piece and shift_piece", "properties": {
   "seed": {"type": "array", "items": {"type": "integer"}, "description": "a voxel of the piece where it came free"},
   "by_m": {"type": "array", "items": {"type": "number"}, "description": "from where it came free, not from where it lay: after a turn about its centre, LPS [m]"},
   "turn_xyzw": {"type": "array", "items": {"type": "number"}, "description": "the turn, a unit quaternion"},
   "writes": {"type": "integer", "description": "how often the bone had been written when the move was prepared; another number: refused"},
   "bricks": {"type": "string", "description": "hexadecimal, hash of the bricks after the move"},
   "body": {"type": "string", "description": "of lift_piece: hexadecimal, hash of the distances to the piece's surface and of where it lay"},
   "lifted": {"type": "boolean", "description": "of move_piece: the piece was lifted before; absent: it was not"},
   "specks": {"type": "boolean", "description": "what lay loose in the pores of the piece went with it; absent: it stayed"}
  }}
 }
})";

constexpr const char* kEventSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Event",
 "description": "What happened to the recording itself.",
 "type": "object",
 "properties": {
  "event": {"enum": ["dropped", "finished", "stopped"],
             "description": "stopped: the session was ended before its time, by a signal"},
  "tick": {"type": "integer", "description": "last tick written"},
  "dropped_ticks": {"type": "integer", "description": "rows lost so far because the ring was full"},
  "dropped_wishes": {"type": "integer"},
  "dropped_bricks": {"type": "integer"},
  "dropped_notes": {"type": "integer", "description": "messages of /view and /course"}
 }
})";

const char* command_name(tick::CommandKind kind) {
  switch (kind) {
    case tick::CommandKind::spindle_speed:
      return "spindle_speed";
    case tick::CommandKind::burr_radius:
      return "burr_radius";
    case tick::CommandKind::stiffness:
      return "stiffness";
    case tick::CommandKind::user_force:
      return "user_force";
    case tick::CommandKind::tool_mode:
      return "tool_mode";
    case tick::CommandKind::undo:
      return "undo";
    case tick::CommandKind::redo:
      return "redo";
    case tick::CommandKind::reset:
      return "reset";
    case tick::CommandKind::friction:
      return "friction";
    case tick::CommandKind::shed:
      return "load";
    case tick::CommandKind::touch_method:
      return "touch_method";
    case tick::CommandKind::removal_law:
      return "removal_law";
    case tick::CommandKind::irrigation:
      return "irrigation";
    case tick::CommandKind::mirror_i:
      return "mirror_i";
    case tick::CommandKind::mirror_j:
      return "mirror_j";
    case tick::CommandKind::mirror_k:
      return "mirror_k";
    case tick::CommandKind::mirror_off:
      return "mirror_off";
    case tick::CommandKind::burr_kind:
      return "burr_kind";
    case tick::CommandKind::tool:
      return "tool";
    case tick::CommandKind::move_piece:
      return "move_piece";
    case tick::CommandKind::lift_piece:
      return "lift_piece";
    case tick::CommandKind::shift_piece:
      return "shift_piece";
    case tick::CommandKind::let_go:
      return "let_go";
    case tick::CommandKind::leave_piece:
      return "leave_piece";
    case tick::CommandKind::take_splinter:
      return "take_splinter";
  }
  return "";
}

template <class T>
ByteSpan bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
bool values_of(ByteSpan bytes, std::vector<T>& values) {
  if (bytes.size() % sizeof(T) != 0) return false;
  values.resize(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return true;
}

}  // namespace

std::string schema_data(std::string_view schema_name) {
  if (schema_name == kSession.schema_name) return kSessionSchema;
  if (schema_name == kCommands.schema_name) return kCommandSchema;
  if (schema_name == kEvents.schema_name) return kEventSchema;
  if (schema_name == kViews.schema_name) return view_schema();
  if (schema_name == kCourse.schema_name) return course_schema();
  if (schema_name == kChanges.schema_name) return descriptor("Bricks", kBrickFields);
  std::vector<FieldText> fields;
  for (const TickColumn& column : kTickColumns) fields.push_back(column.text);
  return descriptor("Ticks", fields);
}

void encode_ticks(std::span<const tick::TickRow> rows, BytesOut& out) {
  BytesOut packed;
  // the access functions need rows that are not const
  std::vector<tick::TickRow> mine(rows.begin(), rows.end());
  const std::size_t few = agree(rows) ? std::min<std::size_t>(1, rows.size()) : rows.size();
  for (const TickColumn& column : kTickColumns) {
    packed.clear();
    for (tick::TickRow& row : std::span(mine).first(column.rarely ? few : mine.size())) {
      if (column.text.type == Type::flag)
        packed.put(static_cast<std::uint8_t>(*static_cast<bool*>(column.in(row)) ? 1 : 0));
      else
        packed.raw(column.in(row), width(column.text.type));
    }
    const ByteSpan bytes = packed.span();
    if (column.absent &&
        std::all_of(bytes.begin(), bytes.end(), [](auto byte) { return byte == 0; }))
      continue;
    put_block(out, column.text.number, bytes);
  }
}

bool decode_ticks(ByteSpan message, std::vector<tick::TickRow>& rows) {
  constexpr std::size_t kColumns = std::size(kTickColumns);
  std::array<ByteSpan, kColumns> columns{};
  if (!each_field(message, [&](std::uint64_t field, std::uint64_t, ByteSpan block) {
        for (std::size_t c = 0; c < kColumns; ++c)
          if (kTickColumns[c].text.number == field) columns[c] = block;
        return true;
      }))
    return false;

  // each column has one value per row, or is empty because the burr that wrote it did not know it
  const std::size_t count = columns[0].size() / sizeof(std::uint64_t);
  for (std::size_t c = 0; c < kColumns; ++c)
    if (!(columns[c].empty() && c > 0) &&
        columns[c].size() != count * width(kTickColumns[c].text.type) &&
        !(kTickColumns[c].rarely && columns[c].size() == width(kTickColumns[c].text.type)))
      return false;

  const std::size_t before = rows.size();
  rows.resize(before + count);
  for (std::size_t c = 0; c < kColumns; ++c) {
    if (columns[c].empty()) continue;
    const std::size_t size = width(kTickColumns[c].text.type);
    for (std::size_t r = 0; r < count; ++r) {
      const std::uint8_t* from = columns[c].data() + (columns[c].size() == size ? 0 : r * size);
      void* to = kTickColumns[c].in(rows[before + r]);
      if (kTickColumns[c].text.type == Type::flag)
        *static_cast<bool*>(to) = *from != 0;
      else
        std::memcpy(to, from, size);
    }
  }
  if (std::all_of(rows.begin() + static_cast<std::ptrdiff_t>(before), rows.end(),
                  [](const tick::TickRow& row) { return possible(row.tool); }))
    return true;
  rows.resize(before);
  return false;
}

std::size_t tick_columns_size() {
  std::size_t size = 0;
  for (const TickColumn& column : kTickColumns) size += width(column.text.type);
  return size;
}

namespace {

bool tells_of_piece(tick::CommandKind kind) {
  return kind == tick::CommandKind::move_piece || kind == tick::CommandKind::lift_piece ||
         kind == tick::CommandKind::shift_piece || kind == tick::CommandKind::take_splinter;
}

}  // namespace

std::string to_json(const tick::CommandRow& row) {
  json object = {
      {"tick", row.tick}, {"kind", command_name(row.command.kind)}, {"value", row.command.value}};
  if (std::isnan(row.command.value)) object["value"] = "nan";
  if (std::isinf(row.command.value)) object["value"] = row.command.value > 0 ? "inf" : "-inf";
  if (tells_of_piece(row.command.kind)) {
    const edit::PieceMove& move = row.command.move;
    object["piece"] = {{"seed", move.seed},
                       {"by_m", move.by},
                       {"turn_xyzw", move.turn},
                       {"writes", move.writes},
                       {"bricks", hex(move.bricks)}};
    if (move.body != 0) object["piece"]["body"] = hex(move.body);
    if (move.lifted) object["piece"]["lifted"] = true;
    if (move.specks) object["piece"]["specks"] = true;
  }
  return object.dump();
}

namespace {

template <class T, std::size_t N>
bool numbers_from(const json& object, const char* name, std::array<T, N>& to) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array() || found->size() != N) return false;
  constexpr double kMost = std::is_integral_v<T> ? 2147483647.0 : 1e300;
  for (std::size_t n = 0; n < N; ++n) {
    const json& one = (*found)[n];
    if (!one.is_number() || !(std::abs(one.get<double>()) <= kMost)) return false;
    to[n] = one.get<T>();
  }
  return true;
}

bool hash_from(const json& object, const char* name, std::uint64_t& to) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return false;
  const std::string text = found->get<std::string>();
  if (text.size() < 3 || text.compare(0, 2, "0x") != 0) return false;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + 2, end, to, 16);
  return read.ec == std::errc() && read.ptr == end;
}

bool move_from_json(const json& object, double number, edit::PieceMove& move) {
  constexpr double kMostPieces = 65536;
  const auto piece = object.find("piece");
  if (piece == object.end() || !piece->is_object() || !(number >= 0 && number < kMostPieces))
    return false;
  const auto writes = piece->find("writes");
  if (writes == piece->end() || !writes->is_number_unsigned() ||
      !hash_from(*piece, "bricks", move.bricks))
    return false;
  if (piece->contains("body") && !hash_from(*piece, "body", move.body)) return false;
  for (const auto& [name, flag] : {std::pair{"lifted", &move.lifted}, {"specks", &move.specks}}) {
    const auto found = piece->find(name);
    if (found == piece->end()) continue;
    if (!found->is_boolean()) return false;
    *flag = found->get<bool>();
  }
  move.piece = static_cast<std::uint32_t>(number);
  move.writes = writes->get<std::uint64_t>();
  return numbers_from(*piece, "seed", move.seed) && numbers_from(*piece, "by_m", move.by) &&
         numbers_from(*piece, "turn_xyzw", move.turn);
}

}  // namespace

bool command_from_json(std::string_view text, tick::CommandRow& row) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return false;
  const auto tick = object.find("tick"), kind = object.find("kind"), value = object.find("value");
  if (tick == object.end() || !tick->is_number_unsigned() || kind == object.end() ||
      !kind->is_string() || value == object.end())
    return false;
  row.tick = tick->get<std::uint64_t>();
  if (value->is_number()) {
    row.command.value = value->get<double>();
  } else {
    const double infinity = std::numeric_limits<double>::infinity();
    if (*value == "nan")
      row.command.value = std::numeric_limits<double>::quiet_NaN();
    else if (*value == "inf" || *value == "-inf")
      row.command.value = *value == "inf" ? infinity : -infinity;
    else
      return false;
  }
  for (unsigned k = 0; k < 256; ++k) {
    const auto known = static_cast<tick::CommandKind>(k);
    const std::string_view name = command_name(known);
    if (name.empty()) break;
    if (*kind == name) {
      row.command.kind = known;
      row.command.move = {};
      return !tells_of_piece(known) || move_from_json(object, row.command.value, row.command.move);
    }
  }
  return false;
}

std::uint32_t BrickContent::crc() const {
  const std::uint32_t of_field =
      crc32({reinterpret_cast<const std::uint8_t*>(field.voxel), sizeof field.voxel});
  return has_tissue ? crc32(of_field, tissue) : of_field;
}

void apply_xor(BrickContent& to, const BrickContent& change) {
  for (std::size_t v = 0; v < std::size(to.field.voxel); ++v)
    to.field.voxel[v] = static_cast<volume::Field>(to.field.voxel[v] ^ change.field.voxel[v]);
  if (!change.has_tissue) return;
  to.has_tissue = true;
  for (std::size_t v = 0; v < to.tissue.size(); ++v)
    to.tissue[v] = static_cast<volume::TissueId>(to.tissue[v] ^ change.tissue[v]);
}

void encode_bricks(const Bricks& bricks, BytesOut& out) {
  put_number(out, kBatch, bricks.batch);
  put_number(out, kPart, bricks.part);
  put_number(out, kParts, bricks.parts);
  put_block(out, kTick, bytes_of(bricks.tick));
  put_block(out, kBrick, bytes_of(bricks.brick));
  put_block(out, kCrc, bytes_of(bricks.crc));
  BytesOut field, has_tissue, tissue;
  for (const BrickContent& content : bricks.content) {
    field.raw(content.field.voxel, sizeof content.field.voxel);
    has_tissue.put(static_cast<std::uint8_t>(content.has_tissue ? 1 : 0));
    if (content.has_tissue) tissue.raw(content.tissue);
  }
  put_block(out, kField, field.span());
  put_block(out, kHasTissue, has_tissue.span());
  put_block(out, kTissue, tissue.span());
}

bool decode_bricks(ByteSpan message, Bricks& bricks) {
  bricks = {};
  ByteSpan field, has_tissue, tissue;
  const bool whole =
      each_field(message, [&](std::uint64_t number, std::uint64_t value, ByteSpan block) {
        switch (number) {
          case kBatch:
            bricks.batch = value;
            return true;
          case kPart:
            bricks.part = static_cast<std::uint32_t>(value);
            return true;
          case kParts:
            bricks.parts = static_cast<std::uint32_t>(value);
            return true;
          case kTick:
            return values_of(block, bricks.tick);
          case kBrick:
            return values_of(block, bricks.brick);
          case kCrc:
            return values_of(block, bricks.crc);
          case kField:
            field = block;
            return true;
          case kHasTissue:
            has_tissue = block;
            return true;
          case kTissue:
            tissue = block;
            return true;
          default:
            return true;
        }
      });
  const std::size_t count = bricks.tick.size();
  if (!whole || bricks.brick.size() != count || bricks.crc.size() != count ||
      field.size() != count * sizeof(volume::BrickField::voxel) || has_tissue.size() != count)
    return false;
  bricks.content.resize(count);
  BytesIn fields(field), tissues(tissue);
  for (std::size_t i = 0; i < count; ++i) {
    BrickContent& content = bricks.content[i];
    const ByteSpan voxels = fields.take(sizeof content.field.voxel);
    std::memcpy(content.field.voxel, voxels.data(), voxels.size());
    content.has_tissue = has_tissue[i] != 0;
    if (!content.has_tissue) continue;
    const ByteSpan ids = tissues.take(content.tissue.size());
    if (!tissues.ok()) return false;
    std::memcpy(content.tissue.data(), ids.data(), ids.size());
  }
  return tissues.empty();
}

}  // namespace burr::record

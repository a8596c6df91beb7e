// record/tick_columns.cpp - the columns of /ticks: each with its number, name, unit and place in a row, and the rows as
// bytes and back. The part "ticks" of schema.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "burr/record/protobuf.h"
#include "burr/record/schema.h"
#include "burr/record/schema_parts.h"
#include "burr/tool/limits.h"

namespace burr::record {
namespace {

using protobuf::each_field;
using protobuf::FieldText;
using protobuf::put_block;
using protobuf::Type;
using protobuf::width;

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

}  // namespace

std::string tick_schema() {
  std::vector<FieldText> fields;
  for (const TickColumn& column : kTickColumns) fields.push_back(column.text);
  return protobuf::descriptor("Ticks", fields);
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

}  // namespace burr::record

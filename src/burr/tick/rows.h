// tick/rows.h - the rows of a recording. Plain structs; the file holds named fields
// (record/tick_columns.cpp), not the bytes of these structs.
//
// Frame: world (LPS). Units: SI.
//
// Within one tick, the servo writes in this order: the commands taken, the bricks changed, then the
// TickRow. So a reader that has the row of a tick has everything that belongs to it.
#pragma once

#include <array>
#include <cstdint>

#include "burr/device/hand_state.h"
#include "burr/edit/ledger.h"
#include "burr/haptics/contact.h"
#include "burr/tick/command.h"
#include "burr/tool/state.h"
#include "burr/volume/bone.h"

namespace burr::tick {

// A piece that was lifted out of the bone. Zero where there is none.
struct PieceRow {
  static constexpr std::int32_t kNone = 0, kLies = 1, kHeld = 2, kHeldByOther = 3;
  std::int32_t state = kNone;         // held: by the hand of this row, or by the second hand
  math::Vec3 p = math::Vec3::Zero();  // its centre
  std::array<double, 4> turn = {0, 0, 0, 0};  // from where it came free: unit quaternion x, y, z, w
};

// What a custom law answered (tick/own_law.h). Zero where there is none, or it was not asked.
struct LawRow {
  static constexpr std::int64_t kNone = 0, kActs = 1, kOff = 2;  // off: it gave what cannot be
  std::int64_t state = kNone;
  math::Vec3 force = math::Vec3::Zero();  // before guard and limits                      [N]
  double energy = 0;                      // to spend on cutting; below 0: as burr        [J]
  double torque = 0;                      // of the bone on the burr                      [N m]
};

// One per tick: the inputs, the outcome, and a hash of both and of the ledger.
struct TickRow {
  std::uint64_t tick = 0;    // 0, 1, 2 ... of the session; time is tick / rate
  device::HandState hand;    // as read
  haptics::Contact contact;  // as felt
  edit::Ledger ledger;       // as cut
  double spindle_rad_s = 0;  // speed of the burr now; below 0: turns backwards
  double cutting_nm = 0;     // torque of the bone on the burr        [N m]
  double cutting_w = 0;      // power that goes into the bone         [W]
  PieceRow piece;            // after this tick
  LawRow law;                // in this tick
  tool::ToolState tool;      // in the hand, after this tick's commands; not part of the hash
  float took_us = 0;         // work of this tick, thread CPU time; not part of the hash
  float late_us = 0;         // after its due time; not part of the hash
  std::uint64_t hash = 0;
};

// A command, and the tick that obeyed it.
struct CommandRow {
  std::uint64_t tick = 0;
  Command command;
};

// A brick's whole field as it is after `tick`. Every brick that changes is written again within 100
// ms. Tissue comes along only where material was deposited, since nothing else changes it.
struct BrickRow {
  std::uint64_t tick = 0;
  volume::BrickIndex brick = volume::kNoBrick;
  bool has_tissue = false;
  volume::BrickField field = {};
  std::array<volume::TissueId, volume::kBrickVoxels> tissue = {};  // only if has_tissue
};

}  // namespace burr::tick

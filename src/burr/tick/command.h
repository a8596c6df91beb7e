// tick/command.h - commands of people and programs to a running session: another burr, undo, a
// mirror.
//
// The servo takes commands at the start of a tick, in the order in which they came. The result of a
// command is not here but in the rows that follow; a command that is refused changes nothing.
// Units: SI.
#pragma once

#include <cstdint>

#include "burr/edit/piece_move.h"

namespace burr::tick {

enum class CommandKind : std::uint8_t {
  spindle_speed,  // value: rad/s at full pedal
  burr_radius,    // value: m
  stiffness,      // value: N/m
  user_force,     // value: N, the user's own limit
  tool_mode,      // value: 0 cut, 1 add, 2 touch only, 3 back to the original, 4 smooth
  undo,           // the last stroke
  redo,           // the last undone stroke
  reset,          // everything back to the start
  friction,       // value: scale of the tissues' friction
  shed,           // value: tick/shed.h, what the servo puts off; its own command, first of its tick
  touch_method,   // value: haptics/touch_method.h, Method
  removal_law,    // value: edit/laws/removal.h, RemovalLaw
  irrigation,     // value: 0 off, 1 on
  mirror_i,       // value: of a plane across i, its place p_grid; what is done is mirrored by it
  mirror_j,       // likewise across j
  mirror_k,       // likewise across k
  mirror_off,
  burr_kind,    // value: 0 cutting, 1 diamond
  tool,         // value: number in the session's list of tools; -1: the round burr
  move_piece,   // value: number of the piece; the rest is in `move`
  lift_piece,   // out of the bone, to be held: likewise
  shift_piece,  // the lifted piece is wanted there: its centre at move.by, turned by move.turn
  let_go,  // the hand lets go of the lifted piece, and may hold it again once its button was up
  leave_piece,  // the lifted piece goes back to where it lay in the bone
  take_splinter,  // suction takes a splinter; value: 0 beside the first hand's tool, 1 the second hand's tube;
                  // the rest is in `move`
};
struct Command {
  CommandKind kind = CommandKind::spindle_speed;
  double value = 0;
  edit::PieceMove move = {};  // of commands for pieces
};

// What became of the command `move_piece`, `lift_piece` or `take_splinter` (restore.h).
enum class MoveState : std::uint8_t { none, waiting, moving, done, refused };

}  // namespace burr::tick

// tick/orders.h - commands become settings and tool state, at the start of a tick.
//
// A command that cannot be obeyed (a burr that has no room, an undo with nothing to undo) changes
// nothing. Every command that is taken is recorded, obeyed or not.
//
// Thread: servo; commands() has one writer, main. Memory: none after construction.
#pragma once

#include <cstdint>

#include "burr/rt/ring.h"
#include "burr/rt/rt.h"
#include "burr/tick/command.h"
#include "burr/tick/controls.h"
#include "burr/tick/cutting.h"
#include "burr/tick/hand.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/restore.h"
#include "burr/tick/servo_outbox.h"
#include "burr/tick/settings.h"
#include "burr/tick/shed.h"
#include "burr/tick/touch_methods.h"
#include "burr/volume/grid.h"

namespace burr::tick {

class Orders {
 public:
  // What commands change.
  struct Parts {
    Controls& controls;
    Hand& hand;
    TouchMethods& touch_by;
    Cutting& cutting;
    Restore& restore;
    HeldPiece& piece;
    Outbox& outbox;
  };
  Orders(const volume::Grid& grid, const Parts& parts)
      : grid_(grid), parts_(parts), settings_(parts.controls.settings) {}

  [[nodiscard]] rt::Ring<Command>& commands() BURR_RT { return commands_; }
  // Enters as a command, before all others of the next tick, if it differs from what holds.
  void request(Shed shed) BURR_RT { shed_requested_ = shed; }

  // Takes the waiting commands, some a tick; the rest waits.
  void take(std::uint64_t tick, std::uint32_t& flags) BURR_RT;

 private:
  void obey(const Command& command, std::uint32_t& flags) BURR_RT;
  void obey_on_piece(const Command& command, std::uint32_t& flags) BURR_RT;
  void set_stiffness(double stiffness) BURR_RT;
  void set_radius(double radius) BURR_RT;
  void set_mode(double mode) BURR_RT;
  void set_law(double law) BURR_RT;
  void set_shed(double shed) BURR_RT;
  void set_method(double method, std::uint32_t& flags) BURR_RT;
  void take_tool(double number, std::uint32_t& flags) BURR_RT;
  void begin_restore(CommandKind kind) BURR_RT;
  void shift_piece(const edit::PieceMove& move) BURR_RT;

  const volume::Grid& grid_;
  Parts parts_;
  ServoSettings& settings_;  // of the controls
  rt::Ring<Command> commands_{256};
  Shed shed_requested_ = Shed::none;
};

}  // namespace burr::tick

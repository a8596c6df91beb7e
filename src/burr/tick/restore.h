// tick/restore.h - undo, redo, reset, and a piece that is put somewhere else; some ticks long.
//
//     lifting     the tool goes back the way it came, until what returns cannot touch it; for a
//                 piece the hand is released, and engages again in free air
//     restoring   bricks are put back, a few a tick; those of a piece were prepared elsewhere
//     settling    their surface is made again; then the tool follows the hand again
//
// Thread: servo; lay_ready() and move_state() one other. Frame: world. Units: SI. Memory: the way of the tool, 1.5 MiB, at construction.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "burr/edit/bone_writer.h"
#include "burr/edit/moved_bricks.h"
#include "burr/edit/piece_move.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tick/command.h"
#include "burr/tick/hand.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

class Restore {
 public:
  Restore(const volume::Bone& bone, const volume::IsoVertices& surface, edit::UndoStore& undo,
          edit::BoneWriter& writer, const ServoSettings& settings, Hand& hand, HeldPiece& piece);

  // kind: undo, redo, reset or leave_piece. False: one is in progress already, or there is nothing to put
  // back. While a piece is lifted an undo is a leave_piece, and nothing can be redone.
  bool begin(CommandKind kind) BURR_RT;
  [[nodiscard]] bool active() const BURR_RT { return state_ != State::none; }

  // A piece leaves the bone, is put down or goes back: this needs no hand.
  [[nodiscard]] bool moves_piece() const BURR_RT {
    return active() && (moving_ != nullptr || back_);
  }

  // Another thread: these are the bricks of the next command `move_piece`. They must live until
  // move_state() is neither waiting nor moving. False: another move is not finished.
  [[nodiscard]] bool lay_ready(const edit::MovedBricks& bricks);
  // Takes that back, if the command did not reach the servo.
  void take_back();
  [[nodiscard]] MoveState move_state() const BURR_RT {
    return move_state_.load(std::memory_order_acquire);
  }
  // move_piece or lift_piece. Refused, and the bone stays as it is: it was changed since the bricks were made, nothing is
  // ready, there is no room for the piece (kFlagReserve) or to undo it (kFlagUndoFull), something
  // else is in progress, or another piece is lifted.
  void begin_move(const Command& command, std::uint32_t& flags) BURR_RT;
  // take_splinter: its bricks at once, all in this tick, as a stroke of its own. The tool stays where it is, for bone only
  // goes away. Refused as above, and where it has more bricks than kSplinterBricks.
  static constexpr std::size_t kSplinterBricks = 32;
  void take_splinter(const Command& command, std::uint32_t& flags) BURR_RT;
  // What suction of the second hand took in this tick  [units]; asked once a tick.
  [[nodiscard]] std::int64_t taken_by_second() BURR_RT {
    return std::exchange(taken_by_second_, 0);
  }
  // A piece is out of the bone, from the command until it is bone again: nothing else writes the bone.
  // The stroke of its lift stays open, so that one undo takes the whole move back.
  [[nodiscard]] bool lifted() const BURR_RT { return lifted_.now; }
  // A piece was moved in this session: bricks are recorded with their tissues.
  [[nodiscard]] bool has_moved() const BURR_RT { return has_moved_; }
  // A tick of it, instead of touch.
  void step(std::uint32_t& flags) BURR_RT;

  // Once a tick: where the tool is now, if it is somewhere to come back to.
  void remember_path() BURR_RT;
  // How far the remembered way has come, for a stroke that begins.
  [[nodiscard]] std::uint64_t path_mark() const BURR_RT { return path_end_; }

 private:
  enum class State { none, lifting, restoring, settling };

  [[nodiscard]] const edit::KeptBrick& kept(std::uint64_t number) const BURR_RT;
  [[nodiscard]] bool clear_of_what_returns(const math::Vec3& p) const BURR_RT;
  void lift(std::uint32_t& flags) BURR_RT;
  void put_back(std::uint32_t& flags) BURR_RT;
  [[nodiscard]] bool may_move(const Command& command,
                              const edit::MovedBricks& bricks) const BURR_RT;
  [[nodiscard]] bool lies_at(const edit::PieceMove& move) const BURR_RT;
  void lay(std::size_t most, std::uint32_t& flags) BURR_RT;
  [[nodiscard]] bool has_room(const edit::MovedBricks& bricks) const BURR_RT;
  void settle() BURR_RT;

  const volume::Bone& bone_;
  const volume::IsoVertices& surface_;
  edit::UndoStore& undo_;
  edit::BoneWriter& writer_;
  const ServoSettings& settings_;
  Hand& hand_;
  HeldPiece& piece_;
  double dt_;

  static constexpr std::size_t kPath = 1 << 16;
  std::vector<math::Vec3> path_;  // a ring
  std::uint64_t path_end_ = 0;
  State state_ = State::none;
  CommandKind kind_ = CommandKind::undo;
  edit::UndoStore::Range range_;
  std::uint64_t restored_ = 0, path_at_ = 0;
  double lift_since_check_ = 0;  // [m]

  std::atomic<const edit::MovedBricks*> ready_ = nullptr;
  std::atomic<MoveState> move_state_ = MoveState::none;
  const edit::MovedBricks* moving_ = nullptr;
  bool has_moved_ = false;
  struct Lifted {
    bool now = false;
    std::uint32_t piece = 0;
    std::size_t bricks = 0;                  // that the lift changed
    std::int64_t lost = 0;                   // by the bone  [units]
    math::Vec3 centre = math::Vec3::Zero();  // where it came free
  };
  Lifted lifted_;
  bool back_ = false;  // what is put back is a lifted piece
  std::int64_t taken_by_second_ = 0;
};

}  // namespace burr::tick

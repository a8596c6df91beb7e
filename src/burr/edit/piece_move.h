// edit/piece_move.h - a piece that has come free is put somewhere else, or lifted out of the bone into a
// hand: the command's data. The bricks that the servo then writes: moved_bricks.h.
//
// A plain struct. Frame: world (LPS). Units: SI.
#pragma once

#include <array>
#include <cstdint>

namespace burr::edit {

// What the commands `move_piece`, `lift_piece` and `shift_piece` say. It holds all that a replay needs.
struct PieceMove {
  std::uint32_t piece = 0;  // number of the piece in this session, 0 the first that was moved
  std::array<std::int32_t, 3> seed = {0, 0, 0};  // a voxel of it, where it came free
  // From where it came free, not from where it lies: a turn about its centre, then a shift.
  std::array<double, 3> by = {0, 0, 0};       // [m]
  std::array<double, 4> turn = {0, 0, 0, 1};  // unit quaternion x, y, z, w
  std::uint64_t writes = 0;  // BoneWriter::writes() of the bone that it was prepared from
  std::uint64_t bricks = 0;  // MovedBricks::hash
  std::uint64_t body = 0;    // of lift_piece: PieceBody::hash
  bool lifted = false;       // of move_piece: the piece is in a hand, and the bone is without it
  bool specks = false;       // what lies loose in the piece's pores goes with it

  bool operator==(const PieceMove&) const = default;
};

}  // namespace burr::edit

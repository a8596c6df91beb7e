// edit/piece_move.h - a piece that has come free is put somewhere else: the command's data, and the
// bricks that the servo then writes.
//
// Plain structs. Frame: world (LPS) for the move, p_grid for bricks. Units: SI.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burr/edit/undo.h"

namespace burr::edit {

// What the command `move_piece` says. It holds all that a replay needs.
struct PieceMove {
  std::uint32_t piece = 0;  // number of the piece in this session, 0 the first that was moved
  std::array<std::int32_t, 3> seed = {0, 0, 0};  // a voxel of it, where it came free
  // From where it came free, not from where it lies: a turn about its centre, then a shift.
  std::array<double, 3> by = {0, 0, 0};       // [m]
  std::array<double, 4> turn = {0, 0, 0, 1};  // unit quaternion x, y, z, w
  std::uint64_t writes = 0;  // BoneWriter::writes() of the bone that it was prepared from
  std::uint64_t bricks = 0;  // MovedBricks::hash

  bool operator==(const PieceMove&) const = default;
};

// What the bricks hold after the move. A piece is prepared by another thread (piece_store.h).
struct MovedBricks {
  std::vector<KeptBrick> bricks;  // that differ, in the order of their numbers
  std::uint64_t hash = 0;         // of them
  std::uint64_t writes = 0;       // of the bone that they were made from
  std::int64_t lost = 0;          // by the whole bone; below 0: gained  [units of volume_of.h]
  std::int64_t overlap = 0;       // of piece and other bone, counted once [units]; part of lost
};

}  // namespace burr::edit

// edit/moved_bricks.h - what the bone holds after a piece was moved (piece_move.h), made by another thread
// (piece_store.h) for the servo to write.
//
// Plain structs. Frame: p_grid for bricks, world for the place of a lifted piece. Units: SI.
#pragma once

#include <cstdint>
#include <vector>

#include "burr/edit/undo.h"
#include "burr/math/pose.h"
#include "burr/tool/tool.h"

namespace burr::edit {

// A piece in a hand. Frame of the tool: edit/piece_body.h.
struct PieceBody {
  tool::Tool tool;  // one part of the kind `grid`; none: the piece is not lifted
  math::Pose at;    // world_from_tool, where the piece lay in the bone
  std::uint64_t hash = 0;
};

// What the bricks hold after the move. A piece is prepared by another thread (piece_store.h).
struct MovedBricks {
  std::vector<KeptBrick> bricks;  // that differ, in the order of their numbers
  std::uint64_t hash = 0;         // of them
  std::uint64_t writes = 0;       // of the bone that they were made from
  std::int64_t lost = 0;          // by the whole bone; below 0: gained  [units of volume_of.h]
  std::int64_t overlap = 0;       // of piece and other bone, counted once [units]; part of lost
  PieceBody body;                 // of a piece that is lifted
};

}  // namespace burr::edit

// edit/piece_print.h - a piece is put into the bricks of a bone, and taken out of them again: what it puts into each brick
// and what was there before. Internal to edit; the pieces themselves are edit/piece_store.h.
//
// Numbers are doubles in a fixed order of operations: the same build gives the same bits.
// Thread: one at a time; the bone at rest. Frame: p_grid, but for PieceMove.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/edit/moved_bricks.h"
#include "burr/edit/piece_move.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/volume/bone.h"

namespace burr::edit::piece_print {

// What a piece put into a brick, and what was there before.
struct Print {
  volume::BrickIndex brick = volume::kNoBrick;
  volume::Field under[volume::kBrickVoxels];
  volume::Field put[volume::kBrickVoxels];  // 0 where the piece is not
  volume::TissueId under_tissue[volume::kBrickVoxels], tissue[volume::kBrickVoxels];
};

// The bricks of a move, read when first needed.
class Work {
 public:
  explicit Work(const volume::Bone& bone) : bone_(bone) {}
  KeptBrick& at(volume::BrickIndex brick);
  [[nodiscard]] const std::map<volume::BrickIndex, std::unique_ptr<KeptBrick>>& all() const {
    return bricks_;
  }

 private:
  const volume::Bone& bone_;
  std::map<volume::BrickIndex, std::unique_ptr<KeptBrick>> bricks_;
};

// A move in p_grid: where a voxel of the new place comes from.
struct Way {
  std::array<math::Vec3, 3> back;  // rows of the turn, backwards
  math::Vec3 from, goal;           // the piece's centre before and after
  math::Vec3 lo, hi;               // box of what the piece may reach there
  [[nodiscard]] math::Vec3 source(const math::Vec3& p) const;
};

// centre, low, high: of the piece as it came free; the box of all that is not zero. Error: no rotation, or too far.
[[nodiscard]] Result<Way> way_of(const volume::Grid& grid, const math::Vec3& centre,
                                 const math::Ijk& low, const math::Ijk& high,
                                 const PieceMove& move);

// Puts the piece into the bricks. False: a part of it would lie outside the volume. overlap: grows by what the
// piece shares with other bone [units of volume_of.h].
[[nodiscard]] bool lay(const volume::Bone& piece, const Way& way, const volume::Bone& bone,
                       Work& work, std::vector<Print>& prints, std::int64_t& overlap);

// The bone becomes what it was before the piece was put there.
void take_out(const std::vector<Print>& prints, Work& work);

// The bricks that differ from the bone's, their hash, and what the bone loses by them.
void find_changed(const volume::Bone& bone, const Work& work, MovedBricks& bricks);

// Whether the piece lies in this brick as it was put there.
[[nodiscard]] bool lies_there(const volume::Bone& bone, const Print& print);

}  // namespace burr::edit::piece_print

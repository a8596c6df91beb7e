// volume/pieces.h - into which separate pieces the bone has come apart, followed while it is cut.
//
//     PieceFinder finder(bone);                         // before the session
//     finder.update();                                  // any other thread: reads what changed
//     for (const Piece& piece : finder.pieces()) ...    // the largest first: the mother
//
// Two voxels belong together if both are inside (field >= kIso) and share a face. So a bridge one
// voxel thin holds, and none frees. Every brick keeps the pieces inside itself and which of them
// reach each of its faces; only changed bricks are looked at again, and a union-find joins the
// bricks (Tarjan 1975). A brick with more than 254 pieces of its own counts the rest as one.
//
// Thread: one, which is not the writer's; the writer never waits. update() may be called while the
// servo cuts: a brick that is being written is read the next time. Frame: voxels of the grid.
// Memory: 0.9 KiB per brick that is not uniform, 2 B per brick of the grid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/rt/changed_bits.h"
#include "burr/volume/bone.h"

namespace burr::volume {

struct Piece {
  std::int64_t voxels = 0;            // inside
  math::Ijk low = math::Ijk::Zero();  // smallest box around them, both ends included
  math::Ijk high = math::Ijk::Zero();
  math::Ijk seed = math::Ijk::Zero();  // its first voxel in the order of the bricks
};

class PieceFinder {
 public:
  // Registers as a watcher of the bone: before the session. The first update() reads the bone.
  explicit PieceFinder(Bone& bone);
  // Looks at the bone as it is now. For a bone at rest.
  explicit PieceFinder(const Bone& bone);
  PieceFinder(const PieceFinder&) = delete;
  PieceFinder& operator=(const PieceFinder&) = delete;
  ~PieceFinder();

  // Reads what changed since the last call. Returns how many bricks had to be left for the next.
  std::size_t update();
  // The pieces as of the last update(), the largest first; equal ones by their seed.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  // Number in pieces() of the piece that this voxel was in; -1: none. Reads the bone.
  [[nodiscard]] int piece_of(const math::Ijk& voxel) const;

  // For each voxel of a brick the number of its piece, or kNone. From the bone as it is now, so only
  // while nothing is written.
  static constexpr std::int32_t kNone = -1;
  void label(BrickIndex brick, std::array<std::int32_t, kBrickVoxels>& out) const;

 private:
  PieceFinder(const Bone& bone, std::uint8_t unread);  // unread 1: all bricks are

  static constexpr int kMost = 255;  // pieces in a brick
  struct Local;                      // the pieces in one mixed brick

  void read(BrickIndex brick, const BrickField& field);
  void join();
  [[nodiscard]] std::uint32_t root(std::uint32_t node);

  const Bone& bone_;
  rt::ChangedBits* changed_ = nullptr;
  std::vector<std::uint8_t> again_;            // (brick_count) could not be read
  std::vector<std::uint8_t> kind_;             // (brick_count) 0 air, 1 solid, 2 mixed
  std::vector<std::unique_ptr<Local>> local_;  // (brick_count) of the mixed ones
  std::vector<std::uint32_t> first_, parent_;  // (brick_count) first node; (nodes)
  std::vector<std::int32_t> piece_of_node_;    // (nodes)
  std::vector<Piece> pieces_;
};

// A piece as a bone of its own, on the same grid, with its tissues. Voxels of the ramp outside go
// to the piece whose voxels are nearest, those that are near none to the largest: the volumes of
// all pieces add up to the bone's to the unit. with: further pieces that go into the same bone; they lie in
// the box around it. The bone must be at rest. Errors: there is no such piece.
[[nodiscard]] Result<std::unique_ptr<Bone>> piece_as_bone(
    const Bone& bone, const PieceFinder& finder, std::size_t piece,
    const std::vector<std::size_t>& with = {});

}  // namespace burr::volume

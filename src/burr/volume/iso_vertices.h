// volume/iso_vertices.h - where the bone's surface crosses the voxel edges, kept per brick for
// touch.
//
// Each brick owns the crossings of the +x, +y, +z edges of its voxels (and, at the grid's low
// faces, those coming in from outside). A crossing is an oriented little disc: place, outward
// normal from the field's central differences, radius. Only bricks whose field changed are made
// anew. While milling that may be put off: the error of a stale brick is then on the safe side (the
// bone only recedes) and bounded by what its field lost meanwhile.
//
// Thread: the servo's (or one thread before the session); take_ahead() on any one other. Frame:
// p_grid [voxel]. Memory: 14 B a vertex, 26 B a brick of the grid; more is taken a little ahead of
// use where milling lays surface bare, its addresses at construction. Cost: see bench/volume.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/rt/promised.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_kernel.h"

namespace burr::volume {

// Where a brick's vertices lie: the smallest of cheap balls.  p_grid
struct BrickBall {
  float x = 0, y = 0, z = 0;
  float radius = -1;  // < 0: none
};

struct IsoSettings {
  float disc = 0.3F;        // radius of the discs                                   [voxel]
  int stale_units = 400;    // a brick that lost less in every voxel may wait        [field units]
  int refresh_budget = 24;  // bricks made anew per call of refresh(), worst first
  int refresh_oldest = 8;   // of these, how many are taken by age even if they lost little
  // of 16 vertices: room for the surface that milling lays bare, promised, not taken
  std::size_t reserve_blocks = 1 << 16;
};

class IsoVertices {
 public:
  IsoVertices(const Bone& bone, const IsoSettings& settings, int threads, Progress& progress);

  [[nodiscard]] const Bone& bone() const BURR_RT { return bone_; }

  // ---- looking
  // A brick owns at most this many blocks (three edges a voxel, and the incoming ones at the
  // border).
  static constexpr int kMostBlocks = 108;
  // Changes whenever any vertex may have changed; blocks() stay as they are until then.
  [[nodiscard]] std::uint64_t revision() const BURR_RT { return revision_; }
  [[nodiscard]] float largest_disc() const BURR_RT { return settings_.disc; }  // [voxel]
  // 64 bricks along x a word; bit set: the brick has vertices.  words_per_row() words for each (bj,
  // bk)
  [[nodiscard]] int words_per_row() const BURR_RT { return words_per_row_; }
  [[nodiscard]] const std::uint64_t* row(int bj, int bk) const BURR_RT {
    return &occupied_[static_cast<std::size_t>(words_per_row_) *
                      static_cast<std::size_t>(bj + bone_.bricks().y() * bk)];
  }
  [[nodiscard]] const BrickBall& ball(BrickIndex brick) const BURR_RT {
    return balls_[static_cast<std::size_t>(brick)];
  }
  // ball(), blocks() and count() of this brick will be asked for soon
  void prefetch(BrickIndex brick) const BURR_RT {
    __builtin_prefetch(&balls_[static_cast<std::size_t>(brick)]);
    __builtin_prefetch(&places_[static_cast<std::size_t>(brick)]);
  }
  [[nodiscard]] std::span<const VertexBlock> blocks(BrickIndex brick) const BURR_RT {
    const Place& place = places_[static_cast<std::size_t>(brick)];
    return {pool_.data() + place.first,
            static_cast<std::size_t>((place.count + kLanes - 1) / kLanes)};
  }
  [[nodiscard]] int count(BrickIndex brick) const BURR_RT {
    return places_[static_cast<std::size_t>(brick)].count;
  }

  // ---- changing
  // The field of `brick` changed by at most `units` in the voxels named: bit (y + 8 z) of rows, bit
  // x of columns. Remembers which bricks' vertices that makes stale.
  void changed(BrickIndex brick, int units, std::uint64_t rows, unsigned columns) BURR_RT;
  // Makes stale bricks anew: those beyond stale_units worst first, then the oldest, within `share`
  // of the budgets (at least one brick). Deterministic.
  void refresh(double share = 1) BURR_RT;
  // All stale bricks at once; unbounded by the budget, so not while a hand is waiting.
  void refresh_all() BURR_RT;
  [[nodiscard]] std::size_t stale() const BURR_RT { return stale_.size(); }
  // The largest loss any vertex may still be stale by.  [field units]
  [[nodiscard]] int worst_staleness() const BURR_RT;
  // true for ever once the pool was full: a brick kept its old vertices then, stays stale and is
  // tried again, the youngest of all; raise reserve_blocks
  [[nodiscard]] bool exhausted() const BURR_RT { return exhausted_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  // Takes the memory that milling will need next; call it every few milliseconds while the servo
  // cuts, from another thread.
  void take_ahead();
  [[nodiscard]] int rebuilt_last() const BURR_RT { return rebuilt_last_; }

 private:
  struct Place {
    std::uint32_t first = 0;  // block in the pool
    std::uint16_t count = 0;  // vertices
    std::uint16_t room = 0;   // blocks
  };
  struct Stale {
    BrickIndex brick = kNoBrick;
    std::uint32_t since = 0;  // call of changed() that first made it stale
  };

  // false: the pool has no room, and the brick keeps the vertices it had
  [[nodiscard]] bool rebuild(BrickIndex brick) BURR_RT;
  [[nodiscard]] bool store(BrickIndex brick, const VertexBlock* blocks, int count) BURR_RT;
  void gather(BrickIndex brick, std::uint16_t* padded) const BURR_RT;
  void note(BrickIndex brick, int units) BURR_RT;
  [[nodiscard]] unsigned low_border(BrickIndex brick) const BURR_RT;
  [[nodiscard]] bool take_room(Place& place, int blocks) BURR_RT;

  const Bone& bone_;
  IsoSettings settings_;
  int words_per_row_ = 0;
  std::vector<std::uint64_t> occupied_;  // (bricks.z x bricks.y x words_per_row)
  std::vector<BrickBall> balls_;         // (brick_count)
  std::vector<Place> places_;            // (brick_count)
  rt::Promised<VertexBlock> pool_;
  std::size_t pool_used_ = 0;
  std::atomic<std::size_t> pool_told_ = 0;  // pool_used_, for take_ahead()
  static constexpr int kClasses = 5;
  std::vector<std::uint32_t>
      free_[kClasses];               // given-back runs by size class, reserved at construction
  std::vector<std::uint16_t> lost_;  // (brick_count) largest change since made  [field units]
  std::vector<Stale> stale_;         // in the order they became stale
  std::uint32_t calls_ = 0;
  std::uint64_t revision_ = 1;
  int rebuilt_last_ = 0;
  bool exhausted_ = false;
};

}  // namespace burr::volume

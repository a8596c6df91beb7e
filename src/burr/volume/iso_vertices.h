// volume/iso_vertices.h - the points where the bone's surface crosses voxel edges, kept per brick,
// for touch.
//
// Each brick owns the crossings on the +x, +y, +z edges of its voxels (and, at the grid's low
// faces, on the edges that come in from outside). A crossing is a small oriented disc: place,
// outward normal from the field's central differences, radius. Only bricks whose field changed are
// recomputed. While milling this may be delayed: the error of a stale brick is on the safe side
// (the bone only recedes) and not larger than what its field lost since then.
//
// Thread: the servo's (or one thread before the session); commit_ahead() on any one other. Frame:
// p_grid [voxel]. Memory: 14 B per vertex, 26 B per brick of the grid; milling that lays new
// surface bare needs more, whose addresses are reserved at construction and whose memory is taken a
// little ahead of use. Cost: see bench/volume.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/base/progress.h"
#include "burr/rt/reserved.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_kernel.h"

namespace burr::volume {

// A ball that holds all vertices of a brick; cheap to compute.  p_grid
struct BrickBall {
  float x = 0, y = 0, z = 0;
  float radius = -1;  // < 0: no vertices
};

struct IsoSettings {
  float disc = 0.3F;        // radius of the discs                                   [voxel]
  int stale_units = 400;    // a brick that lost less in every voxel may wait  [field units]
  int refresh_budget = 24;  // bricks recomputed per call of refresh(), worst first
  int refresh_oldest = 8;   // of these, how many go by age even if they lost little
  // blocks of 16 vertices reserved for surface that milling lays bare; memory is not taken yet
  std::size_t reserve_blocks = 1 << 16;
};

class IsoVertices {
 public:
  IsoVertices(const Bone& bone, const IsoSettings& settings, int threads, Progress& progress);

  [[nodiscard]] const Bone& bone() const BURR_RT { return bone_; }

  // ---- reading
  // Most blocks that a brick can own (three edges per voxel, and the incoming edges at the border).
  static constexpr int kMostBlocks = 108;
  // Changes whenever a vertex may have changed; until then blocks() stay as they are.
  [[nodiscard]] std::uint64_t revision() const BURR_RT { return revision_; }
  [[nodiscard]] float largest_disc() const BURR_RT { return settings_.disc; }  // [voxel]
  // A word covers 64 bricks along x; bit set: the brick has vertices. Each (bj, bk) has
  // words_per_row() words.
  [[nodiscard]] int words_per_row() const BURR_RT { return words_per_row_; }
  [[nodiscard]] const std::uint64_t* row(int bj, int bk) const BURR_RT {
    return &occupied_[static_cast<std::size_t>(words_per_row_) *
                      static_cast<std::size_t>(bj + bone_.bricks().y() * bk)];
  }
  [[nodiscard]] const BrickBall& ball(BrickIndex brick) const BURR_RT {
    return balls_[static_cast<std::size_t>(brick)];
  }
  // Hint: ball(), blocks() and count() of this brick will be read soon.
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
  // x of columns. Marks the bricks whose vertices are stale after that.
  void changed(BrickIndex brick, int units, std::uint64_t rows, unsigned columns) BURR_RT;
  // Recomputes stale bricks: first those beyond stale_units, worst first, then the oldest, within
  // `share` of the budgets (at least one brick). Deterministic.
  void refresh(double share = 1) BURR_RT;
  // Recomputes all stale bricks at once, without a limit: not while a hand is being served.
  void refresh_all() BURR_RT;
  [[nodiscard]] std::size_t stale() const BURR_RT { return stale_.size(); }
  // The largest loss that is not yet in the vertices.  [field units]
  [[nodiscard]] int worst_staleness() const BURR_RT;
  // True for ever once the pool was full. The brick then kept its old vertices, stays stale, and is
  // tried again after all others; raise reserve_blocks.
  [[nodiscard]] bool exhausted() const BURR_RT { return exhausted_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  // Takes the memory that milling will need next. Call it every few milliseconds while the servo
  // cuts, from another thread.
  void commit_ahead();
  [[nodiscard]] int rebuilt_last() const BURR_RT { return rebuilt_last_; }

 private:
  struct Place {
    std::uint32_t first = 0;  // block in the pool
    std::uint16_t count = 0;  // vertices in use
    std::uint16_t room = 0;   // blocks that fit
  };
  struct Stale {
    BrickIndex brick = kNoBrick;
    std::uint32_t since = 0;  // the call of changed() that first made it stale
  };

  // False: the pool has no room, and the brick keeps its old vertices.
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
  rt::ReservedArray<VertexBlock> pool_;
  std::size_t pool_used_ = 0;
  std::atomic<std::size_t> pool_published_ = 0;  // pool_used_, for commit_ahead()
  static constexpr int kClasses = 5;
  std::vector<std::uint32_t>
      free_[kClasses];               // runs given back, by size class; reserved at construction
  std::vector<std::uint16_t> lost_;  // (brick_count) largest change since recomputed  [field units]
  std::vector<Stale> stale_;         // in the order they became stale
  std::uint32_t calls_ = 0;
  std::uint64_t revision_ = 1;
  int rebuilt_last_ = 0;
  bool exhausted_ = false;
};

}  // namespace burr::volume

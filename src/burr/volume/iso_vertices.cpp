#include "burr/volume/iso_vertices.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

#include "burr/base/check.h"
#include "burr/rt/simd.h"
#include "burr/rt/thread.h"

namespace burr::volume {
namespace {

constexpr int kMostBlocks = IsoVertices::kMostBlocks;
constexpr int kClassBlocks[] = {4, 8, 16, 32, kMostBlocks};

int class_of(int blocks) {
  int which = 0;
  while (kClassBlocks[which] < blocks) ++which;
  return which;
}

// At least one brick, or a stale brick would stay stale for ever.
int part_of(int budget, double share) {
  return budget <= 0 ? 0 : std::max(1, static_cast<int>(std::ceil(share * budget)));
}
// Blocks with memory ahead of the tick: enough for a hundred milliseconds of the fastest milling; 1
// MiB.
constexpr std::size_t kAhead = 4096;

BrickBall ball_around(const VertexBlock* blocks, int count, const math::Ijk& first) {
  std::uint16_t lo[3] = {65535, 65535, 65535}, hi[3] = {0, 0, 0};
  const int full = (count + kLanes - 1) / kLanes;
  for (int b = 0; b < full; ++b)
    for (int l = 0; l < kLanes; ++l) {
      const std::uint16_t p[3] = {blocks[b].x[l], blocks[b].y[l], blocks[b].z[l]};
      for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], p[axis]);
        hi[axis] = std::max(hi[axis], p[axis]);
      }
    }
  float middle[3];
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = 0.5F * (static_cast<float>(lo[axis]) + static_cast<float>(hi[axis]));
  float farthest = 0;
  for (int b = 0; b < full; ++b)
    for (int l = 0; l < kLanes; ++l) {
      const float dx = static_cast<float>(blocks[b].x[l]) - middle[0],
                  dy = static_cast<float>(blocks[b].y[l]) - middle[1],
                  dz = static_cast<float>(blocks[b].z[l]) - middle[2];
      farthest = std::max(farthest, dx * dx + dy * dy + dz * dz);
    }
  return {static_cast<float>(first.x()) + middle[0] / kVertexScale - 1.0F,
          static_cast<float>(first.y()) + middle[1] / kVertexScale - 1.0F,
          static_cast<float>(first.z()) + middle[2] / kVertexScale - 1.0F,
          std::sqrt(farthest) / kVertexScale * 1.0001F + 1e-3F};
}

}  // namespace

ExtractVertices extract_vertices_kernel() noexcept {
  if constexpr (rt::kWideKernels) {
    if (rt::simd() == rt::Simd::avx512) return avx512::extract_vertices;
    if (rt::simd() == rt::Simd::avx2) return avx2::extract_vertices;
  }
  return scalar::extract_vertices;
}

IsoVertices::IsoVertices(const Bone& bone, const IsoSettings& settings, int threads,
                         Progress& progress)
    : bone_(bone),
      settings_(settings),
      words_per_row_((bone.bricks().x() + 63) / 64),
      occupied_(static_cast<std::size_t>(words_per_row_) *
                static_cast<std::size_t>(bone.bricks().y()) *
                static_cast<std::size_t>(bone.bricks().z())),
      balls_(static_cast<std::size_t>(bone.brick_count())),
      places_(balls_.size()),
      lost_(balls_.size()) {
  // Workers take slabs of bricks; the results go into one pool, slab by slab in order.
  const int slabs = bone.bricks().z();
  struct Found {
    std::vector<VertexBlock> blocks;
    std::vector<std::pair<BrickIndex, int>> counts;
    bool ready = false;
  };
  std::vector<Found> found(static_cast<std::size_t>(slabs));
  std::mutex laying;
  std::size_t laid = 0;  // slabs already in the pool
  std::size_t regrown = 0, bricks = 0;
  const auto lay = [&](const Found& slab) {
    if (pool_.size() < pool_used_ + slab.blocks.size())
      pool_.grow(std::max(2 * pool_.size(), pool_used_ + slab.blocks.size()));
    const VertexBlock* from = slab.blocks.data();
    for (const auto& [brick, count] : slab.counts) {
      // exactly the room it needs; a brick that grows later moves into the reserve
      const int blocks = (count + kLanes - 1) / kLanes;
      places_[static_cast<std::size_t>(brick)] = {static_cast<std::uint32_t>(pool_used_), 0,
                                                  static_cast<std::uint16_t>(blocks)};
      pool_used_ += static_cast<std::size_t>(blocks);
      BURR_CHECK(store(brick, from, count));  // it was given this room just now
      from += blocks;
      regrown += static_cast<std::size_t>(kClassBlocks[class_of(blocks)]);
      ++bricks;
    }
  };
  std::atomic<int> next = 0;
  const auto work = [&](bool tells) {
    std::vector<std::uint16_t> padded(kPadVoxels);
    std::vector<VertexBlock> out(kMostBlocks);
    for (int slab = next++; slab < slabs; slab = next++) {
      if (tells) progress.report(static_cast<double>(slab) / slabs, "finding the surface");
      Found mine;
      for (int bj = 0; bj < bone_.bricks().y(); ++bj)
        for (int bi = 0; bi < bone_.bricks().x(); ++bi) {
          const BrickIndex brick = bone_.brick_at(bi, bj, slab);
          // a brick of air owns the edges that lead into material of its upper neighbours
          bool any = false;
          for (int n = 0; n < 8 && !any; ++n) {
            const int x = bi + (n & 1), y = bj + ((n >> 1) & 1), z = slab + (n >> 2);
            any = x < bone_.bricks().x() && y < bone_.bricks().y() && z < bone_.bricks().z() &&
                  bone_.brick_field(bone_.brick_at(x, y, z)) != nullptr;
          }
          if (!any) continue;
          gather(brick, padded.data());
          const int count = extract_vertices_kernel()(
              padded.data(), low_border(brick), settings_.disc, out.data(), kMostBlocks * kLanes);
          if (count == 0) continue;
          mine.blocks.insert(mine.blocks.end(), out.begin(),
                             out.begin() + (count + kLanes - 1) / kLanes);
          mine.counts.emplace_back(brick, count);
        }
      mine.ready = true;
      const std::lock_guard lock(laying);
      found[static_cast<std::size_t>(slab)] = std::move(mine);
      for (; laid < found.size() && found[laid].ready; ++laid) {
        lay(found[laid]);
        found[laid] = {};
      }
    }
  };
  rt::on_threads(threads, [&work](int thread) { work(thread == 0); });

  // room for every brick to grow once, and more
  pool_.grow(pool_used_ + regrown + settings_.reserve_blocks);
  stale_.reserve(balls_.size());
  for (auto& list : free_) list.reserve(bricks + settings_.reserve_blocks / 4);
  pool_published_ = pool_used_;
  commit_ahead();
  progress.report(1, "finding the surface");
}

void IsoVertices::commit_ahead() {
  pool_.commit(pool_published_.load(std::memory_order_relaxed) + kAhead);
}

unsigned IsoVertices::low_border(BrickIndex brick) const BURR_RT {
  const math::Ijk first = bone_.brick_ijk(brick);
  return (first.x() == 0 ? 1U : 0U) | (first.y() == 0 ? 2U : 0U) | (first.z() == 0 ? 4U : 0U);
}

void IsoVertices::gather(BrickIndex brick, std::uint16_t* padded) const BURR_RT {
  const math::Ijk& n = bone_.bricks();
  const math::Ijk b = bone_.brick_ijk(brick) / kBrickEdge;
  static constexpr BrickField kAir{};
  const Field* from[3][3][3];  // [z][y][x]
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const math::Ijk at = b + math::Ijk(dx, dy, dz);
        const bool in = (at.array() >= 0).all() && (at.array() < n.array()).all();
        const Field* field =
            in ? bone_.brick_field(bone_.brick_at(at.x(), at.y(), at.z())) : nullptr;
        from[dz + 1][dy + 1][dx + 1] = field != nullptr ? field : kAir.voxel;
      }
  for (int z = -1; z <= 9; ++z)
    for (int y = -1; y <= 9; ++y) {
      const auto& row_of = from[(z >> 3) + 1][(y >> 3) + 1];
      const int offset = 8 * ((y & 7) + 8 * (z & 7));
      std::uint16_t* to = padded + kPadRow * (y + 1) + kPadSlice * (z + 1);
      to[0] = row_of[0][offset + 7];
      std::memcpy(to + 1, row_of[1] + offset, 16);
      std::memcpy(to + 9, row_of[2] + offset, 4);  // the rest of the row is never read
    }
}

bool IsoVertices::take_room(Place& place, int blocks) BURR_RT {
  if (place.room >= blocks) return true;
  const int wanted = class_of(blocks);
  std::uint32_t first = 0;
  if (!free_[wanted].empty()) {
    first = free_[wanted].back();
    free_[wanted].pop_back();
  } else if (pool_used_ + static_cast<std::size_t>(kClassBlocks[wanted]) <= pool_.size()) {
    first = static_cast<std::uint32_t>(pool_used_);
    pool_used_ += static_cast<std::size_t>(kClassBlocks[wanted]);
    pool_published_.store(pool_used_, std::memory_order_relaxed);
  } else {
    return false;
  }
  // the first room of a brick may lie between two size classes: it then serves the lower one
  if (place.room >= kClassBlocks[0]) {
    int given = class_of(place.room);
    if (kClassBlocks[given] > place.room) --given;
    auto& list = free_[given];
    if (list.size() < list.capacity()) list.push_back(place.first);
  }
  place.first = first;
  place.room = static_cast<std::uint16_t>(kClassBlocks[wanted]);
  return true;
}

bool IsoVertices::store(BrickIndex brick, const VertexBlock* blocks, int count) BURR_RT {
  const auto at = static_cast<std::size_t>(brick);
  Place& place = places_[at];
  const int used = (count + kLanes - 1) / kLanes;
  if (!take_room(place, used)) {
    exhausted_ = true;
    return false;
  }
  ++revision_;
  std::copy_n(blocks, used, pool_.begin() + place.first);
  place.count = static_cast<std::uint16_t>(count);
  const math::Ijk first = bone_.brick_ijk(brick);
  balls_[at] = count == 0 ? BrickBall{} : ball_around(blocks, count, first);
  std::uint64_t& word =
      occupied_[static_cast<std::size_t>(words_per_row_) *
                    static_cast<std::size_t>(first.y() / 8 + bone_.bricks().y() * (first.z() / 8)) +
                static_cast<std::size_t>(first.x() / 8 / 64)];
  const std::uint64_t bit = 1ULL << (first.x() / 8 % 64);
  word = count == 0 ? word & ~bit : word | bit;
  return true;
}

bool IsoVertices::rebuild(BrickIndex brick) BURR_RT {
  alignas(64) std::uint16_t padded[kPadVoxels];
  alignas(64) VertexBlock out[kMostBlocks];
  gather(brick, padded);
  const int count = extract_vertices_kernel()(padded, low_border(brick), settings_.disc, out,
                                              kMostBlocks * kLanes);
  return store(brick, out, count);
}

void IsoVertices::note(BrickIndex brick, int units) BURR_RT {
  std::uint16_t& lost = lost_[static_cast<std::size_t>(brick)];
  if (lost == 0)
    stale_.push_back({brick, calls_});  // each brick at most once, so reserve() was enough
  lost = static_cast<std::uint16_t>(std::min(65535, lost + std::max(1, units)));
}

void IsoVertices::changed(BrickIndex brick, int units, std::uint64_t rows,
                          unsigned columns) BURR_RT {
  ++calls_;
  // which neighbours are affected. Below: those whose edges reach voxel 0 (fully), or whose
  // differences reach voxels 0 or 1 (one eighth). Above: those whose differences reach voxel 7.
  unsigned ys = 0, zs = 0;
  for (int z = 0; z < 8; ++z) {
    const auto slice = static_cast<unsigned>((rows >> (8 * z)) & 0xFFU);
    ys |= slice;
    if (slice != 0) zs |= 1U << z;
  }
  const math::Ijk b = bone_.brick_ijk(brick) / kBrickEdge;
  const unsigned masks[3] = {columns, ys, zs};
  int weight[3][3];  // [axis][side]: 8 fully, 1 one eighth, 0 not affected
  for (int axis = 0; axis < 3; ++axis) {
    weight[axis][0] = (masks[axis] & 1U) != 0 ? 8 : (masks[axis] & 2U) != 0 ? 1 : 0;
    weight[axis][1] = 8;
    weight[axis][2] = (masks[axis] & 0x80U) != 0 ? 1 : 0;
  }
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int w = std::min({weight[0][dx + 1], weight[1][dy + 1], weight[2][dz + 1]});
        const math::Ijk at = b + math::Ijk(dx, dy, dz);
        if (w == 0 || !(at.array() >= 0).all() || !(at.array() < bone_.bricks().array()).all())
          continue;
        note(bone_.brick_at(at.x(), at.y(), at.z()), units * w / 8);
      }
}

void IsoVertices::refresh(double share) BURR_RT {
  // move the worst to the front; ties by age and index, so that every machine does the same
  const std::size_t budget =
      std::min(stale_.size(), static_cast<std::size_t>(part_of(settings_.refresh_budget, share)));
  if (budget == 0) {
    rebuilt_last_ = 0;
    return;
  }
  const auto loss = [this](const Stale& s) { return lost_[static_cast<std::size_t>(s.brick)]; };
  if (budget < stale_.size()) {
    std::nth_element(stale_.begin(), stale_.begin() + static_cast<std::ptrdiff_t>(budget),
                     stale_.end(), [&](const Stale& a, const Stale& b) {
                       return loss(a) != loss(b)   ? loss(a) > loss(b)
                              : a.since != b.since ? a.since < b.since
                                                   : a.brick < b.brick;
                     });
  }
  // of these take all that lost much, and a few of the others, so that everything is refreshed in
  // the end
  std::sort(stale_.begin(), stale_.begin() + static_cast<std::ptrdiff_t>(budget),
            [](const Stale& a, const Stale& b) {
              return a.since != b.since ? a.since < b.since : a.brick < b.brick;
            });
  int by_age = part_of(settings_.refresh_oldest, share);
  std::size_t kept = 0;
  rebuilt_last_ = 0;
  for (std::size_t s = 0; s < budget; ++s) {
    const Stale one = stale_[s];
    if (loss(one) < settings_.stale_units && by_age-- <= 0) {
      stale_[kept++] = one;
      continue;
    }
    if (rebuild(one.brick)) {
      lost_[static_cast<std::size_t>(one.brick)] = 0;
    } else {
      lost_[static_cast<std::size_t>(one.brick)] = 1;
      stale_[kept++] = {one.brick, calls_};
    }
    ++rebuilt_last_;
  }
  stale_.erase(stale_.begin() + static_cast<std::ptrdiff_t>(kept),
               stale_.begin() + static_cast<std::ptrdiff_t>(budget));
}

void IsoVertices::refresh_all() BURR_RT {
  std::size_t kept = 0;
  for (const Stale one : stale_) {
    if (rebuild(one.brick))
      lost_[static_cast<std::size_t>(one.brick)] = 0;
    else
      stale_[kept++] = one;
  }
  stale_.resize(kept);
}

int IsoVertices::worst_staleness() const BURR_RT {
  int worst = 0;
  for (const Stale& one : stale_)
    worst = std::max(worst, int{lost_[static_cast<std::size_t>(one.brick)]});
  return worst;
}

std::size_t IsoVertices::memory_bytes() const {
  return pool_used_ * sizeof(VertexBlock) +
         balls_.size() * (sizeof(BrickBall) + sizeof(Place) + 2) +
         stale_.capacity() * sizeof(Stale);
}

}  // namespace burr::volume

// sim/row_log.h - a recorder into memory: the rows of ticks and the voxels that crossed the surface,
// until somebody takes them.
//
// Only in sessions that are not in real time: it takes memory, between ticks. Thread: one, while the
// session stands still; the session itself writes it. Memory: about 0.7 KiB a tick, 32 B a voxel, and
// that of edit/crossed.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "burr/edit/crossed.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::sim {

// A voxel that crossed the surface in this tick.
struct CrossedVoxel {
  std::uint64_t tick = 0;
  std::int32_t i = 0, j = 0, k = 0;
  bool out = true;  // it was inside the bone; false: it was outside
};

class RowLog {
 public:
  // rows, voxels: what to keep
  RowLog(const volume::Bone& bone, bool rows, bool voxels);

  [[nodiscard]] bool keeps_rows() const { return keeps_rows_; }
  // nullptr: no voxels are kept
  [[nodiscard]] edit::CrossedVoxels* crossed() { return crossed_ ? &*crossed_ : nullptr; }

  // Memory for so many ticks.
  void make_room(std::size_t ticks);
  // After each tick.
  void note(const tick::TickRow& row);
  // The bone was put back: what crossed meanwhile is not news. Forgets all rows and voxels.
  void start_over();

  // What came since the last call, in order.
  [[nodiscard]] std::vector<tick::TickRow> take_rows() { return std::exchange(rows_, {}); }
  [[nodiscard]] std::vector<CrossedVoxel> take_voxels() { return std::exchange(voxels_, {}); }

 private:
  bool keeps_rows_;
  std::optional<edit::CrossedVoxels> crossed_;
  std::vector<tick::TickRow> rows_;
  std::vector<CrossedVoxel> voxels_;
};

}  // namespace burr::sim

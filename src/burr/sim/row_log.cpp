#include "burr/sim/row_log.h"

#include <algorithm>

namespace burr::sim {

RowLog::RowLog(const volume::Bone& bone, bool rows, bool voxels) : keeps_rows_(rows) {
  if (voxels) crossed_.emplace(bone);
}

void RowLog::make_room(std::size_t ticks) {
  if (!keeps_rows_ || rows_.capacity() - rows_.size() >= ticks) return;
  rows_.reserve(std::max(rows_.size() + ticks, 2 * rows_.size()));
}

void RowLog::note(const tick::TickRow& row) {
  if (keeps_rows_) rows_.push_back(row);
  if (!crossed_) return;
  crossed_->take([&](const math::Ijk& at, bool out) {
    voxels_.push_back({row.tick, at.x(), at.y(), at.z(), out});
  });
}

void RowLog::start_over() {
  rows_.clear();
  voxels_.clear();
  if (crossed_) crossed_->take([](const math::Ijk&, bool) {});
}

}  // namespace burr::sim

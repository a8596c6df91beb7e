// tests/window/two_blocks.h - a bone in two pieces, ready to be milled at the window.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "shared/window_session.h"
#include "shared/work.h"

namespace burr::app {

inline constexpr double kBlockVoxel = 0.5e-3;  // [m]

// Two blocks, 1 mm apart; the right one is the smaller.
inline std::unique_ptr<volume::Bone> two_blocks(const volume::TissueTable& tissues) {
  constexpr double kMm = 1e-3;
  const phantom::Depth whole = phantom::box({10 * kMm, 4 * kMm, 4 * kMm});
  return phantom::bone_from_distance(
      phantom::box_grid(math::Vec3(-16, -10, -10) * kMm, math::Vec3(24, 10, 12) * kMm, kBlockVoxel),
      tissues,
      [whole](const math::Vec3& p) {
        return std::min(whole(p), std::abs(p.x() - 3 * kMm) - 0.5 * kMm);
      },
      1024);
}

// options: the hands.
inline Result<WindowSession> ready_two_blocks(WorkOptions options = {}) {
  options.volume.source = "block";
  options.volume.voxel_mm = 1e3 * kBlockVoxel;
  NoProgress quiet;
  if (const Status taken = take_case(options); !taken) return taken.error();
  auto work = open_work(options, quiet);
  if (!work) return work.error();
  work->bone = two_blocks(work->bone->tissues());
  work->work_case.reset();
  return make_window_session(options, std::move(*work), quiet);
}

}  // namespace burr::app

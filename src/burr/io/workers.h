// io/workers.h - the same work on two threads, in numbered pieces. Internal to io and importing.
#pragma once

#include <atomic>
#include <thread>

#include "burr/base/progress.h"

namespace burr::io {

// Calls work(piece) once for every piece 0..count-1, on this thread and one more. Reports `stage`
// from this thread. False: cancelled, some pieces were not done. work must not throw.
template <class Work>
[[nodiscard]] bool in_pieces(int count, Progress& progress, const char* stage, const Work& work) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  const auto take = [&](bool reports) {
    while (!stop) {
      const int piece = next++;
      if (piece >= count) return;
      work(piece);
      if (!reports) continue;
      progress.report(static_cast<double>(piece + 1) / count, stage);
      if (progress.cancelled()) stop = true;
    }
  };
  std::thread second;
  if (count > 1 && std::thread::hardware_concurrency() > 1)
    second = std::thread([&] { take(false); });
  take(true);
  if (second.joinable()) second.join();
  return !stop;
}

}  // namespace burr::io

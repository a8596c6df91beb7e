// thermal/heat_worker.h - the thread that computes the bone's temperature while the servo cuts.
//
//     thermal::Worker heat(*bone, work, {});            // before the session: adds its watcher
//     servo:  heat.push({.time_ns = now, .place = contact, .energy = spent, .radius = r});
//     main:   thermal::HeatSummary summary;
//             if (heat.take(summary)) show(summary);
//
// The thread processes the rows in order (heating.h) and sleeps while there are none. The result is
// some milliseconds late; the servo never waits for it. If the machine is too slow, rows are lost,
// with their energy, and counted. Thread: push() from one (servo), wait-free; take() from one
// (main), wait-free; construct and destroy while no other thread uses it. Memory: heat_grid.h, the
// rows, three summaries of 10 KB.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/rt.h"
#include "burr/rt/thread.h"
#include "burr/thermal/heating.h"

namespace burr::thermal {

inline constexpr std::size_t kHeatRows = 4096;  // four seconds at one row per tick

class Worker {
 public:
  // Starts at once. work: world  [m]
  Worker(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings,
         std::size_t rows = kHeatRows);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // False: the ring is full; the row is lost and counted.
  bool push(const HeatRow& row) BURR_RT {
    if (!rows_.push(row)) return false;
    pushed_.store(pushed_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    return true;
  }
  [[nodiscard]] std::uint64_t dropped() const BURR_RT { return rows_.dropped(); }

  // True if there is a newer summary than last time; ten per second of the session's time.
  bool take(HeatSummary& out) BURR_RT { return summary_.take(out); }

  // Waits until all rows pushed before the call are processed. Not for the servo.
  void settle() const;

 private:
  void run();

  Heating heating_;  // used by the thread only
  rt::Ring<HeatRow> rows_;
  rt::Latest<HeatSummary> summary_;
  std::atomic<std::uint64_t> pushed_ = 0, worked_ = 0;
  std::atomic<bool> stop_ = false;
  rt::Thread thread_;  // last: uses all the others
};

}  // namespace burr::thermal

// tick/servo_outbox.h - what leaves the tick: rows and bricks to the recorder, views to other threads,
// heat.
//
// Doors: docs/understand/realtime.md, "Doors". Nothing here may make the servo wait: what finds no
// room is counted as dropped, or stays in its queue.
//
// Thread: servo; view(), burr_radius() and released() any (one reader for the view). Memory: taken
// at construction.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "burr/edit/changed_queue.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/rt.h"
#include "burr/thermal/heat_worker.h"
#include "burr/tick/controls.h"
#include "burr/tick/cutting.h"
#include "burr/tick/recorder_rings.h"
#include "burr/tick/rows.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"

namespace burr::tick {

class Outbox {
 public:
  // changed: the bricks that the writer wrote
  Outbox(const volume::Bone& bone, edit::ChangedQueue& changed, const Controls& controls);

  // ---- before the session
  void set_recorder_rings(const RecorderRings& rings) { recorder_rings_ = rings; }
  void set_watch(rt::Latest<TickRow>* watch) { watch_ = watch; }
  void set_heat(thermal::Worker* heat) { heat_ = heat; }

  // ---- in the tick
  void note(const CommandRow& command) BURR_RT {
    if (recorder_rings_.commands != nullptr) recorder_rings_.commands->push(command);
  }
  void note_radius(double radius) BURR_RT { burr_radius_.store(radius, std::memory_order_relaxed); }
  void note_released(bool released) BURR_RT {
    released_.store(released, std::memory_order_relaxed);
  }
  // The energy of this tick; a row goes out every hundredth of a second, and one more for every other
  // place that was warmed. second: the other hand's; nullptr: it never cuts.
  void note_heat(std::uint64_t tick, const Cutting& cutting, const Cutting* second) BURR_RT;
  // The bone is as it was at the start: so is its heat.
  void start_heat_over() BURR_RT { heat_row_.start_over = true; }

  // ---- after the tick
  // The finished row, and the bricks whose turn it is. with_tissue: their tissues as well.
  void publish(const TickRow& row, bool with_tissue) BURR_RT;
  // Before it: the row of the second hand of this tick.
  void publish_second(const TickRow& row) BURR_RT {
    if (recorder_rings_.second != nullptr) recorder_rings_.second->push(row);
  }
  // All bricks that are waiting.
  void flush_bricks(std::uint64_t tick, bool with_tissue) BURR_RT;

  // ---- for others
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT { return view_; }
  [[nodiscard]] double burr_radius() const BURR_RT {
    return burr_radius_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] bool released() const BURR_RT { return released_.load(std::memory_order_relaxed); }

 private:
  void write_bricks(std::size_t most, std::uint64_t tick, bool with_tissue) BURR_RT;

  const volume::Bone& bone_;
  edit::ChangedQueue& changed_;
  const Controls& controls_;
  double dt_;
  RecorderRings recorder_rings_;
  rt::Latest<TickRow>* watch_ = nullptr;
  thermal::Worker* heat_ = nullptr;
  thermal::HeatRow heat_row_;
  std::array<thermal::HeatRow, 3>
      heat_beside_;  // rubbing parts, the second tool, its rubbing parts
  rt::Latest<TickRow> view_;
  std::atomic<double> burr_radius_;
  std::atomic<bool> released_ = false;
};

}  // namespace burr::tick

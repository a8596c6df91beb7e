// surface/worker.h - the threads that keep the displayed surface up to date while the servo cuts.
//
//     surface::Worker worker(*bone, 1);                // before the session: adds its watchers
//     worker.first(progress, show);                    // the whole surface once
//     each frame:   surface::Skin skin;
//                   while (budget && worker.take(skin)) { show(skin); worker.give_back(skin); }
//
//     changed bits ---> lane: patches to make ---> Mesher ---> ring "skin" ---> main
//                         ^------------------ ring of patches given back <-------'
//
// Each thread is one lane: every n-th patch, with its own watcher, Mesher and rings. So a patch
// always comes from the same lane, and a newer one never arrives before an older one. Guarantee:
// when the bone no longer changes, the newest of each patch taken together are exactly the surface
// of whole_surface(); a patch that was never taken is empty. Thread: construct and destroy while no
// other thread uses it; take(), give_back(), first() and settle() from one thread (main). A lane
// sleeps while nothing changes, and looks every 5 ms. Memory: 0.9 MiB per lane, and the patches in
// transit, at most kLent per lane.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/surface/mesher.h"
#include "burr/surface/patch.h"

namespace burr::surface {

inline constexpr int kLent = 512;  // patches of one lane that may be lent at once

// A rebuilt patch. The mesh is lent: call give_back() after the upload. No triangles: the patch is
// empty now.
struct Skin {
  int patch = -1;  // index, see Mesher
  const Patch* mesh = nullptr;
  int lane = 0;
  std::chrono::steady_clock::time_point seen;  // contains all changes before this time
};

class Worker {
 public:
  // All patches are built at the start. threads: number of lanes, at least 1.
  Worker(volume::Bone& bone, int threads);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  [[nodiscard]] math::Ijk patches() const;  // along each axis

  // Gets the next finished patch; false: none at present. Wait-free.
  [[nodiscard]] bool take(Skin& out);
  void give_back(const Skin& skin);

  // Waits until all changes before the call are meshed, and calls show() for each patch; the mesh
  // is given back after that. Errors: only Trouble::interrupted.
  using Show = std::function<void(const Skin&)>;
  [[nodiscard]] Status first(Progress& progress, const Show& show);
  void settle(const Show& show);

  // true: mesh more slowly, because the machine has more urgent work; false: normal speed again.
  // Any thread.
  void hold_back(bool held) { held_.store(held, std::memory_order_relaxed); }

  [[nodiscard]] int waiting() const;  // patches not built yet, a snapshot; any thread

 private:
  struct Lane;
  [[nodiscard]] bool idle_since(const std::vector<unsigned>& rounds) const;
  [[nodiscard]] std::vector<unsigned> idle_rounds() const;
  std::atomic<bool> held_ = false;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::size_t next_lane_ = 0;  // the lane to take from next
};

}  // namespace burr::surface

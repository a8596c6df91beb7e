// surface/worker.h - the threads that keep the visible surface true while the servo cuts.
//
//     surface::Worker worker(*bone, 1);                // before the session: adds its watchers
//     worker.first(progress, show);                    // everything once
//     each frame:   surface::Skin skin;
//                   while (budget && worker.take(skin)) { show(skin); worker.give_back(skin); }
//
//     changed bits ---> lane: patches to make ---> Mesher ---> ring "skin" ---> main
//                         ^------------------ ring of patches given back <-------'
//
// Each thread is a lane of its own: every n-th patch, its own watcher, Mesher and rings. So a patch
// always comes from the same lane and a newer one never arrives before an older.
// Guarantee: once the bone rests, the newest of each patch taken makes exactly the surface that
// whole_surface() makes; a patch never taken is empty. Full and incremental are the same.
// Thread: make it and destroy it where no other thread uses it; take(), give_back(), first() and
// settle() from one thread (main). Sleeps while nothing changes, looking every 5 ms.
// Memory: 0.9 MiB per lane and the patches under way, at most kLent per lane.
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

inline constexpr int kLent = 512;  // patches of one lane that may be out at once

// A patch made anew. The mesh is lent: give it back when it is uploaded. No triangles: nothing
// left.
struct Skin {
  int patch = -1;  // index, see Mesher
  const Patch* mesh = nullptr;
  int lane = 0;
  std::chrono::steady_clock::time_point seen;  // what the servo did before this is in it
};

class Worker {
 public:
  // Every patch is due at the start. threads: lanes, at least 1.
  Worker(volume::Bone& bone, int threads);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  [[nodiscard]] math::Ijk patches() const;  // along each axis

  // The next patch that is ready; false: none now. Wait-free.
  [[nodiscard]] bool take(Skin& out);
  void give_back(const Skin& skin);

  // Waits until all that changed before the call is made, showing each patch; the mesh is given
  // back after it was shown. Error: only Trouble::interrupted.
  using Show = std::function<void(const Skin&)>;
  [[nodiscard]] Status first(Progress& progress, const Show& show);
  void settle(const Show& show);

  // The machine has more urgent work: make the surface more slowly until told otherwise. Any
  // thread.
  void hold_back(bool held) { held_.store(held, std::memory_order_relaxed); }

  [[nodiscard]] int waiting() const;  // patches not made yet, a snapshot; any thread

 private:
  struct Lane;
  [[nodiscard]] bool idle_since(const std::vector<unsigned>& rounds) const;
  [[nodiscard]] std::vector<unsigned> idle_rounds() const;
  std::atomic<bool> held_ = false;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::size_t next_lane_ = 0;  // taken from in turn
};

}  // namespace burr::surface

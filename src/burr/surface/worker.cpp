#include "burr/surface/worker.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <thread>

#include "burr/base/check.h"
#include "burr/rt/ring.h"
#include "burr/rt/thread.h"

namespace burr::surface {
namespace {

constexpr std::size_t kSpare = 16;                    // patches whose memory an idle lane keeps
constexpr auto kLook = std::chrono::milliseconds(5);  // well below a frame, and almost no load
// pause after each patch while held back, so that meshing uses a quarter of a core
constexpr int kHeldTimes = 3;  // times the duration of the patch
constexpr auto kHeldMost = std::chrono::milliseconds(10);

}  // namespace

struct Worker::Lane {
  Lane(volume::Bone& bone, int index, int lanes, const std::atomic<bool>& held_back)
      : mesher(bone), changed(bone.add_watcher()), held(held_back), mine(index), of(lanes) {
    const auto count = static_cast<std::size_t>(mesher.patch_count());
    queued.resize(count);
    shown.resize(count);
    for (int patch = mine; patch < mesher.patch_count(); patch += of) want(patch);
  }

  void want(int patch) {
    if (patch % of != mine || queued[static_cast<std::size_t>(patch)]) return;
    queued[static_cast<std::size_t>(patch)] = true;
    due.push_back(patch);
  }

  void run() {
    while (!stop.load(std::memory_order_relaxed)) {
      look();
      if (due.empty() || lent == kLent) {
        if (due.empty()) {
          shed();
          idle.fetch_add(1, std::memory_order_release);
        }
        std::this_thread::sleep_for(kLook);
        continue;
      }
      const auto begun = std::chrono::steady_clock::now();
      make(due.front());
      if (held.load(std::memory_order_relaxed))
        std::this_thread::sleep_for(std::min<std::chrono::steady_clock::duration>(
            kHeldTimes * (std::chrono::steady_clock::now() - begun), kHeldMost));
    }
  }

  // Collects changed bricks and returned patches.
  void look() {
    seen = std::chrono::steady_clock::now();
    changed.take_all([&](std::size_t brick) {
      named.clear();
      mesher.patches_of_brick(static_cast<volume::BrickIndex>(brick), named);
      for (const int patch : named) want(patch);
    });
    for (Patch* patch = nullptr; back.pop(patch);) {
      free.push_back(patch);
      --lent;
    }
    waiting.store(static_cast<int>(due.size()), std::memory_order_relaxed);
  }

  // Frees memory: the first surface has many patches in transit at once, milling few.
  void shed() {
    for (std::size_t n = 0; n + kSpare < free.size(); ++n) {
      if (free[n]->vertices.capacity() == 0) continue;
      *free[n] = Patch{};
    }
  }

  void make(int patch) {
    if (free.empty()) {
      all.push_back(std::make_unique<Patch>());
      free.push_back(all.back().get());
    }
    Patch* mesh = free.back();
    due.pop_front();
    if (!mesher.mesh_patch(patch, *mesh)) {  // the servo is writing there: later
      due.push_back(patch);
      std::this_thread::yield();
      return;
    }
    const auto at = static_cast<std::size_t>(patch);
    queued[at] = false;
    if (mesh->triangles.empty() && !shown[at]) return;
    shown[at] = !mesh->triangles.empty();
    free.pop_back();
    ++lent;
    const bool pushed = out.push({patch, mesh, mine, seen});
    BURR_CHECK(pushed);  // the ring holds all patches that may be lent
  }

  // used by this lane's thread only
  Mesher mesher;
  rt::ChangedBits& changed;
  const std::atomic<bool>& held;
  int mine = 0, of = 1;
  std::deque<int> due;              // patches to mesh, oldest request first
  std::vector<bool> queued, shown;  // (patches) in `due`; last taken with triangles
  std::vector<int> named;
  std::vector<std::unique_ptr<Patch>> all;
  std::vector<Patch*> free;
  int lent = 0;
  std::chrono::steady_clock::time_point seen;  // when it last looked for changes

  // shared between this lane and main
  rt::Ring<Skin> out{kLent};
  rt::Ring<Patch*> back{kLent};
  std::atomic<unsigned> idle = 0;  // number of rounds that found nothing to do
  std::atomic<int> waiting = 0;
  std::atomic<bool> stop = false;
  std::unique_ptr<rt::Thread> thread;
};

Worker::Worker(volume::Bone& bone, int threads) {
  BURR_CHECK(threads >= 1);
  for (int i = 0; i < threads; ++i)
    lanes_.push_back(std::make_unique<Lane>(bone, i, threads, held_));
  // all watchers exist before the first thread runs
  for (auto& lane : lanes_)
    lane->thread =
        std::make_unique<rt::Thread>(rt::ThreadRequest{.name = "surface", .stack_bytes = 0},
                                     [work = lane.get()] { work->run(); });
}

Worker::~Worker() {
  for (auto& lane : lanes_) lane->stop = true;
  for (auto& lane : lanes_) lane->thread->join();
}

math::Ijk Worker::patches() const { return lanes_.front()->mesher.patches(); }

bool Worker::take(Skin& out) {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    next_lane_ = (next_lane_ + 1) % lanes_.size();
    if (lanes_[next_lane_]->out.pop(out)) return true;
  }
  return false;
}

void Worker::give_back(const Skin& skin) {
  const bool pushed = lanes_[static_cast<std::size_t>(skin.lane)]->back.push(
      const_cast<Patch*>(skin.mesh));  // lent as const, owned by the lane
  BURR_CHECK(pushed);
}

int Worker::waiting() const {
  int sum = 0;
  for (const auto& lane : lanes_) sum += lane->waiting.load(std::memory_order_relaxed);
  return sum;
}

std::vector<unsigned> Worker::idle_rounds() const {
  std::vector<unsigned> rounds;
  for (const auto& lane : lanes_) rounds.push_back(lane->idle.load(std::memory_order_acquire));
  return rounds;
}

// The present round may have looked before the call; the next one looks after it.
bool Worker::idle_since(const std::vector<unsigned>& rounds) const {
  const std::vector<unsigned> now = idle_rounds();
  for (std::size_t i = 0; i < rounds.size(); ++i)
    if (now[i] - rounds[i] < 2) return false;
  return true;
}

Status Worker::first(Progress& progress, const Show& show) {
  const std::vector<unsigned> before = idle_rounds();
  const int all = std::max(1, lanes_.front()->mesher.patch_count());
  for (;;) {
    const bool idle = idle_since(before);  // read first: nothing comes after the last take
    for (Skin skin; take(skin); give_back(skin)) show(skin);
    if (idle) break;
    progress.report(1 - static_cast<double>(std::min(waiting(), all)) / all, "making the surface");
    if (progress.cancelled())
      return error(Trouble::interrupted, "stopped while computing the surface");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  progress.report(1, "making the surface");
  return fine();
}

void Worker::settle(const Show& show) {
  NoProgress progress;
  static_cast<void>(first(progress, show));
}

}  // namespace burr::surface

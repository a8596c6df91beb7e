#include "burr/render/coarsening.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "burr/render/coarse_mesh.h"

namespace burr::render {
namespace {

// rest before a block is made; for one of the smallest, which follow the burr [s]
constexpr double kRest = 1, kSmallRest = 0.3;
constexpr int kEdge = 2;  // edge of a block in patches, of a larger one in blocks
// Errors of the two levels for each size of block, including those of what it is made of [voxel].
constexpr std::array<std::array<double, 2>, 4> kErrors = {
    {{0.5, 1.5}, {0.75, 1.75}, {1, 2}, {1.25, 2.5}}};
constexpr std::size_t kHandedOutAtOnce = 32;
constexpr int kNice = 15;

}  // namespace

struct Coarsening::Work {
  struct Job {
    std::size_t block = 0, size = 0;
    std::uint64_t versions = 0;
    std::vector<std::shared_ptr<const SkinMesh>> patches;   // made from these patches
    std::vector<std::shared_ptr<const CoarseMesh>> blocks;  // ... or from these blocks
    std::shared_ptr<const CoarseMesh> made;
  };
  // state of a block when it was last found changed
  struct Seen {
    std::uint64_t versions = 0;
    double since = 0;
    bool changed = false, handed_out = false;
  };

  math::Ijk grid;  // number of patches along each axis
  double voxel = 0;
  bool held = false;
  std::vector<Seen> seen;
  std::vector<std::size_t> firsts;  // number of the first block of each size
  std::size_t next = 0;             // next block to check
  std::size_t out = 0;

  mutable std::mutex mutex;
  std::condition_variable due;
  std::deque<Job> jobs, made;
  bool ending = false;
  std::thread thread;

  void lay_out(Scene& scene);
  void take_back(Scene& scene);
  [[nodiscard]] bool collect(const Scene& scene, const SceneBlock& block, Job& job) const;
  [[nodiscard]] CoarseMesh made_of(JoinedMesh&& all, std::size_t size) const;
  void run();
};

// Lays out the smallest blocks like a mesher's patches, then larger and larger ones like the
// blocks.
void Coarsening::Work::lay_out(Scene& scene) {
  if (!seen.empty() && scene.blocks.size() == seen.size()) return;
  scene.blocks.clear();
  const auto group = [&scene](const math::Ijk& cells, std::size_t first, const auto& put) {
    const math::Ijk groups = (cells.array() + kEdge - 1) / kEdge;
    scene.blocks.resize(first + static_cast<std::size_t>(groups.prod()));
    for (int z = 0, n = 0; z < cells.z(); ++z)
      for (int y = 0; y < cells.y(); ++y)
        for (int x = 0; x < cells.x(); ++x, ++n)
          put(static_cast<int>(first) + (z / kEdge * groups.y() + y / kEdge) * groups.x() +
                  x / kEdge,
              n);
    return groups;
  };
  const auto at = [&scene](int block) -> SceneBlock& {
    return scene.blocks[static_cast<std::size_t>(block)];
  };
  scene.block_of.assign(static_cast<std::size_t>(grid.prod()), -1);
  firsts = {0};
  math::Ijk blocks = group(grid, 0, [&](int block, int patch) {
    at(block).patches.push_back(patch);
    scene.block_of[static_cast<std::size_t>(patch)] = block;
  });
  while (firsts.size() < kErrors.size()) {
    const int before = static_cast<int>(firsts.back());
    firsts.push_back(scene.blocks.size());
    blocks = group(blocks, firsts.back(), [&](int large, int number) {
      const int inner = before + number;
      at(inner).outer = large;
      at(large).inner.push_back(inner);
      at(large).patches.insert(at(large).patches.end(), at(inner).patches.begin(),
                               at(inner).patches.end());
    });
  }
  for (SceneBlock& block : scene.blocks) block.now = versions_of(scene, block);
  seen.assign(scene.blocks.size(), {});
}

void Coarsening::Work::take_back(Scene& scene) {
  std::deque<Job> back;
  {
    const std::lock_guard lock(mutex);
    back.swap(made);
  }
  out -= back.size();
  for (Job& job : back) {
    SceneBlock& block = scene.blocks[job.block];
    block.mesh = std::move(job.made);
    block.versions = job.versions;
  }
}

// Collects what the block is made of. False: its own blocks are not ready.
bool Coarsening::Work::collect(const Scene& scene, const SceneBlock& block, Job& job) const {
  for (const int inner : block.inner) {
    const SceneBlock& one = scene.blocks[static_cast<std::size_t>(inner)];
    if (one.now == 0) continue;
    if (one.mesh == nullptr || one.versions != one.now) return false;
    job.blocks.push_back(one.mesh);
  }
  if (!block.inner.empty()) return true;
  for (const int patch : block.patches)
    if (const auto p = static_cast<std::size_t>(patch);
        p < scene.patches.size() && scene.patches[p].mesh != nullptr)
      job.patches.push_back(scene.patches[p].mesh);
  return true;
}

CoarseMesh Coarsening::Work::made_of(JoinedMesh&& all, std::size_t size) const {
  std::array<double, 2> errors = kErrors[size];
  const double before = size == 0 ? 0 : kErrors[size - 1][0];
  for (double& error : errors) error = (error - before) * voxel;
  CoarseMesh mesh = coarser(std::move(all), errors);
  for (CoarseLevel& level : mesh.levels) level.error += before * voxel;
  return mesh;
}

void Coarsening::Work::run() {
  // on Linux this applies to this thread only
  setpriority(PRIO_PROCESS, 0, kNice);
  std::unique_lock lock(mutex);
  for (;;) {
    due.wait(lock, [this] { return ending || !jobs.empty(); });
    if (ending) return;
    Job job = std::move(jobs.front());
    jobs.pop_front();
    lock.unlock();
    JoinedMesh all;
    for (const auto& patch : job.patches) all.add(*patch);
    for (const auto& block : job.blocks) all.add(*block);
    job.made = std::make_shared<const CoarseMesh>(made_of(std::move(all), job.size));
    job.patches.clear();
    job.blocks.clear();
    lock.lock();
    made.push_back(std::move(job));
  }
}

Coarsening::Coarsening(const math::Ijk& patches, double voxel) : work_(std::make_unique<Work>()) {
  work_->grid = patches;
  work_->voxel = voxel;
  work_->thread = std::thread([work = work_.get()] { work->run(); });
}

Coarsening::~Coarsening() {
  {
    const std::lock_guard lock(work_->mutex);
    work_->ending = true;
  }
  work_->due.notify_one();
  work_->thread.join();
}

void Coarsening::update(Scene& scene, double now) {
  Work& w = *work_;
  w.lay_out(scene);
  w.take_back(scene);
  const std::size_t count = scene.blocks.size();
  std::vector<Work::Job> jobs;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t at = (w.next + n) % count;
    const SceneBlock& block = scene.blocks[at];
    Work::Seen& seen = w.seen[at];
    const std::uint64_t versions = block.now;
    // at the start nothing has changed yet: everything is made at once
    if (seen.versions != versions) seen = {versions, now, seen.versions != 0, false};
    if (w.held || seen.handed_out || versions == 0) continue;
    const double rest = block.inner.empty() ? kSmallRest : kRest;
    if (seen.changed && now - seen.since < rest) continue;
    if (w.out + jobs.size() >= kHandedOutAtOnce) continue;
    Work::Job job;
    job.block = at;
    job.size =
        static_cast<std::size_t>(std::ranges::upper_bound(w.firsts, at) - w.firsts.begin() - 1);
    job.versions = versions;
    if (!w.collect(scene, block, job)) continue;
    seen.handed_out = true;
    jobs.push_back(std::move(job));
  }
  if (jobs.empty()) return;
  w.next = jobs.back().block + 1;
  w.out += jobs.size();
  {
    const std::lock_guard lock(w.mutex);
    for (Work::Job& job : jobs) w.jobs.push_back(std::move(job));
  }
  w.due.notify_one();
}

void Coarsening::hold_back(bool held) { work_->held = held; }

std::size_t Coarsening::waiting() const { return work_->out; }

}  // namespace burr::render

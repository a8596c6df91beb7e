#include "burr/render/bone_scene.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "burr/render/soft_scene.h"
#include "burr/surface/mesher.h"

namespace burr::render {

Status skin_bone(Scene& scene, const volume::Bone& bone, int threads, Progress& progress) {
  const int count = surface::Mesher(bone).patch_count();
  std::vector<ScenePatch> patches(static_cast<std::size_t>(count));

  // workers take a group of patches at a time; the first worker, this thread, reports
  constexpr int kHandful = 64;
  std::atomic<int> next = 0;
  std::atomic<bool> stop = false;
  const auto work = [&](bool reports) {
    surface::Mesher mesher(bone);
    surface::Patch mesh;
    while (!stop) {
      const int first = next.fetch_add(kHandful);
      if (first >= count) return;
      for (int patch = first; patch < std::min(first + kHandful, count); ++patch) {
        // a bone at rest is not written, so this succeeds at once
        while (!mesher.mesh_patch(patch, mesh)) {
        }
        patches[static_cast<std::size_t>(patch)] = packed(mesh);
      }
      if (!reports) continue;
      progress.report(static_cast<double>(first) / count, "finding the surface");
      if (progress.cancelled()) stop = true;
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work, false);
  work(true);
  for (std::thread& helper : helpers) helper.join();
  if (stop) return error(Trouble::interrupted, "stopped before the surface was complete");

  scene.tissue_colours = colours_of(bone.tissues());
  for (int patch = 0; patch < count; ++patch)
    set_patch(scene, patch, std::move(patches[static_cast<std::size_t>(patch)]));
  if (const Status soft = add_soft(scene, bone, progress); !soft) return soft;
  progress.report(1, "finding the surface");
  return fine();
}

}  // namespace burr::render

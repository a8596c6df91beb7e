// web/bone_api.h - the bone of a module, as the page shows it: its surface in patches, its tissues, the newest row. The same for the
// module that ticks (core_api.cpp) and the one that reads recordings (replay/replay_api.cpp).
//
// Units: SI. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "burr/render/soft_scene.h"
#include "burr/surface/mesher.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::web {

// A piece of surface for the page.
struct Given {
  int number = -1;  // of the patch; of a soft structure: its tissue
  const void* vertices = nullptr;
  std::size_t vertex_count = 0;
  const std::uint32_t* triangles = nullptr;
  std::size_t index_count = 0;
};

struct ShownBone {
  std::unique_ptr<volume::Bone> bone;
  tick::TickRow row;
  double voxel_mm = 0;

  std::unique_ptr<surface::Mesher> mesher;
  rt::ChangedBits* changed = nullptr;
  std::deque<int> due;  // patches to mesh, oldest request first
  std::vector<bool> queued;
  std::vector<std::uint64_t>
      given_hashes;  // of each patch's surface as the page has it; 0: it has none
  std::vector<int> named;
  surface::Patch patch;
  render::Scene soft;  // its soft structures only
  std::size_t soft_given = 0;
  Given given;

  // All of its surface becomes due, what is around the work first.
  void take(std::unique_ptr<volume::Bone> new_bone);
  void want(int number) {
    if (queued[static_cast<std::size_t>(number)]) return;
    queued[static_cast<std::size_t>(number)] = true;
    due.push_back(number);
  }
};

// The bone that JavaScript asks about; whoever makes one puts it here.
extern ShownBone* shown;

}  // namespace burr::web

// render/coarsening.h - makes the coarse blocks of a scene on a thread in the background.
//
//     render::Coarsening coarse(worker.patches(), bone.grid().voxel);
//     each frame: coarse.update(scene, now);   // gives out blocks, takes finished ones back
//
//     scene ---> blocks whose patches have been at rest for a while ---> thread "coarse" ---> scene
//
// A block is 2 x 2 x 2 patches, a larger one 2 x 2 x 2 blocks, and so on, four sizes in all. A
// larger block has relatively less border, which cannot be coarsened. With smaller blocks, one
// change forces fewer patches to be drawn in full detail. What is being milled is drawn in full
// detail until it has been at rest.
// Thread: update() and hold_back() on main; its own thread runs when no other thread wants the
// processor.
#pragma once

#include <memory>

#include "burr/math/vec3.h"
#include "burr/render/scene.h"

namespace burr::render {

class Coarsening {
 public:
  // patches: number along each axis, numbered as in surface/mesher.h; voxel: its edge length [m]
  Coarsening(const math::Ijk& patches, double voxel);
  ~Coarsening();  // waits for the block in work
  Coarsening(const Coarsening&) = delete;
  Coarsening& operator=(const Coarsening&) = delete;

  // now: any clock that never stops [s].
  void update(Scene& scene, double now);
  // True: the machine has more urgent work, give out no more blocks; false: go on.
  void hold_back(bool held);

  [[nodiscard]] std::size_t waiting() const;  // blocks given out and not yet finished

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace burr::render

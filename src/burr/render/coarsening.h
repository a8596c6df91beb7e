// render/coarsening.h - makes the coarse blocks of a scene beside everything else.
//
//     render::Coarsening coarse(worker.patches(), bone.grid().voxel);
//     each frame:   coarse.update(scene, now);   // hands out blocks, takes back what is made
//
//     scene ---> blocks whose patches have rested for a while ---> thread "coarse" ---> scene
//
// A block is 2 x 2 x 2 patches, a larger one 2 x 2 x 2 blocks, and so on, four sizes in all: the
// larger, the less of it is rim; the smaller, the less is drawn as it is for one hole in it.
// What is being milled is drawn as it is until it has rested. Thread: update() and hold_back() on
// main; its own thread runs when nothing else wants to.
#pragma once

#include <memory>

#include "burr/math/vec3.h"
#include "burr/render/scene.h"

namespace burr::render {

class Coarsening {
 public:
  // patches: along each axis, numbered as surface/mesher.h does; voxel: its edge length [m]
  Coarsening(const math::Ijk& patches, double voxel);
  ~Coarsening();  // ends within a block
  Coarsening(const Coarsening&) = delete;
  Coarsening& operator=(const Coarsening&) = delete;

  // `now`: any clock that goes on [s].
  void update(Scene& scene, double now);
  // The machine has more urgent work: hand out nothing more until told otherwise.
  void hold_back(bool held);

  [[nodiscard]] std::size_t waiting() const;  // blocks handed out and not yet made

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace burr::render

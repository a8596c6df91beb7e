// proof/cut.h - cuts a bone by shapes (known_shape.h), and makes it again what it was.
//
//     proof::CutBone made(*bone, *before);      // two equal bones
//     Status cut = made.cut(*work);  ...  made.restore();
//
// The field of a cut voxel is what its depth in the shape leaves, as where a phantom is made from its formula. Thread: one.
// Cost: the bricks that a shape reaches. The bones must live as long as this.
#pragma once

#include "burr/base/result.h"
#include "burr/proof/known_shape.h"
#include "burr/volume/bone.h"

namespace burr::proof {

class CutBone {
 public:
  // bone: equal to `before`, and the one that is cut.
  CutBone(volume::Bone& bone, const volume::Bone& before) : bone_(bone), before_(before) {}
  // Cuts and adds, on top of what was cut before. Error (data): no room for what is added.
  [[nodiscard]] Status cut(const Work& work);
  // The bone becomes equal to `before`, whatever was cut, by this or another.
  void restore();

 private:
  volume::Bone& bone_;
  const volume::Bone& before_;
};

}  // namespace burr::proof

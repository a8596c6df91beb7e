// workshop/piece_look.h - a piece of bone that is out of the bone, in a picture: in blue, where it is.
//
// Thread: that of the scene. Frame: world. Units: SI.
#pragma once

#include <cstddef>
#include <memory>

#include "burr/math/pose.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// The surface of a piece, where it came free. nullptr: it has none. Any thread; some milliseconds.
[[nodiscard]] std::shared_ptr<const render::CoarseMesh> mesh_of_piece(const volume::Bone& piece);

class PieceLook {
 public:
  static constexpr render::Colour kColour = {0.34F, 0.71F, 0.91F};

  // Draws it moved by `by` from where its mesh is, in place of what this object drew before; nullptr: nothing.
  // colour: a number in the scene's tissue_colours that the bone does not use; from 256 on nothing is drawn.
  void put(render::Scene& scene, const std::shared_ptr<const render::CoarseMesh>& mesh,
           const math::Pose& by, std::size_t colour);
  void take_away(render::Scene& scene) const;

 private:
  std::shared_ptr<const render::CoarseMesh> mesh_, drawn_;
  math::Pose by_;
  std::size_t colour_ = 0;
};

}  // namespace burr::workshop

// render/bone_scene.h - makes a scene from a whole bone: for pictures of a bone at rest, and for
// the first picture of a session.
//
// Thread: one; no other thread may use the scene meanwhile.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"

namespace burr::render {

// Puts the bone's surface, its soft structures, tissue colours and materials into the scene, in
// patches numbered as by surface::Mesher; camera and everything else stay. The bone must be at rest. threads: workers, 1
// or more. Errors: Trouble::interrupted when `progress` was cancelled; the scene then has only a
// part of the patches.
[[nodiscard]] Status skin_bone(Scene& scene, const volume::Bone& bone, int threads,
                               Progress& progress);

}  // namespace burr::render

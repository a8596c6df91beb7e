// render/bone_scene.h - a whole bone becomes a scene: for pictures of a bone at rest, and for the
// first look of a session.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"

namespace burr::render {

// Surface and tissue colours of the bone into the scene, in patches numbered as by
// surface::Mesher; camera and all else stay. The bone must be at rest. threads: workers, 1 or more.
// Errors: Trouble::interrupted when `progress` was cancelled; the scene is then half skinned.
[[nodiscard]] Status skin_bone(Scene& scene, const volume::Bone& bone, int threads,
                               Progress& progress);

}  // namespace burr::render

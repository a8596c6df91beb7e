// render/eye_outside.h - an eye that got into bone, or into a closed hollow of it, is moved out.
//
//     orbit(scene.camera, 0.1, 0);
//     keep_eye_outside(scene);
//
// From inside, a surface is seen from behind, and no bone lies under the pointer. The eye goes back
// along its line of sight until all bone that was behind it is in front of it; what it looks at stays
// in the middle. An eye in a cavity that is open to any side stays there. Thread: any. Cost: one
// pick(), and up to 26 more where bone lies behind the eye.
#pragma once

#include "burr/render/scene.h"

namespace burr::render {

// True: the eye was moved.
bool keep_eye_outside(Scene& scene);

}  // namespace burr::render

// workshop/other_bone.h - the same case on another bone: what differs between people (how far forward a
// sinus lies, how low the dura) is drawn from the bone's number, so that nobody learns one bone by heart.
//
// Only cases on formula bones have others (phantom/phantoms.h). The recipe of the bone holds the number, so
// a recording replays. Landmarks and regions that lean on them move with the bone. Thread: any.
#pragma once

#include <cstdint>
#include <string>

#include "burr/base/result.h"
#include "burr/scenario/case.h"

namespace burr::workshop {

// bone_number: from 1; 0: the case's own bone, nothing changes. Errors (usage): a case on a scan, a phantom
// without others, a number beyond phantom::kMostBones.
[[nodiscard]] Status take_bone(scenario::Case& work, std::uint32_t bone_number);

// True if the case has other bones.
[[nodiscard]] bool has_other_bones(const scenario::Case& work);

}  // namespace burr::workshop

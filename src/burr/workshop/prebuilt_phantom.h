// workshop/prebuilt_phantom.h - the bones of the built-in cases, shaped when burr was built: a formula
// takes seconds, a file does not. `burr phantom NAME --out NAME.bone` makes one; it is looked for
// in bones/ beside the program, then in share/burr/bones of the same installation.
//
// Thread: any.
#pragma once

#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// The phantom with its usual voxels, to the bit as its formula makes it; nothing where no file has
// it or the file is damaged: the formula is always there.
[[nodiscard]] std::unique_ptr<volume::Bone> prebuilt_phantom(const std::string& phantom,
                                                             std::size_t reserve_bricks);

[[nodiscard]] Status write_prebuilt_phantom(const volume::Bone& bone, const std::string& path);

}  // namespace burr::workshop

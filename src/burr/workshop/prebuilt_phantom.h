// workshop/prebuilt_phantom.h - the bones of the built-in cases, computed when burr was built,
// because a formula takes seconds and a file does not. `burr phantom NAME --out NAME.bone` writes
// one. burr looks for them in bones/ beside the program, then in share/burr/bones of the same
// installation.
//
// Thread: any.
#pragma once

#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// The phantom with its default voxels, identical to the bit to the result of its formula. nullptr
// if there is no file or the file is damaged; the caller then uses the formula.
[[nodiscard]] std::unique_ptr<volume::Bone> prebuilt_phantom(const std::string& phantom,
                                                             std::size_t reserve_bricks);

[[nodiscard]] Status write_prebuilt_phantom(const volume::Bone& bone, const std::string& path);

}  // namespace burr::workshop

// src/burr/phantom/phantoms.h - anatomy made by formula: bones of no patient, to practise and to measure on.
//
//     temporal-bone  right temporal bone, 58 x 64 x 58 mm, every structure of a mastoidectomy
//                    labelled
//     jaw            left half of a lower jaw from premolar to second molar, with its nerve canal
//     tooth          lower molar: enamel, dentine, pulp
//     spine          third lumbar vertebra with canal and cord
//     skull          vault and face, 190 mm long
//     block          a block to sculpt
//     ball           a ball
//
// Frame: LPS (x left, y back, z up), metres. Shapes and sizes follow textbooks, not a person.
// Same name and voxel, same bits, whatever the number of threads.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/phantom/build.h"
#include "burr/volume/bone.h"

namespace burr::phantom {

// A phantom before it is voxels.
struct Phantom {
  volume::TissueTable tissues;
  Formula formula;
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();  // box that holds it, world [m]
};

[[nodiscard]] std::vector<std::string_view> phantom_names();

// The voxel that shows a phantom well in moderate time [mm]; 0 for a name that is none.
[[nodiscard]] double default_voxel_mm(std::string_view name);

// The phantom in voxels of voxel_mm (0: its default), with room for `reserve_bricks` bricks of
// added material. Errors: unknown name or a voxel that does not fit (usage), interrupted.
// made_of: may give the tissues other constants than the phantom's own.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> phantom(
    std::string_view name, double voxel_mm, Progress& progress, std::size_t reserve_bricks = 2048,
    int threads = 2, const std::function<void(volume::TissueTable&)>& made_of = {});

// The makers, one file each; `voxel` [m] says how far labels reach into the ramp.
[[nodiscard]] Phantom temporal_bone(double voxel);
[[nodiscard]] Phantom jaw(double voxel);
[[nodiscard]] Phantom tooth(double voxel);
[[nodiscard]] Phantom spine(double voxel);
[[nodiscard]] Phantom skull(double voxel);

}  // namespace burr::phantom

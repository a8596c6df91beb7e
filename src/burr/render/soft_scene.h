// render/soft_scene.h - gives a scene the surfaces of its soft structures (nerves, vessels, dura)
// and the materials of all tissues.
//
// Their surfaces come from the labels (surface/label_surface.h), which nothing cuts, so they are made
// once and stay whole. A picture at full quality draws them as they are; for others there are thinner
// levels by edge collapses, from an error of a seventh of a voxel on.
// Thread: any, while nobody writes the bone; no other thread may use the scene meanwhile. Cost: about
// a second for a temporal bone; nothing to speak of where no voxel is labelled as soft.
#pragma once

#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"

namespace burr::render {

// Replaces scene.soft and scene.materials. Errors: Trouble::interrupted when `progress` was
// cancelled.
[[nodiscard]] Status add_soft(Scene& scene, const volume::Bone& bone, Progress& progress);

// How each tissue looks, from its kind and its English name; what has no known word in it looks like
// bone, or like wet soft tissue.
[[nodiscard]] std::vector<Material> materials_of(const volume::TissueTable& tissues);

}  // namespace burr::render

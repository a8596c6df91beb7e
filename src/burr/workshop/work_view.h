// workshop/work_view.h - how the program looks at work: the same view, size and tool in every picture
// it leaves.
#pragma once

#include <filesystem>

#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/render/wound.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// Lights and scale bar for a still; camera on the work, which shows the cut large and what is
// around it, but no more air than a small bone leaves.
[[nodiscard]] render::Scene scene_of_work(const volume::Bone& bone, double burr_radius,
                                          const math::Vec3& at, const math::Vec3& outward);

// What a tick tells of the look of the bone.
[[nodiscard]] render::Wound::Tick wound_tick(const tick::TickRow& row, double rate_hz);

// The burr as it was in this tick, size and kind too, and with `contact` hand, proxy and force.
void put_tool(render::Scene& scene, const tick::TickRow& row, bool contact);

}  // namespace burr::workshop

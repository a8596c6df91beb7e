// workshop/work_view.h - the view of the work: the same camera and tool in every picture that burr
// writes.
#pragma once

#include <filesystem>
#include <span>

#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/render/wound.h"
#include "burr/tick/rows.h"
#include "burr/tool/shaped_tool.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// A scene with the lights and the scale bar of a picture. The camera looks at the work; its field
// of view shows the cut large with its surroundings, and is not larger than a small bone needs.
[[nodiscard]] render::Scene scene_of_work(const volume::Bone& bone, double burr_radius,
                                          const math::Vec3& at, const math::Vec3& outward);

// The part of a row that changes the look of the bone. tools: of the session. second: of the other hand,
// where it holds a tool that cuts; its row's own tool is number 0 of its list.
[[nodiscard]] render::Wound::Tick wound_tick(const tick::TickRow& row, double rate_hz,
                                             std::span<const tool::ShapedTool> tools,
                                             const tick::TickRow* second = nullptr);

// Where the tool of this tick is, and how contact turned it.
[[nodiscard]] math::Pose pose_of_tool(const tick::TickRow& row);

// Puts the burr of this tick into the scene, with its size and kind; with `contact` also hand,
// proxy and force.
void put_tool(render::Scene& scene, const tick::TickRow& row, bool contact);

}  // namespace burr::workshop

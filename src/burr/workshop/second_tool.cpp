#include "burr/workshop/second_tool.h"

#include "burr/device/hand_state.h"
#include "burr/workshop/tool_looks.h"
#include "burr/workshop/work_view.h"

namespace burr::workshop {
namespace {

// The tube is known by its colour.
constexpr render::Colour kTube = {0.72F, 0.76F, 0.8F};
constexpr double kLong = 60e-3;  // length of the part of the tube that is drawn  [m]

}  // namespace

void SecondTool::put(render::Scene& scene, const tick::TickRow* row, const tool::Tool* tool) {
  std::erase_if(scene.rods, [](const render::Rod& rod) { return rod.colour == kTube; });
  scene.beside.reset();
  if (row == nullptr || !row->hand.valid) return;
  const math::Pose at = pose_of_tool(*row);
  if (tool == nullptr) {
    scene.rods.push_back(
        {at.p, at * math::Vec3(0, 0, kLong), row->tool.radius, kTube, false, false});
    return;
  }
  if (look_ == nullptr) look_ = look_of(*tool);
  scene.beside = {at, look_};
}

bool sucks(const tick::TickRow& row) {
  return row.tool.number < 0 && row.hand.valid && (row.hand.buttons & device::kLifted) == 0 &&
         row.hand.pedal <= 0;
}

}  // namespace burr::workshop

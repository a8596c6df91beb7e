#include "burr/workshop/work_view.h"

#include <algorithm>

#include "burr/math/turn.h"
#include "burr/render/camera.h"
#include "burr/render/look.h"

namespace burr::workshop {

render::Scene scene_of_work(const volume::Bone& bone, double burr_radius, const math::Vec3& at,
                            const math::Vec3& outward) {
  render::Scene scene;
  scene.look = render::still_look();
  scene.scale_bar = true;
  const double bone_height = 1.2 * bone.grid().size.cast<double>().maxCoeff() * bone.grid().voxel;
  const double height = std::min(std::clamp(20 * burr_radius, 20e-3, 70e-3), bone_height);
  scene.camera = render::view_of_work(at, outward, height);
  return scene;
}

namespace {

// From the middle of what cuts to its end along y, along which edges lie.  [m]
math::Vec3 edge_of(const tool::Tool& tool) {
  double half = 0;
  for (int p = 0; p < tool.count; ++p) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(p)];
    if (part.role != tool::Role::cuts) continue;
    half = std::max(half, part.tool_from_part.p.y() +
                              tool::support(part.shape, part.tool_from_part.q.conjugate() *
                                                            math::Vec3::UnitY()));
  }
  return half * math::Vec3::UnitY();
}

// What a tool throws: one that turns dust to all sides, a blade dust along its stroke, an edge that is
// pushed or struck chips, and no dust.
void throw_dust(const tool::ShapedTool& shaped, const math::Quat& world_from_tool,
                render::Wound::Tick& tick) {
  const tool::Cutter& cutter = shaped.cutter;
  switch (cutter.drive) {
    case tool::Drive::turning:
      return;
    case tool::Drive::oscillating:
    case tool::Drive::reciprocating:
      tick.stroke = world_from_tool * cutter.way;
      return;
    case tool::Drive::pushed:
    case tool::Drive::struck:
      tick.dust = 0;
      tick.chips = true;
      tick.forward = world_from_tool * cutter.way;
      tick.edge = world_from_tool * edge_of(shaped.tool);
      return;
  }
}

}  // namespace

render::Wound::Tick wound_tick(const tick::TickRow& row, double rate_hz,
                               std::span<const tool::ShapedTool> tools,
                               const tick::TickRow* second) {
  render::Wound::Tick tick;
  tick.t = static_cast<double>(row.tick) / rate_hz;
  tick.tip = row.contact.proxy;
  tick.up = row.hand.world_from_tool.q * math::Vec3::UnitZ();
  tick.radius = row.tool.radius;
  tick.removed = row.ledger.removed;
  tick.added = row.ledger.added;
  tick.irrigated = row.tool.irrigated;
  tick.undone = row.ledger.undone;
  tick.diamond = row.tool.kind == tool::BurrKind::diamond;
  if (second != nullptr) tick.others = second->ledger.removed;
  const auto number = static_cast<std::size_t>(row.tool.number);
  if (row.tool.number >= 0 && number < tools.size())
    throw_dust(tools[number], pose_of_tool(row).q, tick);
  return tick;
}

math::Pose pose_of_tool(const tick::TickRow& row) {
  // contact may have turned the tool away from the hand
  return {row.contact.proxy,
          math::product(math::rotation_of(row.contact.turn), row.hand.world_from_tool.q)};
}

void put_tool(render::Scene& scene, const tick::TickRow& row, bool contact) {
  scene.burr.visible = true;
  scene.burr.radius = row.tool.radius;
  scene.burr.diamond = row.tool.kind == tool::BurrKind::diamond;
  scene.burr.world_from_tool = pose_of_tool(row);
  if (contact)
    render::show_contact(scene, row.hand.world_from_tool.p, row.contact.proxy, row.contact.force);
}

}  // namespace burr::workshop

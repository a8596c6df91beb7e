#include "burr/workshop/tool_looks.h"

#include "burr/render/tool_mesh.h"

namespace burr::workshop {

std::shared_ptr<const render::ToolLook> look_of(const tool::Tool& tool) {
  auto look = std::make_shared<render::ToolLook>();
  look->cuts = render::mesh_of(tool, tool::Role::cuts);
  look->rubs = render::mesh_of(tool, tool::Role::rubs);
  return look;
}

ToolLooks::ToolLooks(const std::vector<tool::ShapedTool>& tools) {
  for (const tool::ShapedTool& tool : tools) looks_.push_back(look_of(tool.tool));
}

void ToolLooks::put(render::Scene& scene, int number) const {
  const bool there = number >= 0 && number < static_cast<int>(looks_.size());
  scene.burr.other = there ? looks_[static_cast<std::size_t>(number)] : nullptr;
}

}  // namespace burr::workshop

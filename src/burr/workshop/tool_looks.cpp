#include "burr/workshop/tool_looks.h"

#include "burr/render/tool_mesh.h"

namespace burr::workshop {

ToolLooks::ToolLooks(const std::vector<tool::ShapedTool>& tools) {
  for (const tool::ShapedTool& tool : tools) {
    auto look = std::make_shared<render::ToolLook>();
    look->cuts = render::mesh_of(tool.tool, tool::Role::cuts);
    look->rubs = render::mesh_of(tool.tool, tool::Role::rubs);
    looks_.push_back(std::move(look));
  }
}

void ToolLooks::put(render::Scene& scene, int number) const {
  const bool there = number >= 0 && number < static_cast<int>(looks_.size());
  scene.burr.other = there ? looks_[static_cast<std::size_t>(number)] : nullptr;
}

}  // namespace burr::workshop

// workshop/tool_looks.h - the pictures of a session's tools: their surfaces, made once, put into a
// scene by number.
//
// Thread: any, one at a time. Cost of making: some milliseconds a tool.
#pragma once

#include <memory>
#include <vector>

#include "burr/render/scene.h"
#include "burr/tool/shaped_tool.h"

namespace burr::workshop {

[[nodiscard]] std::shared_ptr<const render::ToolLook> look_of(const tool::Tool& tool);

class ToolLooks {
 public:
  ToolLooks() = default;
  explicit ToolLooks(const std::vector<tool::ShapedTool>& tools);
  // number: of the list; any other: the round burr.
  void put(render::Scene& scene, int number) const;
  [[nodiscard]] bool empty() const { return looks_.empty(); }

 private:
  std::vector<std::shared_ptr<const render::ToolLook>> looks_;
};

}  // namespace burr::workshop

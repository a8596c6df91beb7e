#include "burr/scenario/rack.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "burr/base/printable.h"

namespace burr::scenario {

using math::Vec3;
using tool::Role;

const RackTool* Rack::find(std::string_view name) const {
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const RackTool& tool) { return tool.name == name; });
  return at == all.end() ? nullptr : &*at;
}

Result<RackTool> Rack::get(std::string_view name) const {
  if (const RackTool* found = find(name)) return *found;
  std::string list;
  for (const RackTool& tool : all) list += (list.empty() ? "" : ", ") + tool.name;
  return error(fmt::format("there is no tool \"{}\"; use one of {}",
                           base::printable(std::string(name)), list));
}

void Rack::put(RackTool tool) {
  const auto same = std::find_if(all.begin(), all.end(),
                                 [&](const RackTool& one) { return one.name == tool.name; });
  if (same != all.end())
    *same = std::move(tool);
  else
    all.push_back(std::move(tool));
}

double cutting_width(const RackTool& tool) {
  math::Aabb all;
  for (int n = 0; n < tool.tool.count; ++n) {
    const tool::Part& part = tool.tool.parts[static_cast<std::size_t>(n)];
    if (part.role != Role::cuts) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 way = Vec3::Unit(axis), in_part = part.tool_from_part.q.conjugate() * way;
      const double middle = part.tool_from_part.p[axis];
      all.hi[axis] = std::max(all.hi[axis], middle + tool::support(part.shape, in_part));
      all.lo[axis] = std::min(all.lo[axis], middle - tool::support(part.shape, -in_part));
    }
  }
  return std::max(all.hi.x() - all.lo.x(), all.hi.y() - all.lo.y());
}

}  // namespace burr::scenario

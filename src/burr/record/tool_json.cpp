#include "burr/record/tool_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "burr/record/private_text.h"
#include "burr/tool/limits.h"
#include "burr/tool/shape_grid.h"

namespace burr::record {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, tool::kShapeKinds> kShapes = {
    "ball", "capsule", "cylinder",   "frustum", "vesica",
    "box",  "wedge",   "half_shell", "tube",    "grid"};
constexpr std::array<std::string_view, 3> kRoles = {"cuts", "rubs", "seen"};
constexpr std::array<std::string_view, 5> kDrives = {"turning", "oscillating", "reciprocating",
                                                     "pushed", "struck"};

template <class Enum, std::size_t N>
bool named(const json& object, const char* field, const std::array<std::string_view, N>& names,
           Enum& value) {
  const auto at = object.find(field);
  if (at == object.end() || !at->is_string()) return false;
  const auto found = std::find(names.begin(), names.end(), at->get<std::string>());
  if (found == names.end()) return false;
  value = static_cast<Enum>(found - names.begin());
  return true;
}

bool numbers(const json& object, const char* field, std::size_t count, double* values) {
  const auto at = object.find(field);
  if (at == object.end() || !at->is_array() || at->size() != count) return false;
  for (std::size_t n = 0; n < count; ++n) {
    if (!(*at)[n].is_number()) return false;
    values[n] = (*at)[n].get<double>();
    if (!std::isfinite(values[n])) return false;
  }
  return true;
}

bool number(const json& object, const char* field, double& value) {
  const auto at = object.find(field);
  if (at == object.end() || !at->is_number()) return false;
  value = at->get<double>();
  return std::isfinite(value) && std::abs(value) < 1e9;
}

bool grid_from(const json& object, tool::Shape& shape) {
  const auto grid = object.find("grid");
  if (grid == object.end() || !grid->is_object()) return false;
  tool::GridCells cells;
  double size[3];
  if (!numbers(*grid, "size", 3, size)) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(size[axis] >= 0 && size[axis] <= tool::kMostAlongAxis)) return false;
    cells.size[axis] = static_cast<int>(size[axis]);
  }
  const auto phi = grid->find("phi");
  if (phi == grid->end() || !phi->is_array() || phi->size() > tool::kMostNodes) return false;
  for (const json& one : *phi) {
    if (!one.is_number_integer()) return false;
    const auto value = one.get<std::int64_t>();
    if (value < INT16_MIN || value > INT16_MAX) return false;
    cells.phi.push_back(static_cast<std::int16_t>(value));
  }
  shape.grid = tool::keep_grid(cells);
  return shape.grid != nullptr;
}

json json_from(const tool::Part& part) {
  const tool::Shape& shape = part.shape;
  const math::Vec3& at = part.tool_from_part.p;
  const math::Quat& turn = part.tool_from_part.q;
  json out = {{"shape", kShapes[static_cast<std::size_t>(shape.kind)]},
              {"sizes_m", {shape.a, shape.b, shape.c, shape.rounding}},
              {"at_m", {at.x(), at.y(), at.z()}},
              {"turn_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}},
              {"role", kRoles[static_cast<std::size_t>(part.role)]}};
  if (shape.kind == tool::ShapeKind::grid) {
    const tool::GridCells cells = tool::cells_of(*shape.grid);
    out["grid"] = {{"size", cells.size}, {"phi", cells.phi}};
  }
  return out;
}

bool part_from(const json& object, tool::Part& part) {
  double sizes[4], at[3], turn[4];
  if (!object.is_object() || !named(object, "shape", kShapes, part.shape.kind) ||
      !named(object, "role", kRoles, part.role) || !numbers(object, "sizes_m", 4, sizes) ||
      !numbers(object, "at_m", 3, at) || !numbers(object, "turn_xyzw", 4, turn))
    return false;
  part.shape = {part.shape.kind, sizes[0], sizes[1], sizes[2], sizes[3]};
  if (part.shape.kind == tool::ShapeKind::grid && !grid_from(object, part.shape)) return false;
  part.tool_from_part.p = math::Vec3(at[0], at[1], at[2]);
  part.tool_from_part.q.coeffs() << turn[0], turn[1], turn[2], turn[3];
  constexpr double kLargest = 0.5;  // [m]
  return std::abs(part.tool_from_part.q.norm() - 1) < 1e-6 &&
         *std::max_element(sizes, sizes + 4) < kLargest && part.tool_from_part.p.norm() < kLargest;
}

json json_from(const tool::Cutter& cutter) {
  return {{"drive", kDrives[static_cast<std::size_t>(cutter.drive)]},
          {"speed_rad_s", cutter.speed_rad_s},
          {"amplitude_m", cutter.amplitude_m},
          {"cycles_hz", cutter.cycles_hz},
          {"blow_j", cutter.blow_j},
          {"way", {cutter.way.x(), cutter.way.y(), cutter.way.z()}},
          {"efficiency", cutter.efficiency},
          {"least_weight", cutter.least_weight},
          {"teeth", cutter.teeth}};
}

bool cutter_from(const json& object, tool::Cutter& cutter) {
  double way[3], teeth = 0;
  if (!object.is_object() || !named(object, "drive", kDrives, cutter.drive) ||
      !number(object, "speed_rad_s", cutter.speed_rad_s) ||
      !number(object, "amplitude_m", cutter.amplitude_m) ||
      !number(object, "cycles_hz", cutter.cycles_hz) || !number(object, "blow_j", cutter.blow_j) ||
      !numbers(object, "way", 3, way) || !number(object, "efficiency", cutter.efficiency) ||
      !number(object, "least_weight", cutter.least_weight) || !number(object, "teeth", teeth))
    return false;
  cutter.way = math::Vec3(way[0], way[1], way[2]);
  if (!(teeth >= 0 && teeth <= 1e6)) return false;
  cutter.teeth = static_cast<int>(teeth);
  return std::abs(cutter.way.norm() - 1) < 1e-6 && cutter.blow_j >= 0 && cutter.cycles_hz >= 0 &&
         cutter.efficiency >= 0 && cutter.least_weight >= 0;
}

bool tool_from(const json& object, tool::ShapedTool& tool) {
  if (!object.is_object()) return false;
  const auto name = object.find("name"), parts = object.find("parts"),
             cutter = object.find("cutter");
  if (name == object.end() || !name->is_string() || parts == object.end() || !parts->is_array() ||
      cutter == object.end())
    return false;
  tool.name = name->get<std::string>();
  if (looks_private(tool.name) || tool.name.size() > 64) return false;
  bool cuts = false;
  for (const json& one : *parts) {
    tool::Part part;
    if (!part_from(one, part) || !tool::add_part(tool.tool, part)) return false;
    cuts = cuts || part.role == tool::Role::cuts;
  }
  return cuts && cutter_from(*cutter, tool.cutter);
}

}  // namespace

std::string tools_to_json(const std::vector<tool::ShapedTool>& tools) {
  json list = json::array();
  for (const tool::ShapedTool& tool : tools) {
    json parts = json::array();
    for (int p = 0; p < tool.tool.count; ++p)
      parts.push_back(json_from(tool.tool.parts[static_cast<std::size_t>(p)]));
    list.push_back(
        {{"name", tool.name}, {"parts", std::move(parts)}, {"cutter", json_from(tool.cutter)}});
  }
  return list.dump();
}

bool tools_from_json(std::string_view text, std::vector<tool::ShapedTool>& tools) {
  const json list = json::parse(text, nullptr, false);
  if (!list.is_array() || list.size() > tool::kMostTools) return false;
  for (const json& one : list)
    if (!tool_from(one, tools.emplace_back())) return false;
  return true;
}

}  // namespace burr::record

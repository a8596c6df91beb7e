#include "burr/record/grid_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace burr::record {
namespace {

using nlohmann::json;

const char* kind_name(volume::TissueKind kind) {
  switch (kind) {
    case volume::TissueKind::air:
      return "air";
    case volume::TissueKind::soft:
      return "soft";
    case volume::TissueKind::solid:
      return "solid";
  }
  return "air";
}

bool kind_from(const json& name, volume::TissueKind& kind) {
  for (const auto known :
       {volume::TissueKind::air, volume::TissueKind::soft, volume::TissueKind::solid})
    if (name == kind_name(known)) {
      kind = known;
      return true;
    }
  return false;
}

template <std::size_t N>
bool numbers(const json& object, const char* name, std::array<double, N>& out) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_array() || at->size() != N) return false;
  for (std::size_t i = 0; i < N; ++i) {
    if (!(*at)[i].is_number()) return false;
    out[i] = (*at)[i].template get<double>();
    if (!std::isfinite(out[i])) return false;
  }
  return true;
}

bool number(const json& object, const char* name, double& out) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_number()) return false;
  out = at->get<double>();
  return std::isfinite(out);
}

}  // namespace

json json_from_grid(const volume::Grid& grid) {
  const math::Vec3& p = grid.frame.p;
  const math::Quat& q = grid.frame.q;
  return {{"size", {grid.size.x(), grid.size.y(), grid.size.z()}},
          {"voxel_m", grid.voxel},
          {"origin_m", {p.x(), p.y(), p.z()}},
          {"axes_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

bool grid_from_json(const json& object, volume::Grid& grid) {
  if (!object.is_object()) return false;
  std::array<double, 3> size{}, origin{};
  std::array<double, 4> axes{};
  if (!numbers(object, "size", size) || !numbers(object, "origin_m", origin) ||
      !numbers(object, "axes_xyzw", axes) || !number(object, "voxel_m", grid.voxel))
    return false;
  constexpr double kMostVoxels = 2048.0 * 2048.0 * 2048.0;
  for (const double n : size)
    if (!(n >= 1 && n <= 32768) || n != std::floor(n)) return false;
  if (size[0] * size[1] * size[2] > kMostVoxels || !(grid.voxel > 0)) return false;
  grid.size = {static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2])};
  grid.frame.p = {origin[0], origin[1], origin[2]};
  grid.frame.q = math::Quat(axes[3], axes[0], axes[1], axes[2]);
  return std::abs(grid.frame.q.norm() - 1) < 1e-6;
}

namespace {

constexpr std::pair<const char*, double volume::CuttingForce::*> kForce[] = {
    {"chip_tangential_n_per_m2", &volume::CuttingForce::chip_tangential},
    {"chip_radial_n_per_m2", &volume::CuttingForce::chip_radial},
    {"edge_tangential_n_per_m", &volume::CuttingForce::edge_tangential},
    {"edge_radial_n_per_m", &volume::CuttingForce::edge_radial},
    {"edge_onset_m", &volume::CuttingForce::edge_onset}};

json json_from_force(const volume::CuttingForce& force) {
  json object = json::object();
  for (const auto& [name, member] : kForce) object[name] = force.*member;
  return object;
}

// Recordings from before the chips law have none; that law was not used then.
bool force_from_json(const json& tissue, volume::CuttingForce& force) {
  const auto object = tissue.find("cutting_force");
  if (object == tissue.end()) return true;
  if (!object->is_object()) return false;
  for (const auto& [name, member] : kForce)
    if (!number(*object, name, force.*member) || !(force.*member >= 0)) return false;
  return force.edge_onset > 0;
}

}  // namespace

json json_from_tissues(const volume::TissueTable& tissues) {
  json list = json::array();
  for (const volume::Tissue& tissue : tissues.tissues)
    list.push_back({{"name", tissue.name},
                    {"kind", kind_name(tissue.kind)},
                    {"colour_srgb", tissue.colour},
                    {"cutting_energy_j_per_m3", tissue.cutting_energy},
                    {"friction", tissue.friction},
                    {"cutting_friction", tissue.cutting_friction},
                    {"cutting_force", json_from_force(tissue.force)},
                    {"spare", tissue.spare},
                    {"bleeds", tissue.bleeds},
                    {"label", tissue.label}});
  return list;
}

bool tissues_from_json(const json& list, volume::TissueTable& tissues) {
  if (!list.is_array() || list.empty() || list.size() > 256) return false;
  tissues.tissues.clear();
  for (const json& object : list) {
    if (!object.is_object()) return false;
    volume::Tissue tissue;
    std::array<double, 3> colour{};
    const auto name = object.find("name"), kind = object.find("kind"), spare = object.find("spare"),
               label = object.find("label");
    if (name == object.end() || !name->is_string() || kind == object.end() ||
        !kind_from(*kind, tissue.kind) || spare == object.end() || !spare->is_boolean() ||
        label == object.end() || !label->is_number_integer() ||
        !numbers(object, "colour_srgb", colour) ||
        !number(object, "cutting_energy_j_per_m3", tissue.cutting_energy) ||
        !number(object, "friction", tissue.friction) || !force_from_json(object, tissue.force))
      return false;
    // older recordings have one value for all tissues, in the settings of the session
    if (object.contains("cutting_friction") &&
        !(number(object, "cutting_friction", tissue.cutting_friction) &&
          tissue.cutting_friction >= 0))
      return false;
    if (object.contains("bleeds") &&
        !(number(object, "bleeds", tissue.bleeds) && tissue.bleeds >= 0 && tissue.bleeds <= 1))
      return false;
    tissue.name = name->get<std::string>();
    tissue.spare = spare->get<bool>();
    tissue.label = label->get<int>();
    if (!(tissue.cutting_energy > 0) || !(tissue.friction >= 0)) return false;
    for (std::size_t i = 0; i < 3; ++i)
      tissue.colour[i] = static_cast<float>(std::clamp(colour[i], 0.0, 1.0));
    tissues.tissues.push_back(std::move(tissue));
  }
  return tissues.tissues[0].kind == volume::TissueKind::air;
}

}  // namespace burr::record

#include "burr/phantom/phantoms.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace burr::phantom {
namespace {

// A block of bone to sculpt, edges along the world's axes.
Phantom block(double) {
  Phantom phantom;
  phantom.formula.depth = box({20e-3, 20e-3, 15e-3});
  phantom.landmarks = {
      {"centre", {Vec3::Zero()}, {}},
      {"top", {Vec3(0, 0, 15e-3)}, Vec3::UnitZ()},
      {"front edge", {Vec3(-20e-3, -20e-3, 15e-3), Vec3(20e-3, -20e-3, 15e-3)}, {}}};
  phantom.lo = {-22e-3, -22e-3, -17e-3};
  phantom.hi = {22e-3, 22e-3, 17e-3};
  return phantom;
}

Phantom round_ball(double) {
  Phantom phantom;
  phantom.formula.depth = ball(kPeersBall);
  phantom.landmarks = {{"centre", {Vec3::Zero()}, {}}};
  phantom.lo = Vec3::Constant(-0.5 * kPeersCube);
  phantom.hi = Vec3::Constant(0.5 * kPeersCube);
  return phantom;
}

struct Known {
  std::string_view name;
  double voxel_mm;
  Phantom (*make)(double voxel);
};

constexpr std::array<Known, 7> kKnown = {{{"temporal-bone", 0.25, temporal_bone},
                                          {"jaw", 0.25, jaw},
                                          {"tooth", 0.1, tooth},
                                          {"spine", 0.4, spine},
                                          {"skull", 0.5, skull},
                                          {"block", 0.25, block},
                                          {"ball", 0.25, round_ball}}};

const Known* find(std::string_view name) {
  for (const Known& known : kKnown)
    if (known.name == name) return &known;
  return nullptr;
}

std::string list_of_names() {
  std::string list;
  for (const Known& known : kKnown) list += (list.empty() ? "" : ", ") + std::string(known.name);
  return list;
}

// more would not fit into the memory of a common computer; fewer show nothing
constexpr double kMostVoxels = 1.2e9, kFewestAlong = 16;

std::string in_mm(double mm) {
  std::string text = std::to_string(mm);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

}  // namespace

std::vector<std::string_view> phantom_names() {
  std::vector<std::string_view> names;
  for (const Known& known : kKnown) names.push_back(known.name);
  return names;
}

double default_voxel_mm(std::string_view name) {
  const Known* known = find(name);
  return known == nullptr ? 0 : known->voxel_mm;
}

std::vector<Landmark> landmarks(std::string_view name) {
  const Known* known = find(name);
  return known == nullptr ? std::vector<Landmark>() : known->make(1e-3 * known->voxel_mm).landmarks;
}

Result<std::unique_ptr<volume::Bone>> phantom(
    std::string_view name, double voxel_mm, Progress& progress, std::size_t reserve_bricks,
    int threads, const std::function<void(volume::TissueTable&)>& made_of) {
  const Known* known = find(name);
  if (known == nullptr)
    return error(Trouble::usage,
                 "unknown phantom '" + std::string(name) + "'; use one of " + list_of_names());
  if (voxel_mm == 0) voxel_mm = known->voxel_mm;
  if (!(voxel_mm > 0) || !std::isfinite(voxel_mm))
    return error(Trouble::usage,
                 "the voxel size must be a positive number of millimetres, for example " +
                     in_mm(known->voxel_mm) + " for the phantom " + std::string(name));
  const double voxel = 1e-3 * voxel_mm;
  Phantom made = known->make(voxel);
  if (made_of) made_of(made.tissues);
  const Vec3 along = (made.hi - made.lo) / voxel;
  if (along.minCoeff() < kFewestAlong)
    return error(Trouble::usage, "voxels of " + in_mm(voxel_mm) +
                                     " are too coarse for the phantom " + std::string(name) +
                                     ", which is " + in_mm(1e3 * (made.hi - made.lo).minCoeff()) +
                                     " thick; use " + in_mm(known->voxel_mm));
  if (along.prod() > kMostVoxels)
    return error(Trouble::usage, "voxels of " + in_mm(voxel_mm) + " would make more than " +
                                     std::to_string(static_cast<int>(kMostVoxels / 1e6)) +
                                     " million of them; use larger voxels, for example " +
                                     in_mm(known->voxel_mm) + " for the phantom " +
                                     std::string(name));
  return bone_from_formula(box_grid(made.lo, made.hi, voxel), made.tissues, made.formula,
                           reserve_bricks, threads, progress);
}

}  // namespace burr::phantom

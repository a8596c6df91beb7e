#include "burr/phantom/phantoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace burr::phantom {
namespace {

// A block of bone to sculpt, edges along the world's axes.
Phantom block(double, const Variant&) {
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

Phantom round_ball(double, const Variant&) {
  Phantom phantom;
  phantom.formula.depth = ball(kPeersBall);
  phantom.landmarks = {{"centre", {Vec3::Zero()}, {}}};
  phantom.lo = Vec3::Constant(-0.5 * kPeersCube);
  phantom.hi = Vec3::Constant(0.5 * kPeersCube);
  return phantom;
}

constexpr std::array<VariantWord, 5> kTemporalBoneVariants = {
    {{"forward-sinus", "the descending sigmoid sinus lies 4 mm farther forward"},
     {"low-dura", "the dura over the mastoid lies 4 mm lower"},
     {"dehiscent", "no bone over 3 mm of the facial nerve's tympanic part"},
     {"sclerotic", "dense bone in place of the mastoid cells"},
     {"ridge-dura", "the dura covers the ridge of the pyramid too, without gaps"}}};
constexpr std::array<VariantWord, 1> kSpineVariants = {
    {{"thin-pedicle", "the pedicles are 2.4 mm narrower and lower"}}};
constexpr std::array<VariantWord, 3> kJawVariants = {
    {{"long", "longer in front, for an osteotomy: toothless to the front, floor of the mouth"},
     {"high-nerve", "the nerve lies 2.5 mm nearer to the ridge"},
     {"defect", "a round defect 2.5 mm deep in the cheek side, below the nerve"}}};
constexpr std::array<VariantWord, 3> kToothVariants = {
    {{"graded", "caries in three grades, and a second, smaller one in front of it"},
     {"shallow", "the caries ends 0.8 mm higher"},
     {"deep", "the caries ends 0.4 mm lower"}}};

struct Known {
  std::string_view name;
  double voxel_mm;
  Phantom (*make)(double voxel, const Variant& variant);
  std::span<const VariantWord> variants = {};
};

constexpr std::array<Known, 7> kKnown = {
    {{"temporal-bone", 0.25, temporal_bone, kTemporalBoneVariants},
     {"jaw", 0.25, jaw, kJawVariants},
     {"tooth", 0.1, tooth, kToothVariants},
     {"spine", 0.4, spine, kSpineVariants},
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

// "jaw?long,high-nerve"
struct Wanted {
  const Known* known = nullptr;
  Variant variant;
};
Result<Wanted> wanted(std::string_view text) {
  const std::size_t mark = text.find('?');
  const std::string_view name = text.substr(0, mark);
  Wanted out{find(name), {}};
  if (out.known == nullptr)
    return error(Trouble::usage,
                 "unknown phantom '" + std::string(name) + "'; use one of " + list_of_names());
  if (mark == std::string_view::npos) return out;
  std::vector<std::string> words;
  for (std::string_view rest = text.substr(mark + 1);;) {
    const std::size_t comma = rest.find(',');
    words.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::string list;
  for (const VariantWord& one : out.known->variants)
    list += (list.empty() ? "" : ", ") + std::string(one.word);
  for (const std::string& word : words)
    if (std::none_of(out.known->variants.begin(), out.known->variants.end(),
                     [&](const VariantWord& one) { return one.word == word; }))
      return error(Trouble::usage,
                   "the phantom " + std::string(name) + " has no variant '" + word + "'; " +
                       (list.empty() ? "it has none, so leave out what follows the ?"
                                     : "use one or more of " + list));
  out.variant = Variant(std::move(words));
  return out;
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

std::span<const VariantWord> variants_of(std::string_view name) {
  const Known* known = find(name);
  return known == nullptr ? std::span<const VariantWord>() : known->variants;
}

Status known(std::string_view name) {
  const auto found = wanted(name);
  return found ? fine() : Status(found.error());
}

double default_voxel_mm(std::string_view name) {
  const auto found = wanted(name);
  return found ? found->known->voxel_mm : 0;
}

std::vector<Landmark> landmarks(std::string_view name) {
  const auto found = wanted(name);
  return found ? found->known->make(1e-3 * found->known->voxel_mm, found->variant).landmarks
               : std::vector<Landmark>();
}

Result<std::unique_ptr<volume::Bone>> phantom(
    std::string_view name, double voxel_mm, Progress& progress, std::size_t reserve_bricks,
    int threads, const std::function<void(volume::TissueTable&)>& made_of) {
  const auto found = wanted(name);
  if (!found) return found.error();
  const Known* known = found->known;
  if (voxel_mm == 0) voxel_mm = known->voxel_mm;
  if (!(voxel_mm > 0) || !std::isfinite(voxel_mm))
    return error(Trouble::usage,
                 "the voxel size must be a positive number of millimetres, for example " +
                     in_mm(known->voxel_mm) + " for the phantom " + std::string(name));
  const double voxel = 1e-3 * voxel_mm;
  Phantom made = known->make(voxel, found->variant);
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

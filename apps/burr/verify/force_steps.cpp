// burr verify steps - what the hand feels from one tick to the next beyond its own move: on
// formulas, in a slot as wide as the burr, on bone that the border of a scan cuts, and on real bone.
#include "burr/haptics/force_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "burr/importing/import.h"
#include "burr/phantom/build.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/open_bone.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"
#include "workbench.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kMm = 1e-3;
constexpr double kBar = 0.05;   // [N]
constexpr double kFast = 100;   // of the hand along the bone [mm/s]
constexpr double kInSlot = 20;  // in a slot of the burr's own width

struct Stroke {
  haptics::ForceSteps steps{1000, kBar};
  double mean = 0;  // force while touching [N]
  double bobs = 0;  // highest minus lowest place of the burr along the push, in contact [m]
  std::vector<double> t, excess;
};

// A firm hand comes down at `from`, presses `deep` and draws the burr to `to` and back.
Stroke stroke(std::unique_ptr<volume::Bone> bone, double radius, const Vec3& from, const Vec3& to,
              const Vec3& into, double deep, double speed_mm_s) {
  WorkSettings settings;
  settings.radius = radius;
  const double way = (to - from).norm() / (speed_mm_s * kMm), in = 0.4;
  const Vec3 down = deep * into;
  const device::HandPath path = path_through({{0, from - 3 * kMm * into},
                                              {in, from + down},
                                              {in + 0.1, from + down},
                                              {in + 0.1 + way, to + down},
                                              {in + 0.1 + 2 * way, from + down},
                                              {in + 0.2 + 2 * way, from + down}});
  Workbench bench(std::move(bone), settings);
  Stroke out;
  double low = INFINITY, high = -INFINITY;
  int touching = 0;
  for (const auto& row : bench.work(path, {}, false)) {
    const double excess = out.steps.add(row.hand, row.force);
    out.t.push_back(row.t);
    out.excess.push_back(excess);
    if (row.t < in + 0.1 || row.push == 0) continue;
    low = std::min(low, row.proxy.dot(into));
    high = std::max(high, row.proxy.dot(into));
    out.mean += row.force.norm();
    ++touching;
  }
  out.mean /= std::max(1, touching);
  out.bobs = touching > 0 ? high - low : 0;
  return out;
}

// A block that fills its scan up to the border everywhere but at the bottom: as a region cropped
// out of bone. Its top is at z = 4 mm, its sides at +-10 mm.
io::Scan cut_block(bool labels) {
  io::Scan scan;
  scan.size = {50, 50, 30};
  scan.spacing_mm = Vec3::Constant(0.4);
  scan.origin_mm = {-9.8, -9.8, -7.8};
  scan.format = "formula";
  scan.hounsfield = !labels;
  for (int k = 0; k < 30; ++k)
    for (int v = 0; v < 50 * 50; ++v) {
      // grey bone is not even: dense and porous bone in turns along i and j
      const double wave = std::sin(0.5 * (v % 50)) * std::sin(0.4 * (v / 50));
      if (labels)
        scan.labels.push_back(k >= 5 ? 1 : 0);
      else
        scan.values.push_back(static_cast<float>(k >= 5 ? std::round(1100 + 600 * wave) : -1000));
    }
  return scan;
}

std::unique_ptr<volume::Bone> imported(bool labels, const scenario::BoneRecipe& recipe) {
  auto made = importing::import_bone(cut_block(labels), recipe, progress());
  return made ? std::move(made->bone) : nullptr;
}

void formulas(VerifyReport::Part& part, Table& table) {
  const volume::Grid grid =
      phantom::box_grid(Vec3::Constant(-12 * kMm), Vec3::Constant(12 * kMm), 0.4 * kMm);
  const double r = 2.5 * kMm;
  const auto judge = [&](const char* name, const Stroke& one, double bar) {
    if (bar > 0) part.at_most(fmt::format("{}.excess_step", name), bar, one.steps.most(), "N");
    part.at_least(fmt::format("{}.force", name), 0.05, one.mean, "N");
    table.rows.push_back(
        {name, fmt::format("{:.2f}", one.mean), fmt::format("{:.4f}", one.steps.most()),
         fmt::format("{}", one.steps.above()), fmt::format("{:.3f}", 1e3 * one.bobs)});
  };
  judge("plane",
        stroke(phantom::bone_from_distance(grid, {}, phantom::slab()), r, {-6 * kMm, -2 * kMm, r},
               {6 * kMm, 2 * kMm, r}, -Vec3::UnitZ(), 1 * kMm, kFast),
        kBar);
  judge("ball",
        stroke(phantom::bone_from_distance(grid, {}, phantom::ball(9 * kMm)), r,
               {-4 * kMm, 0, 9 * kMm + r}, {4 * kMm, 1 * kMm, 9 * kMm + r}, -Vec3::UnitZ(),
               1.5 * kMm, kFast),
        kBar);
  judge(
      "groove",
      stroke(phantom::bone_from_distance(grid, {}, phantom::groove(45 * M_PI / 180)), r,
             {0, -6 * kMm, r * M_SQRT2}, {0, 6 * kMm, r * M_SQRT2}, -Vec3::UnitZ(), 1 * kMm, kFast),
      kBar);
  // 6 mm deep and exactly as wide as the burr, which rests on its two rims; along the grid, where
  // the walls are even, and across it, where the voxels roughen them
  for (const double turned : {0.0, 17.0}) {
    const math::Pose in_slot{Vec3(0, 0, -3 * kMm),
                             math::Quat(Eigen::AngleAxisd(turned * M_PI / 180, Vec3::UnitZ()))};
    const Vec3 along = 6 * kMm * (in_slot.q * Vec3::UnitX());
    judge(turned == 0 ? "slot" : "slot_across_the_grid",
          stroke(
              phantom::bone_from_distance(
                  grid, {},
                  phantom::without(phantom::slab(),
                                   phantom::placed(phantom::box({20 * kMm, r, 3 * kMm}), in_slot))),
              r, -along, along, -Vec3::UnitZ(), 3 * kMm, kInSlot),
          kBar);
  }
  for (const bool labels : {true, false}) {
    auto bone = imported(labels, {});
    if (bone == nullptr) {
      part.cannot("the block that the border cuts was not imported");
      continue;
    }
    judge(labels ? "border_of_labels" : "border_of_grey",
          stroke(std::move(bone), r, {-6 * kMm, -2 * kMm, 4 * kMm + r},
                 {6 * kMm, 2 * kMm, 4 * kMm + r}, -Vec3::UnitZ(), 0.7 * kMm, kFast),
          kBar);
  }
  // a region taken out of the middle: its sides are cut by nothing but the numbers of --roi
  for (const bool labels : {true, false}) {
    scenario::BoneRecipe recipe;
    recipe.region = scenario::Region{{10, 44}, {3, 40}, {3, 25}};
    auto bone = imported(labels, recipe);
    if (bone == nullptr) {
      part.cannot("the region of the block was not imported");
      continue;
    }
    judge(labels ? "region_of_labels" : "region_of_grey",
          stroke(std::move(bone), r, {-6 * kMm - r, 0, -3 * kMm},
                 {-6 * kMm - r, 2 * kMm, 0.5 * kMm}, Vec3::UnitX(), 0.7 * kMm, kFast),
          kBar);
  }
}

struct Subject {
  const char *name, *file;
  double spacing_mm;
  bool halved;  // only the first half of the slices: a region's border cuts the bone
  bool slow;    // left out with --quick
};
constexpr Subject kSubjects[] = {
    {"jaw", "jaw_cbct/jaw_cbct_half_0.4mm.nii.gz", 0, false, false},
    {"tooth_cut", "tooth_microct/tooth.nhdr", 0.1, true, false},
    {"temporal_bone", "temporal_bone/RT143_512.seg.nrrd", 0, false, true},
};

void real_bones(const Verify& verify, VerifyReport::Part& part, Table& table) {
  for (const Subject& subject : kSubjects) {
    const std::filesystem::path file = std::filesystem::path(verify.data) / subject.file;
    if (verify.data.empty() || !std::filesystem::exists(file)) {
      part.cannot(fmt::format("{}: {}", subject.name,
                              verify.data.empty() ? "give --data DIR, where the real bones lie"
                                                  : file.string() + " is not there"));
      continue;
    }
    if (verify.quick && subject.slow) continue;
    if (interrupted()) return;
    scenario::BoneRecipe recipe;
    recipe.source = file.string();
    recipe.spacing_mm = Vec3::Constant(subject.spacing_mm);
    auto opened = workshop::open_bone(recipe, progress());
    if (opened && subject.halved) {
      const math::Ijk n = opened->summary.scan_size;
      recipe.region = scenario::Region{{0, n.x() - 1}, {0, n.y() - 1}, {0, n.z() / 2}};
      opened = workshop::open_bone(recipe, progress());
    }
    if (!opened) {
      part.cannot(fmt::format("{}: {}", subject.name, in_options(opened.error()).text));
      continue;
    }
    const double r = 8 * opened->bone->grid().voxel;
    const auto place = surgeon::find_work_place(*opened->bone, r, {}, {});
    if (!place) {
      part.cannot(fmt::format("{}: {}", subject.name, in_options(place.error()).text));
      continue;
    }
    const Vec3 along = place->into.unitOrthogonal(), at = place->at - r * place->into;
    const Stroke one =
        stroke(std::move(opened->bone), r, at, at + 2 * r * along, place->into, 0.5 * r, 20);
    table.rows.push_back(
        {subject.name, fmt::format("{:.2f}", one.mean), fmt::format("{:.4f}", one.steps.most()),
         fmt::format("{}", one.steps.above()), fmt::format("{:.3f}", 1e3 * one.bobs)});
    part.at_least(fmt::format("{}.force", subject.name), 0.05, one.mean, "N");
  }
}

void steps(const Verify& verify, VerifyReport::Part& part) {
  Table table{
      fmt::format(
          "A firm hand presses the burr down and draws it along and back, {} mm/s on "
          "formulas ({} in the slots) and 20 mm/s on real bone, nothing is cut. The excess step is "
          "the change "
          "of the force from one tick to the next less the spring's share of the hand's own "
          "move. On real bone it is reported and not judged: there a burr slips over edges.",
          kFast, kInSlot),
      {"bone", "force [N]", "largest excess step [N]", "ticks above 0.05 N", "bobs [mm]"},
      {}};
  formulas(part, table);
  real_bones(verify, part, table);
  part.table(std::move(table));
}

const VerifyPart part{45, "steps", "Steps of the force",
                      "What the hand feels from one tick to the next beyond the spring's share of "
                      "its own move, on formulas, on bone that the border of a scan or a region "
                      "cuts, and on real bone.",
                      steps};

}  // namespace
}  // namespace burr::app

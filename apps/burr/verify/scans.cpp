// burr verify scans - is the bone of a scan the scan's bone? The law of
// docs/understand/bone_of_a_scan.md, asked of random thin, small and turned shapes, and of real
// scans.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "burr/importing/import.h"
#include "burr/importing/scan_law.h"
#include "burr/io/read/read_scan.h"
#include "burr/surface/mesher.h"
#include "burr/surface/shells.h"
#include "burr/workshop/open_bone.h"
#include "scenes/thin_shapes.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kPrinted = 0.005;            // the volume that is printed and the mesh's
constexpr double kThick = 0.02, kThin = 0.1;  // the mesh's volume and that of marching cubes
constexpr double kThinWall = 2;               // [voxel]
constexpr double kFewVoxels = 100;            // fewer have no volume that two methods agree on
constexpr double kSmall = 1000;               // smoothing of noise rounds what is smaller [voxel]
constexpr double kBallVoxels = 10,
                 kMoved = 0.1;  // smooth bone: a ball's radius; its surface [voxel]

struct Judged {
  importing::ImportSummary plan;
  importing::ScanLaw law;
  surface::Shells mesh;
  double voxel_mm = 0;
  [[nodiscard]] double mesh_mm3() const { return mesh.volume * 1e9; }
  [[nodiscard]] double printed_off() const {
    return std::abs(plan.parts->mm3 / std::max(mesh_mm3(), 1e-9) - 1);
  }
  [[nodiscard]] double volume_off() const { return law.mesh_mm3 / law.scan_mm3 - 1; }
  [[nodiscard]] bool same_parts() const {
    return plan.parts->count == law.parts && mesh.parts == law.parts;
  }
};

Result<Judged> judge(const io::Scan& scan, const scenario::BoneRecipe& recipe) {
  auto plan = importing::plan_import(scan, recipe);
  if (!plan) return plan.error();
  Judged out;
  out.plan = std::move(*plan);
  if (Status counted = importing::count_parts(scan, recipe, progress(), out.plan); !counted)
    return counted.error();
  auto made = importing::import_bone(scan, recipe, progress());
  if (!made) return made.error();
  out.law = importing::scan_law(scan, *made->bone, out.plan.iso);
  out.voxel_mm = made->bone->grid().voxel * 1e3;
  const auto mesh = surface::whole_surface(*made->bone, 2, progress());
  if (!mesh) return mesh.error();
  out.mesh = surface::shells_of(*mesh);
  return out;
}

struct Way {
  const char* name;
  Vec3 spacing_mm;
  double noise;  // [HU]
};
const std::array<Way, 8> kWays = {{{"cubes-0.1mm", Vec3::Constant(0.1), 0},
                                   {"cubes-0.5mm", Vec3::Constant(0.5), 0},
                                   {"cubes-3mm", Vec3::Constant(3), 0},
                                   {"cubes-0.5mm-noise", Vec3::Constant(0.5), 40},
                                   {"cubes-3mm-noise", Vec3::Constant(3), 40},
                                   {"slices-0.9mm", {0.4, 0.4, 0.9}, 0},
                                   {"slices-0.3mm", {0.9, 0.9, 0.3}, 0},
                                   {"boxes-noise", {0.7, 0.5, 1.3}, 40}}};

void shapes(const Verify& verify, VerifyReport::Part& part) {
  const unsigned seed = static_cast<unsigned>(verify.seed_or(41)), each = verify.quick ? 8 : 125;
  Table table{fmt::format("{} shapes a row, seeds from {}: the largest difference of the mesh's "
                          "volume to that of marching cubes.",
                          each, seed),
              {"voxels", "walls of two voxels or more [%]", "thinner, or small with noise [%]"},
              {}};
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Way& way = kWays[w];
    double ghosts = 0, lost = 0, parts = 0, printed = 0, thick = 0, thin = 0;
    for (unsigned n = 0; n < each; ++n) {
      if (interrupted()) return;
      const auto drawn = scenes::thin_shapes(seed + n + each * static_cast<unsigned>(w),
                                             way.spacing_mm, way.noise);
      const auto one = judge(drawn.scan, {});
      if (!one) {
        part.cannot(fmt::format("{}: {}", way.name, in_options(one.error()).text));
        return;
      }
      ghosts += static_cast<double>(one->law.ghosts + one->law.ramps);
      lost += static_cast<double>(one->law.lost);
      parts += one->same_parts() ? 0 : 1;
      const double voxels = one->law.scan_mm3 / drawn.scan.spacing_mm.prod();
      if (voxels < kFewVoxels) continue;
      printed = std::max(printed, one->printed_off());
      const bool small = drawn.thinnest < kThinWall || (way.noise > 0 && voxels < kSmall);
      double& off = small ? thin : thick;
      off = std::max(off, std::abs(one->volume_off()));
    }
    const std::string name = std::string("shapes.") + way.name;
    part.at_most(name + ".ghosts", 0, ghosts, "voxels");
    if (way.noise == 0) part.at_most(name + ".lost", 0, lost, "voxels");
    part.at_most(name + ".parts_differ", 0, parts, "shapes");
    part.at_most(name + ".printed", kPrinted, printed, "");
    part.at_most(name + ".thick", kThick, thick, "");
    part.at_most(name + ".thin", kThin, thin, "");
    table.rows.push_back(
        {way.name, fmt::format("{:.1f}", 100 * thick), fmt::format("{:.1f}", 100 * thin)});
  }
  part.table(std::move(table));
}

// On smooth bone the surface lies where the formula says.
void smooth_ball(VerifyReport::Part& part) {
  for (const double noise : {0.0, 40.0}) {
    io::Scan scan;
    scan.size = math::Ijk::Constant(40);
    scan.spacing_mm = Vec3::Constant(0.5);
    scan.hounsfield = true;
    const Vec3 middle(19.7, 20.2, 19.4);
    // the level lies at the formula's surface
    const double level = 300, steep = 600;  // [HU], [HU/voxel]
    std::uint64_t state = 41;
    const auto stray = [&state] {  // a sum of twelve uniform numbers: nearly normal
      double sum = -6;
      for (int n = 0; n < 12; ++n) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        sum += static_cast<double>(state >> 11) * 0x1p-53;
      }
      return sum;
    };
    for (int k = 0; k < 40; ++k)
      for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) {
          const double depth = kBallVoxels - (Vec3(i, j, k) - middle).norm();
          const double hu = std::clamp(level + steep * depth, -200.0, 1200.0);
          scan.values.push_back(static_cast<float>(std::round(hu + noise * stray())));
        }
    const auto made = importing::import_bone(scan, {}, progress());
    if (!made) {
      part.cannot(in_options(made.error()).text);
      return;
    }
    const auto mesh = surface::whole_surface(*made->bone, 2, progress());
    if (!mesh) return;
    const Vec3 at = scan.origin_mm + middle * 0.5;
    std::vector<double> off;
    for (const surface::Vertex& vertex : mesh->vertices)
      off.push_back(std::abs((1e3 * vertex.p.cast<double>() - at).norm() / 0.5 - kBallVoxels));
    // of noise the worst of thousands of places says little
    double moved = *std::max_element(off.begin(), off.end());
    if (noise > 0) {
      double sum = 0;
      for (const double one : off) sum += one * one;
      moved = std::sqrt(sum / static_cast<double>(off.size()));
    }
    part.at_most(fmt::format("ball.noise-{:g}HU.moved{}", noise, noise > 0 ? "_rms" : ""), kMoved,
                 moved, "voxel");
  }
}

struct Real {
  const char *name, *file;
  bool slow, thick;  // thick: its walls are thicker than two voxels
};
constexpr Real kReal[] = {
    {"head", "head_ct/ct_example.nii.gz", false, false},
    {"head-and-neck", "headsq/headsq_hu.mha", false, false},
    {"lumbar", "spine_lumbar/example_ct.nii.gz", false, false},
    {"thoracic", "spine_thorax/LIDC-IDRI-0314_spine_crop.nii.gz", true, false},
    {"skull-5mm", "skull_phantom/std_5mm_jpegll", false, false},
    {"skull-1mm", "skull_phantom/bone_1mm_jpegls", true, true},
    {"skull-tilted", "skull_phantom/tilt_minus18.5_j2k", true, false},
    {"jaw", "jaw_cbct/jaw_cbct_half_0.4mm.nii.gz", true, true},
};

void real(const Verify& verify, VerifyReport::Part& part) {
  if (verify.data.empty()) {
    part.cannot("real scans: give --data DIR, where they lie");
    return;
  }
  Table table{
      "Real scans at 300 HU, or at the level that burr estimates. Noise is smoothed out first, "
      "so a scan with noise has fewer crumbs than marching cubes of its own values.",
      {"scan", "voxel [mm]", "parts", "mesh [mm3]", "marching cubes [mm3]", "ratio"},
      {}};
  for (const Real& subject : kReal) {
    if (interrupted()) return;
    if (verify.quick && subject.slow) continue;
    const std::filesystem::path file = std::filesystem::path(verify.data) / subject.file;
    if (!std::filesystem::exists(file)) {
      part.cannot(fmt::format("{}: {} is not there", subject.name, file.string()));
      continue;
    }
    scenario::BoneRecipe recipe;
    recipe.source = file.string();
    const auto scan = io::read_scan(recipe.source, workshop::read_options(recipe), progress());
    const auto one = scan ? judge(*scan, recipe) : Result<Judged>(scan.error());
    if (!one) {
      part.cannot(fmt::format("{}: {}", subject.name, in_options(one.error()).text));
      continue;
    }
    const std::string name = std::string("real.") + subject.name;
    part.at_most(name + ".ghosts", 0, static_cast<double>(one->law.ghosts + one->law.ramps),
                 "voxels");
    part.at_most(name + ".parts_differ", 0, one->same_parts() ? 0 : 1, "");
    part.at_most(name + ".printed", kPrinted, one->printed_off(), "");
    part.at_most(name + ".volume", subject.thick ? kThick : kThin, std::abs(one->volume_off()), "");
    table.rows.push_back(
        {subject.name, fmt::format("{:.3g}", one->voxel_mm), fmt::format("{}", one->law.parts),
         fmt::format("{:.0f}", one->law.mesh_mm3), fmt::format("{:.0f}", one->law.scan_mm3),
         fmt::format("{:.3f}", one->law.mesh_mm3 / one->law.scan_mm3)});
  }
  part.table(std::move(table));
}

void scans(const Verify& verify, VerifyReport::Part& part) {
  shapes(verify, part);
  smooth_ball(part);
  real(verify, part);
}

const VerifyPart part{
    85, "scans", "The bone of a scan",
    "Is the bone that burr makes of a scan the scan's bone: none where nothing is, none "
    "lost, the same parts in the count, the choice and the mesh, and the volume of "
    "marching cubes at the same level?",
    scans};

}  // namespace
}  // namespace burr::app

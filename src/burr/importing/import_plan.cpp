#include "burr/importing/import_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "burr/importing/cut_off.h"
#include "burr/importing/grey.h"
#include "burr/importing/scan_notes.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

// Between the soft tissues (up to about 100 HU, 200 with contrast medium) and thin or porous bone:
// half-way from muscle (50) to the 550 HU that a one-voxel lamella still shows.
constexpr double kBoneHu = 300;

std::size_t product(const Ijk& n) {
  return static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) *
         static_cast<std::size_t>(n.z());
}

Status set_region(const io::Scan& scan, const scenario::BoneRecipe& recipe, ImportSummary& out) {
  out.roi_from = {0, 0, 0};
  out.roi_size = scan.size;
  if (!recipe.region) return fine();
  const std::array<std::array<int, 2>, 3> box = {recipe.region->i, recipe.region->j,
                                                 recipe.region->k};
  constexpr const char* kAxes = "ijk";
  for (int a = 0; a < 3; ++a) {
    const auto& range = box[static_cast<std::size_t>(a)];
    if (range[0] < 0 || range[1] >= scan.size[a] || range[0] > range[1])
      return error(Trouble::usage,
                   fmt::format("`region`: {} {}..{} is outside 0..{}; choose a smaller region",
                               kAxes[a], range[0], range[1], scan.size[a] - 1));
    out.roi_from[a] = range[0];
    out.roi_size[a] = range[1] - range[0] + 1;
  }
  if (scan.k_reversed) out.roi_from.z() = scan.size.z() - 1 - box[2][1];
  return fine();
}

// Sets the cubic voxels: as wide as the finest axis, or as requested, or wider to keep to the
// memory budget.
Status set_voxels(const io::Scan& scan, const scenario::BoneRecipe& recipe, Plan& plan) {
  ImportSummary& out = plan.summary;
  const Vec3 spacing = scan.spacing_mm;
  const bool labels = out.labels;
  double voxel = spacing.minCoeff();
  const auto size_at = [&](double edge) {
    Ijk size;
    for (int a = 0; a < 3; ++a)
      size[a] = static_cast<int>(std::floor((out.roi_size[a] - 1) * spacing[a] / edge + 1e-6)) + 1;
    return size;
  };
  const auto memory_mb = [&](double edge) {
    double voxels = 1;
    for (int a = 0; a < 3; ++a)
      voxels *= std::floor((out.roi_size[a] - 1) * spacing[a] / edge + 1e-6) + 1;
    // while working: 2 bytes a voxel twice (grey), then 3 or 5 bytes where there is bone (assumed
    // to be two thirds)
    const double each = labels ? 2 + 2.0 : 4 + 3.4;
    return voxels * each / 1048576.0 +
           static_cast<double>(recipe.reserve_bricks) * 2560 / 1048576.0;
  };
  if (recipe.voxel_mm != 0) {
    if (!(recipe.voxel_mm >= 0.005 && recipe.voxel_mm <= 20))
      return error(Trouble::usage,
                   fmt::format("`voxel_mm`: {} is out of range; use 0.005 to 20", recipe.voxel_mm));
    voxel = recipe.voxel_mm;
    // nearly cubic and wanted as it is: an axis off by less than a third of a voxel in all stays
  } else {
    const double finest = voxel;
    while (memory_mb(voxel) > recipe.memory_mb) voxel *= 1.02;
    if (voxel > finest)
      out.notices.push_back(fmt::format(
          "Voxels of {:.3g} mm would need {:.0f} MB, more than the memory budget of {:.0f} MB: "
          "voxels of {:.3g} mm are used instead; crop with `region` or give `voxel_mm`.",
          finest, memory_mb(finest), recipe.memory_mb, voxel));
  }
  double voxels = 1;
  for (int a = 0; a < 3; ++a)
    voxels *= std::floor((out.roi_size[a] - 1) * spacing[a] / voxel + 1e-6) + 1;
  if (voxels > 1.6e9)
    return error(Trouble::usage,
                 fmt::format("voxels of {:.3g} mm make {:.1f} billion voxels, more than 1.6 "
                             "billion; use a larger `voxel_mm` or a smaller `region`",
                             voxel, voxels / 1e9));

  // a grid that is cubic but for rounding in its header is not resampled
  const double mean = spacing.mean();
  bool nearly = recipe.voxel_mm == 0 || std::abs(recipe.voxel_mm - mean) < 0.002 * mean;
  for (int a = 0; a < 3; ++a)
    nearly = nearly && std::abs(spacing[a] - mean) / mean * out.roi_size[a] < 0.6;
  if (nearly && voxel < 1.002 * mean) {
    out.voxel_mm = mean;
    out.size = out.roi_size;
    plan.scale = Vec3::Ones();
    plan.first = Vec3::Zero();
    if ((spacing.array() - mean).abs().maxCoeff() / mean > 1e-4)
      out.notices.push_back(
          fmt::format("The voxels are cubic to within {:.1g}: cubes of {:.6g} mm are used.",
                      (spacing.array() - mean).abs().maxCoeff() / mean, mean));
  } else {
    out.voxel_mm = voxel;
    out.size = size_at(voxel);
    for (int a = 0; a < 3; ++a) {
      plan.scale[a] = voxel / spacing[a];
      if (std::abs(plan.scale[a] - 1) < 1e-9) plan.scale[a] = 1;
      // both ends share the remainder
      plan.first[a] = plan.scale[a] == 1
                          ? 0
                          : 0.5 * ((out.roi_size[a] - 1) - (out.size[a] - 1) * plan.scale[a]);
    }
  }
  out.memory_mb = memory_mb(out.voxel_mm);
  return fine();
}

// Questions of the reader that the recipe leaves open; what it answers becomes a notice.
Status answer(const io::Scan& scan, const scenario::BoneRecipe& recipe, ImportSummary& out) {
  for (const io::Question& question : scan.questions) {
    const bool is_answered = answered(question, recipe);
    switch (question.ask) {
      case io::Ask::missing:
      case io::Ask::absent:
        if (!is_answered)
          return error(question.text +
                       "; copy the files again, or go on without these slices with "
                       "`allow_missing`");
        out.notices.push_back(question.text + "; used all the same (`allow_missing`).");
        break;
      case io::Ask::spacing:
        if (!is_answered)
          return error(question.text + "; give the size of a voxel with `spacing_mm` X,Y,Z");
        break;
      case io::Ask::doubt:
        if (!is_answered) return error(question.text + "; to use it all the same, give `as_it_is`");
        out.notices.push_back(question.text + "; used all the same (`as_it_is`).");
        break;
      case io::Ask::volume:
        if (!is_answered) return error(question.text + "; choose it by its number with `series`");
        break;
    }
  }
  return fine();
}

// What the file says.
ImportSummary summary_of(const io::Scan& scan) {
  ImportSummary out;
  out.format = scan.format;
  out.modality = scan.modality;
  out.scan_size = scan.size;
  out.spacing_mm = scan.spacing_mm;
  out.axes = scan.axes;
  out.origin_mm = scan.origin_mm;
  out.labels = scan.values.empty();
  out.hounsfield = scan.hounsfield;
  out.notices = scan.notices;
  return out;
}

// What the region cannot show. solid(voxel): whether that voxel of the scan is bone.
template <class Solid>
void say_notes(const io::Scan& scan, ImportSummary& out, const Solid& solid) {
  const auto nx = static_cast<std::size_t>(scan.size.x()),
             ny = static_cast<std::size_t>(scan.size.y());
  const auto notes = scan_notes(
      scan, {out.roi_from, out.roi_size, out.roi_size == scan.size}, [&](int i, int j, int k) {
        return solid(static_cast<std::size_t>(i) +
                     nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k)));
      });
  out.notices.insert(out.notices.end(), notes.begin(), notes.end());
}

Status plan_labels(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                   const Materials& materials, Plan& plan) {
  ImportSummary& out = plan.summary;
  plan.counts = count_labels({scan.labels.data(), scan.size, out.roi_from}, out.roi_size);
  std::array<bool, 256> present{};
  for (std::size_t v = 1; v < 256; ++v) present[v] = plan.counts[v] > 0;
  auto labels = label_tissues(scan, present, recipe.labels, materials);
  if (!labels) return labels.error();
  plan.labels = std::move(*labels);
  out.notices.insert(out.notices.end(), plan.labels.notices.begin(), plan.labels.notices.end());
  const double each = scan.spacing_mm.prod();
  bool any_solid = false;
  for (std::size_t v = 1; v < 256; ++v) {
    const volume::TissueId id = plan.labels.of_label[v];
    if (id == 0) continue;
    const volume::Tissue& tissue = plan.labels.table[id];
    any_solid = any_solid || tissue.kind == volume::TissueKind::solid;
    out.tissues.push_back({id, tissue, plan.counts[v], static_cast<double>(plan.counts[v]) * each,
                           plan.labels.assumed[v]});
  }
  const auto solid = solid_labels(plan);
  say_notes(scan, out, [&scan, &solid](std::size_t voxel) { return solid[scan.labels[voxel]]; });
  if (!any_solid)
    return error(
        "no label is solid, so there is nothing to mill; mark the solid labels with `labels`");
  return fine();
}

// Sets the lowest and the highest value of the region.
void set_range(const io::Scan& scan, ImportSummary& out) {
  out.low = std::numeric_limits<float>::infinity();
  out.high = -out.low;
  for (int k = 0; k < out.roi_size.z(); ++k)
    for (int j = 0; j < out.roi_size.y(); ++j) {
      const auto row =
          scan.values.begin() +
          static_cast<std::ptrdiff_t>(static_cast<std::size_t>(out.roi_from.x()) +
                                      static_cast<std::size_t>(scan.size.x()) *
                                          (static_cast<std::size_t>(out.roi_from.y() + j) +
                                           static_cast<std::size_t>(scan.size.y()) *
                                               static_cast<std::size_t>(out.roi_from.z() + k)));
      for (int i = 0; i < out.roi_size.x(); ++i) {
        if (row[i] == scan.outside) continue;
        out.low = std::min(out.low, row[i]);
        out.high = std::max(out.high, row[i]);
      }
    }
}

// Estimates where bone begins in values that are not HU; false: they show one material only.
bool estimate_iso(const io::Scan& scan, bool check_scan, ImportSummary& out) {
  const BoneLevel estimate = estimate_bone_level(scan, out.roi_from, out.roi_size, check_scan);
  if (!estimate.found) return false;
  out.iso = estimate.level;
  out.iso_estimated = true;
  out.iso_sure = estimate.sure;
  out.iso_why = estimate.why;
  out.notices.push_back(fmt::format(
      "The values are not HU: the surface level {:.4g} is an estimate (how sure: {}): {}; "
      "give another level with `iso`.",
      out.iso, word_of(out.iso_sure), out.iso_why));
  return true;
}

// Says where the values of a scan in HU were cut off. Error: below the level of bone.
Status say_cut_off(const io::Scan& scan, const scenario::BoneRecipe& recipe, ImportSummary& out) {
  const CutOff cut = find_cut_off(
      io::sample_values(scan.values.data(), scan.size, out.roi_from, out.roi_size, scan.outside));
  constexpr double kAir = -900, kDense = 2000;  // [HU] scanners themselves end beyond these
  const bool low = cut.low && cut.low_value > kAir, high = cut.high && cut.high_value < kDense;
  if (!low && !high) return fine();
  if (high && cut.high_value <= kBoneHu && !recipe.iso && !recipe.as_it_is)
    return error(fmt::format(
        "the values were cut off below bone, as by the window of a viewer ({}), and bone begins at "
        "{:.0f} HU; export the scan again without a window, or give a level with `iso`",
        piles_text(cut), kBoneHu));
  out.notices.push_back(
      fmt::format("The values were cut off, as by the window of a viewer: {}.", piles_text(cut)));
  return fine();
}

// Sets the surface level: as requested, or that of bone in HU, or an estimate, or Otsu's threshold.
Status set_iso(const io::Scan& scan, const scenario::BoneRecipe& recipe, ImportSummary& out) {
  if (recipe.check_scan && scan.hounsfield)
    if (Status status = say_cut_off(scan, recipe, out); !status) return status;
  if (recipe.iso) {
    out.iso = *recipe.iso;
  } else if (scan.hounsfield && kBoneHu < double{out.high}) {
    out.iso = kBoneHu;
  } else if (scan.hounsfield || !recipe.check_values ||
             !estimate_iso(scan, recipe.check_scan, out)) {
    out.iso = otsu(scan, out.roi_from, out.roi_size);
    out.iso_by_otsu = true;
    out.notices.push_back(
        scan.hounsfield ? fmt::format("No voxel reaches {:.0f} HU: Otsu's threshold {:.4g} is used "
                                      "as surface level; see `iso`.",
                                      kBoneHu, out.iso)
                        : fmt::format("The values are not HU: Otsu's threshold {:.4g} between dark "
                                      "and bright is used as surface level; see `iso`.",
                                      out.iso));
  }
  if (!(out.iso > double{out.low} && out.iso <= double{out.high}))
    return error(
        fmt::format("the surface level {:.4g} is outside the range of values, {:.4g} to {:.4g}, so "
                    "there is no bone; choose another level with `iso`",
                    out.iso, out.low, out.high));
  return fine();
}

// Sets the smoothing: as requested, or by the noise of the scan.
void set_smooth(const io::Scan& scan, const scenario::BoneRecipe& recipe, ImportSummary& out) {
  if (recipe.smooth >= 0) {
    out.smooth = recipe.smooth;
    return;
  }
  const double noise = measure_noise(scan, out.roi_from, out.roi_size, out.iso);
  // Noise below half a percent of the step from air to bone cannot be felt; more than a tenth is
  // structure.
  const double step = 2 * (out.iso - double{out.low});
  out.smooth = noise < 0.003 * step ? 0.0 : std::min(noise, 0.1 * step);
  if (out.smooth > 0)
    out.notices.push_back(
        fmt::format("Noise of {:.3g} {} is smoothed out along the surface; see `smooth`.",
                    out.smooth, scan.hounsfield ? "HU" : "(the file's unit)"));
}

Status plan_grey(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                 const Materials& materials, Plan& plan) {
  ImportSummary& out = plan.summary;
  std::error_code trouble;
  if (std::filesystem::is_directory(recipe.labels, trouble))
    out.notices.emplace_back(
        "`labels` is a folder and no table of labels, so it was ignored; to use the masks in it, "
        "give that folder in place of the scan.");
  else if (!recipe.labels.empty())
    out.notices.emplace_back(
        "`labels` is a table of labels, but this scan has grey values; the table was ignored.");
  set_range(scan, out);
  if (Status status = set_iso(scan, recipe, out); !status) return status;
  say_notes(scan, out, [&scan, iso = static_cast<float>(out.iso)](std::size_t voxel) {
    return scan.values[voxel] >= iso;
  });
  set_smooth(scan, recipe, out);
  if (scan.hounsfield) plan.grey_tissues = hu_tissues(materials);
  auto& tissues = plan.grey_tissues.tissues;
  if (!scan.hounsfield) materials.apply_material(tissues[1]);
  for (std::size_t id = 1; id < tissues.size(); ++id)
    out.tissues.push_back({static_cast<volume::TissueId>(id), tissues[id], 0, 0});
  return fine();
}

}  // namespace

std::array<std::int64_t, 256> count_labels(const LabelRegion& region, const Ijk& size) {
  std::array<std::int64_t, 256> counts{};
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const std::uint8_t* row = region.row(j, k);
      for (int i = 0; i < size.x(); ++i) ++counts[row[i]];
    }
  return counts;
}

Result<Materials> materials_of(const scenario::BoneRecipe& recipe) {
  if (recipe.materials.empty()) return built_in_materials();
  return read_materials(recipe.materials);
}

std::array<bool, 256> solid_labels(const Plan& plan) {
  std::array<bool, 256> solid{};
  for (std::size_t v = 1; v < 256; ++v) {
    const volume::TissueId id = plan.labels.of_label[v];
    solid[v] = id != 0 && plan.labels.table[id].kind == volume::TissueKind::solid;
  }
  return solid;
}

Result<Plan> make_plan(const io::Scan& scan, const scenario::BoneRecipe& recipe) {
  if (scan.values.empty() == scan.labels.empty() ||
      std::max(scan.values.size(), scan.labels.size()) != product(scan.size))
    return error(Trouble::internal, "a scan needs values or labels, one for each voxel");
  const auto materials = materials_of(recipe);
  if (!materials) return materials.error();
  Plan plan;
  ImportSummary& out = plan.summary;
  out = summary_of(scan);
  if (Status answered = answer(scan, recipe, out); !answered) return answered.error();
  if (Status status = set_region(scan, recipe, out); !status) return status.error();
  if (out.roi_size.minCoeff() < 2)
    return error(
        fmt::format("{} x {} x {} voxels are not a volume; give the folder of the whole series",
                    out.roi_size.x(), out.roi_size.y(), out.roi_size.z()));
  if (Status status = set_voxels(scan, recipe, plan); !status) return status.error();
  if (Status status = out.labels ? plan_labels(scan, recipe, *materials, plan)
                                 : plan_grey(scan, recipe, *materials, plan);
      !status)
    return status.error();
  return plan;
}

}  // namespace burr::importing

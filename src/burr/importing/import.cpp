#include "burr/importing/import.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <span>

#include "burr/importing/cut_off.h"
#include "burr/importing/grey.h"
#include "burr/importing/keep_greys.h"
#include "burr/importing/materials.h"
#include "burr/importing/parts.h"
#include "burr/importing/scan_notes.h"
#include "burr/importing/surface_field.h"
#include "burr/importing/tissues.h"
#include "burr/io/workers.h"
#include "burr/volume/volume_of.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

// Between the soft tissues (up to about 100 HU, 200 with contrast medium) and thin or porous bone:
// half-way from muscle (50) to the 550 HU that a one-voxel lamella still shows.
constexpr double kBoneHu = 300;

struct Plan {
  ImportSummary summary;
  LabelTissues labels;
  volume::TissueTable grey_tissues;
  std::array<std::int64_t, 256> counts{};
  Vec3 scale = Vec3::Ones();  // size of a new voxel, in old voxels
  Vec3 first = Vec3::Zero();  // centre of the first new voxel, in old voxels of the region
};

std::size_t product(const Ijk& n) {
  return static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) *
         static_cast<std::size_t>(n.z());
}

Status set_region(const io::Scan& scan, const scenario::Recipe& recipe, ImportSummary& out) {
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
                   fmt::format("--roi: {} {}..{} is outside 0..{}; choose a smaller region",
                               kAxes[a], range[0], range[1], scan.size[a] - 1));
    out.roi_from[a] = range[0];
    out.roi_size[a] = range[1] - range[0] + 1;
  }
  if (scan.k_reversed) out.roi_from.z() = scan.size.z() - 1 - box[2][1];
  return fine();
}

// Sets the cubic voxels: as wide as the finest axis, or as requested, or wider to keep to the
// memory budget.
Status set_voxels(const io::Scan& scan, const scenario::Recipe& recipe, Plan& plan) {
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
                   fmt::format("--voxel-mm: {} is out of range; use 0.005 to 20", recipe.voxel_mm));
    voxel = recipe.voxel_mm;
    // nearly cubic and wanted as it is: an axis off by less than a third of a voxel in all stays
  } else {
    const double finest = voxel;
    while (memory_mb(voxel) > recipe.memory_mb) voxel *= 1.02;
    if (voxel > finest)
      out.notices.push_back(fmt::format(
          "Voxels of {:.3g} mm would need {:.0f} MB, more than the memory budget of {:.0f} MB: "
          "voxels of {:.3g} mm are used instead; crop with --roi or give --voxel-mm.",
          finest, memory_mb(finest), recipe.memory_mb, voxel));
  }
  double voxels = 1;
  for (int a = 0; a < 3; ++a)
    voxels *= std::floor((out.roi_size[a] - 1) * spacing[a] / voxel + 1e-6) + 1;
  if (voxels > 1.6e9)
    return error(Trouble::usage,
                 fmt::format("voxels of {:.3g} mm make {:.1f} billion voxels, more than 1.6 "
                             "billion; use a larger --voxel-mm or a smaller --roi",
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

// The labels of the region: those of the scan, or a copy without the parts that were removed.
struct LabelRegion {
  const std::uint8_t* labels = nullptr;  // of a box of `size` voxels (x fastest)
  Ijk size = {0, 0, 0}, from = {0, 0, 0};
  std::vector<std::uint8_t> own;  // the copy; empty: there is none
  [[nodiscard]] const std::uint8_t* row(int j, int k) const {
    return labels + static_cast<std::size_t>(from.x()) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(from.y() + j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(from.z() + k));
  }
};

std::array<std::int64_t, 256> count_labels(const LabelRegion& region, const Ijk& size) {
  std::array<std::int64_t, 256> counts{};
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const std::uint8_t* row = region.row(j, k);
      for (int i = 0; i < size.x(); ++i) ++counts[row[i]];
    }
  return counts;
}

Result<Materials> materials_of(const scenario::Recipe& recipe) {
  if (recipe.materials.empty()) return built_in_materials();
  return read_materials(recipe.materials);
}

// Questions of the reader that the recipe leaves open; what it answers becomes a notice.
Status answer(const io::Scan& scan, const scenario::Recipe& recipe, ImportSummary& out) {
  for (const io::Question& question : scan.questions) {
    const bool is_answered = answered(question, recipe);
    switch (question.ask) {
      case io::Ask::missing:
      case io::Ask::absent:
        if (!is_answered)
          return error(question.text +
                       "; copy the files again, or go on without these slices with "
                       "--allow-missing");
        out.notices.push_back(question.text + "; used all the same (--allow-missing).");
        break;
      case io::Ask::spacing:
        if (!is_answered)
          return error(question.text + "; give the size of a voxel with --spacing-mm X,Y,Z");
        break;
      case io::Ask::doubt:
        if (!is_answered) return error(question.text + "; to use it all the same, give --as-it-is");
        out.notices.push_back(question.text + "; used all the same (--as-it-is).");
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

std::array<bool, 256> solid_labels(const Plan& plan) {
  std::array<bool, 256> solid{};
  for (std::size_t v = 1; v < 256; ++v) {
    const volume::TissueId id = plan.labels.of_label[v];
    solid[v] = id != 0 && plan.labels.table[id].kind == volume::TissueKind::solid;
  }
  return solid;
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

Status plan_labels(const io::Scan& scan, const scenario::Recipe& recipe, const Materials& materials,
                   Plan& plan) {
  ImportSummary& out = plan.summary;
  plan.counts = count_labels({scan.labels.data(), scan.size, out.roi_from, {}}, out.roi_size);
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
        "no label is solid, so there is nothing to mill; mark the solid labels with --tissues");
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
      "give another level with --iso.",
      out.iso, word_of(out.iso_sure), out.iso_why));
  return true;
}

// Says where the values of a scan in HU were cut off. Error: below the level of bone.
Status say_cut_off(const io::Scan& scan, const scenario::Recipe& recipe, ImportSummary& out) {
  const CutOff cut = find_cut_off(
      io::sample_values(scan.values.data(), scan.size, out.roi_from, out.roi_size, scan.outside));
  constexpr double kAir = -900, kDense = 2000;  // [HU] scanners themselves end beyond these
  const bool low = cut.low && cut.low_value > kAir, high = cut.high && cut.high_value < kDense;
  if (!low && !high) return fine();
  if (high && cut.high_value <= kBoneHu && !recipe.iso && !recipe.as_it_is)
    return error(fmt::format(
        "the values were cut off below bone, as by the window of a viewer ({}), and bone begins at "
        "{:.0f} HU; export the scan again without a window, or give a level with --iso",
        piles_text(cut), kBoneHu));
  out.notices.push_back(
      fmt::format("The values were cut off, as by the window of a viewer: {}.", piles_text(cut)));
  return fine();
}

// Sets the surface level: as requested, or that of bone in HU, or an estimate, or Otsu's threshold.
Status set_iso(const io::Scan& scan, const scenario::Recipe& recipe, ImportSummary& out) {
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
                                      "as surface level; see --iso.",
                                      kBoneHu, out.iso)
                        : fmt::format("The values are not HU: Otsu's threshold {:.4g} between dark "
                                      "and bright is used as surface level; see --iso.",
                                      out.iso));
  }
  if (!(out.iso > double{out.low} && out.iso <= double{out.high}))
    return error(
        fmt::format("the surface level {:.4g} is outside the range of values, {:.4g} to {:.4g}, so "
                    "there is no bone; choose another level with --iso",
                    out.iso, out.low, out.high));
  return fine();
}

// Sets the smoothing: as requested, or by the noise of the scan.
void set_smooth(const io::Scan& scan, const scenario::Recipe& recipe, ImportSummary& out) {
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
        fmt::format("Noise of {:.3g} {} is smoothed out along the surface; see --smooth.",
                    out.smooth, scan.hounsfield ? "HU" : "(the file's unit)"));
}

Status plan_grey(const io::Scan& scan, const scenario::Recipe& recipe, const Materials& materials,
                 Plan& plan) {
  ImportSummary& out = plan.summary;
  if (!recipe.labels.empty())
    out.notices.emplace_back(
        "--tissues is a table of labels, but this scan has grey values; the table was ignored.");
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

Result<Plan> make_plan(const io::Scan& scan, const scenario::Recipe& recipe) {
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

// The bone's grid: the cubic voxels, and the layers of air around them.
volume::Grid grid_of(const io::Scan& scan, const Plan& plan, const InsideGrid& inside) {
  const ImportSummary& out = plan.summary;
  volume::Grid grid;
  grid.size = out.size + 2 * inside.margin;
  grid.voxel = out.voxel_mm * 1e-3;
  // the middle of the region keeps its place
  const Vec3 middle_old =
      out.roi_from.cast<double>() + 0.5 * (out.roi_size - Ijk::Ones()).cast<double>();
  const Vec3 middle_mm = scan.origin_mm + scan.axes * middle_old.cwiseProduct(scan.spacing_mm);
  const Vec3 half_mm = 0.5 * (grid.size - Ijk::Ones()).cast<double>() * out.voxel_mm;
  grid.frame.q = math::Quat(Eigen::Quaterniond(scan.axes).normalized());
  grid.frame.p = 1e-3 * (middle_mm - scan.axes * half_mm);
  return grid;
}

// Labels on the cubic grid: the solid share of each new voxel, and its label.
struct CubicLabels {
  std::vector<std::uint8_t> labels, share;
};

bool resample_labels(const LabelRegion& region, const Plan& plan,
                     const std::array<bool, 256>& solid, CubicLabels& out, Progress& progress) {
  const ImportSummary& s = plan.summary;
  const std::size_t nx = static_cast<std::size_t>(s.size.x()),
                    ny = static_cast<std::size_t>(s.size.y());
  out.labels.resize(product(s.size));
  const bool same = plan.scale.isOnes(0);
  if (!same) out.share.resize(product(s.size));
  struct Taps {
    int first = 0;
    std::vector<float> weights;
  };
  // tent weights: linear between voxels, wider where the new grid is coarser
  std::array<std::vector<Taps>, 3> taps;
  for (int a = 0; a < 3; ++a) {
    const double wide = std::max(1.0, plan.scale[a]);
    for (int n = 0; n < s.size[a]; ++n) {
      const double at = plan.first[a] + n * plan.scale[a];
      const int lo = std::clamp(static_cast<int>(std::floor(at - wide)) + 1, 0, s.roi_size[a] - 1),
                hi = std::clamp(static_cast<int>(std::ceil(at + wide)) - 1, lo, s.roi_size[a] - 1);
      Taps tap{lo, {}};
      double total = 0;
      for (int v = lo; v <= hi; ++v) total += std::max(0.0, 1 - std::abs(v - at) / wide);
      for (int v = lo; v <= hi; ++v)
        tap.weights.push_back(static_cast<float>(
            total > 0 ? std::max(0.0, 1 - std::abs(v - at) / wide) / total : 1.0));
      taps[static_cast<std::size_t>(a)].push_back(std::move(tap));
    }
  }
  return io::in_pieces(s.size.z(), progress, "making voxels cubic", [&](int z) {
    const auto k = static_cast<std::size_t>(z);
    std::array<float, 256> weight{};
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) {
        const Taps &tx = taps[0][i], &ty = taps[1][j], &tz = taps[2][k];
        std::array<std::uint8_t, 64> met{};
        std::size_t different = 0;
        float bone = 0;
        for (std::size_t c = 0; c < tz.weights.size(); ++c)
          for (std::size_t b = 0; b < ty.weights.size(); ++b) {
            const float w_row = tz.weights[c] * ty.weights[b];
            const std::uint8_t* row =
                region.row(ty.first + static_cast<int>(b), tz.first + static_cast<int>(c)) +
                tx.first;
            for (std::size_t a = 0; a < tx.weights.size(); ++a) {
              const std::uint8_t label = row[a];
              const float w = w_row * tx.weights[a];
              if (w == 0) continue;
              if (weight[label] == 0 && different < met.size()) met[different++] = label;
              weight[label] += w;
              if (solid[label]) bone += w;
            }
          }
        const std::size_t v = i + nx * (j + ny * k);
        const bool is_solid = bone >= 0.5F;
        float most = -1;
        for (std::size_t d = 0; d < different; ++d) {
          const std::uint8_t label = met[d];
          if (solid[label] == is_solid &&
              (weight[label] > most || (weight[label] == most && label > out.labels[v]))) {
            most = weight[label];
            out.labels[v] = label;
          }
        }
        for (std::size_t d = 0; d < different; ++d) weight[met[d]] = 0;
        if (!same)
          out.share[v] = static_cast<std::uint8_t>(
              std::clamp(std::lround(bone * 255.0F), is_solid ? 128L : 0L, is_solid ? 255L : 127L));
      }
  });
}

// Says in the summary what is removed.
Result<ChosenParts> choose(const FoundParts& found, const scenario::Recipe& recipe,
                           ImportSummary& out) {
  auto chosen = choose_parts(found.parts, recipe, found.place);
  if (!chosen) return chosen.error();
  out.parts = chosen->found;
  out.notices.insert(out.notices.end(), chosen->notices.begin(), chosen->notices.end());
  return chosen;
}

Result<FoundParts> found_or_stopped(std::optional<Parts> parts, const Place& place) {
  if (!parts) return error(Trouble::interrupted, "the import was stopped");
  return FoundParts{std::move(*parts), place};
}

bool keeps_all(const scenario::Recipe& recipe) {
  return recipe.keep.all() && recipe.drop_islands_mm3 <= 0;
}

Result<FoundParts> label_parts(const io::Scan& scan, const LabelRegion& region,
                               const std::array<bool, 256>& solid, const ImportSummary& out,
                               Progress& progress) {
  const auto row = [&](int j, int k, std::span<std::uint8_t> inside) {
    const std::uint8_t* labels = region.row(j, k);
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = solid[labels[i]] ? 1 : 0;
  };
  const Place place{
      scan.origin_mm + scan.axes * out.roi_from.cast<double>().cwiseProduct(scan.spacing_mm),
      scan.spacing_mm, scan.axes};
  return found_or_stopped(find_parts(out.roi_size, row, progress), place);
}

// Replaces the region by a copy without the parts that the recipe does not keep.
Status remove_label_parts(const io::Scan& scan, const scenario::Recipe& recipe,
                          const std::array<bool, 256>& solid, Plan& plan, LabelRegion& region,
                          Progress& progress) {
  ImportSummary& out = plan.summary;
  const auto found = label_parts(scan, region, solid, out, progress);
  if (!found) return found.error();
  const auto chosen = choose(*found, recipe, out);
  if (!chosen) return chosen.error();
  if (!chosen->removes()) return fine();
  std::vector<std::uint8_t> own;
  own.reserve(product(out.roi_size));
  for (int k = 0; k < out.roi_size.z(); ++k)
    for (int j = 0; j < out.roi_size.y(); ++j) {
      const std::uint8_t* row = region.row(j, k);
      own.insert(own.end(), row, row + out.roi_size.x());
    }
  remove_labels(found->parts, chosen->kept, own);
  region.own = std::move(own);
  region.labels = region.own.data();
  region.size = out.roi_size;
  region.from = {0, 0, 0};
  // the volumes that are restored are those of what is left
  plan.counts = count_labels(region, out.roi_size);
  for (TissueFound& one : out.tissues) {
    one.voxels = plan.counts[static_cast<std::size_t>(one.tissue.label)];
    one.volume_mm3 = static_cast<double>(one.voxels) * scan.spacing_mm.prod();
  }
  return fine();
}

Result<Imported> import_labels(const io::Scan& scan, const scenario::Recipe& recipe, Plan plan,
                               Progress& progress) {
  InsideGrid inside;
  inside.size = plan.summary.size;
  inside.tissue = plan.labels.of_label;
  inside.solid = solid_labels(plan);
  LabelRegion region{scan.labels.data(), scan.size, plan.summary.roi_from, {}};
  if (!keeps_all(recipe)) {
    const Status status = remove_label_parts(scan, recipe, inside.solid, plan, region, progress);
    if (!status) return status.error();
  }
  std::vector<double> wanted(plan.labels.table.tissues.size(), -1.0);
  const double old_voxel = scan.spacing_mm.prod(), new_voxel = std::pow(plan.summary.voxel_mm, 3);
  for (std::size_t v = 1; v < 256; ++v)
    if (inside.solid[v])
      wanted[plan.labels.of_label[v]] = static_cast<double>(plan.counts[v]) * old_voxel / new_voxel;
  // the whole scan on its own grid is read without a copy
  CubicLabels cubic;
  const bool in_place = plan.scale.isOnes(0) && plan.summary.roi_size == region.size;
  if (!in_place) {
    if (!resample_labels(region, plan, inside.solid, cubic, progress))
      return error(Trouble::interrupted, "the import was stopped");
    inside.labels = cubic.labels.data();
    inside.share = cubic.share.empty() ? nullptr : cubic.share.data();
  } else {
    inside.labels = region.labels;
  }
  // a nearly cubic grid is taken as cubic: voxels are counted, rounding is ignored
  if (in_place && plan.summary.roi_size == scan.size)
    for (double& voxels : wanted) voxels *= new_voxel / old_voxel;
  Imported made;
  if (recipe.margin) leave_margins(inside);
  made.bone = bone_from_inside(grid_of(scan, plan, inside), std::move(plan.labels.table), inside,
                               {}, recipe.reserve_bricks, progress);
  if (made.bone == nullptr) return error(Trouble::interrupted, "the import was stopped");
  restore_tissue_volumes(*made.bone, wanted);
  made.summary = std::move(plan.summary);
  return made;
}

// The region of a grey scan, smoothed and on the cubic grid. None: cancelled.
std::optional<Grey> cubic_grey(const io::Scan& scan, const Plan& plan, Progress& progress) {
  const ImportSummary& out = plan.summary;
  Grey grey = take_grey(scan, out.roi_from, out.roi_size);
  if (out.smooth > 0 &&
      !smooth_near(grey, grey.stored(out.iso), out.smooth / grey.step, scan.spacing_mm, progress))
    return std::nullopt;
  if (!resample(grey, out.size, plan.scale, plan.first, progress)) return std::nullopt;
  return grey;
}

Result<FoundParts> grey_parts(const io::Scan& scan, const Grey& grey, const Plan& plan,
                              Progress& progress) {
  const ImportSummary& out = plan.summary;
  const auto iso = static_cast<float>(grey.stored(out.iso));
  const auto nx = static_cast<std::size_t>(out.size.x()),
             ny = static_cast<std::size_t>(out.size.y());
  const auto row = [&](int j, int k, std::span<std::uint8_t> inside) {
    const std::int16_t* values =
        grey.voxels.data() + nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k));
    for (std::size_t i = 0; i < nx; ++i) inside[i] = static_cast<float>(values[i]) >= iso ? 1 : 0;
  };
  const Vec3 first = out.roi_from.cast<double>() + plan.first;
  const Place place{scan.origin_mm + scan.axes * first.cwiseProduct(scan.spacing_mm),
                    plan.scale.cwiseProduct(scan.spacing_mm), scan.axes};
  return found_or_stopped(find_parts(out.size, row, progress), place);
}

Result<Imported> import_grey(const io::Scan& scan, const scenario::Recipe& recipe, Plan plan,
                             bool with_greys, Progress& progress) {
  ImportSummary& out = plan.summary;
  const auto stopped = [] { return error(Trouble::interrupted, "the import was stopped"); };
  std::optional<Grey> cubic = cubic_grey(scan, plan, progress);
  if (!cubic) return stopped();
  Grey& grey = *cubic;
  if (!keeps_all(recipe)) {
    const auto found = grey_parts(scan, grey, plan, progress);
    if (!found) return found.error();
    const auto chosen = choose(*found, recipe, out);
    if (!chosen) return chosen.error();
    if (chosen->removes()) remove_grey(found->parts, chosen->kept, grey.voxels);
  }

  InsideGrid inside;
  inside.size = out.size;
  inside.grey = grey.voxels.data();
  inside.iso = static_cast<float>(grey.stored(out.iso));
  // noise that the filter leaves is averaged over neighbouring points of the surface
  inside.soft = out.smooth > 0 ? 4.0F : 1.0F;
  const GreyTissue rule{grey.step, grey.zero, scan.hounsfield};
  Imported made;
  if (recipe.margin) leave_margins(inside);
  made.bone = bone_from_inside(grid_of(scan, plan, inside), std::move(plan.grey_tissues), inside,
                               rule, recipe.reserve_bricks, progress);
  if (made.bone == nullptr) return stopped();
  if (with_greys) {
    made.greys = keep_greys(scan, out.iso, progress);
    if (made.greys == nullptr) return stopped();
  }
  made.summary = std::move(out);
  return made;
}

}  // namespace

bool answered(const io::Question& question, const scenario::Recipe& recipe) {
  switch (question.ask) {
    case io::Ask::missing:
    case io::Ask::absent:
      return recipe.allow_missing;
    case io::Ask::spacing:
      return (recipe.spacing_mm.array() > 0).all();
    case io::Ask::doubt:
      return recipe.as_it_is;
  }
  return false;
}

Result<ImportSummary> plan_import(const io::Scan& scan, const scenario::Recipe& recipe) {
  auto plan = make_plan(scan, recipe);
  if (!plan) return plan.error();
  return std::move(plan->summary);
}

Result<FoundParts> parts_of(const io::Scan& scan, const scenario::Recipe& recipe,
                            Progress& progress) {
  try {
    const auto plan = make_plan(scan, recipe);
    if (!plan) return plan.error();
    if (plan->summary.labels)
      return label_parts(scan, {scan.labels.data(), scan.size, plan->summary.roi_from, {}},
                         solid_labels(*plan), plan->summary, progress);
    const std::optional<Grey> grey = cubic_grey(scan, *plan, progress);
    if (!grey) return error(Trouble::interrupted, "the import was stopped");
    return grey_parts(scan, *grey, *plan, progress);
  } catch (const std::bad_alloc&) {
    return error(
        "not enough memory to look for the parts of the bone; use a larger --voxel-mm or a "
        "smaller --roi");
  }
}

Status count_parts(const io::Scan& scan, const scenario::Recipe& recipe, Progress& progress,
                   ImportSummary& summary) {
  const auto found = parts_of(scan, recipe, progress);
  if (!found) return found.error();
  const auto chosen = choose(*found, recipe, summary);
  return chosen ? fine() : Status(chosen.error());
}

Result<std::vector<TissueFound>> labels_of(const io::Scan& scan, const scenario::Recipe& recipe) {
  std::vector<TissueFound> all;
  if (scan.labels.empty()) return all;
  const auto materials = materials_of(recipe);
  if (!materials) return materials.error();
  const std::array<std::int64_t, 256> counts =
      count_labels({scan.labels.data(), scan.size, {0, 0, 0}, {}}, scan.size);
  std::array<bool, 256> present{};
  for (std::size_t v = 1; v < 256; ++v) present[v] = counts[v] > 0;
  const auto labels = label_tissues(scan, present, recipe.labels, *materials);
  if (!labels) return labels.error();
  for (std::size_t v = 1; v < 256; ++v)
    if (const volume::TissueId id = labels->of_label[v]; id != 0)
      all.push_back({id, labels->table[id], counts[v], 0, labels->assumed[v]});
  for (const volume::Tissue& air : labels->air)
    all.push_back({0, air, counts[static_cast<std::size_t>(air.label)], 0});
  for (TissueFound& one : all)
    one.volume_mm3 = static_cast<double>(one.voxels) * scan.spacing_mm.prod();
  std::sort(all.begin(), all.end(), [](const TissueFound& a, const TissueFound& b) {
    return a.tissue.label < b.tissue.label;
  });
  return all;
}

Result<Imported> import_bone(const io::Scan& scan, const scenario::Recipe& recipe,
                             Progress& progress, bool with_greys) {
  try {
    auto plan = make_plan(scan, recipe);
    if (!plan) return plan.error();
    auto made = plan->summary.labels
                    ? import_labels(scan, recipe, std::move(*plan), progress)
                    : import_grey(scan, recipe, std::move(*plan), with_greys, progress);
    if (!made) return made;
    const volume::Bone& bone = *made->bone;
    made->summary.solid_mm3 = volume::volume_of(bone) * 1e9;
    made->summary.memory_mb = static_cast<double>(bone.memory_bytes()) / 1048576.0;
    if (made->summary.solid_mm3 <= 0)
      return error("there is no bone at this surface level; choose another with --iso");
    return made;
  } catch (const std::bad_alloc&) {
    return error("not enough memory for the bone; use a larger --voxel-mm or a smaller --roi");
  }
}

}  // namespace burr::importing

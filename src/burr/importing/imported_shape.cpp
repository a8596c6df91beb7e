#include "burr/importing/imported_shape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "burr/importing/crumbs.h"
#include "burr/importing/part_volumes.h"
#include "burr/importing/tissue_volumes.h"

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

Error stopped() { return error(Trouble::interrupted, "the import was stopped"); }

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

// Makes the bone of what `inside` says now.
Status build(const io::Scan& scan, const scenario::BoneRecipe& recipe, Shape& shape,
             Progress& progress) {
  shape.inside.margin = {0, 0, 0};
  if (recipe.margin) leave_margins(shape.inside);
  const Plan& plan = shape.plan;
  shape.bone = bone_from_inside(grid_of(scan, plan, shape.inside),
                                shape.grey ? plan.grey_tissues : plan.labels.table, shape.inside,
                                shape.rule, recipe.reserve_bricks, progress);
  if (shape.bone == nullptr) return stopped();
  if (!shape.grey) restore_tissue_volumes(*shape.bone, shape.wanted, recipe.bone_law);
  return fine();
}

// The labels of the region on the cubic grid; the whole scan on its own grid is read without a copy.
Status set_labels(const io::Scan& scan, Shape& shape, Progress& progress) {
  const Plan& plan = shape.plan;
  const ImportSummary& out = plan.summary;
  InsideGrid& inside = shape.inside;
  inside.tissue = plan.labels.of_label;
  inside.solid = solid_labels(plan);
  const bool own_grid = plan.scale.isOnes(0), whole = out.roi_size == scan.size;
  // a nearly cubic grid is taken as cubic: voxels are counted, rounding is ignored
  const double per_voxel =
      own_grid && whole ? 1 : scan.spacing_mm.prod() / std::pow(out.voxel_mm, 3);
  shape.wanted.assign(plan.labels.table.tissues.size(), -1.0);
  for (std::size_t v = 1; v < 256; ++v)
    if (inside.solid[v])
      shape.wanted[plan.labels.of_label[v]] = static_cast<double>(plan.counts[v]) * per_voxel;
  inside.labels = scan.labels.data();
  if (own_grid && whole) return fine();
  const LabelRegion region{scan.labels.data(), scan.size, out.roi_from};
  if (!resample_labels(region, plan, inside.solid, shape.cubic, progress)) return stopped();
  inside.labels = shape.cubic.labels.data();
  inside.share = shape.cubic.share.empty() ? nullptr : shape.cubic.share.data();
  return fine();
}

std::optional<Parts> find_grey_parts(const Grey& grey, std::int16_t level, Progress& progress) {
  const auto nx = static_cast<std::size_t>(grey.size.x()),
             ny = static_cast<std::size_t>(grey.size.y());
  const auto row = [&](int j, int k, std::span<std::uint8_t> in) {
    const std::int16_t* values =
        grey.voxels.data() + nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k));
    for (std::size_t i = 0; i < nx; ++i) in[i] = values[i] >= level ? 1 : 0;
  };
  return find_parts(grey.size, row, progress);
}

// The region of a grey scan, smoothed and on the cubic grid, its crumbs joined.
Status set_greys(const io::Scan& scan, Shape& shape, Progress& progress) {
  const Plan& plan = shape.plan;
  const ImportSummary& out = plan.summary;
  Grey grey = take_grey(scan, out.roi_from, out.roi_size);
  const double iso = grey.stored(out.iso);
  if (out.smooth > 0 && !smooth_near(grey, iso, out.smooth / grey.step, scan.spacing_mm,
                                     shape.inside.law >= 2, progress))
    return stopped();
  // stored values are whole: they reach the level from the next whole number on
  const auto level = static_cast<std::int16_t>(std::clamp(std::ceil(iso), -32768.0, 32767.0));
  NewGrid cubic{out.size, plan.scale, plan.first};
  cubic.faithful = shape.inside.law >= 2;
  if (!make_cubic(grey, level, cubic, progress)) return stopped();
  if (shape.inside.law >= 2) {
    const auto parts = find_grey_parts(grey, level, progress);
    if (!parts) return stopped();
    join_crumbs(*parts, level, grey.voxels);
  }
  shape.grey = std::move(grey);
  shape.inside.grey = shape.grey->voxels.data();
  shape.inside.iso = static_cast<float>(iso);
  // noise that the filter leaves is averaged over neighbouring points of the surface
  shape.inside.soft = out.smooth > 0 ? 4.0F : 1.0F;
  shape.rule = {shape.grey->step, shape.grey->zero, scan.hounsfield};
  return fine();
}

// The part that a voxel of the file became one of; none: it is of no part.
std::optional<std::uint32_t> part_of(const Parts& parts, const Vec3& at) {
  const Ijk nearest(at.array().round().cast<int>());
  if (const auto part = parts.part_at(nearest)) return part;
  // a corner of a voxel that became air
  for (int n = 0; n < 27; ++n)
    if (const auto part = parts.part_at(nearest + Ijk(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)))
      return part;
  return std::nullopt;
}

// Takes the parts that are not kept out of the labels, and their voxels of the file out of the volumes.
void remove_label_parts(const io::Scan& scan, const Parts& parts, const std::vector<bool>& kept,
                        Shape& shape) {
  Plan& plan = shape.plan;
  ImportSummary& out = plan.summary;
  const LabelRegion region{scan.labels.data(), scan.size, out.roi_from};
  std::array<std::int64_t, 256> gone{};                   // of each label
  std::vector<std::int64_t> of_part(parts.parts.size());  // of each part
  for (int k = 0; k < out.roi_size.z(); ++k)
    for (int j = 0; j < out.roi_size.y(); ++j) {
      const std::uint8_t* row = region.row(j, k);
      for (int i = 0; i < out.roi_size.x(); ++i) {
        if (!shape.inside.solid[row[i]]) continue;
        const auto part = part_of(parts, (Vec3(i, j, k) - plan.first).cwiseQuotient(plan.scale));
        if (!part || kept[*part]) continue;
        ++gone[row[i]];
        ++of_part[*part];
      }
    }
  std::vector<std::uint8_t>& labels = shape.cubic.labels;
  if (labels.empty())
    labels.assign(shape.inside.labels,
                  shape.inside.labels +
                      static_cast<std::size_t>(shape.inside.size.cast<std::int64_t>().prod()));
  remove_labels(parts, kept, labels);
  if (!shape.cubic.share.empty()) remove_values(parts, kept, shape.cubic.share);
  shape.inside.labels = labels.data();
  // what was bone is now of the label around its part
  std::array<std::int64_t, 256> come{};
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const Ijk& first = parts.first[n];
    if (!kept[n])
      come[labels[static_cast<std::size_t>(first.x()) +
                  static_cast<std::size_t>(parts.size.x()) *
                      (static_cast<std::size_t>(first.y()) +
                       static_cast<std::size_t>(parts.size.y()) *
                           static_cast<std::size_t>(first.z()))]] += of_part[n];
  }
  for (TissueFound& one : out.tissues) {
    const auto label = static_cast<std::size_t>(one.tissue.label);
    const std::int64_t now = one.voxels + come[label] - gone[label];
    double& wanted = shape.wanted[plan.labels.of_label[label]];
    if (wanted > 0) wanted *= static_cast<double>(now) / static_cast<double>(one.voxels);
    one.voxels = now;
    one.volume_mm3 = static_cast<double>(now) * scan.spacing_mm.prod();
  }
}

}  // namespace

Result<Shape> shape_of(const io::Scan& scan, const scenario::BoneRecipe& recipe, Plan plan,
                       Progress& progress) {
  Shape shape;
  shape.plan = std::move(plan);
  shape.inside.size = shape.plan.summary.size;
  shape.inside.law = recipe.bone_law;
  const Status set = shape.plan.summary.labels ? set_labels(scan, shape, progress)
                                               : set_greys(scan, shape, progress);
  if (!set) return set.error();
  if (Status built = build(scan, recipe, shape, progress); !built) return built.error();
  return shape;
}

Result<FoundParts> parts_of(const io::Scan& scan, const Shape& shape, Progress& progress) {
  const InsideGrid& inside = shape.inside;
  const Plan& plan = shape.plan;
  const auto nx = static_cast<std::size_t>(inside.size.x()),
             ny = static_cast<std::size_t>(inside.size.y());
  const auto row = [&](int j, int k, std::span<std::uint8_t> in) {
    const std::size_t first = nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k));
    for (std::size_t i = 0; i < nx; ++i) in[i] = inside.inside(first + i) ? 1 : 0;
  };
  auto parts = find_parts(inside.size, row, progress);
  if (!parts) return stopped();
  if (inside.law >= 2) measure_parts(*shape.bone, inside.margin, *parts);
  const Vec3 first = plan.summary.roi_from.cast<double>() + plan.first;
  return FoundParts{std::move(*parts),
                    {scan.origin_mm + scan.axes * first.cwiseProduct(scan.spacing_mm),
                     plan.scale.cwiseProduct(scan.spacing_mm), scan.axes}};
}

Result<ChosenParts> choose(const FoundParts& found, const scenario::BoneRecipe& recipe,
                           ImportSummary& out) {
  auto chosen = choose_parts(found.parts, recipe, found.place);
  if (!chosen) return chosen.error();
  out.parts = chosen->found;
  out.notices.insert(out.notices.end(), chosen->notices.begin(), chosen->notices.end());
  return chosen;
}

Status keep_parts(const io::Scan& scan, const scenario::BoneRecipe& recipe, Shape& shape,
                  Progress& progress) {
  const auto found = parts_of(scan, shape, progress);
  if (!found) return found.error();
  const auto chosen = choose(*found, recipe, shape.plan.summary);
  if (!chosen) return chosen.error();
  if (!chosen->removes()) return fine();
  if (shape.grey)
    remove_values(found->parts, chosen->kept, shape.grey->voxels);
  else
    remove_label_parts(scan, found->parts, chosen->kept, shape);
  return build(scan, recipe, shape, progress);
}

}  // namespace burr::importing

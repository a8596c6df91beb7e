#include "burr/importing/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace burr::importing {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kNearMm = 1;  // a point so near to a part is taken as one of it

std::size_t row_of(const Ijk& size, int j, int k) {
  return static_cast<std::size_t>(j) +
         static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k);
}

// Run::part is the parent in the forest until the parts are numbered; a root is its own parent, and
// the first of its tree.
std::uint32_t root(std::vector<Run>& runs, std::uint32_t run) {
  while (runs[run].part != run) {
    runs[run].part = runs[runs[run].part].part;  // halves the way for the next
    run = runs[run].part;
  }
  return run;
}

void join(std::vector<Run>& runs, std::size_t a, std::size_t b) {
  const std::uint32_t one = root(runs, static_cast<std::uint32_t>(a)),
                      other = root(runs, static_cast<std::uint32_t>(b));
  runs[std::max(one, other)].part = std::min(one, other);
}

// Joins the runs of two neighbouring rows where they overlap.
void join_rows(std::vector<Run>& runs, std::size_t a, std::size_t a_end, std::size_t b,
               std::size_t b_end) {
  while (a < a_end && b < b_end) {
    if (runs[a].from < runs[b].to && runs[b].from < runs[a].to) join(runs, a, b);
    ++(runs[a].to < runs[b].to ? a : b);
  }
}

// Numbers the parts, the largest first.
void number(Parts& parts) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> found(parts.runs.size(), kNone);  // of each root
  for (std::size_t n = 0; n < parts.runs.size(); ++n) {
    const std::uint32_t top = root(parts.runs, static_cast<std::uint32_t>(n));
    parts.runs[n].part = top;
    if (found[top] == kNone) {
      found[top] = static_cast<std::uint32_t>(parts.parts.size());
      parts.parts.push_back(0);
      parts.first.push_back(Ijk::Zero());
    }
    parts.parts[found[top]] += parts.runs[n].to - parts.runs[n].from;
  }
  std::vector<std::uint32_t> order(parts.parts.size()), rank(order.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return parts.parts[a] > parts.parts[b];
  });
  std::vector<std::int64_t> sorted;
  for (const std::uint32_t part : order) {
    rank[part] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(parts.parts[part]);
  }
  parts.parts = std::move(sorted);
  for (Run& run : parts.runs) run.part = rank[found[run.part]];
  std::vector<bool> seen(order.size());
  for (int k = 0; k < parts.size.z(); ++k)
    for (int j = 0; j < parts.size.y(); ++j) {
      const std::size_t row = row_of(parts.size, j, k);
      for (std::size_t n = parts.starts[row]; n < parts.starts[row + 1]; ++n) {
        const Run& run = parts.runs[n];
        if (seen[run.part]) continue;
        seen[run.part] = true;
        parts.first[run.part] = {run.from, j, k};
      }
    }
}

// Calls use(j, k, run) for each run.
template <class Use>
void each_run(const Parts& parts, const Use& use) {
  for (int k = 0; k < parts.size.z(); ++k)
    for (int j = 0; j < parts.size.y(); ++j) {
      const std::size_t row = row_of(parts.size, j, k);
      for (std::size_t n = parts.starts[row]; n < parts.starts[row + 1]; ++n)
        use(j, k, parts.runs[n]);
    }
}

// Calls use(part, voxel) for each neighbour, outside every part, of the parts that are not kept;
// once for each face.
template <class Use>
void around(const Parts& parts, const std::vector<bool>& kept, const Use& use) {
  const auto nx = static_cast<std::size_t>(parts.size.x());
  const auto beside = [&](const Run& run, int j, int k) {
    if (j < 0 || k < 0 || j >= parts.size.y() || k >= parts.size.z()) return;
    const std::size_t row = row_of(parts.size, j, k);
    std::size_t n = parts.starts[row];
    const std::size_t end = parts.starts[row + 1];
    while (n < end && parts.runs[n].to <= run.from) ++n;
    for (int i = run.from; i < run.to;) {
      if (n < end && i >= parts.runs[n].from) {
        i = parts.runs[n++].to;
        continue;
      }
      use(run.part, static_cast<std::size_t>(i++) + nx * row);
    }
  };
  each_run(parts, [&](int j, int k, const Run& run) {
    if (kept[run.part]) return;
    const std::size_t base = nx * row_of(parts.size, j, k);
    if (run.from > 0) use(run.part, base + static_cast<std::size_t>(run.from - 1));
    if (run.to < parts.size.x()) use(run.part, base + static_cast<std::size_t>(run.to));
    beside(run, j - 1, k);
    beside(run, j + 1, k);
    beside(run, j, k - 1);
    beside(run, j, k + 1);
  });
}

template <class Value>
void fill(const Parts& parts, const std::vector<bool>& kept, const std::vector<Value>& by,
          std::vector<Value>& voxels) {
  each_run(parts, [&](int j, int k, const Run& run) {
    if (kept[run.part]) return;
    const auto row =
        voxels.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(parts.size.x()) *
                                                     row_of(parts.size, j, k));
    std::fill(row + run.from, row + run.to, by[run.part]);
  });
}

template <class Value>
void remove_any(const Parts& parts, const std::vector<bool>& kept, std::vector<Value>& voxels) {
  std::vector<std::int64_t> sums(kept.size()), counts(kept.size());
  around(parts, kept, [&](std::uint32_t part, std::size_t voxel) {
    sums[part] += voxels[voxel];
    ++counts[part];
  });
  // rounded down: the mean of values below the level stays below it
  std::vector<Value> mean(kept.size(), std::numeric_limits<Value>::min());
  for (std::size_t n = 0; n < kept.size(); ++n)
    if (counts[n] > 0)
      mean[n] = static_cast<Value>(
          std::floor(static_cast<double>(sums[n]) / static_cast<double>(counts[n])));
  fill(parts, kept, mean, voxels);
}

struct Nearest {
  std::uint32_t part = 0;
  double mm = 0;
  Ijk voxel = Ijk::Zero();
};
Nearest nearest(const Parts& parts, const Vec3& at, const Vec3& voxel_mm) {
  Nearest best{0, std::numeric_limits<double>::infinity(), Ijk::Zero()};
  each_run(parts, [&](int j, int k, const Run& run) {
    const int i = static_cast<int>(std::clamp(std::round(at.x()), static_cast<double>(run.from),
                                              static_cast<double>(run.to - 1)));
    const double mm = (at - Vec3(i, j, k)).cwiseProduct(voxel_mm).norm();
    if (mm < best.mm) best = {run.part, mm, {i, j, k}};
  });
  return best;
}

std::string point_text(const Vec3& mm) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", mm.x(), mm.y(), mm.z());
}

std::string mm3_text(double mm3) {
  return mm3 < 10 ? fmt::format("{:.3g}", mm3) : fmt::format("{:.0f}", mm3);
}

// Marks the parts at the points of the recipe.
Status keep_at(const Parts& parts, const std::vector<Vec3>& points, const Place& place,
               ChosenParts& out) {
  for (const Vec3& mm : points) {
    const Vec3 at = (place.axes.transpose() * (mm - place.origin_mm)).cwiseQuotient(place.voxel_mm);
    const bool in_grid = at.array().abs().maxCoeff() < 1e6;
    const Ijk voxel = in_grid ? Ijk(at.array().round().cast<int>()) : Ijk(-1, -1, -1);
    if (const auto part = parts.part_at(voxel)) {
      out.kept[*part] = true;
      continue;
    }
    const Nearest near = nearest(parts, at, place.voxel_mm);
    const Vec3 there =
        place.origin_mm + place.axes * near.voxel.cast<double>().cwiseProduct(place.voxel_mm);
    if (near.mm > kNearMm)
      return error(Trouble::usage,
                   fmt::format("`keep` at {}: there is no bone at this point; the nearest part is "
                               "{:.3g} mm away, at {}; give a point in the part to keep",
                               point_text(mm), near.mm, point_text(there)));
    out.kept[near.part] = true;
    out.notices.push_back(
        fmt::format("There is no bone at {} mm: the part {:.2g} mm away is kept (`keep`).",
                    point_text(mm), near.mm));
  }
  return fine();
}

}  // namespace

std::optional<std::uint32_t> Parts::part_at(const Ijk& voxel) const {
  if (voxel.minCoeff() < 0 || (voxel.array() >= size.array()).any()) return std::nullopt;
  const std::size_t row = row_of(size, voxel.y(), voxel.z());
  const auto end = runs.begin() + static_cast<std::ptrdiff_t>(starts[row + 1]);
  const auto run = std::upper_bound(runs.begin() + static_cast<std::ptrdiff_t>(starts[row]), end,
                                    voxel.x(), [](int i, const Run& one) { return i < one.to; });
  if (run == end || voxel.x() < run->from) return std::nullopt;
  return run->part;
}

std::optional<Parts> find_parts(const Ijk& size, const InsideRow& inside, Progress& progress) {
  Parts parts;
  parts.size = size;
  const int nx = size.x();
  std::vector<std::uint8_t> row(static_cast<std::size_t>(nx));
  parts.starts.reserve(row_of(size, 0, size.z()) + 1);
  parts.starts.push_back(0);
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      inside(j, k, row);
      // the next voxel of this kind; a row is mostly air, or mostly bone
      const auto next = [&row, nx](int i, int kind) {
        const void* found = std::memchr(row.data() + i, kind, static_cast<std::size_t>(nx - i));
        return found == nullptr
                   ? nx
                   : static_cast<int>(static_cast<const std::uint8_t*>(found) - row.data());
      };
      const std::size_t first = parts.runs.size(), number = parts.starts.size() - 1;
      for (int from = next(0, 1); from < nx;) {
        const int to = next(from, 0);
        parts.runs.push_back({from, to, static_cast<std::uint32_t>(parts.runs.size())});
        from = to < nx ? next(to, 1) : nx;
      }
      parts.starts.push_back(parts.runs.size());
      if (j > 0) join_rows(parts.runs, parts.starts[number - 1], first, first, parts.runs.size());
      if (k > 0) {
        const std::size_t below = number - static_cast<std::size_t>(size.y());
        join_rows(parts.runs, parts.starts[below], parts.starts[below + 1], first,
                  parts.runs.size());
      }
    }
    progress.report(static_cast<double>(k + 1) / size.z(), "looking for separate parts");
    if (progress.cancelled()) return std::nullopt;
  }
  ::burr::importing::number(parts);
  return parts;
}

Result<ChosenParts> choose_parts(const Parts& parts, const scenario::BoneRecipe& recipe,
                                 const Place& place) {
  ChosenParts out;
  PartsFound& found = out.found;
  const std::size_t count = parts.parts.size();
  const double each = place.voxel_mm.prod();
  const auto mm3 = [&](std::size_t n) {
    return (parts.volumes.empty() ? static_cast<double>(parts.parts[n]) : parts.volumes[n]) * each;
  };
  found.count = count;
  for (std::size_t n = 0; n < count; ++n) {
    found.mm3 += mm3(n);
    if (mm3(n) < kIslandMm3) ++found.islands;
  }
  out.kept.assign(count, recipe.keep.all());
  if (count == 0) return out;
  found.largest_mm3 = mm3(0);
  const auto wanted = static_cast<std::size_t>(std::max(recipe.keep.largest, 0));
  for (std::size_t n = 0; n < std::min(wanted, count); ++n) out.kept[n] = true;
  if (wanted > count)
    out.notices.push_back(fmt::format("The bone has only {} part{}, so `keep` {} keeps {}.", count,
                                      count == 1 ? "" : "s", wanted,
                                      count == 1 ? "it" : "them all"));
  if (Status status = keep_at(parts, recipe.keep.at_mm, place, out); !status) return status.error();
  if (recipe.drop_islands_mm3 > 0)
    for (std::size_t n = 0; n < count; ++n)
      if (mm3(n) < recipe.drop_islands_mm3) out.kept[n] = false;

  std::size_t largest = count;
  for (std::size_t n = 0; n < count; ++n) {
    if (out.kept[n]) continue;
    ++found.removed;
    found.removed_mm3 += mm3(n);
    largest = std::min(largest, n);  // the largest come first
  }
  if (found.removed == count)
    return error(Trouble::usage,
                 fmt::format("`drop_islands_mm3` {:g} leaves nothing: the largest part that was to "
                             "be kept is smaller; the largest of all has {} mm3; give less",
                             recipe.drop_islands_mm3, mm3_text(found.largest_mm3)));
  if (found.removed == 0) return out;
  found.largest_removed_mm3 = mm3(largest);
  const Vec3 where = place.origin_mm +
                     place.axes * parts.first[largest].cast<double>().cwiseProduct(place.voxel_mm);
  const char* option = recipe.keep.all()             ? "`drop_islands_mm3`"
                       : recipe.drop_islands_mm3 > 0 ? "`keep` and `drop_islands_mm3`"
                                                     : "`keep`";
  out.notices.push_back(
      found.removed == 1
          ? fmt::format("One of {} separate parts was removed ({}): {} mm3, at {} mm.", count,
                        option, mm3_text(found.removed_mm3), point_text(where))
          : fmt::format("{} of {} separate parts were removed ({}): {} mm3 in all, the largest "
                        "of {} mm3 at {} mm.",
                        found.removed, count, option, mm3_text(found.removed_mm3),
                        mm3_text(found.largest_removed_mm3), point_text(where)));
  return out;
}

void remove_values(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::int16_t>& voxels) {
  remove_any(parts, kept, voxels);
}
void remove_values(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::uint8_t>& voxels) {
  remove_any(parts, kept, voxels);
}

void remove_labels(const Parts& parts, const std::vector<bool>& kept,
                   std::vector<std::uint8_t>& labels) {
  std::unordered_map<std::uint64_t, std::int64_t> met;  // part * 256 + label
  around(parts, kept, [&](std::uint32_t part, std::size_t voxel) {
    ++met[std::uint64_t{part} << 8U | labels[voxel]];
  });
  std::vector<std::int64_t> most(kept.size());
  std::vector<std::uint8_t> by(kept.size());
  for (const auto& [key, count] : met) {
    const auto part = static_cast<std::size_t>(key >> 8U);
    const auto label = static_cast<std::uint8_t>(key & 0xFFU);
    // of two that are equally frequent the smaller, whatever the order here
    if (count < most[part] || (count == most[part] && label > by[part])) continue;
    most[part] = count;
    by[part] = label;
  }
  fill(parts, kept, by, labels);
}

}  // namespace burr::importing

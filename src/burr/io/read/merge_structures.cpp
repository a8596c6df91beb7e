#include "burr/io/read/merge_structures.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/samples.h"

namespace burr::io {
namespace {

using math::Ijk;
using math::Vec3;

constexpr std::size_t kMostLabels = 255, kNamed = 8;
constexpr double kSamePlace = 0.1;  // [voxel]

// "a, b and 5 more"
std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t n = 0; n < std::min(names.size(), kNamed); ++n)
    out += (n == 0 ? "" : n + 1 == names.size() ? " and " : ", ") + names[n];
  if (names.size() > kNamed) out += fmt::format(" and {} more", names.size() - kNamed);
  return out;
}

// The smallest grid like that of the first structure that holds all of them.
Result<VoxelPlaces> grid_of_all(const std::vector<LooseStructure>& all, const std::string& file) {
  const VoxelPlaces& first = all.front().places;
  Ijk low = {0, 0, 0}, high = first.size - Ijk::Ones();
  for (const LooseStructure& one : all) {
    const auto turn = turn_of(one.places, first);
    if (!turn)
      return error(fmt::format(
          "{}: {} and {} have different voxels ({}; {}), so they cannot become one label map; "
          "resample them to one grid, or give burr one file",
          file, all.front().file, one.file, in_words(first), in_words(one.places)));
    const Ijk last = turn->first + turn->turn * (one.places.size - Ijk::Ones());
    low = low.cwiseMin(turn->first).cwiseMin(last);
    high = high.cwiseMax(turn->first).cwiseMax(last);
  }
  VoxelPlaces out = first;
  out.size = high - low + Ijk::Ones();
  out.origin_mm = first.origin_mm + first.axes * first.spacing_mm.cwiseProduct(low.cast<double>());
  return out;
}

// Paints structures into a label map, and counts where they overlap.
class Brush {
 public:
  Brush(const VoxelPlaces& on, Scan& scan) : on_(on), scan_(scan), shared_(scan.labels.size()) {}

  void paint(const LooseStructure& one, const GridTurn& turn, std::uint8_t number) {
    const auto nx = static_cast<std::uint64_t>(one.places.size.x()),
               ny = static_cast<std::uint64_t>(one.places.size.y());
    const std::array<std::int64_t, 3> step = {
        1, on_.size.x(), std::int64_t{on_.size.x()} * std::int64_t{on_.size.y()}};
    const auto along = [&](int axis) {
      std::int64_t sum = 0;
      for (int a = 0; a < 3; ++a) sum += step[static_cast<std::size_t>(a)] * turn.turn(a, axis);
      return sum;
    };
    std::int64_t start = 0;
    for (int a = 0; a < 3; ++a) start += step[static_cast<std::size_t>(a)] * turn.first[a];
    const std::int64_t di = along(0), dj = along(1), dk = along(2);
    for (const VoxelRun& run : one.runs)
      for (std::uint64_t at = run.from, end = run.from + run.count; at < end;) {
        const std::uint64_t i = at % nx, row = at / nx, here = std::min(end - at, nx - i);
        const Ijk ijk(static_cast<int>(i), static_cast<int>(row % ny), static_cast<int>(row / ny));
        if (inside(turn, ijk) && inside(turn, ijk + Ijk(static_cast<int>(here) - 1, 0, 0))) {
          std::int64_t to = start + di * ijk.x() + dj * ijk.y() + dk * ijk.z();
          for (std::uint64_t n = 0; n < here; ++n, to += di)
            one_voxel(static_cast<std::size_t>(to), number);
        }
        at += here;
      }
  }

  [[nodiscard]] std::size_t overlap() const { return overlap_; }
  // The pairs that share most voxels: the smaller one, the larger one, how many.
  [[nodiscard]] std::vector<std::pair<std::pair<int, int>, std::size_t>> pairs() const {
    std::vector<std::pair<std::pair<int, int>, std::size_t>> out(pairs_.begin(), pairs_.end());
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return out;
  }

 private:
  [[nodiscard]] bool inside(const GridTurn& turn, const Ijk& ijk) const {
    const Ijk at = turn.first + turn.turn * ijk;
    return (at.array() >= 0).all() && (at.array() < on_.size.array()).all();
  }
  void one_voxel(std::size_t voxel, std::uint8_t number) {
    std::uint8_t& label = scan_.labels[voxel];
    if (label != 0 && label != number) {
      if (!shared_[voxel]) ++overlap_;
      shared_[voxel] = true;
      ++pairs_[{number, label}];
    }
    label = number;
  }

  const VoxelPlaces& on_;
  Scan& scan_;
  std::vector<bool> shared_;
  std::size_t overlap_ = 0;
  std::map<std::pair<int, int>, std::size_t> pairs_;
};

// The structures that have voxels, and a notice of the others.
Result<std::vector<const LooseStructure*>> with_voxels(const std::vector<LooseStructure>& all,
                                                       const std::string& file, Scan& scan) {
  std::vector<const LooseStructure*> out;
  std::vector<std::string> empty;
  for (const LooseStructure& one : all)
    if (one.runs.empty())
      empty.push_back(base::printable(one.label.name));
    else
      out.push_back(&one);
  if (!empty.empty())
    scan.notices.push_back(fmt::format(
        "{} {} no voxel and {} left out: {}.",
        empty.size() == 1 ? "One structure" : fmt::format("{} structures", empty.size()),
        empty.size() == 1 ? "has" : "have", empty.size() == 1 ? "is" : "are", list_of(empty)));
  if (out.empty())
    return error(fmt::format("{}: none of its {} structures has a voxel; give other files", file,
                             all.size()));
  if (out.size() > kMostLabels)
    return error(
        fmt::format("{}: holds {} structures, and burr reads at most 255; leave some of them out",
                    file, out.size()));
  return out;
}

void tell_overlap(const Brush& brush, const std::vector<const LooseStructure*>& there, Scan& scan) {
  if (brush.overlap() == 0) return;
  const auto name = [&](int number) {
    return base::printable(there[static_cast<std::size_t>(number) - 1]->label.name);
  };
  std::vector<std::string> pairs;
  for (const auto& [pair, voxels] : brush.pairs())
    pairs.push_back(fmt::format("{} over {} in {}", name(pair.first), name(pair.second), voxels));
  scan.notices.push_back(
      fmt::format("Structures overlap in {} voxels: there the smaller one stays ({}).",
                  brush.overlap(), list_of(pairs)));
}

}  // namespace

VoxelPlaces places_of(const Scan& scan) {
  return {scan.size, scan.spacing_mm, scan.axes, scan.origin_mm};
}

std::string in_words(const VoxelPlaces& p) {
  return fmt::format(
      "{} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm from ({:.6g}, {:.6g}, {:.6g})",
      p.size.x(), p.size.y(), p.size.z(), p.spacing_mm.x(), p.spacing_mm.y(), p.spacing_mm.z(),
      p.origin_mm.x(), p.origin_mm.y(), p.origin_mm.z());
}

std::optional<GridTurn> turn_of(const VoxelPlaces& from, const VoxelPlaces& to) {
  const auto place = [&](const Ijk& ijk) -> Vec3 {
    const Vec3 at = from.origin_mm + from.axes * from.spacing_mm.cwiseProduct(ijk.cast<double>());
    return (to.axes.transpose() * (at - to.origin_mm)).cwiseQuotient(to.spacing_mm);
  };
  GridTurn out;
  const Vec3 first = place(Ijk::Zero());
  if (!(first.cwiseAbs().maxCoeff() < 1e6)) return std::nullopt;
  out.first = first.array().round().cast<int>();
  if ((first - out.first.cast<double>()).cwiseAbs().maxCoeff() > kSamePlace) return std::nullopt;
  for (int a = 0; a < 3; ++a) {
    const Vec3 step = place(Ijk::Unit(a)) - first;
    if (!(step.cwiseAbs().maxCoeff() < (from.size[a] == 1 ? 1e3 : 2.0))) return std::nullopt;
    out.turn.col(a) = step.array().round().cast<int>();
    if (from.size[a] == 1) {  // one voxel, however thick
      Eigen::Index along = 0;
      step.cwiseAbs().maxCoeff(&along);
      out.turn.col(a) = Ijk::Unit(along) * (step[along] < 0 ? -1 : 1);
    }
    // to the far end of the grid, so that a small difference of the spacing shows
    const Vec3 end = place((from.size[a] - 1) * Ijk::Unit(a));
    const Ijk whole = out.first + (from.size[a] - 1) * out.turn.col(a);
    if ((end - whole.cast<double>()).cwiseAbs().maxCoeff() > kSamePlace ||
        out.turn.col(a).cwiseAbs().sum() != 1)
      return std::nullopt;
  }
  if (std::abs(out.turn.cast<double>().determinant()) < 0.5) return std::nullopt;
  return out;
}

Status merge_structures(const std::vector<LooseStructure>& all,
                        const std::optional<VoxelPlaces>& on, const std::string& file, Scan& scan,
                        Progress& progress) {
  if (all.empty()) return error(file + ": holds no structure; give other files");
  auto grid = on ? Result<VoxelPlaces>(*on) : grid_of_all(all, file);
  if (!grid) return grid.error();
  const auto there = with_voxels(all, file, scan);
  if (!there) return there.error();
  const auto count = voxel_count(file, grid->size.x(), grid->size.y(), grid->size.z());
  if (!count) return count.error();
  scan.size = grid->size;
  scan.spacing_mm = grid->spacing_mm;
  scan.axes = grid->axes;
  scan.origin_mm = grid->origin_mm;
  scan.hounsfield = false;
  scan.outside.reset();
  Voxels<float>().swap(scan.values);
  scan.labels.assign(*count, 0);
  scan.label_names.clear();
  std::vector<std::size_t> order;
  for (std::size_t n = 0; n < there->size(); ++n) {
    order.push_back(n);
    Label label = (*there)[n]->label;
    label.value = static_cast<int>(n) + 1;
    scan.label_names.push_back(std::move(label));
  }
  std::vector<std::uint64_t> voxels;
  for (const LooseStructure* one : *there) voxels.push_back(one->voxels());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return voxels[a] > voxels[b]; });
  Brush brush(*grid, scan);
  for (std::size_t n = 0; n < order.size(); ++n) {
    const LooseStructure& one = *(*there)[order[n]];
    const auto turn = turn_of(one.places, *grid);
    if (!turn)
      return error(fmt::format("{}: {} has other voxels than the scan ({}; {})", file, one.file,
                               in_words(one.places), in_words(*grid)));
    brush.paint(one, *turn, static_cast<std::uint8_t>(order[n] + 1));
    progress.report(static_cast<double>(n + 1) / static_cast<double>(order.size()), "reading");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  tell_overlap(brush, *there, scan);
  return fine();
}

}  // namespace burr::io

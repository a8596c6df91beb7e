#include "window/import/import_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/importing/keep_greys.h"
#include "burr/workshop/open_bone.h"

namespace burr::app {
namespace {

using math::Ijk;

constexpr double kMb = 1048576.0;
// CT: values of air, or above those of enamel, do not help to find where bone begins
constexpr double kLeastHu = -1100, kMostHu = 3200;

double mb_of(const io::Scan& scan) {
  return (static_cast<double>(scan.values.size()) * sizeof(float) +
          static_cast<double>(scan.labels.size())) /
         kMb;
}

// The quantile: the value below which this share (0..1) of the counts lies.
double quantile(const std::vector<std::int64_t>& counts, double from, double step, double share) {
  std::int64_t total = 0, sum = 0;
  for (const std::int64_t n : counts) total += n;
  for (std::size_t n = 0; n < counts.size(); ++n) {
    sum += counts[n];
    if (static_cast<double>(sum) >= share * static_cast<double>(total))
      return from + static_cast<double>(n + 1) * step;
  }
  return from + static_cast<double>(counts.size()) * step;
}

std::vector<std::int64_t> count(const io::Scan& scan, double from, double to, int steps) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(steps));
  const auto least = static_cast<float>(from);
  const float scale = static_cast<float>(steps) / static_cast<float>(to - from);
  const auto last = static_cast<float>(steps - 1);
  for (const float value : scan.values) {
    if (value == scan.outside) continue;
    ++counts[static_cast<std::size_t>(std::clamp((value - least) * scale, 0.0F, last))];
  }
  return counts;
}

// Reads one number from a file such as /sys/fs/cgroup/memory.max; NaN if there is none.
double number_in(const char* path) {
  std::ifstream file(path);
  double number = 0;
  return file >> number ? number : std::numeric_limits<double>::quiet_NaN();
}

// The amount of bone and of surface, on the grid of the plan.
struct Extent {
  double bricks = 0;  // that contain bone
  double faces = 0;   // faces of voxels between bone and not bone
};

template <class Inside>
Extent extent_of(const io::Scan& scan, const importing::ImportSummary& plan, Inside inside) {
  const math::Vec3 fine = scan.spacing_mm / plan.voxel_mm;  // number of new voxels per old one
  const std::size_t nx = static_cast<std::size_t>(scan.size.x()),
                    ny = static_cast<std::size_t>(scan.size.y());
  std::array<std::size_t, 3> from{}, size{}, bricks{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    from[a] = static_cast<std::size_t>(plan.roi_from[axis]);
    size[a] = static_cast<std::size_t>(plan.roi_size[axis]);
    bricks[a] = static_cast<std::size_t>(plan.size[axis]) / 8 + 2;
  }
  const auto brick = [&fine](std::size_t n, int axis) {
    return static_cast<std::size_t>(static_cast<double>(n) * fine[axis]) / 8;
  };
  std::vector<std::size_t> column(size[0]);
  for (std::size_t i = 0; i < size[0]; ++i) column[i] = brick(i, 0);
  std::vector<std::uint8_t> met(bricks[0] * bricks[1] * bricks[2]), row(size[0]), before(size[0]),
      below(size[0] * size[1]);
  std::array<std::int64_t, 3> crossed{};
  for (std::size_t k = 0; k < size[2]; ++k)
    for (std::size_t j = 0; j < size[1]; ++j) {
      const std::size_t at = from[0] + nx * (from[1] + j + ny * (from[2] + k));
      std::uint8_t any = 0;
      for (std::size_t i = 0; i < size[0]; ++i) any |= row[i] = inside(at + i) ? 1 : 0;
      std::uint8_t* under = below.data() + j * size[0];
      std::int64_t x = 0, y = 0, z = 0;
      for (std::size_t i = 1; i < size[0]; ++i) x += row[i] ^ row[i - 1];
      if (j > 0)
        for (std::size_t i = 0; i < size[0]; ++i) y += row[i] ^ before[i];
      if (k > 0)
        for (std::size_t i = 0; i < size[0]; ++i) z += row[i] ^ under[i];
      crossed[0] += x;
      crossed[1] += y;
      crossed[2] += z;
      std::copy(row.begin(), row.end(), under);
      std::copy(row.begin(), row.end(), before.begin());
      if (any == 0) continue;
      std::uint8_t* to = met.data() + bricks[0] * (brick(j, 1) + bricks[1] * brick(k, 2));
      for (std::size_t i = 0; i < size[0]; ++i) to[column[i]] |= row[i];
    }
  Extent out;
  for (const std::uint8_t one : met) out.bricks += one;
  out.bricks *=
      std::max(1.0, fine.x() / 8) * std::max(1.0, fine.y() / 8) * std::max(1.0, fine.z() / 8);
  out.faces = static_cast<double>(crossed[0]) * fine.y() * fine.z() +
              static_cast<double>(crossed[1]) * fine.x() * fine.z() +
              static_cast<double>(crossed[2]) * fine.x() * fine.y();
  return out;
}

Extent extent_of(const io::Scan& scan, const importing::ImportSummary& plan) {
  if (!scan.values.empty()) {
    const auto iso = static_cast<float>(plan.iso);
    return extent_of(scan, plan, [&scan, iso](std::size_t n) { return scan.values[n] >= iso; });
  }
  std::array<bool, 256> solid{};
  for (const importing::TissueFound& one : plan.tissues)
    solid[static_cast<std::size_t>(one.tissue.label)] =
        one.tissue.kind == volume::TissueKind::solid;
  return extent_of(scan, plan, [&scan, &solid](std::size_t n) { return solid[scan.labels[n]]; });
}

}  // namespace

Greys greys_of(const io::Scan& scan, int steps) {
  Greys greys;
  if (scan.values.empty()) return greys;
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : scan.values) {
    if (value == scan.outside) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = scan.values.front();  // nothing was measured
  greys.low = double{low};
  greys.high = double{high};
  greys.from = greys.low;
  greys.to = greys.high > greys.low ? greys.high : greys.low + 1;
  if (scan.hounsfield) {
    greys.from = std::clamp(greys.from, kLeastHu, 0.0);
    greys.to = std::clamp(greys.to, 1000.0, kMostHu);
  } else {
    // a few voxels with extreme values must not squeeze all others into one step
    constexpr int kFine = 4096;
    constexpr double kStray = 1e-4;
    const std::vector<std::int64_t> fine = count(scan, greys.from, greys.to, kFine);
    const double step = (greys.to - greys.from) / kFine;
    const double most = quantile(fine, greys.from, step, 1 - kStray);
    greys.from = quantile(fine, greys.from, step, kStray) - step;
    greys.to = std::max(most, greys.from + step);
  }
  greys.counts = count(scan, greys.from, greys.to, steps);
  greys.most = *std::max_element(greys.counts.begin(), greys.counts.end());
  return greys;
}

double Greys::share_from(double value) const {
  if (counts.empty() || value > high) return 0;
  double above = 0, total = 0;
  const double wide = (to - from) / static_cast<double>(counts.size());
  for (std::size_t n = 0; n < counts.size(); ++n) {
    const auto all = static_cast<double>(counts[n]);
    total += all;
    above += all * std::clamp((from + static_cast<double>(n + 1) * wide - value) / wide, 0.0, 1.0);
  }
  return above / total;
}

double Greys::step() const {
  return std::pow(10.0, std::floor(std::log10(std::max(to - from, 1e-30) / 1000)));
}

std::array<Direction, 3> directions(const math::Mat3& axes) {
  constexpr PatientDirection kWays[3][2] = {
      {PatientDirection::left, PatientDirection::right},
      {PatientDirection::backwards, PatientDirection::forwards},
      {PatientDirection::upwards, PatientDirection::downwards}};
  constexpr double kExact = 0.9998;  // within a degree
  std::array<Direction, 3> out;
  for (int a = 0; a < 3; ++a) {
    int most = 0;
    axes.col(a).cwiseAbs().maxCoeff(&most);
    const double part = axes(most, a);
    out[static_cast<std::size_t>(a)] = {kWays[most][part > 0 ? 0 : 1], std::abs(part) < kExact};
  }
  return out;
}

std::string number_text(double value) { return fmt::format("{}", value); }

Box whole(const io::Scan& scan) { return {Ijk::Zero(), scan.size - Ijk::Ones()}; }

std::optional<scenario::Region> region_of(const io::Scan& scan, const Box& box) {
  if (box == whole(scan)) return std::nullopt;
  int first = box.from.z(), last = box.to.z();
  if (scan.k_reversed) {
    const int end = scan.size.z() - 1;
    first = end - box.to.z();
    last = end - box.from.z();
  }
  return scenario::Region{{box.from.x(), box.to.x()}, {box.from.y(), box.to.y()}, {first, last}};
}

Result<Box> box_of(const io::Scan& scan, const std::optional<scenario::Region>& region) {
  if (!region) return whole(scan);
  Box box{{region->i[0], region->j[0], region->k[0]}, {region->i[1], region->j[1], region->k[1]}};
  for (int a = 0; a < 3; ++a)
    if (box.from[a] < 0 || box.from[a] > box.to[a] || box.to[a] >= scan.size[a])
      return error(Trouble::usage,
                   fmt::format("--roi: {} {}..{} is outside 0..{}; choose a smaller region",
                               "ijk"[a], box.from[a], box.to[a], scan.size[a] - 1));
  if (scan.k_reversed) {
    const int end = scan.size.z() - 1, first = box.from.z();
    box.from.z() = end - box.to.z();
    box.to.z() = end - first;
  }
  return box;
}

std::vector<LabelChoice> choices_of(const std::vector<importing::TissueFound>& labels) {
  std::vector<LabelChoice> all;
  for (const importing::TissueFound& one : labels)
    all.push_back({one.tissue.kind, one.tissue.spare, one.assumed});
  return all;
}

std::string table_of(const std::vector<importing::TissueFound>& taken_for,
                     const std::vector<LabelChoice>& wanted) {
  std::string table;
  for (std::size_t n = 0; n < taken_for.size() && n < wanted.size(); ++n) {
    const volume::Tissue& tissue = taken_for[n].tissue;
    const bool other_kind = wanted[n].kind != tissue.kind;
    if (!other_kind && wanted[n].spare == tissue.spare) continue;
    table += fmt::format("\n[[label]]\nvalue = {}\n", tissue.label);
    if (other_kind)
      table += fmt::format("kind = \"{}\"\n", wanted[n].kind == volume::TissueKind::solid  ? "solid"
                                              : wanted[n].kind == volume::TissueKind::soft ? "soft"
                                                                                           : "air");
    if (wanted[n].spare != tissue.spare) table += fmt::format("spare = {}\n", wanted[n].spare);
  }
  return table.empty() ? table
                       : "# Labels as chosen in burr's window; see docs/use/labels.md.\n" + table;
}

Result<KeptTable> keep_table(const std::filesystem::path& folder, const std::string& table) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : table) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (!trouble) std::filesystem::permissions(folder, std::filesystem::perms::owner_all, trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: cannot be made ({}); the kinds of the labels are not saved",
                             folder.string(), trouble.message()));
  KeptTable kept{folder / fmt::format("labels_{:016x}.toml", hash), false};
  kept.fresh = !std::filesystem::exists(kept.path, trouble);
  auto file = base::NewFile::create(kept.path.string());
  if (!file) return file.error();
  file->write(table);
  if (const Status put = file->put_in_place(); !put) return put.error();
  return kept;
}

SessionMemory session_memory(const io::Scan& scan, const importing::ImportSummary& plan) {
  // Measured on eight scans of 0.4 to 130 million voxels. The processor drew the pictures, so the
  // triangles were in the same memory.
  constexpr double kGreyBrick = 2700, kLabelBrick = 1200, kReserved = 1100;  // [byte]
  constexpr double kFace = 120;                                              // in the mesh  [byte]
  constexpr double kSession = 20, kSpared = 40;                              // [MB]
  const Extent extent = extent_of(scan, plan);
  const double bone = (extent.bricks * (plan.labels ? kLabelBrick : kGreyBrick) +
                       static_cast<double>(scenario::BoneRecipe{}.reserve_bricks) * kReserved) /
                      kMb;
  const double region = plan.roi_size.cast<double>().prod() / kMb,
               made = plan.size.cast<double>().prod() / kMb;
  const bool in_place = plan.size == plan.roi_size;
  const double work = plan.labels
                          ? (in_place ? 0 : 2 * made) + 1.5 * bone
                          : std::max(2 * region + (in_place ? 0 : 2 * made), 2 * made + bone);
  const bool spared =
      std::any_of(plan.tissues.begin(), plan.tissues.end(),
                  [](const importing::TissueFound& one) { return one.tissue.spare; });
  SessionMemory memory;
  double greys =
      plan.labels ? 0 : static_cast<double>(scan.values.size());  // importing/keep_greys.h
  while (greys > importing::kMostGreys) greys /= 2;
  memory.working =
      bone + kSession + (spared ? kSpared : 0) + extent.faces * kFace / kMb + 2 * greys / kMb;
  memory.making = mb_of(scan) + std::max(work, memory.working);
  return memory;
}

double free_memory_mb() {
  double free = std::numeric_limits<double>::infinity();
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  double kb = 0;
  while (file >> name >> kb && std::getline(file, unit))
    if (name == "MemAvailable:") free = kb / 1024;
  // a container may be allowed less memory than the computer has
  const double limit = number_in("/sys/fs/cgroup/memory.max"),
               taken = number_in("/sys/fs/cgroup/memory.current");
  if (limit >= taken) free = std::min(free, (limit - taken) / kMb);
  return free;
}

Result<Planned> plan_session(const io::Scan& scan, const scenario::BoneRecipe& recipe) {
  auto plan = importing::plan_import(scan, recipe);
  if (!plan) return plan.error();
  Planned planned{std::move(*plan), {}};
  planned.memory = session_memory(scan, planned.import);
  return planned;
}

Result<OpenedScan> open_scan(const scenario::BoneRecipe& recipe, Progress& progress) {
  auto read = io::read_scan(recipe.source, workshop::read_options(recipe), progress);
  if (!read) return read.error();
  auto scan = std::make_shared<const io::Scan>(std::move(*read));
  progress.report(1, "counting values");
  auto planned = plan_session(*scan, recipe);
  if (!planned && scan->size.minCoeff() < 2) return planned.error();
  auto labels = importing::labels_of(*scan, recipe);
  if (!labels) return labels.error();
  Greys greys = greys_of(*scan);
  return OpenedScan{recipe, std::move(scan), std::move(greys), std::move(*labels),
                    std::move(planned)};
}

}  // namespace burr::app

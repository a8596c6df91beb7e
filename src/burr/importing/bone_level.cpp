#include "burr/importing/bone_level.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "burr/importing/cut_off.h"
#include "burr/io/value_groups.h"

namespace burr::importing {
namespace {

using io::ValueGroup;
using io::ValueGroups;
using io::ValueSample;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// 300 HU = 40 + 0.25 * (40 + 1000). Where noise or fat make the group of soft tissue broad, a share of
// its width at half height is added; 0.24 and 0.18 fit ten real scans best (docs/use/own_ct.md).
constexpr double kAboveSoft = 0.24, kOfWidth = 0.18;
// Groups within this share of the range above the lowest are air too: the table's foam, lung, what
// lies outside the body.
constexpr double kAirReach = 0.15;
// Fat and muscle: (40 + 1000) / (-100 + 1000) = 1.16.
constexpr double kSameTissue = 1.2;

struct GroupsOfMaterial {
  ValueGroup air, soft;
  bool alone = false;  // soft is the only material beside air
  bool hard = false;   // and is hard, as dentine below enamel
};

// Which of the groups is air and which is soft tissue; false: there is one material only.
bool name_groups(const ValueSample& sample, const ValueGroups& groups, GroupsOfMaterial& out) {
  const std::vector<ValueGroup>& all = groups.all;
  if (all.empty()) return false;
  const double top = std::max(groups.high, all.back().value);
  const double reach = all.front().value + kAirReach * (top - all.front().value);
  std::size_t first = 0;
  while (first < all.size() && all[first].value <= reach) ++first;
  if (first == all.size()) return false;
  const auto less = [](const ValueGroup& a, const ValueGroup& b) { return a.share < b.share; };
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  out.air = *std::max_element(all.begin(), begin, less);
  const auto above_air = [&](const ValueGroup& group) { return group.value - out.air.value; };
  ValueGroup most = *std::max_element(begin, all.end(), less);
  // where most of it is bone, soft tissue is a smaller group below
  for (auto group = begin; group != all.end(); ++group)
    if (above_air(most) > 1.3 * above_air(*group) && above_air(most) < 4 * above_air(*group) &&
        group->share > 0.1 * most.share) {
      most = *group;
      break;
    }
  // where most of it is fat, muscle is a smaller group above
  for (auto group = begin; group != all.end(); ++group)
    if (group->value > most.value && above_air(*group) < kSameTissue * above_air(most) &&
        group->share > 0.15 * most.share)
      most = *group;
  out.soft = most;
  const double apart = above_air(most);
  const double denser = io::share_between(sample, most.value + 0.3 * apart, kInfinity);
  const double own =
      io::share_between(sample, most.value - 0.15 * apart, most.value + 0.15 * apart);
  out.alone = denser < 0.005 * own;
  return true;
}

// Share of the surface at `level` that meets air within four voxels, and not soft tissue.
double share_beside_air(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size,
                        const GroupsOfMaterial& materials, double level) {
  const auto bone = static_cast<float>(level);
  const auto half = static_cast<float>(0.5 * (materials.air.value + materials.soft.value));
  const std::ptrdiff_t nx = scan.size.x(), slice = nx * scan.size.y();
  const std::array<std::ptrdiff_t, 2> strides = {1, nx};
  const int step = std::max(1, static_cast<int>(std::cbrt(size.cast<double>().prod() / 2e6)));
  std::int64_t air = 0, soft = 0;
  for (int k = 0; k < size.z(); k += step)
    for (int j = 0; j < size.y(); j += step)
      for (int i = 0; i < size.x(); ++i) {
        const std::array<int, 2> at = {i, j};
        const float* here =
            scan.values.data() + (from.x() + i) + nx * (from.y() + j) + slice * (from.z() + k);
        if (!(*here >= bone)) continue;
        for (std::size_t a = 0; a < 2; ++a)
          for (const int way : {-1, 1}) {
            bool left = false, met = false;
            for (int n = 1; n <= 4; ++n) {
              const int to = at[a] + way * n;
              if (to < 0 || to >= size[static_cast<Eigen::Index>(a)]) break;
              const float value = here[way * n * strides[a]];
              if (value >= bone) break;
              left = true;
              met = met || value < half;
            }
            (met ? air : soft) += left ? 1 : 0;
          }
      }
  return air + soft > 0 ? static_cast<double>(air) / static_cast<double>(air + soft) : 0.0;
}

// Enamel on dentine, and nothing soft around them: two hard materials, of which the denser one is in
// air for a good part.
bool is_tooth(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size,
              const ValueGroups& groups, const GroupsOfMaterial& materials) {
  const ValueGroup& top = groups.all.back();
  const double ratio =
      (top.value - materials.air.value) / (materials.soft.value - materials.air.value);
  if (ratio < 1.65 || ratio > 2.2 || top.share < 0.15 * materials.soft.share) return false;
  for (const ValueGroup& group : groups.all)
    if (group.value > materials.air.value + 0.3 * (materials.soft.value - materials.air.value) &&
        group.value < top.value && group.value != materials.soft.value)
      return false;
  return share_beside_air(scan, from, size, materials, 0.5 * (materials.soft.value + top.value)) >
         0.3;
}

constexpr std::size_t kBins = 256;
struct Histogram {
  double low = 0, width = 1;
  std::vector<double> count = std::vector<double>(kBins, 0.0);
  std::vector<double> steep = std::vector<double>(kBins, 0.0);  // sum
  std::vector<double> with_steep = std::vector<double>(kBins, 0.0);
  [[nodiscard]] std::size_t bin(double value) const {
    return static_cast<std::size_t>(
        std::clamp((value - low) / width, 0.0, static_cast<double>(kBins) - 1));
  }
  // How steep the scan is around a value.
  [[nodiscard]] double steep_at(double value) const {
    const std::size_t at = bin(value);
    double sum = 0, n = 0;
    for (std::size_t b = at > 2 ? at - 2 : 0; b <= std::min(kBins - 1, at + 2); ++b) {
      sum += steep[b];
      n += with_steep[b];
    }
    return n > 0 ? sum / n : 0.0;
  }
};

Histogram histogram_of(const ValueSample& sample, double low, double high) {
  Histogram out;
  out.low = low;
  out.width = std::max((high - low) / static_cast<double>(kBins), 1e-30);
  for (std::size_t v = 0; v < sample.values.size(); ++v) {
    const std::size_t b = out.bin(double{sample.values[v]});
    ++out.count[b];
    if (!std::isfinite(sample.steep[v])) continue;
    out.steep[b] += double{sample.steep[v]};
    ++out.with_steep[b];
  }
  return out;
}

// The upper one of the two thresholds that part the values into three classes; of equally good ones
// the middle.
double upper_of_three(const Histogram& histogram) {
  std::vector<double> count(kBins + 1, 0.0), sum(kBins + 1, 0.0);
  for (std::size_t b = 0; b < kBins; ++b) {
    count[b + 1] = count[b] + histogram.count[b];
    sum[b + 1] = sum[b] + histogram.count[b] * static_cast<double>(b);
  }
  const auto part = [&](std::size_t from, std::size_t to) {
    const double n = count[to] - count[from], s = sum[to] - sum[from];
    return n > 0 ? s * s / n : 0.0;
  };
  double best = -1, first = 0, last = 0;
  for (std::size_t i = 1; i < kBins; ++i)
    for (std::size_t j = i + 1; j < kBins; ++j) {
      const double between = part(0, i) + part(i, j) + part(j, kBins);
      if (between > best * (1 + 1e-12)) {
        best = between;
        first = last = static_cast<double>(j);
      } else if (between >= best * (1 - 1e-12)) {
        last = std::max(last, static_cast<double>(j));
      }
    }
  return histogram.low + histogram.width * 0.5 * (first + last);
}

}  // namespace

const char* word_of(Sure sure) {
  switch (sure) {
    case Sure::low:
      return "low";
    case Sure::medium:
      return "medium";
    case Sure::high:
      return "high";
  }
  return "";
}

namespace {

// Share of the border of the box at or above a level.
double bright_border(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size,
                     double level) {
  std::int64_t bright = 0, all = 0;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const bool inner = k > 0 && k + 1 < size.z() && j > 0 && j + 1 < size.y();
      const float* row = scan.values.data() + from.x() +
                         std::ptrdiff_t{scan.size.x()} *
                             (from.y() + j + std::ptrdiff_t{scan.size.y()} * (from.z() + k));
      for (int i = 0; i < size.x(); i += inner && size.x() > 1 ? size.x() - 1 : 1) {
        if (row[i] == scan.outside) continue;
        ++all;
        bright += double{row[i]} >= level ? 1 : 0;
      }
    }
  return all > 0 ? static_cast<double>(bright) / static_cast<double>(all) : 0.0;
}

// Where air was cut off, its distance to soft tissue says nothing: then bone begins half-way to what
// is denser than soft tissue, if that is a group of its own.
void level_of_cut_off(const CutOff& cut, const ValueGroups& groups, const ValueGroup& soft,
                      BoneLevel& out) {
  const double above = soft.value + 0.3 * (soft.value - cut.low_value);
  const ValueGroup* denser = nullptr;
  for (const ValueGroup& group : groups.all)
    if (group.value > above && (denser == nullptr || group.share > denser->share)) denser = &group;
  out.sure = Sure::low;
  std::string level = "the level is a guess";
  if (denser != nullptr) {
    out.level = 0.5 * (soft.value + denser->value);
    level = fmt::format(
        "the level is half-way from soft tissue, around {:.4g}, to what is denser, "
        "around {:.4g}",
        soft.value, denser->value);
    if (cut.high && denser->value > cut.high_value - 0.05 * (cut.high_value - cut.low_value))
      level +=
          ", which was cut off too: bone cannot be told from all that is a little denser than "
          "soft tissue";
  }
  out.why = fmt::format(
      "values were cut off, as by the window of a viewer ({}), so how far air lies below soft "
      "tissue is not known; {}. Export the scan again without a window",
      piles_text(cut), level);
}

BoneLevel estimate(const io::Scan& scan, const ValueSample& sample, const ValueGroups& groups,
                   const math::Ijk& from, const math::Ijk& size, const CutOff& cut) {
  BoneLevel out;
  GroupsOfMaterial found;
  if (!name_groups(sample, groups, found)) {
    out.why = "the values show one material only";
    return out;
  }
  out.found = true;
  const double air = found.air.value, soft = found.soft.value, apart = soft - air;
  if (cut.low && air < cut.low_value + 0.1 * apart && !found.alone) {
    out.level = soft + kAboveSoft * apart + kOfWidth * found.soft.width;
    level_of_cut_off(cut, groups, found.soft, out);
    return out;
  }
  found.hard = !found.alone && is_tooth(scan, from, size, groups, found);
  if (found.alone || found.hard) {
    out.level = 0.5 * (air + soft);
    out.sure = found.hard || cut.low ? Sure::low : Sure::medium;
    out.why = found.hard
                  ? fmt::format(
                        "two hard materials around {:.4g} and {:.4g} (as dentine and enamel) "
                        "lie in air or resin around {:.4g}; the level is half-way to the "
                        "softer one",
                        soft, groups.all.back().value, air)
                  : fmt::format(
                        "the values show two materials, around {:.4g} and {:.4g}; the level "
                        "is half-way",
                        air, soft);
    if (cut.low)
      out.why += fmt::format(
          "; but values were cut off, as by the window of a viewer ({}), so what lies around the "
          "bone is not known",
          piles_text(cut));
    return out;
  }
  out.level = soft + kAboveSoft * apart + kOfWidth * found.soft.width;
  const double high = std::min(io::value_at_share(sample, 0.999), air + 4 * apart);
  const Histogram histogram =
      histogram_of(sample, std::min(groups.low, air), std::max(high, soft + apart));
  const double otsu = upper_of_three(histogram);
  const double own = io::share_between(sample, out.level, kInfinity),
               others = io::share_between(sample, otsu, kInfinity);
  const bool classes = own < 1.6 * others && others < 1.6 * own;
  const bool edges = histogram.steep_at(out.level) > 1.5 * histogram.steep_at(soft);
  out.sure = classes && edges ? Sure::high : classes || edges ? Sure::medium : Sure::low;
  out.why = fmt::format(
      "air lies around {:.4g} and soft tissue around {:.4g}, and 300 HU a quarter of that distance "
      "above; three classes of values {} ({:.4g}), the edges in the picture {}",
      air, soft, classes ? "agree" : "do not agree", otsu, edges ? "agree" : "do not");
  return out;
}

}  // namespace

BoneLevel estimate_bone_level(const io::Scan& scan, const math::Ijk& from, const math::Ijk& size,
                              bool check_scan) {
  const ValueSample sample =
      io::sample_values(scan.values.data(), scan.size, from, size, scan.outside);
  const CutOff cut = check_scan ? find_cut_off(sample) : CutOff{};
  BoneLevel out = estimate(scan, sample, io::groups_of(sample), from, size, cut);
  if (!check_scan || !out.found) return out;
  if (cut.high && out.level >= cut.high_value) {
    out.sure = Sure::low;
    out.why += fmt::format("; values were cut off below this level ({})", piles_text(cut));
  }
  constexpr double kMostBorder = 0.5;
  if (const double share = bright_border(scan, from, size, out.level); share > kMostBorder) {
    out.sure = Sure::low;
    out.why += fmt::format(
        "; but {:.0f} % of the scan's border would be bone, where air or flesh is expected: is "
        "dark "
        "dense here?",
        100 * share);
  }
  return out;
}

}  // namespace burr::importing

#include "burr/io/read/calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "burr/io/value_groups.h"

namespace burr::io {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// Where air lies in HU; cone-beam scanners are off by up to 200.
constexpr double kAirLow = -1150, kAirHigh = -780;
constexpr double kAirShare = 1e-3;  // less air is noise
// Air and soft tissue are 1040 apart in HU.
constexpr double kSoftLow = 900, kSoftHigh = 1150;

ValueSample sample_of(const Scan& scan) {
  return sample_values(scan.values.data(), scan.size, math::Ijk::Zero(), scan.size, scan.outside);
}

// The least and the greatest measured value.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -low;
};
Range range_of(const Scan& scan) {
  Range range;
  for (const float value : scan.values) {
    if (std::isnan(value) || value == scan.outside) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

// At most 300 000 measured values, sorted.
std::vector<float> sorted_values(const ValueSample& sample) {
  constexpr std::size_t kMost = 300000;
  const std::size_t step = sample.values.size() / kMost + 1;
  std::vector<float> out;
  for (std::size_t v = 0; v < sample.values.size(); v += step) out.push_back(sample.values[v]);
  std::sort(out.begin(), out.end());
  return out;
}

std::size_t corners_with(const Scan& scan, float value) {
  std::size_t found = 0;
  const auto nx = static_cast<std::size_t>(scan.size.x()),
             ny = static_cast<std::size_t>(scan.size.y()),
             nz = static_cast<std::size_t>(scan.size.z());
  for (const std::size_t i : {std::size_t{0}, nx - 1})
    for (const std::size_t j : {std::size_t{0}, ny - 1})
      for (const std::size_t k : {std::size_t{0}, nz - 1})
        found += scan.values[i + nx * (j + ny * k)] == value ? 1 : 0;
  return found;
}

// Whether the first of the sorted values is a fill: many voxels have exactly this one, and the next
// values are much farther away than any two others lie apart. Half-filled voxels lie between air and
// tissue, but not between a fill and what was measured.
bool first_is_fill(const std::vector<float>& sorted, double least_share) {
  const auto n = static_cast<double>(sorted.size());
  const float fill = sorted.front();
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), fill);
  const auto filled = static_cast<double>(end - sorted.begin());
  if (filled < std::max(least_share * n, 8.0) || sorted.end() - end < 64) return false;
  const auto rest = static_cast<double>(sorted.end() - end);
  const auto at = [&](double share) {
    return end + static_cast<std::ptrdiff_t>(share * (rest - 1));
  };
  const double gap = double{*at(1e-4)} - double{fill};
  const double bulk = double{*at(0.99)} - double{*at(0.01)};
  double widest = 0;
  for (auto v = at(1e-4); v < at(0.99); ++v) widest = std::max(widest, double{v[1]} - double{v[0]});
  return gap > 0.06 * bulk && gap > 2.5 * widest;
}

// A value that stands for "not measured", though the header does not say so.
std::optional<float> find_fill(const Scan& scan, const ValueSample& sample) {
  std::vector<float> sorted = sorted_values(sample);
  if (sorted.size() < 100 || sorted.front() == sorted.back()) return {};
  // of two values neither is a fill: what is left would be one value, and no picture
  if (*std::upper_bound(sorted.begin(), sorted.end(), sorted.front()) == sorted.back()) return {};
  if (first_is_fill(sorted, 0.003)) return sorted.front();
  // metal that is cut off at the largest number looks the same, but does not fill the corners
  const float top = sorted.back();
  if (corners_with(scan, top) < 4) return {};
  std::transform(sorted.begin(), sorted.end(), sorted.begin(), [](float v) { return -v; });
  std::reverse(sorted.begin(), sorted.end());
  if (first_is_fill(sorted, 0.01)) return top;
  return {};
}

// Zeros outside the body, in the midst of the other values (a scan whose air was removed).
bool zeros_are_outside(const Scan& scan, const ValueSample& sample) {
  if (corners_with(scan, 0.0F) < 4) return false;
  const double zeros = share_between(sample, 0, 0);
  const double near = 0.01 * (value_at_share(sample, 0.995) - value_at_share(sample, 0.005));
  return zeros > 0.05 && share_between(sample, -kInfinity, -1e-30) > 0.005 &&
         zeros > 2 * (share_between(sample, -near, near) - zeros);
}

// Reads numbers with the other sign where that leaves one unbroken range: signed numbers that were
// called unsigned lie at both ends of 0..period with nothing between, and the other way round.
bool mend_sign(Scan& scan, const Claim& claim, const ValueSample& sample) {
  if (!(claim.period > 0) || claim.slope == 0) return false;
  const std::vector<float> sorted = sorted_values(sample);
  if (sorted.size() < 100) return false;
  std::size_t widest = 1;
  for (std::size_t v = 1; v < sorted.size(); ++v)
    if (sorted[v] - sorted[v - 1] > sorted[widest] - sorted[widest - 1]) widest = v;
  const double period = claim.period * std::abs(claim.slope);
  const double zero = claim.intercept;  // the value of a stored 0
  const double below = double{sorted[widest - 1]}, above = double{sorted[widest]};
  const double low = double{sorted.front()}, high = double{sorted.back()};
  const double share = static_cast<double>(widest) / static_cast<double>(sorted.size());
  if (share < 0.005 || share > 0.995) return false;
  const bool was_unsigned = low >= zero && above - below > 0.4 * period &&
                            above >= zero + 0.5 * period && high <= zero + period;
  const bool was_signed =
      low >= zero - 0.5 * period && above - below > 0.8 * period && below < zero && above > zero;
  if (!was_unsigned && !was_signed) return false;
  const double split = 0.5 * (below + above);
  if (was_unsigned) {
    // only if a CT comes out
    const auto moved = [&](double value) { return value > split ? value - period : value; };
    double least = kInfinity, air = 0;
    for (const float value : sorted) {
      const double now = moved(double{value});
      least = std::min(least, now);
      air += now > kAirLow && now < kAirHigh ? 1 : 0;
    }
    if (least < -3100 || air < kAirShare * static_cast<double>(sorted.size())) return false;
  }
  for (float& value : scan.values) {
    if (was_unsigned && double{value} > split)
      value = static_cast<float>(double{value} - period);
    else if (was_signed && double{value} < split)
      value = static_cast<float>(double{value} + period);
  }
  scan.notices.push_back(
      fmt::format("The file calls its numbers {}, but then they lie in two heaps with nothing "
                  "between, {:.0f} to "
                  "{:.0f} and {:.0f} to {:.0f}: they are read as {} numbers.",
                  was_unsigned ? "unsigned" : "signed", low, below, above, high,
                  was_unsigned ? "signed" : "unsigned"));
  return true;
}

// Why the values cannot be HU; empty: they can.
std::string impossible(const ValueSample& sample) {
  const double middle = value_at_share(sample, 0.5);
  if (middle > 4000 || value_at_share(sample, 0.01) > 3500)
    return fmt::format("half of the values are above {:.0f}, and no tissue is so dense", middle);
  // what lies outside the field of view may be at -2000 or -3024, but not nearly all
  if (share_between(sample, -1250, kInfinity) < 0.05)
    return fmt::format("half of the values are below {:.0f}, and nothing is below -1024", middle);
  return "";
}

// Why values that the header calls HU are not; empty: nothing is wrong with them.
std::string contradiction(const ValueSample& sample, const ValueGroups& groups,
                          const Range& range) {
  std::string why = impossible(sample);
  if (!why.empty() || share_between(sample, -kInfinity, -100) > 1e-4) return why;
  if (range.low == 0 && range.high == 255) return "they are a picture of 8 bit, from 0 to 255";
  if (range.low >= -2 && range.high <= 2 && range.high > range.low)
    return fmt::format("they range from {:.3g} to {:.3g} only", range.low, range.high);
  if (groups.all.empty() || groups.all.front().value > 200) return "";
  // Air and soft tissue, shifted by about 1000, with something denser above. (Muscle and thin
  // cortex can lie as far apart, but a piece of a body without any air has fat in it, below -60.)
  const double air = groups.all.front().value;
  for (const ValueGroup& soft : groups.all)
    if (soft.value - air > kSoftLow && soft.value - air < kSoftHigh && soft.share > 0.1 &&
        share_between(sample, air + 1350, kInfinity) > 0.002 &&
        share_between(sample, -kInfinity, air - 60) < 0.002)
      return fmt::format(
          "no voxel is below -100, and the values lie around {:.0f} and {:.0f}, as air and soft "
          "tissue do (-1000 and 40 HU) when all values are shifted",
          air, soft.value);
  return "";
}

// Whether values of which no header says what they are behave as HU do.
bool behaves_as_hounsfield(const ValueSample& sample, const ValueGroups& groups, const Range& range,
                           std::size_t voxels, std::size_t unmeasured) {
  if (!impossible(sample).empty() || !(range.high >= 300) ||
      share_between(sample, 4000, kInfinity) > 0.05 ||
      share_between(sample, -kInfinity, -3100) > 0.01)
    return false;
  const bool air_group = std::any_of(
      groups.all.begin(), groups.all.end(),
      [](const ValueGroup& group) { return group.value > kAirLow && group.value < kAirHigh; });
  const double air = share_between(sample, kAirLow, kAirHigh);
  if (air > kAirShare && (air_group || air < 0.05) && range.low <= -900) return true;
  // the air was taken out: soft tissue is where it must be, and its edges go far down
  if (static_cast<double>(unmeasured) < 0.005 * static_cast<double>(voxels) || groups.all.empty())
    return false;
  const auto most =
      std::max_element(groups.all.begin(), groups.all.end(),
                       [](const ValueGroup& a, const ValueGroup& b) { return a.share < b.share; });
  return most->value > -20 && most->value < 110 && range.low >= -1100 &&
         value_at_share(sample, 0.001) < -80;
}

// A value for voxels without a measurement in a scan that is not in HU: a little below all others, and
// whole where those are.
float below_all(const Range& range) {
  const double span = double{range.high} - double{range.low};
  const bool whole = range.low == std::floor(range.low) && span >= 100;
  const auto below = static_cast<float>(double{range.low} - (whole ? 1.0 : 1e-6 * span));
  return below < range.low ? below
                           : std::nextafter(range.low, -std::numeric_limits<float>::infinity());
}

// Gives voxels without a measurement a value. In HU it is air. In grey values a fill below
// all others stays what it is, because it is only a guess; what the file itself calls no value gets the fill's, or one below
// all others.
void place_unmeasured(Scan& scan, const Claim& claim, const Range& range, std::size_t filled,
                      float fill) {
  float air = -1024.0F;
  std::string now = "are now air (-1024 HU)";
  if (!scan.hounsfield) {
    // above all others it would be bone
    const bool stays = filled > 0 && fill < range.low;
    air = stays ? fill : below_all(range);
    scan.outside = air;
    now = fmt::format("count nowhere (they hold {:.6g} now)", air);
  }
  for (float& value : scan.values)
    if (std::isnan(value)) value = air;
  if (claim.padded > 0)
    scan.notices.push_back(fmt::format("{} voxels were padding and {}.", claim.padded, now));
  if (filled > 0)
    scan.notices.push_back(
        fmt::format("{} voxels hold {:.6g}, far from all others: they were not measured and {}.",
                    filled, fill, scan.hounsfield || fill > range.low ? now : "count nowhere"));
  if (claim.broken > 0)
    scan.notices.push_back(fmt::format(
        "{} voxels hold no finite number, or one beyond 1e+30; they {}.", claim.broken, now));
}

// Takes out a fill value; the number of its voxels.
std::size_t take_out(Scan& scan, float fill) {
  std::size_t filled = 0;
  for (float& value : scan.values)
    if (value == fill) {
      value = kNothing;
      ++filled;
    }
  return filled;
}

}  // namespace

Status calibrate(Scan& scan, const Claim& claim) {
  scan.hounsfield = false;
  scan.outside.reset();
  ValueSample sample = sample_of(scan);
  if (sample.values.empty()) {
    const float only = range_of(scan).low;
    if (std::isinf(only)) return error("no voxel holds a number");
    sample.values.push_back(only);
    sample.steep.push_back(0);
  }
  const bool has_air = share_between(sample, kAirLow, kAirHigh) > kAirShare;
  if (!has_air && mend_sign(scan, claim, sample)) sample = sample_of(scan);

  std::size_t filled = 0;
  float fill = 0;
  if (const auto found = find_fill(scan, sample)) {
    fill = *found;
    filled = take_out(scan, fill);
    sample = sample_of(scan);
  }
  if (zeros_are_outside(scan, sample)) {
    scan.outside = 0.0F;
    scan.notices.emplace_back(
        "The voxels around the body hold 0, amid the other values: they were not measured and "
        "count "
        "nowhere.");
    sample = sample_of(scan);
  }
  const Range range = range_of(scan);
  const ValueGroups groups = groups_of(sample);
  const std::string why = claim.hounsfield ? contradiction(sample, groups, range) : "";
  const std::size_t unmeasured =
      filled + claim.padded + claim.broken + (scan.outside ? scan.values.size() : 0);
  if (claim.hounsfield && why.empty()) {
    scan.hounsfield = true;
  } else if (claim.hounsfield) {
    scan.notices.push_back(fmt::format(
        "The header says Hounsfield units, but {}: they are read as grey values.", why));
  } else if (claim.can_be_hounsfield &&
             behaves_as_hounsfield(sample, groups, range, scan.values.size(), unmeasured)) {
    scan.hounsfield = true;
    scan.notices.push_back(fmt::format(
        "The values range from {:.0f} to {:.0f}, as in a CT: Hounsfield units are assumed.",
        range.low, range.high));
  }
  if (filled + claim.padded + claim.broken > 0) place_unmeasured(scan, claim, range, filled, fill);

  if (!scan.hounsfield || !claim.clip_below_air) return fine();
  std::size_t below = 0;
  for (float& value : scan.values)
    if (value < -1024.0F) {
      value = -1024.0F;
      ++below;
    }
  if (below > 0)
    scan.notices.push_back(fmt::format(
        "{} voxels were below -1024 HU (outside the scanner's field of view) and are now -1024 HU.",
        below));
  return fine();
}

}  // namespace burr::io

// metrics/near.h - how near the burr is to the structures that matter: force, speed, time and the
// choice of burr, each by distance.
//
//     d = D_S(c) - r        c: centre of the head, r: its radius, D: volume/distance_to.h
//
// d of a moment is the least over the critical structures; beyond the reach of D it is infinite. A
// tick that does not say how large the burr is (a radius of 0, or one that is not finite) has no d
// and counts in no measure here that needs one. D is wrong by up to half a voxel.
// Frame: world. Units: SI. Thread: one per object. Memory: fixed; none per tick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/volume/distance_to.h"

namespace burr::metrics {

inline constexpr double kFar = std::numeric_limits<double>::infinity();
// No distance: no comparison holds for it, so it lies in no range.
inline constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

inline constexpr const char* kNoRadius = "the burr's radius is not recorded";
inline constexpr const char* kNoStructure =
    "no structure is named that the burr could come near to";
inline constexpr const char* kNotInBone =
    "the structure is not in this bone: no voxel has its label";

struct Watched {
  std::string name;
  const volume::DistanceTo* distance = nullptr;  // outlives the measures
};

// The distances of one moment, worked out once for all measures.
class Distances {
 public:
  explicit Distances(std::vector<Watched> watched)
      : watched_(std::move(watched)), d_(watched_.size(), kNoDistance) {}
  void update(const Moment& now);
  [[nodiscard]] const std::vector<Watched>& watched() const { return watched_; }
  // [m]; kNoDistance: the structure is not in the bone, or the radius is not known
  [[nodiscard]] double of(std::size_t n) const { return d_[n]; }
  // [m]; kNoDistance: none of the structures has a distance
  [[nodiscard]] double least() const { return least_; }
  // Why no moment at all has a distance to structure n, or to any of them; empty: some have one.
  [[nodiscard]] std::string why_none(std::size_t n) const;
  [[nodiscard]] std::string why_none() const;

 private:
  std::vector<Watched> watched_;
  std::vector<double> d_;
  double least_ = kNoDistance;
  bool radius_ = false;  // some moment had one
};

// The bins 0 - 1, 1 - 2, 2 - 4 and over 4 mm. Inside a structure counts as the first. d: a number.
inline constexpr std::size_t kBins = 4;
inline constexpr std::array<double, kBins - 1> kBinEnds = {1e-3, 2e-3, 4e-3};  // [m]
[[nodiscard]] std::size_t bin_of(double d);

// A mean that is taken piece by piece.
struct Running {
  double sum = 0, weight = 0;
  void add(double value, double by) {
    sum += value * by;
    weight += by;
  }
  [[nodiscard]] std::optional<double> mean() const {
    return weight > 0 ? std::optional<double>(sum / weight) : std::nullopt;
  }
};

// Values counted in steps of a fixed width: any share of them within one step.
class Histogram {
 public:
  Histogram(double step, std::size_t steps) : step_(step), count_(steps + 1, 0) {}
  void add(double value);
  // The value below which this share lies; none: no values. Above the last step: the largest value.
  [[nodiscard]] std::optional<double> quantile(double share) const;
  [[nodiscard]] double largest() const { return largest_; }

 private:
  double step_, largest_ = 0;
  std::vector<std::uint64_t> count_;
  std::uint64_t all_ = 0;
};

// ---- force in contact
struct ForceByDistance {
  std::array<double, kBins> time = {};                     // in contact [s]
  std::array<std::optional<double>, kBins> bin_mean = {};  // [N]; none: never in contact there
  std::array<double, kBins> bin_peak = {};                 // [N]
  // mean F at d < 2 mm / mean F at d > 4 mm: below 1, the hand is gentler near structures. A ratio
  // survives a change of device, newtons do not. Not assessable: under half a second of contact in
  // either.
  Assessed<double> restraint = NotAssessable{"not measured"};
};

struct ForceNear {
  double mean = 0, p95 = 0, peak = 0;  // of |F| in contact [N]
  double peak_at = 0;                  // [s]
  double seconds = 0;                  // in contact
  // Not assessable: no contact at a known distance.
  Assessed<ForceByDistance> by_distance = NotAssessable{"not measured"};
};

class ForceNearMaker {
 public:
  void add(const Moment& now, double d);
  // Not assessable: the burr never touched bone.
  [[nodiscard]] Assessed<ForceNear> finish(const Distances& distances) const;

 private:
  Histogram forces_{0.01, 4000};  // to 40 N
  Running all_;
  double peak_at_ = 0;
  std::array<Running, kBins> bins_ = {};
  std::array<double, kBins> peaks_ = {};
};

// ---- nearness: how near, how long, how fast
struct Nearness {
  double least = kFar;                          // d [m]
  double least_at = 0;                          // [s]
  math::Vec3 least_place = math::Vec3::Zero();  // centre of the head then
  // time cutting at d < 2, 1, 0.5 mm [s]
  std::array<double, 3> cutting_within = {};
  // How fast d fell at the first crossing of d = 1 mm, over the 50 ms before, or as long as the
  // recording has no gap and the burr is the same [m/s]. A crossing is two ticks, one after the other
  // and with the same burr, the first at 1 mm or farther, the second nearer. None: there is none.
  std::optional<double> approach;
};
struct NearnessOf {
  std::string name;
  Assessed<Nearness> found = NotAssessable{"not measured"};
};
inline constexpr std::array<double, 3> kWithin = {2e-3, 1e-3, 0.5e-3};  // [m]

class NearnessMaker {
 public:
  explicit NearnessMaker(const std::vector<Watched>& watched);
  void add(const Moment& now, const Distances& distances);
  // One for each structure. Not assessable: it is not in the bone, or no radius was recorded.
  [[nodiscard]] std::vector<NearnessOf> finish(const Distances& distances) const;

 private:
  static constexpr std::size_t kPast = 256;  // ticks; 50 ms up to 5 kHz
  struct Past {
    std::array<double, kPast> d = {}, t = {};
    std::size_t next = 0, count = 0;
    double radius = 0;  // of the burr in these ticks [m]
  };
  static void approach(const Moment& now, double d, Past& past, Nearness& found);
  std::vector<Nearness> found_;
  std::vector<Past> past_;
};

// ---- choice of burr
struct BurrChoiceSettings {
  double near = 2e-3, far = 5e-3;  // d [m]
  double small = 2e-3;             // radius of a small burr: at most [m]
  double large = 2e-3;             // radius of a large one: at least [m]
};

struct BurrChoice {
  double near_volume = 0, far_volume = 0;  // removed at d < near, d > far [m^3]
  // of the volume removed near; none: nothing was
  std::optional<double> diamond, small, diamond_or_small;
  // of the volume removed far; none: nothing was
  std::optional<double> large_cutting;
};

class BurrChoiceMaker {
 public:
  explicit BurrChoiceMaker(const BurrChoiceSettings& settings) : settings_(settings) {}
  void add(const Moment& now, double d);
  // Not assessable: no moment in which something was removed has a distance.
  [[nodiscard]] Assessed<BurrChoice> finish(const Distances& distances) const;

 private:
  BurrChoiceSettings settings_;
  bool known_ = false;  // something was removed at a known distance
  double near_ = 0, far_ = 0, diamond_ = 0, small_ = 0, either_ = 0, large_ = 0;  // [m^3]
};

}  // namespace burr::metrics

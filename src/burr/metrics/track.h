// metrics/track.h - the way of the burr at 100 Hz, smoothed, and what holds all along it: the time
// line that strokes, paths and moves are found on.
//
// Each sample is the mean of the ticks of 10 ms. The way is then smoothed by a low pass of 6 Hz
// without delay (Butterworth of 2nd order, forwards and back). A gap in the recording, or a pause of
// the session, begins a new piece; smoothing and all measures stay within a piece.
// Frame: world. Units: SI. Thread: one. Memory: 152 bytes per 10 ms, reserved at the start: none per
// tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/moment.h"
#include "burr/metrics/near.h"
#include "burr/tool/state.h"

namespace burr::metrics {

inline constexpr double kTrackRate = 100;  // [Hz]
inline constexpr double kTrackCorner = 6;  // of the low pass [Hz]

struct TrackSample {
  double t = 0;                          // the middle of its ticks [s]
  math::Vec3 raw = math::Vec3::Zero();   // mean of the burr's centre
  math::Vec3 hand = math::Vec3::Zero();  // mean of the hand
  math::Vec3 p = math::Vec3::Zero();     // raw, smoothed
  double removed = 0;                    // [m^3]
  double d = kNoDistance;  // the least to the critical structures; kNoDistance: not known [m]
  bool touching = false;   // in any of its ticks, as all below
  bool turning = false;
  bool irrigated = false;
  tool::Mode mode = tool::Mode::cut;
  bool diamond = false;  // the burr of the last of its ticks
  double radius = 0;     // of that burr [m]
  double force = 0;      // the largest of its ticks [N]
  [[nodiscard]] bool cutting() const { return removed > 0; }
};

struct Track {
  std::vector<TrackSample> samples;
  std::vector<std::size_t> begins;  // of the pieces: indices into samples

  // Calls use(piece) for each piece, in order.
  template <class Use>
  void for_each_piece(const Use& use) const {
    for (std::size_t n = 0; n < begins.size(); ++n) {
      const std::size_t end = n + 1 < begins.size() ? begins[n + 1] : samples.size();
      use(std::span<const TrackSample>(samples).subspan(begins[n], end - begins[n]));
    }
  }
};

class TrackMaker {
 public:
  // seconds: about how long the recording is; a longer one takes memory once more.
  explicit TrackMaker(double seconds);
  // d: Distances::least()
  void add(const Moment& now, double d);
  [[nodiscard]] Track finish();

 private:
  void close();
  Track track_;
  TrackSample sum_;
  std::uint64_t slot_ = 0;  // of 10 ms
  std::size_t ticks_ = 0;
  bool apart_ = true;  // the next sample begins a piece
};

// Speed along a piece by central differences of p, one per sample [m/s].
[[nodiscard]] std::vector<double> speeds(std::span<const TrackSample> piece);

}  // namespace burr::metrics

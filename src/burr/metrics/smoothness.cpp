#include "burr/metrics/smoothness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/math/sums.h"
#include "burr/metrics/median.h"
#include "burr/metrics/same_math.h"

namespace burr::metrics {
namespace {

constexpr double kHighest = 20, kFloor = 0.05;  // [Hz], share
constexpr int kPadding = 16;
constexpr double kStill = 0.05;  // of the peak
constexpr double kLeastChord = 10e-3, kLeastTime = 0.2, kMostTime = 3;

// |sum of speed_n exp(-i w n)|, w per sample; the turn is made step by step, always in this order.
double amplitude(std::span<const double> speed, double w) {
  const double c = cosine(w), s = sine(w);
  double re = 0, im = 0, x = 1, y = 0;
  for (const double v : speed) {
    re += v * x;
    im += v * y;
    const double next = x * c - y * s;
    y = x * s + y * c;
    x = next;
  }
  return std::sqrt(re * re + im * im);
}

// At least four finite values, and one above 0.
bool is_motion(std::span<const double> speed) {
  const auto finite = [](double v) { return std::isfinite(v); };
  return speed.size() >= 4 && std::all_of(speed.begin(), speed.end(), finite) &&
         *std::max_element(speed.begin(), speed.end()) > 0;
}

using Piece = std::span<const TrackSample>;

void add_move(const Piece& part, std::span<const double> speed, std::vector<Move>& moves) {
  if (part.size() < 4) return;
  Move move{part.front().t, part.back().t, math::norm(part.back().p - part.front().p)};
  const double seconds = move.end - move.begin;
  if (move.chord < kLeastChord || seconds < kLeastTime || seconds > kMostTime) return;
  const auto by_spectrum = sparc(speed, kTrackRate), by_jerk = ldlj(speed, kTrackRate);
  if (!by_spectrum || !by_jerk) return;
  move.sparc = *by_spectrum;
  move.ldlj = *by_jerk;
  moves.push_back(move);
}

// Of a stretch in free air: around each peak of the speed down to standstill.
void find_moves(const Piece& part, std::span<const double> speed, std::vector<Move>& moves) {
  constexpr double kSlow = 10e-3;  // [m/s] slower is standing
  for (std::size_t n = 0; n < part.size();) {
    if (speed[n] < kSlow) {
      ++n;
      continue;
    }
    std::size_t end = n;
    double peak = 0;
    for (; end < part.size() && speed[end] >= kSlow; ++end) peak = std::max(peak, speed[end]);
    std::size_t from = n, to = end;
    while (from > 0 && speed[from] > kStill * peak) --from;
    while (to + 1 < part.size() && speed[to] > kStill * peak) ++to;
    const bool whole =
        speed[from] <= kStill * peak && to < part.size() && speed[to] <= kStill * peak;
    if (whole)
      add_move(part.subspan(from, to + 1 - from), speed.subspan(from, to + 1 - from), moves);
    n = std::max(end, n + 1);
  }
}

}  // namespace

std::optional<double> sparc(std::span<const double> speed, double rate) {
  if (!is_motion(speed)) return std::nullopt;
  std::size_t length = 1;
  while (length < speed.size()) length *= 2;
  length *= kPadding;
  const double step = 2 * kPi / static_cast<double>(length);  // per sample
  const double zero = amplitude(speed, 0);
  if (!(zero > 0)) return std::nullopt;
  const auto most = static_cast<std::size_t>(
      std::floor(std::min(kHighest, 0.5 * rate) / rate * static_cast<double>(length)));
  std::vector<double> spectrum(most + 1);
  std::size_t last = 0;
  for (std::size_t n = 0; n <= most; ++n) {
    spectrum[n] = amplitude(speed, step * static_cast<double>(n)) / zero;
    if (spectrum[n] >= kFloor) last = n;
  }
  if (last == 0) return std::nullopt;
  const double share = 1 / static_cast<double>(last);
  double arc = 0;
  for (std::size_t n = 1; n <= last; ++n) {
    const double rise = spectrum[n] - spectrum[n - 1];
    arc += std::sqrt(share * share + rise * rise);
  }
  return -arc;
}

std::optional<double> ldlj(std::span<const double> speed, double rate) {
  if (!is_motion(speed)) return std::nullopt;
  const double peak = *std::max_element(speed.begin(), speed.end());
  const double seconds = static_cast<double>(speed.size() - 1) / rate;
  double jerk = 0;
  for (std::size_t n = 1; n + 1 < speed.size(); ++n) {
    const double second = (speed[n + 1] - 2 * speed[n] + speed[n - 1]) * rate * rate;
    jerk += second * second / rate;
  }
  // the two ends, as long as half a step each, by the neighbours' values
  const auto ends = [&](std::size_t n) {
    const double second = (speed[n + 1] - 2 * speed[n] + speed[n - 1]) * rate * rate;
    return 0.5 * second * second / rate;
  };
  jerk += ends(1) + ends(speed.size() - 2);
  if (!(jerk > 0)) return std::nullopt;
  return -logarithm(seconds * seconds * seconds / (peak * peak) * jerk);
}

std::vector<Move> moves_of(const Track& track) {
  std::vector<Move> moves;
  track.for_each_piece([&](const Piece& piece) {
    const std::vector<double> speed = speeds(piece);
    for (std::size_t n = 0; n < piece.size();) {
      if (piece[n].touching) {
        ++n;
        continue;
      }
      std::size_t end = n;
      while (end < piece.size() && !piece[end].touching) ++end;
      find_moves(piece.subspan(n, end - n), std::span<const double>(speed).subspan(n, end - n),
                 moves);
      n = end;
    }
  });
  return moves;
}

Assessed<Smoothness> smoothness_of(std::span<const Move> moves) {
  if (moves.size() < 5) return NotAssessable{"fewer than five free moves"};
  std::vector<double> by_spectrum, by_jerk;
  for (const Move& one : moves) {
    by_spectrum.push_back(one.sparc);
    by_jerk.push_back(one.ldlj);
  }
  return Smoothness{moves.size(), median(std::move(by_spectrum)), median(std::move(by_jerk))};
}

}  // namespace burr::metrics

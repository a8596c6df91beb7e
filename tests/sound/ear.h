// tests/sound/ear.h - measures samples without using the synth's own formulas.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "burr/sound/synth.h"

namespace burr::test {

inline constexpr double kRate = 48e3;  // [Hz]

// Power in each bin of the discrete Fourier transform of all samples, Hann window; bin k is at k
// kRate / size.
inline std::vector<double> spectrum(std::span<const float> samples) {
  const std::size_t size = samples.size();
  std::vector<double> windowed(size);
  for (std::size_t n = 0; n < size; ++n)
    windowed[n] =
        static_cast<double>(samples[n]) *
        (0.5 - 0.5 * std::cos(2 * M_PI * static_cast<double>(n) / static_cast<double>(size)));
  std::vector<std::complex<double>> bins;
  Eigen::FFT<double> transform;
  transform.fwd(bins, windowed);
  std::vector<double> power(size / 2);
  for (std::size_t k = 0; k < power.size(); ++k) power[k] = std::norm(bins[k]);
  return power;
}

// Frequency of the largest power, from `lowest` on [Hz]
inline double peak_hz(std::span<const float> samples, double lowest = 20) {
  const std::vector<double> power = spectrum(samples);
  const double bin = kRate / static_cast<double>(samples.size());
  const auto from = power.begin() + static_cast<std::ptrdiff_t>(std::ceil(lowest / bin));
  const auto most = std::max_element(from, power.end());
  return static_cast<double>(most - power.begin()) * bin;
}

// The centroid of its power [Hz]
inline double centroid_hz(std::span<const float> samples) {
  const std::vector<double> power = spectrum(samples);
  double sum = 0, weighted = 0;
  for (std::size_t k = 1; k < power.size(); ++k) {
    sum += power[k];
    weighted += static_cast<double>(k) * power[k];
  }
  return weighted / sum * kRate / static_cast<double>(samples.size());
}

inline double rms(std::span<const float> samples) {
  double sum = 0;
  for (const float x : samples) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

inline double largest(std::span<const float> samples) {
  double most = 0;
  for (const float x : samples) most = std::max(most, std::abs(static_cast<double>(x)));
  return most;
}

// Its sharpest bend: a click is a sample that does not continue those before it.
inline double sharpest(std::span<const float> samples) {
  double most = 0;
  for (std::size_t n = 2; n < samples.size(); ++n)
    most = std::max(
        most, std::abs(static_cast<double>(samples[n]) - 2.0 * static_cast<double>(samples[n - 1]) +
                       static_cast<double>(samples[n - 2])));
  return most;
}

inline std::vector<float> made(sound::Synth& synth, double seconds) {
  std::vector<float> samples(static_cast<std::size_t>(seconds * kRate));
  synth.make(samples);
  return samples;
}

// the last `count` samples
inline std::vector<float> end_of(const std::vector<float>& samples, std::size_t count) {
  return {samples.end() - static_cast<std::ptrdiff_t>(count), samples.end()};
}

inline double rad_s(double rpm) { return rpm * 2 * M_PI / 60; }

}  // namespace burr::test

#include "burr/people/observer.h"

#include <algorithm>
#include <cmath>

namespace burr::people {
namespace {

// sqrt(2) times the 75 % point of the normal distribution
constexpr double kAtThreshold = 1.4142135623730951 * 0.6744897501960817;

RandomStream random_stream_of(std::uint64_t seed, const Trial& trial) {
  return RandomStream(seed, 1000 + static_cast<std::uint64_t>(trial.number));
}

}  // namespace

int KnowingObserver::answer(const Trial& trial) const {
  RandomStream random = random_stream_of(seed_, trial);
  const bool right = random.uniform() < truth_.right(trial.level);
  return right ? trial.right_answer() : 3 - trial.right_answer();
}

FeelingObserver::FeelingObserver(Stimulus stimulus, double threshold, double lapse,
                                 std::uint64_t seed)
    : stimulus_(stimulus),
      sigma_((stimulus == Stimulus::vibration ? threshold : std::log1p(threshold)) / kAtThreshold),
      lapse_(lapse),
      seed_(seed) {}

int FeelingObserver::answer(const Trial& trial, double first, double second) const {
  RandomStream random = random_stream_of(seed_, trial);
  // an inattentive observer is right half the time
  if (random.uniform() < 2 * lapse_) return 1 + random.below(2);
  const auto sensed = [&](double felt) {
    const double size = stimulus_ == Stimulus::vibration ? felt : std::log(std::max(1e-9, felt));
    return size + sigma_ * random.normal();
  };
  const double one = sensed(first), two = sensed(second);
  return one > two ? 1 : 2;
}

}  // namespace burr::people

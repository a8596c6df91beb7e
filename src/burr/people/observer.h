// people/observer.h - an observer whose threshold is known, to see whether an experiment finds it.
//
// KnowingObserver answers by its psychometric function; it proves the estimator. FeelingObserver
// is given what each interval felt like, adds noise of its own and says which was more; it proves
// the stimuli too. Its noise is normal, of the logarithm for stiffness and friction (Weber), of
// newtons for vibration, and such that without lapses half of what guessing leaves is right at the
// threshold: 2 Phi(d / (sqrt(2) sigma)) - 1 = 1/2.
//
// Each trial has random numbers of its own, so an interrupted observer goes on as the same person.
// Thread: any. Memory: none.
#pragma once

#include "burr/people/experiment.h"

namespace burr::people {

class KnowingObserver {
 public:
  KnowingObserver(const Psychometric& truth, std::uint64_t seed) : truth_(truth), seed_(seed) {}

  // The interval it says was more.
  [[nodiscard]] int answer(const Trial& trial) const;

 private:
  Psychometric truth_;
  std::uint64_t seed_;
};

class FeelingObserver {
 public:
  // threshold: in units of the level; lapse: as of the psychometric function
  FeelingObserver(Stimulus stimulus, double threshold, double lapse, std::uint64_t seed);

  // first, second: what the intervals felt like, people/felt.h.
  [[nodiscard]] int answer(const Trial& trial, double first, double second) const;

 private:
  Stimulus stimulus_;
  double sigma_, lapse_;
  std::uint64_t seed_;
};

}  // namespace burr::people

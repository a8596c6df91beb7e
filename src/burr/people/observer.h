// people/observer.h - simulated observers with a known threshold, to check that an experiment finds
// it.
//
// KnowingObserver answers by its psychometric function; it tests the estimator. FeelingObserver
// gets what each interval felt like, adds its own noise and names the one that was more; it tests
// the stimuli too. Its noise is normal: of the logarithm for stiffness and friction (Weber), in
// newtons for vibration. It is set so that at the threshold, without lapses, half of the answers
// beyond chance are right: 2 Phi(d / (sqrt(2) sigma)) - 1 = 1/2.
//
// Each trial has its own random numbers, so an interrupted observer continues as the same person.
// Thread: any. Memory: none.
#pragma once

#include "burr/people/experiment.h"

namespace burr::people {

class KnowingObserver {
 public:
  KnowingObserver(const Psychometric& truth, std::uint64_t seed) : truth_(truth), seed_(seed) {}

  // The interval that it names as more.
  [[nodiscard]] int answer(const Trial& trial) const;

 private:
  Psychometric truth_;
  std::uint64_t seed_;
};

class FeelingObserver {
 public:
  // threshold: in units of the level; lapse: as of the psychometric function
  FeelingObserver(Stimulus stimulus, double threshold, double lapse, std::uint64_t seed);

  // first, second: what was felt in the intervals, from people/felt.h.
  [[nodiscard]] int answer(const Trial& trial, double first, double second) const;

 private:
  Stimulus stimulus_;
  double sigma_, lapse_;
  std::uint64_t seed_;
};

}  // namespace burr::people

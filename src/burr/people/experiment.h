// people/experiment.h - a two-interval forced-choice experiment: what is presented next, in which
// order, and what follows from the answers.
//
//     Experiment experiment(plan);
//     while (!experiment.finished()) {
//       const Trial trial = experiment.next();
//       ... show(trial.shown(1)), show(trial.shown(2)), ask which was more ...
//       experiment.answer(1 or 2);
//     }
//     experiment.outcome().fit.threshold
//
// Everything but the answers follows from the plan and its seed, so answers read from a file bring
// an experiment back to its state. In every ten trials the comparison comes first five times.
// Thread: one. Memory: one row per trial.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "burr/people/fit.h"
#include "burr/people/psi.h"
#include "burr/people/random_stream.h"
#include "burr/people/staircase.h"

namespace burr::people {

enum class Stimulus { stiffness, friction, vibration };
inline constexpr std::array<std::string_view, 3> kStimulusNames = {"stiffness", "friction",
                                                                   "vibration"};
enum class Method { bayes, staircase, constant };
inline constexpr std::array<std::string_view, 3> kMethodNames = {"bayes", "staircase", "constant"};

[[nodiscard]] constexpr std::string_view name(Stimulus stimulus) {
  return kStimulusNames[static_cast<std::size_t>(stimulus)];
}
[[nodiscard]] constexpr std::string_view name(Method method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}
[[nodiscard]] constexpr std::string_view name(Rule rule) {
  return kRuleNames[static_cast<std::size_t>(rule)];
}

struct Plan {
  Stimulus stimulus = Stimulus::stiffness;
  // N/m, coefficient, or N root mean square. For vibration, 0: the standard has none.
  double standard = 400;
  // Levels. Stiffness and friction: how much more the comparison has, as a share of the standard
  // (Weber's fraction). Vibration: what is added [N].
  double smallest = 0.01, largest = 1;
  Method method = Method::bayes;
  Rule rule = Rule::one_up_two_down;  // of the staircase
  int trials = 300;                   // at most
  double until = 0;  // ends when the interval is within this share of the threshold; 0: all trials
  int levels = 7;    // of constant stimuli, evenly spaced in the logarithm from smallest to largest
  double guess = 0.5, lapse = 0.02;  // of the fitted function
  std::uint64_t seed = 1;
};

struct Trial {
  int number = 1;
  double level = 0;
  double standard = 0, comparison = 0;
  bool comparison_first = false;
  // The stimulus in the first or second interval.
  [[nodiscard]] double shown(int interval) const {
    return (interval == 1) == comparison_first ? comparison : standard;
  }
  [[nodiscard]] int right_answer() const { return comparison_first ? 1 : 2; }
};

struct Answered {
  Trial trial;
  int answer = 0;  // the interval that was named as more: 1 or 2
  [[nodiscard]] bool right() const { return answer == trial.right_answer(); }
};

struct Outcome {
  Fit fit;
  std::vector<Tally> tallies;     // by increasing level
  std::optional<double> settled;  // of a staircase: at target_of(rule)
  int trials = 0, comparison_first = 0, said_first = 0;
};

class Experiment {
 public:
  explicit Experiment(const Plan& plan);

  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] const Trial& next() const { return next_; }  // while the experiment is not finished
  void answer(int interval);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const std::vector<Answered>& answered() const { return answered_; }
  [[nodiscard]] Outcome outcome() const;

 private:
  void prepare();
  [[nodiscard]] double level();

  Plan plan_;
  RandomStream order_, blocks_;
  std::variant<Psi, Staircase, std::vector<double>> chooser_;  // constant stimuli: levels to come
  std::vector<bool> orders_;
  std::vector<Answered> answered_;
  Trial next_;
  bool finished_ = false;
};

}  // namespace burr::people

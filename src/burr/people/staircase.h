// people/staircase.h - a staircase: the level goes down after right answers and up after wrong
// ones, and settles where both are equally likely.
//
//     one wrong up, two right down    p^2 = 1/2                    70.7 %   (Levitt 1971)
//     one wrong up, three right down  p^3 = 1/2                    79.4 %
//     weighted                        p down = (1 - p) up, 1 : 3   75.0 %   (Kaernbach 1991)
//
// Steps are factors: large ones until the level has reversed four times, then small ones. The
// result is the geometric mean of the levels at the reversals after that, an even number of them.
//
// Thread: one. Memory: the reversals.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace burr::people {

enum class Rule { one_up_two_down, one_up_three_down, weighted };
inline constexpr std::array<std::string_view, 3> kRuleNames = {"1up2down", "1up3down", "weighted"};

// The share of right answers at which the staircase settles.
[[nodiscard]] double target_of(Rule rule);

struct StaircaseSettings {
  Rule rule = Rule::one_up_two_down;
  double start = 1, smallest = 0.01, largest = 1;
  double first_step = 1.5;  // factor, for the first coarse_turns reversals
  int coarse_turns = 4;
  double step = 1.1;  // factor after that; for the weighted rule the one down
};

class Staircase {
 public:
  explicit Staircase(const StaircaseSettings& settings);

  [[nodiscard]] double level() const { return level_; }
  void answer(bool right);

  // Number of reversals with small steps so far.
  [[nodiscard]] const std::vector<double>& turns() const { return turns_; }
  // Where it settles; nothing before four reversals with small steps.
  [[nodiscard]] std::optional<double> found() const;

 private:
  void go(int way, double factor);

  StaircaseSettings settings_;
  double level_;
  int right_in_a_row_ = 0;
  int way_ = 0;  // last direction: 1 up, -1 down
  int turned_ = 0;
  std::vector<double> turns_;
};

}  // namespace burr::people

#include "burr/people/staircase.h"

#include <algorithm>
#include <cmath>

namespace burr::people {

double target_of(Rule rule) {
  switch (rule) {
    case Rule::one_up_two_down:
      return std::sqrt(0.5);
    case Rule::one_up_three_down:
      return std::cbrt(0.5);
    case Rule::weighted:
      return 0.75;
  }
  return 0.5;
}

Staircase::Staircase(const StaircaseSettings& settings)
    : settings_(settings),
      level_(std::clamp(settings.start, settings.smallest, settings.largest)) {}

void Staircase::go(int way, double factor) {
  if (way_ != 0 && way != way_) {
    if (turned_ >= settings_.coarse_turns) turns_.push_back(level_);
    ++turned_;
  }
  way_ = way;
  level_ = std::clamp(way > 0 ? level_ * factor : level_ / factor, settings_.smallest,
                      settings_.largest);
}

void Staircase::answer(bool right) {
  const double step = turned_ < settings_.coarse_turns ? settings_.first_step : settings_.step;
  if (!right) {
    right_in_a_row_ = 0;
    go(1, settings_.rule == Rule::weighted ? std::pow(step, 3) : step);
    return;
  }
  ++right_in_a_row_;
  const int needed = settings_.rule == Rule::one_up_two_down     ? 2
                     : settings_.rule == Rule::one_up_three_down ? 3
                                                                 : 1;
  if (right_in_a_row_ < needed) return;
  right_in_a_row_ = 0;
  go(-1, step);
}

std::optional<double> Staircase::found() const {
  const std::size_t even = turns_.size() / 2 * 2;
  if (even < 4) return std::nullopt;
  double sum = 0;
  for (std::size_t n = turns_.size() - even; n < turns_.size(); ++n) sum += std::log(turns_[n]);
  return std::exp(sum / static_cast<double>(even));
}

}  // namespace burr::people

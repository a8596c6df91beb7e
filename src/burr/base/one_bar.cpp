#include "burr/base/one_bar.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace burr::base {
namespace {

constexpr std::string_view kOf = " of ", kBehind = ": ";

// Takes a number and the text behind it off the front of `text`.
bool take(std::string_view& text, int& number, std::string_view behind) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  if (!text.starts_with(behind)) return false;
  text.remove_prefix(behind.size());
  return true;
}

}  // namespace

OneBar::OneBar(Progress& whole, std::vector<Step> steps)
    : whole_(whole), steps_(std::move(steps)), passes_(dynamic_cast<OneBar*>(&whole) != nullptr) {
  for (const Step& step : steps_) all_ += step.share;
}

// later: not the stage at hand, but one behind it.
bool OneBar::find(std::string_view stage, bool later) {
  for (std::size_t s = step_; s < steps_.size(); ++s) {
    const auto& stages = steps_[s].stages;
    const std::size_t from = s > step_ ? 0 : stage_ + (later ? 1 : 0);
    for (std::size_t n = from; n < stages.size(); ++n) {
      if (stages[n] != stage) continue;
      step_ = s;
      stage_ = n;
      return true;
    }
  }
  return false;
}

void OneBar::report(double fraction, std::string_view stage) {
  if (passes_ || steps_.size() < 2) return whole_.report(fraction, stage);
  fraction = std::clamp(fraction, 0.0, 1.0);
  constexpr double kBack = 0.3;  // more than threads that report one after another may differ
  const bool again = stage == last_ && fraction < done_ - kBack;
  if (stage != last_ || again) {
    static_cast<void>(find(stage, again));
    last_ = stage;
    done_ = 0;
  }
  done_ = std::max(done_, fraction);
  double before = 0;
  for (std::size_t s = 0; s < step_; ++s) before += steps_[s].share;
  const Step& now = steps_[step_];
  const auto parts = static_cast<double>(now.stages.size());
  const bool named = now.stages[stage_] == stage;
  const double in_step = (static_cast<double>(stage_) + (named ? fraction : 0)) / parts;
  told_ = std::max(told_, (before + now.share * in_step) / all_);
  std::string text = std::to_string(step_ + 1);
  text.append(kOf).append(std::to_string(steps_.size())).append(kBehind).append(stage);
  whole_.report(told_, text);
}

std::optional<NumberedStage> numbered_stage(std::string_view stage) {
  NumberedStage found;
  if (!take(stage, found.number, kOf) || !take(stage, found.of, kBehind)) return std::nullopt;
  found.words = stage;
  return found;
}

}  // namespace burr::base

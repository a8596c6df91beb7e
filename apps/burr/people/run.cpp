#include "people/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "burr/base/printable.h"

namespace burr::app {
namespace {

using people::Stimulus;

std::optional<double> number_of(const std::string& text) {
  if (text == "inf") return INFINITY;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

Error bad_observer(const std::string& part, const char* what) {
  return error(Trouble::usage,
               fmt::format("--observer: '{}' {}; give e.g. threshold=0.12,slope=3.5,lapse=0.02,"
                           "seed=1,feels=yes",
                           base::printable(part), what));
}

}  // namespace

Result<ObserverRequest> read_observer(const std::string& words) {
  ObserverRequest request;
  bool has_slope = false, has_threshold = false;
  for (std::size_t from = 0; from <= words.size();) {
    const std::size_t to = std::min(words.find(',', from), words.size());
    const std::string part = words.substr(from, to - from);
    from = to + 1;
    const std::size_t is = part.find('=');
    if (is == std::string::npos) return bad_observer(part, "is not name=value");
    const std::string name = part.substr(0, is), value = part.substr(is + 1);
    if (name == "feels") {
      if (value != "yes" && value != "no") return bad_observer(part, "is neither yes nor no");
      request.feels = value == "yes";
      continue;
    }
    const std::optional<double> number = number_of(value);
    if (!number) return bad_observer(part, "is not a number");
    if (name == "threshold") {
      if (!(*number > 0)) return bad_observer(part, "is not above 0");
      request.threshold = *number;
      has_threshold = true;
    } else if (name == "slope") {
      if (!(*number >= 0.5 && *number <= 12)) return bad_observer(part, "is not 0.5 to 12");
      request.slope = *number;
      has_slope = true;
    } else if (name == "lapse") {
      if (!(*number >= 0 && *number <= 0.2)) return bad_observer(part, "is not 0 to 0.2");
      request.lapse = *number;
    } else if (name == "seed") {
      if (!(*number >= 0 && *number < 1e15 && *number == std::floor(*number)))
        return bad_observer(part, "is not a whole number of at least 0");
      request.seed = static_cast<std::uint64_t>(*number);
    } else {
      return bad_observer(part, "is not known");
    }
  }
  if (!has_threshold) return bad_observer(words, "has no threshold");
  if (request.feels && has_slope)
    return bad_observer(words, "has a slope; with feels=yes the slope comes from the noise");
  if (request.feels && std::isinf(request.threshold))
    return bad_observer(words, "feels nothing; for an observer that guesses, leave out feels=yes");
  return request;
}

const char* unit_of(Stimulus stimulus) {
  return stimulus == Stimulus::stiffness ? "N/m" : stimulus == Stimulus::friction ? "" : "N";
}

const char* question_of(Stimulus stimulus) {
  switch (stimulus) {
    case Stimulus::stiffness:
      return "Press. Which of the two was stiffer?";
    case Stimulus::friction:
      return "Rub. Which of the two rubbed more?";
    case Stimulus::vibration:
      return "Hold it against the wall. Which of the two vibrated more?";
  }
  return "";
}

const char* level_unit_of(Stimulus stimulus) {
  return stimulus == Stimulus::vibration ? "N rms" : "of the standard";
}

people::Plan usual_plan(Stimulus stimulus) {
  people::Plan plan;
  plan.stimulus = stimulus;
  if (stimulus == Stimulus::friction) {
    plan.standard = 0.4;
    plan.largest = 1.5;
  }
  if (stimulus == Stimulus::vibration) {
    plan.standard = 0;
    plan.smallest = 0.002;
    plan.largest = sim::Wall::kMostVibration;
  }
  return plan;
}

Status check(const PeopleRun& run) {
  const people::Plan& plan = run.plan;
  const auto usage = [](std::string text) { return error(Trouble::usage, std::move(text)); };
  if (plan.trials < 10 || plan.trials > 5000)
    return usage(fmt::format("--trials {} is out of range; use 10 to 5000", plan.trials));
  if (!(plan.smallest > 0 && plan.smallest < 0.5 * plan.largest && plan.largest < 100))
    return usage(
        fmt::format("--smallest {:g} and --largest {:g} are too close; the smallest must be above "
                    "0 and the largest at least twice that",
                    plan.smallest, plan.largest));
  if (!(plan.standard >= 0 && std::isfinite(plan.standard)) ||
      (plan.standard == 0 && plan.stimulus != Stimulus::vibration))
    return usage(
        fmt::format("--standard {:g} is not possible; it is the value to compare with, e.g. {:g}",
                    plan.standard, usual_plan(plan.stimulus).standard));
  if (!(plan.until == 0 || (plan.until >= 0.02 && plan.until <= 1)))
    return usage(fmt::format("--until {:g} is out of range; use 0.02 to 1, or 0 for all trials",
                             plan.until));
  if (!(plan.lapse >= 0 && plan.lapse <= 0.2))
    return usage(fmt::format("--lapse {:g} is out of range; use 0 to 0.2", plan.lapse));
  if (!(run.seconds >= 1.5 && run.seconds <= 60))
    return usage(fmt::format("--seconds {:g} is out of range; use 1.5 to 60", run.seconds));
  if (!(run.wall.rate_hz >= 500 && run.wall.rate_hz <= 10000))
    return usage(fmt::format("--rate {:g} is out of range; use 500 to 10000 Hz", run.wall.rate_hz));
  if (run.subject.size() > 16)
    return usage("--subject is longer than 16 characters; give a code, not a name");
  for (const char c : run.subject)
    if (!(std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_'))
      return usage(
          "--subject has other characters than letters, digits, - and _; give a code, not a name");
  return fine();
}

std::string result_words(const PeopleRun& run, const people::Experiment& experiment) {
  const people::Outcome out = experiment.outcome();
  const people::Fit& fit = out.fit;
  std::string words = fmt::format("{} trials: ", out.trials);
  if (!fit.found) return words + fit.why;
  const people::Plan& plan = run.plan;
  words += fmt::format("threshold {:.4g} {} (95 % interval {:.4g} to {:.4g}), slope {:.2g}",
                       fit.best.threshold, level_unit_of(plan.stimulus), fit.low, fit.high,
                       fit.best.slope);
  if (plan.stimulus != Stimulus::vibration) {
    const char* unit = unit_of(plan.stimulus);
    words += fmt::format("; at {:g}{}{} that is {:.4g}{}{}", plan.standard, *unit != 0 ? " " : "",
                         unit, plan.standard * fit.best.threshold, *unit != 0 ? " " : "", unit);
  }
  if (out.settled)
    words += fmt::format("; the staircase settled at {:.4g} ({:.1f} % right)", *out.settled,
                         100 * people::target_of(plan.rule));
  return words;
}

}  // namespace burr::app

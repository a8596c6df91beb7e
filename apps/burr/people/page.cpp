// A run on one page: the psychometric function with the answers, and the level of each trial.
#include <fmt/format.h>

#include <cmath>

#include "burr/base/markup.h"
#include "burr/base/version.h"
#include "people/run.h"
#include "verify/page.h"

namespace burr::app {
namespace {

constexpr int kDot = 20;      // least number of answers in a dot of the plot
constexpr int kPoints = 120;  // number of points of a curve

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>burr psychophysics</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 1100px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; font-size: 13px; margin: 1em 0 }
td { border: 1px solid #ddd; padding: 2px 8px } figcaption { color: #444; max-width: 75em } svg { max-width: 100%; height: auto }
</style></head><body>
)";

// Joins neighbouring levels, so that a dot stands for more than one or two answers.
Line dots(const std::vector<people::Tally>& tallies) {
  Line line{fmt::format("answers, {} or more a dot", kDot), {}, {}, false, true};
  double place = 0;
  int trials = 0, right = 0;
  for (std::size_t n = 0; n < tallies.size(); ++n) {
    place += tallies[n].trials * std::log(tallies[n].level);
    trials += tallies[n].trials;
    right += tallies[n].right;
    if (trials < kDot && n + 1 < tallies.size()) continue;
    line.x.push_back(std::exp(place / trials));
    line.y.push_back(100.0 * right / trials);
    place = trials = right = 0;
  }
  return line;
}

Axes function(const PeopleRun& run, const people::Outcome& out) {
  const people::Plan& plan = run.plan;
  Axes axes;
  axes.title = fmt::format("{}: psychometric function", name(plan.stimulus));
  axes.x = fmt::format("difference [{}]", level_unit_of(plan.stimulus));
  axes.y = "right answers [%]";
  axes.log_x = true;
  axes.lines.push_back(dots(out.tallies));
  const auto curve = [&](const people::Psychometric& model, std::string legend, bool dashed) {
    Line line{std::move(legend), {}, {}, dashed, false};
    for (int n = 0; n <= kPoints; ++n) {
      const double level =
          plan.smallest * std::pow(plan.largest / plan.smallest, 1.0 * n / kPoints);
      line.x.push_back(level);
      line.y.push_back(100 * model.right(level));
    }
    axes.lines.push_back(std::move(line));
  };
  if (out.fit.found) {
    const people::Psychometric& best = out.fit.best;
    curve(best, "found", false);
    const double height = 100 * best.right(best.threshold);
    axes.lines.push_back({"threshold, 95 %", {out.fit.low, out.fit.high}, {height, height}});
  }
  if (run.observer && !run.observer->feels) {
    people::Psychometric truth{run.observer->threshold, run.observer->slope, plan.guess,
                               run.observer->lapse};
    curve(truth, "the observer's own", true);
  }
  return axes;
}

Axes track(const PeopleRun& run, const people::Experiment& experiment) {
  Axes axes;
  axes.title = "levels, trial by trial";
  axes.x = "trial";
  axes.y = fmt::format("difference [{}]", level_unit_of(run.plan.stimulus));
  axes.log_y = true;
  Line all{"level", {}, {}, false, false}, wrong{"wrong answer", {}, {}, false, true};
  for (const people::Answered& one : experiment.answered()) {
    all.x.push_back(one.trial.number);
    all.y.push_back(one.trial.level);
    if (one.right()) continue;
    wrong.x.push_back(one.trial.number);
    wrong.y.push_back(one.trial.level);
  }
  axes.lines = {std::move(all), std::move(wrong)};
  return axes;
}

}  // namespace

std::string result_page(const PeopleRun& run, const people::Experiment& experiment) {
  const people::Outcome out = experiment.outcome();
  const people::Plan& plan = run.plan;
  Plot plot{"", 2, {function(run, out), track(run, experiment)}};
  std::string html = kHead;
  html += fmt::format("<h1>{}</h1>\n<p>{}.</p>\n<figure>{}<figcaption>", name(plan.stimulus),
                      base::markup_text(result_words(run, experiment)), svg(plot));
  html += base::markup_text(
      fmt::format("Left: how often the answer was right, over the difference from the standard of "
                  "{:g} {}. The threshold is half way between guessing (50 %) and the highest "
                  "rate, which only lapses ({:g} %) limit; the short line across it is its 95 % "
                  "interval. Right: the difference presented in each trial.",
                  plan.standard, unit_of(plan.stimulus), 100 * plan.lapse));
  html += "</figcaption></figure>\n<table>\n";
  const auto row = [&](const char* what, const std::string& value) {
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", what, base::markup_text(value));
  };
  row("question", question_of(plan.stimulus));
  row("answered by", run.observer ? fmt::format("a simulated observer{}, threshold {:g}, seed {}",
                                                run.observer->feels ? " that feels" : "",
                                                run.observer->threshold, run.observer->seed)
                                  : "a person");
  if (!run.subject.empty()) row("subject", run.subject);
  row("device", run.device_id.empty() ? run.device : run.device_id);
  row("method", plan.method == people::Method::staircase
                    ? fmt::format("{} {}", name(plan.method), name(plan.rule))
                    : std::string(name(plan.method)));
  row("trials", fmt::format("{}{}", out.trials,
                            experiment.finished() ? "" : fmt::format(" of {}", plan.trials)));
  row("comparison first, first said",
      fmt::format("{} and {} times", out.comparison_first, out.said_first));
  row("seed", std::to_string(plan.seed));
  row("program", fmt::format("burr {}", base::version()));
  return html + "</table></body></html>\n";
}

}  // namespace burr::app

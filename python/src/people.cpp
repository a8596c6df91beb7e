// Experiments on what a person can tell apart (docs/understand/psychophysics.md): what is shown
// next, and what follows from the answers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "burr/people/experiment.h"
#include "common.h"

namespace burr::python {
namespace {

using namespace py::literals;

template <class Enum, class Names>
Enum named(const std::string& word, const Names& names, const char* what) {
  for (std::size_t n = 0; n < names.size(); ++n)
    if (names[n] == word) return static_cast<Enum>(n);
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  raise(fmt::format("{} \"{}\" is not known; use one of {}", what, word, list));
}

// As `burr psychophysics` has it.
people::Plan usual(people::Stimulus stimulus) {
  people::Plan plan;
  plan.stimulus = stimulus;
  if (stimulus == people::Stimulus::friction) {
    plan.standard = 0.4;
    plan.largest = 1.5;
  } else if (stimulus == people::Stimulus::vibration) {
    plan.standard = 0;
    plan.smallest = 0.002;
    plan.largest = 0.15;
  }
  return plan;
}

people::Experiment make(const std::string& stimulus, const py::object& standard,
                        const py::object& smallest, const py::object& largest,
                        const std::string& method, const std::string& rule, int trials,
                        double until, int levels, double lapse, std::uint64_t seed) {
  people::Plan plan = usual(named<people::Stimulus>(stimulus, people::kStimulusNames, "stimulus"));
  plan.method = named<people::Method>(method, people::kMethodNames, "method");
  plan.rule = named<people::Rule>(rule, people::kRuleNames, "rule");
  if (!standard.is_none()) plan.standard = standard.cast<double>();
  if (!smallest.is_none()) plan.smallest = smallest.cast<double>();
  if (!largest.is_none()) plan.largest = largest.cast<double>();
  plan.trials = trials;
  plan.until = until;
  plan.levels = levels;
  plan.lapse = lapse;
  plan.seed = seed;
  if (!(plan.smallest > 0 && plan.largest > plan.smallest && plan.largest <= 1e3))
    raise("the levels must go from smallest, above 0, to a larger largest");
  if (!(plan.standard >= 0 && std::isfinite(plan.standard)))
    raise("the standard must be a number of 0 or more");
  if (trials < 1 || trials > 100'000) raise("trials must be 1 to 100000");
  if (levels < 2 || levels > 50) raise("levels must be 2 to 50");
  if (!(lapse >= 0 && lapse <= 0.2)) raise("lapse must be 0 to 0.2");
  if (!(until >= 0 && until < 1)) raise("until must be 0 to 1");
  return people::Experiment(plan);
}

py::dict outcome_of(const people::Experiment& experiment) {
  const people::Outcome out = experiment.outcome();
  py::dict made("found"_a = out.fit.found, "why"_a = out.fit.why,
                "threshold"_a = out.fit.best.threshold, "low"_a = out.fit.low,
                "high"_a = out.fit.high, "slope"_a = out.fit.best.slope, "trials"_a = out.trials,
                "settled"_a = py::none());
  if (!out.fit.found)
    for (const char* key : {"threshold", "low", "high", "slope"}) made[key] = py::none();
  if (out.settled) made["settled"] = *out.settled;
  return made;
}

}  // namespace

void add_people(py::module_& module) {
  py::class_<people::Trial> trial(module, "Trial", "Two intervals; which of them has more?");
  trial.def_readonly("number", &people::Trial::number);
  trial.def_readonly("level", &people::Trial::level);
  trial.def_readonly("standard", &people::Trial::standard);
  trial.def_readonly("comparison", &people::Trial::comparison);
  trial.def_property_readonly("right_answer", &people::Trial::right_answer);
  trial.def(
      "shown",
      [](const people::Trial& self, int interval) {
        if (interval != 1 && interval != 2) raise("the interval is 1 or 2");
        return self.shown(interval);
      },
      "interval"_a);
  py::class_<people::Experiment> experiment(
      module, "Experiment", "A two-interval experiment (docs/understand/psychophysics.md).");
  experiment.def(py::init(&make), "stimulus"_a = "stiffness", py::kw_only(),
                 "standard"_a = py::none(), "smallest"_a = py::none(), "largest"_a = py::none(),
                 "method"_a = "bayes", "rule"_a = "1up2down", "trials"_a = 300, "until"_a = 0.0,
                 "levels"_a = 7, "lapse"_a = 0.02, "seed"_a = 1);
  experiment.def_property_readonly("finished", &people::Experiment::finished);
  experiment.def("next", [](const people::Experiment& self) {
    if (self.finished()) raise("this experiment is finished; see outcome()");
    return self.next();
  });
  experiment.def(
      "answer",
      [](people::Experiment& self, int interval) {
        if (self.finished()) raise("this experiment is finished; see outcome()");
        if (interval != 1 && interval != 2) raise("the answer is 1 or 2: the interval with more");
        self.answer(interval);
      },
      "interval"_a);
  experiment.def("outcome", &outcome_of);
}

}  // namespace burr::python

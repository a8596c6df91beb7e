// apps/burr/people/run.h - one run of `burr psychophysics`: its settings, and the files in which it
// is kept.
//
//     DIR/trials.csv   a row per trial         DIR/result.json  the result, and the settings
//     DIR/result.html  the same as a page
//
// Thread: one. No name, date or place of a person: at most a code.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/people/experiment.h"
#include "burr/sim/trial_interval.h"

namespace burr::app {

// A simulated observer with a known threshold.
struct ObserverRequest {
  double threshold = 0.15, slope = 3.5, lapse = 0.02;
  std::uint64_t seed = 1;
  bool feels = false;  // presses, rubs and holds still, instead of answering by formula
};

struct PeopleRun {
  people::Plan plan;
  sim::WallSettings wall;
  double seconds = 3;  // longest interval
  std::string device = "simulated", subject;
  std::string device_id = {};               // name and serial number of a real device
  std::optional<ObserverRequest> observer;  // none: a person answers
};

// "threshold=0.12,slope=3.5,lapse=0.02,seed=1,feels=yes"
[[nodiscard]] Result<ObserverRequest> read_observer(const std::string& words);

// The unit of a stimulus, and the question for the person.
[[nodiscard]] const char* unit_of(people::Stimulus stimulus);
[[nodiscard]] const char* question_of(people::Stimulus stimulus);
// The unit of a level: a share, or newtons.
[[nodiscard]] const char* level_unit_of(people::Stimulus stimulus);

// Sensible standard and levels for a stimulus.
[[nodiscard]] people::Plan usual_plan(people::Stimulus stimulus);
// Refuses settings with which no experiment is possible; names the option.
[[nodiscard]] Status check(const PeopleRun& run);

// seconds[n]: response time of the n-th answer; below 0: not a person.
[[nodiscard]] Status save_trials(const std::string& folder, const people::Experiment& experiment,
                                 const std::vector<double>& seconds);
[[nodiscard]] Status save_result(const std::string& folder, const PeopleRun& run,
                                 const people::Experiment& experiment);
[[nodiscard]] std::string result_json(const PeopleRun& run, const people::Experiment& experiment);
// One page that needs no other file.
[[nodiscard]] std::string result_page(const PeopleRun& run, const people::Experiment& experiment);
// The result in a sentence.
[[nodiscard]] std::string result_words(const PeopleRun& run, const people::Experiment& experiment);

// An interrupted run and its answers.
struct Unfinished {
  PeopleRun run;
  std::vector<int> answers;
  std::vector<double> levels;   // to be compared with those of the plan
  std::vector<double> seconds;  // as in save_trials
};
[[nodiscard]] Result<Unfinished> load_run(const std::string& folder);

}  // namespace burr::app

// apps/burr/people/run.h - one run of `burr psychophysics`: what was asked for, and the files in
// which it is kept.
//
//     DIR/trials.csv   a row a trial     DIR/result.json   what came out, and the run itself
//     DIR/result.html  the same to look at
//
// Thread: one. No name, date or place of a person: at most a code.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/people/experiment.h"
#include "burr/sim/interval.h"

namespace burr::app {

// A simulated observer of known threshold.
struct ObserverRequest {
  double threshold = 0.15, slope = 3.5, lapse = 0.02;
  std::uint64_t seed = 1;
  bool feels = false;  // presses, rubs and holds instead of answering by formula
};

struct PeopleRun {
  people::Plan plan;
  sim::WallSettings wall;
  double seconds = 3;  // of an interval, at most
  std::string device = "simulated", subject;
  std::string device_id = {};               // name and serial number of a real one
  std::optional<ObserverRequest> observer;  // none: a person answers
};

// "threshold=0.12,slope=3.5,lapse=0.02,seed=1,feels=yes"
[[nodiscard]] Result<ObserverRequest> read_observer(const std::string& words);

// What belongs to a stimulus: its unit, and what the person is asked.
[[nodiscard]] const char* unit_of(people::Stimulus stimulus);
[[nodiscard]] const char* question_of(people::Stimulus stimulus);
// Of a level: a share, or newtons.
[[nodiscard]] const char* level_unit_of(people::Stimulus stimulus);

// Sensible standard and levels of a stimulus.
[[nodiscard]] people::Plan usual_plan(people::Stimulus stimulus);
// Refuses what no experiment can be made of; names the option.
[[nodiscard]] Status check(const PeopleRun& run);

// seconds[n]: how long the n-th answer took; below 0: no person.
[[nodiscard]] Status save_trials(const std::string& folder, const people::Experiment& experiment,
                                 const std::vector<double>& seconds);
[[nodiscard]] Status save_result(const std::string& folder, const PeopleRun& run,
                                 const people::Experiment& experiment);
[[nodiscard]] std::string result_json(const PeopleRun& run, const people::Experiment& experiment);
// One page that needs nothing beside it.
[[nodiscard]] std::string result_page(const PeopleRun& run, const people::Experiment& experiment);
// In a sentence.
[[nodiscard]] std::string result_words(const PeopleRun& run, const people::Experiment& experiment);

// A run that was broken off, and its answers.
struct Unfinished {
  PeopleRun run;
  std::vector<int> answers;
  std::vector<double> levels;   // to be compared with what the plan gives
  std::vector<double> seconds;  // as in save_trials
};
[[nodiscard]] Result<Unfinished> load_run(const std::string& folder);

}  // namespace burr::app

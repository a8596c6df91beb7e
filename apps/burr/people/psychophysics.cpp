// burr psychophysics - measures how small a difference of stiffness, friction or vibration a person
// can feel: two intervals, one answer, some hundred times.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "batch/row_command.h"
#include "burr/people/observer.h"
#include "burr/sim/feeling.h"
#include "burr/workshop/hand_device.h"
#include "people/run.h"
#include "scenes/wall.h"
#include "shared/front_words.h"
#include "shared/hand_options.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/setting_options.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using people::Stimulus;
using people::Trial;
using Clock = std::chrono::steady_clock;

constexpr const char* kSimulated = "simulated";
constexpr double kAbove = 20e-3;  // height above the wall at which the tip starts [m]

struct Options {
  std::string stimulus, device = kSimulated, method = "bayes", rule = "1up2down", observer, subject,
                        out, go_on;
  std::optional<double> standard, smallest, largest;
  int trials = 300;
  double until = 0, lapse = 0.02, seconds = 3, rate_hz = 1000;
  std::uint64_t seed = 1;
  bool json = false;
  workshop::HandRequest hand;  // only homing is used
};

template <class T, std::size_t N>
T named(const std::array<std::string_view, N>& names, const std::string& text) {
  return static_cast<T>(std::find(names.begin(), names.end(), text) - names.begin());
}

Result<PeopleRun> run_of(const Options& options) {
  PeopleRun run;
  run.plan = usual_plan(named<Stimulus>(people::kStimulusNames, options.stimulus));
  run.plan.standard = options.standard.value_or(run.plan.standard);
  run.plan.smallest = options.smallest.value_or(run.plan.smallest);
  run.plan.largest = options.largest.value_or(run.plan.largest);
  run.plan.method = named<people::Method>(people::kMethodNames, options.method);
  run.plan.rule = named<people::Rule>(people::kRuleNames, options.rule);
  run.plan.trials = options.trials;
  run.plan.until = options.until;
  run.plan.lapse = options.lapse;
  run.plan.seed = options.seed;
  run.seconds = options.seconds;
  run.wall.rate_hz = options.rate_hz;
  run.device = options.device;
  run.subject = options.subject;
  if (!options.observer.empty()) {
    auto observer = read_observer(options.observer);
    if (!observer) return observer.error();
    run.observer = *observer;
  }
  return run;
}

// Shows the intervals and gets the answers, from a person or a simulated observer.
class Lab {
 public:
  // hand: of an open device; nullptr: the simulated one
  Lab(const PeopleRun& run, device::MappedHand* hand)
      : run_(run), wall_(scenes::wall, run.wall), hand_(hand) {}

  // Refuses the run before the first trial if this device could not show one of its intervals.
  Status possible() {
    const people::Plan& plan = run_.plan;
    const double most = plan.stimulus == Stimulus::vibration ? plan.standard + plan.largest
                                                             : plan.standard * (1 + plan.largest);
    return wall_.check_device(hand_ != nullptr ? hand_->spec() : device::DeviceSpec{},
                              wall_.of(plan.stimulus, most));
  }

  // 1 or 2; 0: there are no more answers. took: response time of a person [s].
  Result<int> ask(const Trial& trial, double& took) {
    took = -1;
    if (run_.observer && !run_.observer->feels) {
      const ObserverRequest& request = *run_.observer;
      return people::KnowingObserver(
                 {request.threshold, request.slope, run_.plan.guess, request.lapse}, request.seed)
          .answer(trial);
    }
    std::array<double, 2> felt = {};
    for (const int interval : {1, 2}) {
      if (!run_.observer)
        fmt::print(stderr, "trial {} of {}, interval {} ...\n", trial.number, run_.plan.trials,
                   interval);
      auto one = show(trial, interval);
      if (!one) return one.error();
      felt[static_cast<std::size_t>(interval - 1)] = *one;
      if (interrupted()) return 0;
    }
    if (!run_.observer) return person(took);
    const ObserverRequest& request = *run_.observer;
    return people::FeelingObserver(run_.plan.stimulus, request.threshold, request.lapse,
                                   request.seed)
        .answer(trial, felt[0], felt[1]);
  }

 private:
  Result<double> show(const Trial& trial, int interval) {
    return hand_ != nullptr ? show_to_hand(trial, interval) : show_to_simulated(trial, interval);
  }

  // An interval in which the device released the force is shown again.
  Result<double> show_to_hand(const Trial& trial, int interval) {
    while (true) {
      auto felt = wall_.show(*hand_, wall_.of(run_.plan.stimulus, trial.shown(interval)),
                             run_.seconds, [] { return interrupted() || key(); });
      if (!felt) return felt.error();
      const std::string trouble = hand_->trouble();
      if (trouble.empty() || interrupted()) return sim::sensed(run_.plan.stimulus, *felt);
      fmt::print(stderr, "{} Interval {} again ...\n", in_options(trouble), interval);
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }

  // Each time with another gesture.
  Result<double> show_to_simulated(const Trial& trial, int interval) {
    const int gesture = (trial.number + 2 * interval) % sim::kGestures;
    device::SimulatedHand hand(
        sim::gesture_for(run_.plan.stimulus, gesture, run_.wall, run_.seconds), {});
    if (Status opened = hand.open(); !opened) return opened.error();
    auto felt = wall_.show(hand, wall_.of(run_.plan.stimulus, trial.shown(interval)), run_.seconds,
                           [] { return interrupted(); });
    if (!felt) return felt.error();
    return sim::sensed(run_.plan.stimulus, *felt);
  }

  // A line was typed: the interval is over.
  static bool key() {
    pollfd in = {.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (isatty(STDIN_FILENO) == 0 || poll(&in, 1, 0) <= 0) return false;
    std::string line;
    std::getline(std::cin, line);
    return true;
  }

  int person(double& took) {
    const auto began = Clock::now();
    while (!interrupted()) {
      fmt::print(stderr, "{} 1 or 2, then Enter: ", question_of(run_.plan.stimulus));
      std::string line;
      if (!std::getline(std::cin, line)) return 0;
      took = std::chrono::duration<double>(Clock::now() - began).count();
      if (line == "1" || line == "2") return line == "1" ? 1 : 2;
    }
    return 0;
  }

  const PeopleRun& run_;
  sim::Wall wall_;
  device::MappedHand* hand_;
};

// The device of the run, aligned with the wall: right is right, up is up. From then on the wall
// uses its rate, its user's limit and its stiffness. nullptr: the simulated hand.
Result<std::unique_ptr<device::MappedHand>> take_hand(const Options& options, PeopleRun& run) {
  if (run.device == kSimulated) return std::unique_ptr<device::MappedHand>();
  if (run.observer)
    return error(Trouble::usage, "an --observer works with the simulated hand; leave out --device");
  workshop::HandRequest request = options.hand;
  request.device = run.device;
  math::Pose above;
  above.p = {0, 0, run.wall.burr_radius + kAbove};
  auto laid = workshop::open_hand(request, above,
                                  math::Quat(Eigen::AngleAxisd(M_PI / 2, math::Vec3::UnitX())));
  if (!laid) return laid.error();
  print_notices(laid->notices);
  run.device_id = laid->id;
  run.wall.rate_hz = workshop::tick_rate(laid->hand->spec());
  run.wall.user_force = laid->max_force;
  run.wall.other_stiffness = std::min(run.wall.other_stiffness, laid->hand->spec().max_stiffness);
  return std::move(laid->hand);
}

Result<Unfinished> begin(const Options& options) {
  if (!options.go_on.empty()) return load_run(options.go_on);
  if (options.stimulus.empty())
    return error(Trouble::usage, fmt::format("name the stimulus: {}; or give --continue DIR",
                                             fmt::join(people::kStimulusNames, ", ")));
  auto run = run_of(options);
  if (!run) return run.error();
  return Unfinished{*run, {}, {}, {}};
}

// given: takes the findings; nullptr: it is printed.
Status run(const Options& options, CommandResult* given) {
  auto begun = begin(options);
  if (!begun) return begun.error();
  auto hand = take_hand(options, begun->run);
  if (!hand) return hand.error();
  const PeopleRun& run = begun->run;
  if (Status sound = check(run); !sound) return sound;
  Lab lab(run, hand->get());
  if (Status can = lab.possible(); !can) return can;
  const std::string folder = options.go_on.empty() ? options.out : options.go_on;

  people::Experiment experiment(run.plan);
  std::vector<double> seconds = begun->seconds;
  for (std::size_t n = 0; n < begun->answers.size(); ++n) {
    if (experiment.finished() ||
        std::abs(experiment.next().level - begun->levels[n]) > 1e-9 * begun->levels[n])
      return error(
          fmt::format("{}/trials.csv: trial {} differs from the plan; the file was changed, or "
                      "written by another version of burr; start again without --continue",
                      folder, n + 1));
    experiment.answer(begun->answers[n]);
  }
  const auto save = [&](bool all) {
    if (folder.empty()) return fine();
    if (Status done = save_trials(folder, experiment, seconds); !done) return done;
    return all ? save_result(folder, run, experiment) : fine();
  };
  if (Status done = save(true); !done) return done;  // a folder that cannot be made is reported now

  bool left = false;
  while (!experiment.finished() && !interrupted() && !left) {
    double took = -1;
    auto answer = lab.ask(experiment.next(), took);
    if (!answer) return answer.error();
    left = *answer == 0;
    if (left) break;
    experiment.answer(*answer);
    seconds.push_back(took);
    if (!run.observer)  // the answers of a person are never lost
      if (Status done = save(false); !done) return done;
    progress().report(static_cast<double>(seconds.size()) / run.plan.trials, "trials");
  }
  if (Status done = save(true); !done) return done;
  if (given != nullptr)
    given->result = nlohmann::json::parse(result_json(run, experiment));
  else if (options.json)
    fmt::print("{}\n", json_line(nlohmann::json::parse(result_json(run, experiment))));
  else
    fmt::print("{}\n", result_words(run, experiment));
  if (experiment.finished()) return fine();
  return error(
      Trouble::interrupted,
      folder.empty()
          ? fmt::format("stopped after {} trials; they were not kept, because --out was not given",
                        seconds.size())
          : fmt::format("stopped after {} trials; continue with burr psychophysics --continue {}",
                        seconds.size(), folder));
}

// chosen: gets the options when they were parsed.
void add_psychophysics(CLI::App& app,
                       const std::function<void(std::shared_ptr<const Options>)>& chosen) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "psychophysics",
      "measure the smallest difference that a person feels: two intervals per trial, one answer");
  command
      ->add_option("stimulus", options->stimulus,
                   "the stimulus: stiffness [N/m], friction, or vibration [N rms]")
      ->check(CLI::IsMember(people::kStimulusNames));
  command
      ->add_option("--device", options->device,
                   fmt::format("the hand: simulated, or one of {}", workshop::kinds_known()))
      ->capture_default_str();
  add_homing_options(*command, options->hand);
  command->add_option("--observer", options->observer,
                      "threshold=T[,slope=S][,lapse=L][,seed=N][,feels=yes]: simulated; "
                      "default: a person answers 1 or 2");
  command->add_option("--method", options->method, "method that chooses the levels")
      ->check(CLI::IsMember(people::kMethodNames))
      ->capture_default_str();
  command->add_option("--rule", options->rule, "rule of the staircase")
      ->check(CLI::IsMember(people::kRuleNames))
      ->capture_default_str();
  command->add_option("--trials", options->trials, "largest number of trials")
      ->capture_default_str();
  command
      ->add_option(
          "--until", options->until,
          "end when the 95 % interval is narrower than this share to either side; 0: never")
      ->capture_default_str();
  command->add_option("--standard", options->standard,
                      "the standard to compare with (default: 400 N/m, 0.4, 0 N)");
  command->add_option("--smallest", options->smallest,
                      "smallest difference, as a share of the standard; for vibration [N]");
  command->add_option("--largest", options->largest,
                      "largest difference (default: 1 for stiffness, 1.5 for friction, 0.15 N)");
  command->add_option("--lapse", options->lapse, "assumed lapse rate of the person")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "longest duration of an interval")
      ->capture_default_str();
  add_setting_option(*command, "rate_hz", options->rate_hz);
  command->add_option("--seed", options->seed, "seed of orders and levels")->capture_default_str();
  command->add_option("--subject", options->subject,
                      "code of the person: at most 16 letters, digits, - and _; not a name");
  auto* out = command->add_option("--out", options->out,
                                  "DIR: write trials.csv, result.json, result.html there");
  command
      ->add_option("--continue", options->go_on,
                   "DIR: continue an interrupted run; all other options are read from there")
      ->excludes(out);
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, chosen] { chosen(options); });
}

void add(CLI::App& app, Todo& todo) {
  add_psychophysics(
      app, [&todo](auto options) { todo.work = [options] { return run(*options, nullptr); }; });
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_psychophysics(app, [&todo](auto options) {
    todo.work = [options](CommandResult& findings) -> Status {
      if (options->observer.empty())
        return error(Trouble::usage, "--observer: is missing; a row has nobody who answers");
      return run(*options, &findings);
    };
  });
}

const Command command{55, add};
const RowCommand row_command{"psychophysics", add_row};

}  // namespace
}  // namespace burr::app

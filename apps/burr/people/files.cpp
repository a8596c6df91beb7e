// The files of a run, and how an unfinished run is continued.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "burr/base/new_file.h"
#include "burr/base/plain_file.h"
#include "burr/base/version.h"
#include "people/run.h"

namespace burr::app {
namespace {

using nlohmann::json;

constexpr const char* kHead =
    "trial,order,level,standard,comparison,answer,right,response_s";  // order: position of the
                                                                      // comparison

Status write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code trouble;
  std::filesystem::create_directories(path.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made: {}; choose another folder",
                                          path.parent_path().string(), trouble.message()));
  auto file = base::NewFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  return file->put_in_place();
}

json finite(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json plan_json(const PeopleRun& run) {
  const people::Plan& plan = run.plan;
  json out = {{"stimulus", name(plan.stimulus)},
              {"standard", plan.standard},
              {"smallest", plan.smallest},
              {"largest", plan.largest},
              {"method", name(plan.method)},
              {"rule", name(plan.rule)},
              {"trials", plan.trials},
              {"until", plan.until},
              {"levels", plan.levels},
              {"guess", plan.guess},
              {"lapse", plan.lapse},
              {"seed", plan.seed},
              {"seconds", run.seconds},
              {"rate_hz", run.wall.rate_hz},
              {"burr_radius_m", run.wall.burr_radius},
              {"user_force_N", run.wall.user_force},
              {"vibration_hz", run.wall.vibration_hz},
              {"other_stiffness_N_m", run.wall.other_stiffness},
              {"device", run.device},
              {"device_id", run.device_id},
              {"subject", run.subject}};
  if (run.observer)
    out["observer"] = {{"threshold", finite(run.observer->threshold)},
                       {"slope", run.observer->slope},
                       {"lapse", run.observer->lapse},
                       {"seed", run.observer->seed},
                       {"feels", run.observer->feels}};
  return out;
}

template <class T, std::size_t N>
T named(const std::array<std::string_view, N>& names, const json& value) {
  const auto text = value.get<std::string>();
  for (std::size_t n = 0; n < N; ++n)
    if (names[n] == text) return static_cast<T>(n);
  throw std::invalid_argument("unknown name");
}

PeopleRun run_of(const json& in) {
  PeopleRun run;
  people::Plan& plan = run.plan;
  plan.stimulus = named<people::Stimulus>(people::kStimulusNames, in.at("stimulus"));
  plan.method = named<people::Method>(people::kMethodNames, in.at("method"));
  plan.rule = named<people::Rule>(people::kRuleNames, in.at("rule"));
  in.at("standard").get_to(plan.standard);
  in.at("smallest").get_to(plan.smallest);
  in.at("largest").get_to(plan.largest);
  in.at("trials").get_to(plan.trials);
  in.at("until").get_to(plan.until);
  in.at("levels").get_to(plan.levels);
  in.at("guess").get_to(plan.guess);
  in.at("lapse").get_to(plan.lapse);
  in.at("seed").get_to(plan.seed);
  in.at("seconds").get_to(run.seconds);
  in.at("rate_hz").get_to(run.wall.rate_hz);
  in.at("burr_radius_m").get_to(run.wall.burr_radius);
  in.at("user_force_N").get_to(run.wall.user_force);
  in.at("vibration_hz").get_to(run.wall.vibration_hz);
  in.at("other_stiffness_N_m").get_to(run.wall.other_stiffness);
  in.at("device").get_to(run.device);
  run.device_id = in.value("device_id", "");
  in.at("subject").get_to(run.subject);
  if (const auto found = in.find("observer"); found != in.end()) {
    ObserverRequest request;
    const json& threshold = found->at("threshold");
    request.threshold = threshold.is_null() ? INFINITY : threshold.get<double>();
    found->at("slope").get_to(request.slope);
    found->at("lapse").get_to(request.lapse);
    found->at("seed").get_to(request.seed);
    found->at("feels").get_to(request.feels);
    run.observer = request;
  }
  return run;
}

}  // namespace

Status save_trials(const std::string& folder, const people::Experiment& experiment,
                   const std::vector<double>& seconds) {
  std::string text = fmt::format("{}\n", kHead);
  for (std::size_t n = 0; n < experiment.answered().size(); ++n) {
    const people::Answered& one = experiment.answered()[n];
    text += fmt::format("{},{},{:.17g},{:.9g},{:.9g},{},{},{}\n", one.trial.number,
                        one.trial.right_answer(), one.trial.level, one.trial.standard,
                        one.trial.comparison, one.answer, one.right() ? 1 : 0,
                        seconds[n] >= 0 ? fmt::format("{:.3f}", seconds[n]) : "");
  }
  return write_file(std::filesystem::path(folder) / "trials.csv", text);
}

std::string result_json(const PeopleRun& run, const people::Experiment& experiment) {
  const people::Outcome out = experiment.outcome();
  const people::Fit& fit = out.fit;
  const people::Plan& plan = run.plan;
  json result = {{"burr", base::version()},
                 {"run", plan_json(run)},
                 {"unit", unit_of(plan.stimulus)},
                 {"level_unit", level_unit_of(plan.stimulus)},
                 {"question", question_of(plan.stimulus)},
                 {"answered_by", !run.observer         ? "a person"
                                 : run.observer->feels ? "a simulated observer that feels"
                                                       : "a simulated observer"},
                 {"finished", experiment.finished()},
                 {"trials", out.trials},
                 {"comparison_first", out.comparison_first},
                 {"said_first", out.said_first},
                 {"found", fit.found},
                 {"threshold", nullptr},
                 {"low", nullptr},
                 {"high", nullptr},
                 {"slope", nullptr}};
  if (fit.found) {
    result["threshold"] = fit.best.threshold;
    result["low"] = fit.low;
    result["high"] = fit.high;
    result["slope"] = fit.best.slope;
    result["right_at_threshold"] = fit.best.right(fit.best.threshold);
  } else {
    result["why"] = fit.why;
  }
  if (plan.method == people::Method::staircase)
    result["staircase"] = {{"target", people::target_of(plan.rule)},
                           {"settled", out.settled ? json(*out.settled) : json(nullptr)}};
  return result.dump(1);
}

Status save_result(const std::string& folder, const PeopleRun& run,
                   const people::Experiment& experiment) {
  const std::filesystem::path into(folder);
  if (Status done = write_file(into / "result.json", result_json(run, experiment) + "\n"); !done)
    return done;
  return write_file(into / "result.html", result_page(run, experiment));
}

Result<Unfinished> load_run(const std::string& folder) {
  const std::filesystem::path from(folder);
  const std::string result = (from / "result.json").string(),
                    trials = (from / "trials.csv").string();
  for (const std::string& one : {result, trials})
    if (const Status plain = base::check_plain_file(one); !plain) return plain.error();
  std::ifstream file(result);
  if (!file)
    return error(
        Trouble::io,
        fmt::format("{}: cannot be read; --continue needs the folder of an earlier --out", result));
  Unfinished out;
  try {
    out.run = run_of(json::parse(file).at("run"));
  } catch (const std::exception&) {
    return error(fmt::format(
        "{}: the field run was not written by burr psychophysics; start again without --continue",
        result));
  }
  std::ifstream rows(trials);
  std::string line;
  if (!std::getline(rows, line) || line != kHead)
    return error(Trouble::io, fmt::format("{}: has not the columns {}; start again without "
                                          "--continue",
                                          trials, kHead));
  while (std::getline(rows, line)) {
    std::vector<std::string> cells;
    std::istringstream parts(line + ",");
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    double level = 0, took = -1;
    try {
      level = std::stod(cells.at(2));
      if (!cells.at(7).empty()) took = std::stod(cells.at(7));
    } catch (const std::exception&) {
      cells.clear();
    }
    if (cells.size() != 8 || (cells[5] != "1" && cells[5] != "2"))
      return error(fmt::format("{}: trial {} is not {}; take that line and all after it away",
                               trials, out.answers.size() + 1, kHead));
    out.answers.push_back(cells[5] == "1" ? 1 : 2);
    out.levels.push_back(level);
    out.seconds.push_back(took);
  }
  return out;
}

}  // namespace burr::app

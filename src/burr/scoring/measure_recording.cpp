#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "burr/base/printable.h"
#include "burr/metrics/process.h"
#include "burr/record/course.h"
#include "burr/scoring/measure.h"
#include "burr/scoring/score.h"
#include "burr/scoring/step_order.h"

namespace burr::scoring {
namespace {

constexpr std::string_view kSoft = "intact_soft", kSolid = "untouched", kOrder = "order";

// What the steps of the case spare, without plates of bone, which are to be thinned.
std::vector<std::string> critical(const scenario::CaseLesson& lesson) {
  std::vector<std::string> names;
  for (const scenario::Structure& one : lesson.structures) {
    const auto spares = [&](const scenario::Step& step) {
      return std::find(step.spare.begin(), step.spare.end(), one.name) != step.spare.end();
    };
    if (one.intact != scenario::Intact::plate &&
        std::any_of(lesson.steps.begin(), lesson.steps.end(), spares))
      names.push_back(one.name);
  }
  return names;
}

Outcome soft(const Item& item, const metrics::Process& process, double rate_hz) {
  for (const metrics::Process::SoftResult& one : process.soft) {
    if (one.name != item.id) continue;
    if (!one.intact) return not_assessable(item, one.intact.reason());
    Outcome out = decided(item, one.intact->entered, "how deep a turning burr went in", false);
    if (one.intact->entered.value > 0) {
      out.place = one.intact->deepest_place;
      out.tick = static_cast<std::uint64_t>(std::llround(one.intact->deepest_at * rate_hz));
    } else {
      out.value = 0;  // it stayed outside; by how much is no merit
    }
    return out;
  }
  return not_assessable(item, "the bone has no label of it");
}

// How long a turning burr touched a structure of solid tissue.
Outcome untouched(const Item& item, const metrics::Process& process, Workpiece& scene,
                  double rate_hz) {
  for (const metrics::Process::SolidResult& one : process.solid) {
    if (one.name != item.id) continue;
    if (!one.contacts) return not_assessable(item, one.contacts.reason());
    const metrics::Contacts& contacts = *one.contacts;
    Outcome out = decided(
        item,
        metrics::intact_mark(contacts.seconds(), item.limit("most_s"), 1 / rate_hz, scene.worked()),
        "time that a turning burr touched it", false);
    if (contacts.list().empty()) return out;
    out.place = contacts.list().front().at;
    out.tick = static_cast<std::uint64_t>(std::llround(contacts.list().front().begin * rate_hz));
    return out;
  }
  return not_assessable(item, "the bone has no label of it");
}

Outcome burr_choice(const Item& item, const metrics::Process& process) {
  if (!process.choice) return not_assessable(item, process.choice.reason());
  const auto& share = process.choice->diamond_or_small;
  if (!share) return not_assessable(item, "nothing was removed near what is to be spared");
  const double least = item.limit("share");
  return decided(item, {*share >= least, true, *share, least, 0},
                 "share removed with a diamond or small burr within 1 mm", true);
}

Outcome restraint(const Item& item, const metrics::Process& process, double rate_hz) {
  if (!process.force) return not_assessable(item, process.force.reason());
  if (!process.force->by_distance) return not_assessable(item, process.force->by_distance.reason());
  const auto& restrained = process.force->by_distance->restraint;
  if (!restrained) return not_assessable(item, restrained.reason());
  const double value = *restrained, most = item.limit("most");
  Outcome out = decided(item, {value <= most, true, value, most, 0},
                        "force within 2 mm / force beyond 4 mm", false);
  out.tick = static_cast<std::uint64_t>(std::llround(process.force->peak_at * rate_hz));
  return out;
}

std::vector<metrics::StepMark> marks_of(const record::Player& player) {
  std::vector<metrics::StepMark> marks;
  for (const record::CourseEvent& event : player.course()) {
    const double t = static_cast<double>(event.tick) / player.info().rate_hz;
    if (event.kind == record::CourseKind::step_done)
      marks.push_back({t, event.what, metrics::StepEvent::done});
    if (event.kind == record::CourseKind::step_reopened)
      marks.push_back({t, event.what, metrics::StepEvent::reopened});
  }
  return marks;
}

Outcome order(const Item& item, const StepOrder& found) {
  if (found.done < 2)
    return not_assessable(item, "the recording names fewer than two steps as done");
  const double most = item.limit("most"), wrong = static_cast<double>(found.wrong);
  return decided(item, {wrong <= most, true, wrong, most, 0}, "pairs of steps in the wrong order",
                 false);
}

Figures figures_of(const metrics::Process& process, Workpiece& scene,
                   const record::Player& player) {
  std::vector<std::string> regions;
  for (const scenario::Step& step : scene.lesson().steps)
    if (!step.region.empty() && !step.adds) regions.push_back(step.region);
  Figures out;
  out.times = process.times;
  out.paths = process.paths;
  out.strokes = metrics::figures_of(process.strokes);
  out.economy = metrics::economy_of(process.track, process.paths.all, process.strokes.size(),
                                    regions.empty() ? metrics::Region() : scene.regions(regions));
  out.speed = metrics::speed_near(process.track);
  out.shaft = process.shaft;
  out.dwell = process.dwell;
  out.motor = process.motor;
  out.reaction =
      metrics::reaction_of(metrics::cues_of(player.course(), player.info().rate_hz), std::nullopt);
  return out;
}

}  // namespace

RecordingPass::RecordingPass(const Rubric& rubric, Workpiece& scene, record::Player& player)
    : player_(player) {
  const auto distance = [&](const std::string& structure) {
    return kept_.emplace_back(scene.distance(structure)).get();
  };
  settings_.choice.near = kNearCut;
  settings_.choice.small = kSmallBurr;
  for (const std::string& name : critical(scene.lesson()))
    if (!scene.tissues(name).empty()) settings_.critical.push_back({name, distance(name)});
  for (const Item& item : rubric.items)
    if (item.how->name == kSoft && !scene.tissues(item.structure).empty())
      settings_.soft.push_back({item.id,
                                &scene.voxels(item.structure),
                                distance(item.structure),
                                scene.worked(),
                                {.p2 = item.limit("deep_mm")}});
  for (const Item& item : rubric.items)
    if (item.how->name == kSolid && !scene.tissues(item.structure).empty())
      settings_.solid.push_back({item.id, scene.tissues(item.structure),
                                 kept_.emplace_back(scene.distance_to_solid()).get(),
                                 scene.before().grid().voxel});
}

void RecordingPass::start(Progress& progress) {
  thread_.emplace(rt::ThreadRequest{.name = "score"}, [this, &progress] {
    class Quiet final : public Progress {  // the caller's reports are about the bone meanwhile
     public:
      Quiet(const Progress& caller, std::atomic<double>& fraction)
          : caller_(caller), fraction_(fraction) {}
      void report(double fraction, std::string_view) override { fraction_ = fraction; }
      [[nodiscard]] bool cancelled() const override { return caller_.cancelled(); }

     private:
      const Progress& caller_;
      std::atomic<double>& fraction_;
    } quiet(progress, fraction_);
    process_ = metrics::process_of(player_, settings_, quiet);
    ended_ = true;
  });
}

Result<metrics::Process> RecordingPass::finish(Progress& progress) {
  while (!ended_) {
    progress.report(fraction_, "measuring what was done");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  thread_.reset();  // joins
  return std::move(process_);
}

bool needs_recording(const Item& item) {
  return item.part == Part::process || item.how->name == kSoft || item.how->name == kSolid;
}

std::vector<Outcome> measure_recording(const Rubric& rubric, Workpiece& scene,
                                       const record::Player& player, metrics::Process process,
                                       Shown& shown) {
  std::vector<Outcome> out;
  const double rate_hz = player.info().rate_hz;
  Figures figures = figures_of(process, scene, player);
  StepOrder steps = step_order(scene.lesson(), marks_of(player));
  for (const Item& item : rubric.items) {
    if (!needs_recording(item)) continue;
    const std::string_view how = item.how->name;
    auto manner = measure_manner(item, process, figures, scene.lesson());
    out.push_back(manner                 ? *std::move(manner)
                  : how == kSoft         ? soft(item, process, rate_hz)
                  : how == kSolid        ? untouched(item, process, scene, rate_hz)
                  : how == kOrder        ? order(item, steps)
                  : how == "burr_choice" ? burr_choice(item, process)
                                         : restraint(item, process, rate_hz));
  }
  shown.figures = std::move(figures);
  shown.track = std::move(process.track);
  shown.nearness = std::move(process.nearness);
  shown.strokes = std::move(process.strokes);
  shown.steps = std::move(steps.steps);
  return out;
}

}  // namespace burr::scoring

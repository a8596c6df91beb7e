// scoring/measure.h - the measure of one item becomes its outcome. For use of this room only.
//
// `requires` is not applied here. Thread: one at a time.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/process.h"
#include "burr/record/player.h"
#include "burr/rt/thread.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/outcome.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/shown.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {

[[nodiscard]] Outcome not_assessable(const Item& item, std::string reason);
// The number that decided.
[[nodiscard]] Outcome decided(const Item& item, const metrics::Mark& mark, const char* what,
                              bool at_least);

// An item about the shape of the cut: a planned axis, plane or cavity; none: it is about something else.
[[nodiscard]] std::optional<Outcome> measure_shape(const Item& item, Workpiece& scene);
// An item about the manner of work; none: it is about something else.
[[nodiscard]] std::optional<Outcome> measure_manner(const Item& item,
                                                    const metrics::Process& process,
                                                    const Figures& figures,
                                                    const scenario::CaseLesson& lesson);
// An item that the two bones decide.
[[nodiscard]] Outcome measure_bone(const Item& item, Workpiece& scene);

// The pass over the ticks of a recording, on a thread of its own: meanwhile the caller measures the bone. The scene is used by
// the constructor only, and it says when that was stopped.
class RecordingPass {
 public:
  // The player is kept by reference, and is the pass's alone from start() to finish(). So are, as long as the pass lives, the
  // voxels of structures that the scene has.
  RecordingPass(const Rubric& rubric, Workpiece& scene, record::Player& player);
  // progress: kept until finish(); the other thread calls only its cancelled().
  void start(Progress& progress);
  // Waits for the end of the pass. Error: as of metrics::process_of().
  [[nodiscard]] Result<metrics::Process> finish(Progress& progress);

 private:
  record::Player& player_;
  std::vector<std::shared_ptr<const volume::DistanceTo>> kept_;  // of settings_
  metrics::ProcessSettings settings_;
  std::atomic<double> fraction_ = 0;
  std::atomic<bool> ended_ = false;
  Result<metrics::Process> process_ = error("not measured yet");
  std::optional<rt::Thread> thread_;  // last: joins before the rest goes
};
// The items that the recording decides, in the order of the rubric; `shown` gets the way of the burr.
[[nodiscard]] std::vector<Outcome> measure_recording(const Rubric& rubric, Workpiece& scene,
                                                     const record::Player& player,
                                                     metrics::Process process, Shown& shown);

}  // namespace burr::scoring

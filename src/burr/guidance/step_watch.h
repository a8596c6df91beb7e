// guidance/step_watch.h - finds out, on a thread of its own, where the work of a step of the case lies on the bone as
// it is now, and whether the current step is done by its measure.
//
//     StepWatch watch(session.bone(), lesson);         // before the session begins
//     watch.seek({step, radius});                      // a step begins: where is its target?
//     if (const auto seen = watch.seen()) ...          // there
//     watch.look(step);                                // in each picture: the step of interest
//     if (const auto done = watch.take()) ...          // this step has reached its measure
//
// The thread copies the bone while it is milled, measures the copy, and rests. It runs at low
// priority; the servo knows nothing of it. Thread: main. Memory: a copy of the bone before the first
// cut, the distances to what is spared, and one more copy while it works; none if the case has no step.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "burr/base/progress.h"
#include "burr/rt/changed_bits.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/step_target.h"
#include "burr/volume/bone.h"

namespace burr::guidance {

class StepWatch {
 public:
  static constexpr std::chrono::seconds kRest{3};  // from the end of a measurement to the next

  // bone: must outlive this object.
  StepWatch(volume::Bone& bone, const scenario::CaseLesson& lesson);
  ~StepWatch();
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;

  // A step, and the burr that is to work there.
  struct Sought {
    std::size_t step = 0;
    double radius = 0;  // [m]
  };
  // Asks where its target is; the newest question counts. It comes before any measurement.
  void seek(const Sought& sought);
  struct Seen {
    std::size_t step = 0;
    scoring::StepTarget target;
  };
  // The answer to the newest question, once.
  [[nodiscard]] std::optional<Seen> seen();

  // step: which to look at from now on; none: rest.
  void look(std::optional<std::size_t> step);
  // A step that has reached its measure since the last call.
  [[nodiscard]] std::optional<std::size_t> take();

 private:
  class Stop final : public Progress {
   public:
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return token_.stop_requested(); }
    void obey(std::stop_token token) { token_ = std::move(token); }

   private:
    std::stop_token token_;
  };
  void run(const std::stop_token& token);
  void find(const Sought& sought, scoring::TargetFinder& finder, Progress& stop);
  void measure(std::size_t step, Progress& stop);

  volume::Bone& bone_;
  rt::ChangedBits& changed_;
  scenario::CaseLesson lesson_;
  std::unique_ptr<volume::Bone> before_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::size_t> step_, done_;  // under mutex_
  std::optional<Sought> sought_;            // under mutex_
  std::optional<Seen> seen_;                // under mutex_
  std::jthread thread_;                     // last: begins when all else is there
};

}  // namespace burr::guidance

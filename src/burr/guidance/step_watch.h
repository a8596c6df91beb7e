// guidance/step_watch.h - finds out, on a thread of its own, whether the current step of
// the case is done by its measure.
//
//     StepWatch watch(session.bone(), lesson);         // before the session begins
//     watch.look(step);                                // in each picture: the step of interest
//     if (const auto done = watch.take()) ...          // this step has reached its measure
//
// The thread copies the bone while it is milled, measures the copy, and rests. It runs at low
// priority; the servo knows nothing of it. Thread: main. Memory: a copy of the bone before the first
// cut, and one more while it measures; none if no step of the case has a `done`.
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

  volume::Bone& bone_;
  rt::ChangedBits& changed_;
  scenario::CaseLesson lesson_;
  std::unique_ptr<volume::Bone> before_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::size_t> step_, done_;  // under mutex_
  std::jthread thread_;                     // last: begins when all else is there
};

}  // namespace burr::guidance

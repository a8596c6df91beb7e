#include "burr/guidance/step_watch.h"

#include <sys/resource.h>

#include <stop_token>
#include <utility>

#include "burr/scoring/step_done.h"
#include "burr/volume/shared_copy.h"

namespace burr::guidance {
namespace {

constexpr int kNice = 10;

}  // namespace

StepWatch::StepWatch(volume::Bone& bone, const scenario::CaseLesson& lesson)
    : bone_(bone), changed_(bone.add_watcher()), lesson_(lesson) {
  bool measured = false;
  for (const scenario::Step& step : lesson_.steps) measured = measured || step.done.has_value();
  if (!measured) return;
  NoProgress quiet;
  if (auto copy = volume::shared_copy(bone_, changed_, quiet)) before_ = std::move(*copy);
  if (before_) thread_ = std::jthread([this](const std::stop_token& token) { run(token); });
}

StepWatch::~StepWatch() {
  thread_.request_stop();
  wake_.notify_all();
}

void StepWatch::look(std::optional<std::size_t> step) {
  if (step && !lesson_.steps[*step].done) step.reset();
  const std::lock_guard lock(mutex_);
  if (std::exchange(step_, step) != step) wake_.notify_all();
}

std::optional<std::size_t> StepWatch::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, {});
}

void StepWatch::run(const std::stop_token& token) {
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kNice));  // of this thread only
  Stop stop;
  stop.obey(token);
  while (!token.stop_requested()) {
    std::optional<std::size_t> step;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, token, [this] { return step_.has_value(); })) return;
      step = step_;
    }
    // a bone that changes too fast to be copied is copied the next time
    if (const auto now = volume::shared_copy(bone_, changed_, stop)) {
      const auto reached = scoring::step_done(lesson_.steps[*step], lesson_, *before_, **now, stop);
      const std::lock_guard lock(mutex_);
      if (reached && *reached && step_ == step) {
        done_ = step;
        step_.reset();
      }
    }
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, token, kRest, [] { return false; });
  }
}

}  // namespace burr::guidance

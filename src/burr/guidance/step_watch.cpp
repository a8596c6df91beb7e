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
  if (lesson_.steps.empty()) return;
  NoProgress quiet;
  if (auto copy = volume::shared_copy(bone_, changed_, quiet)) before_ = std::move(*copy);
  if (before_) thread_ = std::jthread([this](const std::stop_token& token) { run(token); });
}

StepWatch::~StepWatch() {
  thread_.request_stop();
  wake_.notify_all();
}

void StepWatch::seek(const Sought& sought) {
  if (sought.step >= lesson_.steps.size()) return;
  const std::lock_guard lock(mutex_);
  sought_ = sought;
  seen_.reset();
  wake_.notify_all();
}

std::optional<StepWatch::Seen> StepWatch::seen() {
  const std::lock_guard lock(mutex_);
  return std::exchange(seen_, {});
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

void StepWatch::find(const Sought& sought, scoring::TargetFinder& finder, Progress& stop) {
  const auto now = volume::shared_copy(bone_, changed_, stop);
  if (!now) return;
  auto target = finder.find(lesson_.steps[sought.step], **now, sought.radius);
  if (!target) return;
  const std::lock_guard lock(mutex_);
  if (!sought_) seen_ = Seen{sought.step, std::move(*target)};  // nobody has asked anew
}

// A bone that changes too fast to be copied is copied the next time.
void StepWatch::measure(std::size_t step, Progress& stop) {
  const auto now = volume::shared_copy(bone_, changed_, stop);
  if (!now) return;
  const auto reached = scoring::step_done(lesson_.steps[step], lesson_, *before_, **now, stop);
  const std::lock_guard lock(mutex_);
  if (!reached || !*reached || step_ != step) return;
  done_ = step;
  step_.reset();
}

void StepWatch::run(const std::stop_token& token) {
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kNice));  // of this thread only
  Stop stop;
  stop.obey(token);
  scoring::TargetFinder finder(*before_, lesson_, stop);
  while (!token.stop_requested()) {
    std::optional<std::size_t> step;
    std::optional<Sought> sought;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, token, [this] { return step_ || sought_; })) return;
      sought = std::exchange(sought_, {});
      step = step_;
    }
    if (sought) {
      find(*sought, finder, stop);
      continue;
    }
    measure(*step, stop);
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, token, kRest, [this] { return sought_.has_value(); });
  }
}

}  // namespace burr::guidance

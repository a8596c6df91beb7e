// apps/burr/window/shell/loading.h - long work beside the window: how far it is, and a way to stop it.
//
//     Loading loading([=](Progress& progress) { return make(progress); });
//     each frame:   if (loading.finished()) result = loading.take();
//
// The work runs on a thread of its own and touches nothing of the window's; destroying it asks the
// work to stop and waits. Thread: main, except where the work runs.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "window/shell/desk.h"

namespace burr::app {

// Progress that another thread looks at.
class SeenProgress final : public Progress {
 public:
  void report(double fraction, std::string_view stage) override;
  [[nodiscard]] bool cancelled() const override { return cancel_.load(); }
  void cancel() { cancel_ = true; }
  struct Now {
    double fraction = 0;
    std::string stage;
  };
  [[nodiscard]] Now now() const;

 private:
  mutable std::mutex mutex_;
  Now now_;
  std::atomic<bool> cancel_ = false;
};

template <class Value>
class Loading {
 public:
  using Make = std::function<Result<Value>(Progress&)>;
  explicit Loading(Make make)
      : thread_([this, make = std::move(make)] {
          result_.emplace(make(progress_));
          finished_ = true;
        }) {}
  ~Loading() { progress_.cancel(); }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] SeenProgress& progress() { return progress_; }
  // Once, after finished().
  [[nodiscard]] Result<Value> take() {
    thread_.join();
    return std::move(*result_);
  }

 private:
  SeenProgress progress_;
  std::optional<Result<Value>> result_;
  std::atomic<bool> finished_ = false;
  std::jthread thread_;  // last: begins when all else is there, ends before it
};

// The loading page until finished(). false: the user wants no more of it, and the work was told.
// closed: the window was.
[[nodiscard]] Result<bool> watch_loading(Desk& desk, const std::string& title,
                                         SeenProgress& progress,
                                         const std::function<bool()>& finished, bool& closed);

// The page shown until the bone, or what else takes long, is ready. Error: Trouble::interrupted if
// the user cancelled; `closed` is true if the window was closed.
template <class Value>
[[nodiscard]] Result<Value> load(Desk& desk, const std::string& title,
                                 typename Loading<Value>::Make make, bool& closed) {
  Loading<Value> loading(std::move(make));
  const Result<bool> watched = watch_loading(
      desk, title, loading.progress(), [&loading] { return loading.finished(); }, closed);
  if (!watched) return watched.error();
  Result<Value> made = loading.take();
  if (!*watched && !closed) return error(Trouble::interrupted, "stopped");
  return made;
}

}  // namespace burr::app

// apps/burr/window/ui/loading.h - long work in the background: reports how far it is, and can be
// stopped.
//
//     Loading loading([=](Progress& progress) { return make(progress); });
//     each frame:   if (loading.finished()) result = loading.take();
//
// The work runs on a thread of its own and must not use the window. The destructor asks the work to
// stop and waits for it. Thread: main, except the work itself.
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
#include "window/ui/desk.h"

namespace burr::app {

// Progress that another thread may read.
class SharedProgress final : public Progress {
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
  [[nodiscard]] SharedProgress& progress() { return progress_; }
  // Call it once, after finished() is true.
  [[nodiscard]] Result<Value> take() {
    thread_.join();
    return std::move(*result_);
  }

 private:
  SharedProgress progress_;
  std::optional<Result<Value>> result_;
  std::atomic<bool> finished_ = false;
  std::jthread thread_;  // last: starts after the other members, ends before them
};

// The step of a work in the user's language; one that has no words is shown as the program calls it.
[[nodiscard]] std::string stage_words(const std::string& stage);

// Shows the loading page until finished(). false: the user cancelled, and `progress` was cancelled.
// closed: set if the user closed the window.
[[nodiscard]] Result<bool> watch_loading(Desk& desk, const std::string& title,
                                         SharedProgress& progress,
                                         const std::function<bool()>& finished, bool& closed);

// Shows the loading page until the work is done. Error: Trouble::interrupted if the user cancelled;
// `closed` is true if the user closed the window.
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

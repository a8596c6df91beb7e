#include "shared/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "burr/base/one_bar.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// On a terminal one line that is rewritten, with the remaining time; elsewhere a line per stage. The
// numbered stages of one work ("3 of 5: smoothing") share a line and a bar.
class Console final : public Progress {
 public:
  void report(double fraction, std::string_view stage) override {
    if (quiet()) return;
    const bool fresh = stage != stage_;
    if (fresh) {
      if (!goes_on(stage)) {
        finish_line();
        started_ = Clock::now();
      }
      stage_ = stage;
      shown_ = {};
    }
    if (!terminal_) {
      const int percent = static_cast<int>(100 * fraction);
      if (each_percent() && (fresh || percent != percent_))
        fmt::print(stderr, "{} {} %\n", stage, percent);
      else if (fresh)
        fmt::print(stderr, "{} ...\n", stage);
      percent_ = percent;
      return;
    }
    if (!fresh && fraction < 1 && seconds_since(shown_) < 0.1) return;
    shown_ = Clock::now();
    const double took = seconds_since(started_);
    std::string left;
    if (fraction > 0.02 && fraction < 1 && took > 1)
      left = fmt::format(", {:.0f} s left", took * (1 - fraction) / fraction);
    fmt::print(stderr, "\r\x1b[K{} {:3.0f} %{}", stage, 100 * fraction, left);
    open_ = true;
    if (fraction >= 1) finish_line();
  }

  [[nodiscard]] bool cancelled() const override { return interrupted(); }

  ~Console() override { finish_line(); }

 private:
  // The same work, and no step of it that was there before.
  [[nodiscard]] bool goes_on(std::string_view stage) const {
    const auto was = base::numbered_stage(stage_), is = base::numbered_stage(stage);
    return was && is && open_ && was->of == is->of && was->number <= is->number;
  }
  void finish_line() {
    if (open_) fmt::print(stderr, "\n");
    open_ = false;
  }

  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool open_ = false;
  int percent_ = -1;
  std::string stage_;
  Clock::time_point started_ = Clock::now(), shown_;
};

}  // namespace

bool& quiet() noexcept {
  static bool value = false;
  return value;
}

bool& each_percent() noexcept {
  static bool value = false;
  return value;
}

Progress& progress() {
  static Console console;
  return console;
}

}  // namespace burr::app

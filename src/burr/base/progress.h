// base/progress.h - long work reports how far it is, and can be cancelled.
//
// Thread: report() by the working threads, one call at a time; cancelled() from any thread.
#pragma once

#include <string_view>

namespace burr {

class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  virtual ~Progress() = default;

  // fraction: 0..1 of the present stage; stage: a few words ("reading slices"). Call it as often as
  // you like.
  virtual void report(double fraction, std::string_view stage) = 0;

  // true: the caller wants to stop. Return error(Trouble::interrupted, ...) soon, and leave no
  // half-written file.
  [[nodiscard]] virtual bool cancelled() const = 0;
};

// For callers that need neither progress nor cancelling.
class NoProgress final : public Progress {
 public:
  void report(double, std::string_view) override {}
  [[nodiscard]] bool cancelled() const override { return false; }
};

}  // namespace burr

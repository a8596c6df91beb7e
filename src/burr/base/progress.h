// base/progress.h - long work says how far it is, and may be asked to stop.
//
// Thread: called by whoever works, one at a time; cancelled() from any thread.
#pragma once

#include <string_view>

namespace burr {

class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  virtual ~Progress() = default;

  // fraction: 0..1 of the present stage; stage: a few words ("reading slices"). Call as often as
  // you like.
  virtual void report(double fraction, std::string_view stage) = 0;

  // true: somebody wants to stop; return error(Trouble::interrupted, ...) soon, leave nothing
  // half-written.
  [[nodiscard]] virtual bool cancelled() const = 0;
};

// For callers that do not care.
class NoProgress final : public Progress {
 public:
  void report(double, std::string_view) override {}
  [[nodiscard]] bool cancelled() const override { return false; }
};

}  // namespace burr

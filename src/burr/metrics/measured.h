// metrics/measured.h - what every measure of this room returns: a value, or one sentence that says
// why it cannot be known.
//
//     Assessed<Identified> found = identified(cover, {});
//     if (!found) fmt::print("not assessable: {}\n", found.reason());
//     else        fmt::print("{:.0f} %\n", 100 * found->mark.value);
//
// There is no number where there is no answer, so nobody can take a zero for one. Thread: any.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "burr/base/check.h"

namespace burr::metrics {

// The bone, its labels or its voxels do not allow an answer. One sentence: what is missing, and
// what would help.
struct NotAssessable {
  std::string reason;
  bool too_little_done =
      false;  // the reason is the work, not the bone: more of it would be measured
};

template <class T>
class [[nodiscard]] Assessed {
 public:
  Assessed(T value) : state_(std::move(value)) {}            // NOLINT(google-explicit-constructor)
  Assessed(NotAssessable none) : state_(std::move(none)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  [[nodiscard]] const std::string& reason() const {
    BURR_CHECK(!ok());
    return std::get<NotAssessable>(state_).reason;
  }
  [[nodiscard]] bool too_little_done() const {
    return !ok() && std::get<NotAssessable>(state_).too_little_done;
  }
  [[nodiscard]] const T& operator*() const {
    BURR_CHECK(ok());
    return std::get<T>(state_);
  }
  [[nodiscard]] const T* operator->() const { return &**this; }

 private:
  std::variant<T, NotAssessable> state_;
};

// One number against its threshold.
struct Mark {
  bool met = false;
  // False: the structure is as it should be only because nothing was done near it; then `met` is
  // false too.
  bool earned = true;
  double value = 0;
  double threshold = 0;
  double error = 0;  // of `value`, in its unit; the truth is this near or nearer
  // Within its own error of the threshold: a person should look.
  [[nodiscard]] bool borderline() const { return std::abs(value - threshold) < error; }
};

// "Intact" is a merit only of somebody who worked: at least this share of the target must be gone.
inline constexpr double kLeastWork = 0.2;

// Share of the target that was removed, 0..1. It has no default: every caller must say it.
struct Worked {
  Worked(double of_target) : share(of_target) {}  // NOLINT(google-explicit-constructor)
  double share;
};

// value <= threshold, as the measures of what must stay whole need it.
[[nodiscard]] inline Mark intact_mark(double value, double threshold, double error,
                                      const Worked& worked) {
  const bool earned = worked.share >= kLeastWork;
  return {value <= threshold && earned, earned, value, threshold, error};
}

}  // namespace burr::metrics

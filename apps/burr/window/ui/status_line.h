// apps/burr/window/ui/status_line.h - the two lines beside the picture while milling: a note
// about the last action, and a warning. That the force was released is shown as a warning, so that
// it does not replace the answer to a key.
// Thread: main.
#pragma once

#include <chrono>
#include <string>
#include <utility>

namespace burr::app {

class StatusLine {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kShown{6};

  void note(std::string text, Clock::time_point now) { note_ = {std::move(text), now}; }
  // A note that stays until it is forgotten, or until the next one: somebody waited for it.
  void keep(std::string text) { note_ = {std::move(text), {}, true}; }
  [[nodiscard]] bool kept() const { return note_.stays; }
  void forget_kept() {
    if (note_.stays) note_ = {};
  }
  void warn_released(std::string text, Clock::time_point now) {
    released_ = {std::move(text), now};
  }

  // `otherwise`: shown when there is no recent note
  [[nodiscard]] std::string note(Clock::time_point now, const std::string& otherwise) const {
    return fresh(note_, now) ? note_.text : otherwise;
  }
  // `lasting`: a warning that is still true; it is shown instead of one about a past event
  [[nodiscard]] std::string warning(Clock::time_point now, const std::string& lasting) const {
    return !lasting.empty() || !fresh(released_, now) ? lasting : released_.text;
  }

 private:
  struct Line {
    std::string text;
    Clock::time_point at = {};
    bool stays = false;
  };
  static bool fresh(const Line& line, Clock::time_point now) {
    return !line.text.empty() && (line.stays || now - line.at <= kShown);
  }
  Line note_, released_;
};

}  // namespace burr::app

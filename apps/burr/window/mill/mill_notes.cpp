#include "window/mill/mill_notes.h"

#include "shared/front_words.h"
#include "shared/word_names.h"

namespace burr::app {

void MillNotes::note(std::string text) {
  if (!text.empty()) line_.note(in_options(text), Clock::now());
}

void MillNotes::click_away() {
  line_.forget_kept();
  renewed_ = {};
}

bool MillNotes::due() {
  const Clock::time_point now = Clock::now();
  if (now - renewed_ < std::chrono::milliseconds(200)) return false;
  renewed_ = now;
  return true;
}

std::string MillNotes::renew(const Stands& now) {
  warning_ = line_.warning(renewed_, in_options(now.warning));
  // after the reason of the release: what the user should do
  if (now.warning.empty() && now.released)
    warning_ += (warning_.empty() ? "" : ". ") + std::string(word(Word::begins_free));
  if (!now.progress.empty()) line_.forget_kept();  // of the export before
  note_ = line_.note(renewed_, now.progress);
  const std::string measured = note_.empty() ? now.measured : std::string();
  if (note_.empty() && measured.empty()) note_ = now.hint;
  const std::string& line = note_.empty() ? measured : note_;
  if (!now.trouble.empty()) return now.trouble;
  return warning_.empty() || line.empty() ? warning_ + line : warning_ + "; " + line;
}

}  // namespace burr::app

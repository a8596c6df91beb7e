#include "window/review/full_report.h"

#include <vector>

#include "shared/word_names.h"

namespace burr::app {

void FullReport::ask() {
  if (child_) return;
  if (written_ && language_ == spoken().code) return show();
  written_ = false;
  language_ = spoken().code;
  std::vector<std::string> words = {burr_itself(), "--quiet", "report",     file_,
                                    "--out",       page_,     "--language", language_};
  const auto add = [&words](const char* option, const std::string& value) {
    if (value.empty()) return;
    words.emplace_back(option);
    words.push_back(value);
  };
  add("--rubric", rubric_);
  add("--volume", volume_.source);
  add("--series", volume_.series);
  add("--tissues", volume_.labels);
  add("--materials", volume_.materials);
  child_ = std::make_unique<HelperProcess>(words, 0);  // no session runs beside it
  note_ = word(Word::review_writes);
  if (!child_->began()) {
    child_.reset();
    note_ = word(Word::review_not_begun);
  }
}

void FullReport::step(bool shows) {
  if (!child_ || !child_->ended()) return;
  written_ = child_->fine();
  if (written_ && shows)
    show();
  else if (written_)
    note_ = say(Word::review_written, page_);
  else
    note_ = child_->complaint(word(Word::review_not_begun));
  child_.reset();
}

// The note names the file even if a browser opens: there may be none.
void FullReport::show() {
  note_ = say(Word::review_written, page_);
  if (const std::string opener = program_in_path("xdg-open"); !opener.empty())
    static_cast<void>(start_apart({opener, page_}));
}

}  // namespace burr::app

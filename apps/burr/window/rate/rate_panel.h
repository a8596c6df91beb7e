// apps/burr/window/rate/rate_panel.h - what the page for raters draws beside the bone: the name of the rater, the items with
// their marks, and the buttons of the views.
//
// Takes plain data and says what was pressed. Thread: main, between Ui::begin() and draw().
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "window/ui/ui.h"

namespace burr::app {

inline constexpr std::array<const char*, 3> kRateMarks = {"met", "unmet", "not assessable"};
inline constexpr float kRatePanel = 470;  // width of the panel at the right [points]

struct RateItem {
  std::string id, text;
  std::string mark, reason;  // mark: one of kRateMarks; empty: none yet
};

struct RateShown {
  // who marks: asked for while this is so
  bool asks_who = true;
  std::string rater;
  std::string heading;  // of the product, with its case
  std::size_t left = 0, elsewhere = 0;
  bool making = false;  // the bone is being made
  double progress = 0;  // [0..1]
  std::string trouble;  // why the product cannot be shown
  std::string note;     // a sentence: what was kept, what is missing
  std::vector<RateItem> items;
  std::size_t at = 0;              // the item that the keys mark
  std::vector<std::string> views;  // names of the buttons; the first has the key 1, the tenth 0
  std::size_t view = 0;
  double wide_mm = 0;
  bool to_reason = false;  // the keys go to the field of the item's reason
  bool scroll = false;     // the item of the keys must be seen
};

struct RatePressed {
  bool begin = false, keep = false, later = false, leave = false;
  int view = -1;  // below 0: none
};

// rater, items' marks and reasons, and `at` are changed in place.
[[nodiscard]] RatePressed draw_rate(Ui& ui, RateShown& shown);

}  // namespace burr::app

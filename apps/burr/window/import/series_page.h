// apps/burr/window/import/series_page.h - the page for a folder that holds several series: a list of
// all, each with a picture of its middle slice, before one of them becomes bone.
//
// The lines are those of `burr info`: no name or number of a patient is read. Where the folder holds
// several studies, a line says which it belongs to. The dates of the studies are shown only when the
// user asks for them; the next list hides them again. The pictures are made one after the other
// on a thread of its own; a series that cannot be read has none. Thread: main.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/render/image.h"
#include "window/import/import_choice.h"
#include "window/ui/desk.h"
#include "window/ui/loading.h"
#include "window/ui/texture.h"

namespace burr::app {

// The middle axial slice in the usual orientation, at most `most` pixels wide and high; labels in
// their colours.
[[nodiscard]] render::Image middle_of(const OpenedScan& opened, int most);

class SeriesPage {
 public:
  // opened: the series that burr would take by itself, with the list of all.
  SeriesPage(Desk& desk, const OpenedScan& opened);
  ~SeriesPage();
  SeriesPage(const SeriesPage&) = delete;
  SeriesPage& operator=(const SeriesPage&) = delete;

  struct Choice {
    std::optional<std::size_t> series;  // index in the list; none: the user went back
    bool closed = false;                // the window
  };
  // seconds: as in StartPage::ask.
  [[nodiscard]] Result<Choice> ask(double seconds);

  // Top left corner of the first row and height of a row; the switch of the dates from kLeft, and
  // the top of what is below the list from the bottom [points], for tests.
  static constexpr float kLeft = 40, kTop = 110, kRow = 92, kDates = 200, kFoot = 54;

 private:
  void take_events();
  void work();
  void draw();
  void move(int by);

  Desk& desk_;
  scenario::BoneRecipe recipe_;
  std::vector<std::string> lines_, dates_;
  bool dates_shown_ = false;
  std::vector<std::optional<render::Image>> pictures_;  // none: not made yet; empty: there is none
  std::vector<Texture> textures_;
  std::unique_ptr<Loading<render::Image>> making_;
  std::size_t makes_ = 0;  // which one
  std::size_t chosen_ = 0;
  bool show_chosen_ = false;
  int renewed_ = 0;
  std::optional<Choice> choice_;
};

}  // namespace burr::app

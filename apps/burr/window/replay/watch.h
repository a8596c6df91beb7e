// apps/burr/window/replay/watch.h - the page that plays recordings, as a class: watch.cpp runs it,
// watch_keys.cpp takes what the user does, watch_drawing.cpp draws what lies over the bones.
// Internal to the page. Thread: main.
#pragma once

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "window/parts/export_page.h"
#include "window/replay/comparison.h"
#include "window/replay/facts.h"
#include "window/replay/replay_page.h"
#include "window/replay/replay_view.h"
#include "window/replay/split_view.h"
#include "window/ui/file_dialog.h"

namespace burr::app {

class Watch {
 public:
  using Clock = std::chrono::steady_clock;

  Watch(Desk& desk, Recorded& recorded, const WatchOptions& options)
      : desk_(desk), recorded_(recorded), scene_(recorded.scene), options_(options) {
    take_titles();
  }

  Result<Closed> run();

 private:
  void take_titles() const;
  void take_events();
  void key(const SDL_Keysym& pressed);
  void act(Action action);
  void leave();
  void move(const SDL_MouseMotionEvent& motion);
  void go(double t);
  void play(bool playing);
  void change_pace(int by);
  void film_here(bool begins);
  void turn_view(double right, double up, bool shift);
  Status show();
  Status open_beside(const std::string& file);
  void close_beside();
  void tell();
  void draw_slices();
  void next_comparison();
  void next_slices();
  void ask_beside();
  void shift(double by);
  void follow();
  void panels();
  void draw_table(const Facts* left);
  void titles() const;
  void ring() const;
  void show_labels(bool shown);
  void show_panels(bool shown);
  void note(std::string text, bool stays = false) {
    note_ = std::move(text);
    noted_ = Clock::now();
    note_stays_ = stays;
  }
  [[nodiscard]] bool page_open() const {
    return help_ || dialog_.open() || (export_ && export_->shown());
  }
  // on the shared clock, until both have ended  [s]
  [[nodiscard]] double seconds() const {
    return std::max(first_->line().seconds, second_ ? second_->line().seconds + now_.shift : 0.0);
  }
  [[nodiscard]] bool at_rest() const;
  [[nodiscard]] double stroke_before(double t) const;
  [[nodiscard]] double stroke_after(double t) const;

  Desk& desk_;
  Recorded& recorded_;
  render::Scene& scene_;
  const WatchOptions& options_;

  render::Camera first_view_;
  std::optional<ReplayView> first_;
  std::unique_ptr<Recorded> beside_;  // shown by second_, if there is one
  std::optional<ReplayView> second_;
  render::Camera second_view_;
  std::optional<FactsJob> facts_;           // of the first recording
  std::unique_ptr<Comparison> comparison_;  // with the second one
  enum class Compare { none, table, colours } compare_ = Compare::table;
  std::optional<SplitView> pair_;
  FileDialog dialog_;
  std::vector<std::string> dropped_;
  Watched now_;
  bool open_ = true, picture_ = false, panels_ = true, help_ = false, scrubbing_ = false;
  bool labels_ = true, leaves_ = false;  // leaves_: leave, even if a film is being made
  std::optional<ExportPage> export_;
  Closed closed_ = Closed::window;
  std::string note_, trouble_;     // trouble_: of the second recording, until a key
  std::optional<Action> pressed_;  // the button of the last picture
  bool writing_ = false;           // a file is being written
  bool note_stays_ = false;        // until it is clicked away
  bool click_ = false;  // a button of the mouse went down, and the mouse has not moved since
  Clock::time_point noted_{}, stirred_ = Clock::now();  // stirred_: last input or change
  double stop_at_ = 0;                                  // playing ends there [s]
};

}  // namespace burr::app

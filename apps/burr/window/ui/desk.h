// apps/burr/window/ui/desk.h - what all pages share: the window, the user interface drawn over
// it, and the user's settings.
//
// Thread: main.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/places.h"
#include "burr/base/result.h"
#include "burr/render/governor.h"
#include "burr/render/headset.h"
#include "burr/render/renderer.h"
#include "shared/user_settings.h"
#include "window/hands/gamepad.h"
#include "window/hands/pedals.h"
#include "window/hands/spacemouse.h"
#include "window/station/station_link.h"
#include "window/ui/pointer_truth.h"
#include "window/ui/printed_keys.h"
#include "window/ui/ui.h"

namespace burr::app {

enum class Page { none, start, loading, import, milling, replay, self_marks, review, rate };

class Desk {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Desk>> open(const DeskPlaces& places);
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  ~Desk() = default;

  [[nodiscard]] render::Renderer& renderer() { return *renderer_; }
  [[nodiscard]] Ui& ui() { return *ui_; }
  [[nodiscard]] const DeskPlaces& places() const { return places_; }

  Settings settings;
  render::GovernorSettings governor;  // how much the picture may leave out on a busy machine
  std::vector<std::string> troubles;  // about the settings file and stereo; shown once
  Page page = Page::none;             // the page that is shown now
  std::string message;                // start and import pages: the error that is shown
  std::string news;  // start page: a line that is no error, until it is clicked away
  // What a page that was left still has under way, looked at in each picture; true: it has ended.
  std::vector<std::function<bool()>> under_way;
  std::string store;     // of learners, as the user named it; empty: the usual one
  Status lost = fine();  // what could not be recorded; the program ends with it
  // Shows the milling page on the instructor's page; nullptr: nobody asked for it. And whose sessions these are.
  std::unique_ptr<StationLink> station;
  std::string station_learner;
  // After each session: how long it was [s], and whether the work was declared done.
  std::function<void(double, bool)> session_over;
  std::string status_text;  // milling page: warning, last note; review: what was met
  Gamepads pads;            // input other than the mouse
  Pedals pedals;
  SpaceMouse cap;
  std::function<void()> after_frame;  // called after each picture, for tests and watchers
  // Present while the user wears it for milling; destroyed when the window is renewed.
  std::unique_ptr<render::Headset> headset;
  bool headset_wanted = false;  // by settings or command line; false after a failed start
  // Call it after a change: applies the settings and writes the file.
  void settings_changed();

  // Makes the window and everything on the GPU again, for example after the graphics card was lost.
  // The next picture loads its data again. Error: no new window could be made.
  [[nodiscard]] Status renew();
  // Number of calls of renew(); each call destroys what others keep on the GPU.
  [[nodiscard]] int renewed() const { return renewed_; }

  // Takes the next event, after the user interface has seen it; false: there is none. F3 is not
  // returned: it changes to the next way to show two eyes. If the picture is shown twice, side by
  // side, mouse positions are converted as if there were one picture as large as the window. Keys are
  // those that are printed (printed_keys.h).
  [[nodiscard]] bool next(SDL_Event& event);
  // Position of the mouse now, converted in the same way.
  void mouse(int& x, int& y) const;
  // How two eyes are shown now: the setting, as far as the driver supports it.
  [[nodiscard]] render::TwoEyes eyes(const render::Camera& camera) const;
  // Shows one picture: the scene and, if `panels` is set, what it draws with ImGui over it. keys:
  // the panels can be used with the keyboard.
  [[nodiscard]] Status show(const render::Scene& scene, const std::function<void()>& panels,
                            bool keys = false);
  // Writes the window's picture as a PNG into `folder`: burr_001.png, 002 ... Returns the name.
  [[nodiscard]] Result<std::string> leave_picture(const std::string& folder);

 private:
  Desk() = default;
  void next_stereo();
  void into_half(SDL_Event& event);
  [[nodiscard]] bool halves() const { return settings.stereo == render::Stereo::side_by_side; }
  DeskPlaces places_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Ui> ui_;  // after renderer_, so that it is destroyed before it
  PrintedKeys printed_;
  PointerTruth pointer_;
  bool keep_old_ = false;       // the settings file had an error: keep the old one
  bool minimised_ = false;      // the window is not visible: nothing is drawn
  bool asked_quads_ = false;    // the window was made with a picture for each eye requested
  bool in_right_half_ = false;  // the mouse is in the right picture of two
  int pictures_ = 0, renewed_ = 0;
};

}  // namespace burr::app

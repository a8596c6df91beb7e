// apps/burr/window/shell/desk.h - what all pages share: the window, what draws panels over it, and the
// user's settings.
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
#include "burr/render/headset.h"
#include "burr/render/renderer.h"
#include "window/hands/gamepad.h"
#include "window/hands/pedals.h"
#include "window/hands/spacemouse.h"
#include "window/shell/settings.h"
#include "window/shell/ui.h"

namespace burr::app {

enum class Page { none, start, loading, import, milling, replay };

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
  std::vector<std::string> troubles;  // of the settings' file and of stereo, to be told once
  Page page = Page::none;             // the one shown
  std::string told;                   // what went wrong, on the start and import pages
  std::string said;                   // while milling: what must be known, what was done last
  Gamepads pads;                      // hands other than the mouse's
  Pedals pedals;
  SpaceMouse cap;
  std::function<void()> after_frame;  // whoever wants to look on, after each picture
  // Worn while milling; gone when the window is made anew.
  std::unique_ptr<render::Headset> headset;
  bool headset_wanted = false;  // by the settings or the command line, until one was tried in vain
  // After a change: in effect, and written down.
  void settings_changed();

  // Window and everything on the GPU anew, as after a graphics card was lost; what is shown is sent
  // again with the next picture. Error: none can be had any more.
  [[nodiscard]] Status renew();
  // How often that was done; what others keep on the GPU is gone each time.
  [[nodiscard]] int renewed() const { return renewed_; }

  // The next event, already known to the panels; false: none now.
  // F3 is not among them: it goes on to the next way to show two eyes. Where the picture is there
  // twice, side by side, the mouse comes as if there were one, of the window's size.
  [[nodiscard]] bool next(SDL_Event& event);
  // Where it is now, in that way.
  void mouse(int& x, int& y) const;
  // How the window is looked at: the setting, as far as the driver can.
  [[nodiscard]] render::TwoEyes eyes(const render::Camera& camera) const;
  // One picture: the scene and, if `panels` is set, what it draws with ImGui over it. keys: the
  // panels may be walked through by keyboard.
  [[nodiscard]] Status show(const render::Scene& scene, const std::function<void()>& panels,
                            bool keys = false);
  // What the window shows now as a PNG in `folder`: burr_001.png, 002 ... The name, or the error.
  [[nodiscard]] Result<std::string> leave_picture(const std::string& folder);

 private:
  Desk() = default;
  void next_stereo();
  void into_half(SDL_Event& event);
  [[nodiscard]] bool halves() const { return settings.stereo == render::Stereo::side_by_side; }
  DeskPlaces places_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Ui> ui_;      // goes first
  bool keep_old_ = false;       // the settings' file had trouble
  bool minimised_ = false;      // nobody sees it: nothing is drawn
  bool asked_quads_ = false;    // the window was made with a request for a picture for each eye
  bool in_right_half_ = false;  // the mouse
  int pictures_ = 0, renewed_ = 0;
};

}  // namespace burr::app

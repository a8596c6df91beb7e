// apps/burr/window/ui/ui.h - panels, text and colours over the picture, with Dear ImGui.
//
//     ui->event(event);                                  // every SDL event, pages look after it
//     ui->begin(window, renderer->width(), ...);  ... ImGui and the helpers below ...
//     renderer->show(scene, [&] { ui->draw(); });
//
// Sizes are in pixels of the drawing area; unit() is the number of pixels in one point of the
// design and depends on the display's scale. The position of the mouse comes from events only, so
// that a test can act as a user by pushing events. A click counts where it was made, however far the
// mouse has gone on before the next picture. The colours can be distinguished by colour-blind
// people (Okabe and Ito), and a colour never carries a meaning alone: a word or a shape shows the
// same. Letters have the contrast of WCAG level AA (contrast.h, tests/window/contrast_test.cpp). Thread: main, with the renderer's context; one at a time. Cost: drawing of panels only, a
// few thousand triangles.
#pragma once

#include <SDL2/SDL_events.h>
#include <imgui/imgui.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "window/ui/imgui_keys.h"

namespace burr::app {

namespace ink {
constexpr ImU32 rgb(unsigned r, unsigned g, unsigned b, unsigned a = 255) {
  return r | g << 8U | b << 16U | a << 24U;
}
inline constexpr ImU32 kText = rgb(238, 240, 242), kDim = rgb(176, 182, 189),
                       kPanel = rgb(17, 19, 22, 236), kLine = rgb(255, 255, 255, 28),
                       kTrough = rgb(255, 255, 255, 34), kButton = rgb(44, 49, 55, 235),
                       kOver = rgb(62, 70, 78, 245), kAccent = rgb(86, 180, 233),
                       kGood = rgb(0, 178, 133), kWarn = rgb(240, 180, 30),
                       kBad = rgb(240, 125, 50);
}  // namespace ink

class Ui {
 public:
  // The context of the renderer must be current.
  [[nodiscard]] static std::unique_ptr<Ui> make();
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void event(const SDL_Event& event);
  // window_*: size of the window as SDL gives it, in the unit of mouse events. keys: panels can be
  // used with Tab and arrow keys.
  void begin(int window_width, int window_height, int width, int height, double user_scale,
             bool keys);
  void draw();  // inside Renderer::show(); may be called twice per picture
  // Draws a mouse pointer among the panels instead of the desktop's.
  void own_pointer(bool on);

  [[nodiscard]] float unit() const { return unit_; }
  [[nodiscard]] float width() const;
  [[nodiscard]] float height() const;
  // The user types into a field, or has just clicked into one: keys are letters, not commands.
  [[nodiscard]] bool typing() const;
  // The mouse is over a panel of the last picture. forget_panels(): that picture had none.
  [[nodiscard]] bool over_panel() const { return over_panel(mouse_x_, mouse_y_); }
  // the same for any position  [window coordinates]
  [[nodiscard]] bool over_panel(float window_x, float window_y) const;
  void forget_panels() {
    boxes_.clear();
    fields_.clear();
    field_has_keys_ = false;
  }

  // A field for text, as it was drawn now: the item before this call. For text_field().
  void field();

  // ---- parts of panels
  // Begins a panel at a fixed place; end it with ImGui::End().
  void panel(const char* name, float x, float y, float w, float h, bool plain = false);
  // The same for a page in the middle, which takes the keyboard input.
  void page(const char* name, float x, float y, float w, float h);

  enum class Letter { small, body, strong, large, title };
  [[nodiscard]] ImFont* font(Letter letter) const { return fonts_[static_cast<int>(letter)]; }
  // Writes one line; its top is at y. x is its left end, middle or right end for aligned 0, 0.5, 1.
  void write(float x, float y, Letter letter, ImU32 colour, const std::string& text,
             float aligned = 0) const;
  [[nodiscard]] float width_of(Letter letter, const std::string& text) const;
  [[nodiscard]] float height_of(Letter letter) const;

  // For tests and watchers: the lines that write() draws from now on; nullptr: nobody listens.
  void listen(std::vector<std::string>* to) { heard_ = to; }
  // For whoever draws text in another way than by write().
  void tell(const std::string& text) const {
    if (heard_ != nullptr) heard_->push_back(text);
  }
  // The middle of the first field for text of the last picture [window coordinates]; false: none.
  [[nodiscard]] bool first_field(float& window_x, float& window_y) const;

  // name of the font: "DejaVu Sans"; "" for ImGui's own
  [[nodiscard]] const std::string& letters() const { return letters_; }

 private:
  Ui() = default;
  void build_fonts();
  void style() const;

  struct Box {
    float x, y, w, h;
  };
  ImGuiContext* context_ = nullptr;
  ImFont* fonts_[5] = {};
  std::string letters_;
  std::vector<std::string>* heard_ = nullptr;
  float unit_ = 0;
  float from_window_ = 1;  // pixels per unit of the window
  float mouse_x_ = -1, mouse_y_ = -1;
  // What the mouse did and no picture has seen yet: one button goes down or up in a picture.
  struct MouseStep {
    float x, y;
    int button;  // below 0: it only moved
    bool down;
  };
  void take_mouse();
  std::deque<MouseStep> mouse_;
  float seen_x_ = -1, seen_y_ = -1;  // as the panels see it now
  bool down_[3] = {};
  [[nodiscard]] static bool holds(const std::vector<Box>& boxes, float x, float y);
  std::vector<Box> boxes_, fields_;
  bool field_has_keys_ = false;  // in the last picture
  KeysDown keys_;
  // a key that is released in the frame in which it was pressed stays down for one frame
  std::vector<SDL_Scancode> fresh_, let_go_, up_;
  Uint64 last_ = 0;
};

// The next item gets the keyboard. (SetKeyboardFocusHere() of Dear ImGui 1.90.1, that of Debian 13, looks for it only in the
// child window where the last one was.)
void focus_next();

// ImGui's field for a std::string; true when Enter was pressed in it.
// complete: Tab replaces the text by what this makes of it; nullptr: Tab goes to the next field.
[[nodiscard]] bool text_field(const char* id, const char* hint, std::string& text, float width,
                              std::string (*complete)(const std::string&) = nullptr);

}  // namespace burr::app

#include "window/parts/toolbar.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "shared/words.h"
#include "window/ui/printed_keys.h"

namespace burr::app {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Draws an icon. c: its middle, r: half its size.
struct Pen {
  ImDrawList& draw;
  ImVec2 c;
  float r;
  ImU32 shade;
  float thick = 0.22F * r;

  void ring(float from, float to, float radius) const {
    draw.PathArcTo(c, radius, from, to, 24);
    draw.PathStroke(shade, 0, thick);
  }
  // the tip of an arrow on a ring at angle a; way: forward or back around the ring
  void tip(float a, float radius, float way) const {
    const ImVec2 p = {c.x + radius * std::cos(a), c.y + radius * std::sin(a)};
    const ImVec2 t = {-way * std::sin(a), way * std::cos(a)};
    const float s = 0.42F * r;
    draw.AddTriangleFilled({p.x + 1.3F * s * t.x, p.y + 1.3F * s * t.y},
                           {p.x + s * std::cos(a), p.y + s * std::sin(a)},
                           {p.x - s * std::cos(a), p.y - s * std::sin(a)}, shade);
  }
};

// icons for what the burr does, its size and speed
void burr_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  switch (action) {
    case Action::cut:  // a burr on its shaft
      pen.draw.AddLine({pen.c.x + 0.9F * r, pen.c.y - 0.9F * r}, {pen.c.x, pen.c.y}, pen.shade,
                       pen.thick);
      pen.draw.AddCircleFilled({pen.c.x - 0.25F * r, pen.c.y + 0.25F * r}, 0.55F * r, pen.shade,
                               20);
      break;
    case Action::add:
    case Action::larger:
    case Action::faster:
      pen.draw.AddLine({pen.c.x, pen.c.y - 0.8F * r}, {pen.c.x, pen.c.y + 0.8F * r}, pen.shade,
                       pen.thick);
      pen.draw.AddLine({pen.c.x - 0.8F * r, pen.c.y}, {pen.c.x + 0.8F * r, pen.c.y}, pen.shade,
                       pen.thick);
      break;
    case Action::smaller:
    case Action::slower:
      pen.draw.AddLine({pen.c.x - 0.8F * r, pen.c.y}, {pen.c.x + 0.8F * r, pen.c.y}, pen.shade,
                       pen.thick);
      break;
    case Action::touch:  // a ball on a line
      pen.draw.AddCircle({pen.c.x, pen.c.y - 0.1F * r}, 0.55F * r, pen.shade, 20, pen.thick);
      pen.draw.AddLine({pen.c.x - r, pen.c.y + 0.75F * r}, {pen.c.x + r, pen.c.y + 0.75F * r},
                       pen.shade, pen.thick);
      break;
    case Action::back:  // a hollow that fills
      pen.ring(0, kPi, 0.75F * r);
      pen.draw.AddLine({pen.c.x - 1.1F * r, pen.c.y}, {pen.c.x - 0.7F * r, pen.c.y}, pen.shade,
                       pen.thick);
      pen.draw.AddLine({pen.c.x + 0.7F * r, pen.c.y}, {pen.c.x + 1.1F * r, pen.c.y}, pen.shade,
                       pen.thick);
      pen.draw.AddLine({pen.c.x, pen.c.y + 0.5F * r}, {pen.c.x, pen.c.y - 0.4F * r}, pen.shade,
                       pen.thick);
      pen.draw.AddTriangleFilled({pen.c.x + 0.4F * r, pen.c.y - 0.3F * r},
                                 {pen.c.x - 0.4F * r, pen.c.y - 0.3F * r},
                                 {pen.c.x, pen.c.y - 0.95F * r}, pen.shade);
      break;
    case Action::smooth: {  // a wave above, a line below
      for (int n = 0; n < 16; ++n) {
        const auto wave = [&](int at) {
          const float t = static_cast<float>(at) / 16;
          return ImVec2{pen.c.x + (2 * t - 1) * r,
                        pen.c.y - 0.35F * r - 0.3F * r * std::sin(4 * kPi * t)};
        };
        pen.draw.AddLine(wave(n), wave(n + 1), pen.shade, 0.8F * pen.thick);
      }
      pen.draw.AddLine({pen.c.x - r, pen.c.y + 0.6F * r}, {pen.c.x + r, pen.c.y + 0.6F * r},
                       pen.shade, pen.thick);
      break;
    }
    default:
      break;
  }
}

// icons for work on the bone
void work_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  switch (action) {
    case Action::undo:
      pen.ring(-0.95F * kPi, 0.35F * kPi, 0.7F * r);
      pen.tip(-0.95F * kPi, 0.7F * r, -1);
      break;
    case Action::redo:
      pen.ring(0.65F * kPi, 1.95F * kPi, 0.7F * r);
      pen.tip(1.95F * kPi, 0.7F * r, 1);
      break;
    case Action::reset:
      pen.ring(-0.4F * kPi, 1.35F * kPi, 0.7F * r);
      pen.tip(1.35F * kPi, 0.7F * r, 1);
      pen.draw.AddCircleFilled(pen.c, 0.2F * r, pen.shade, 12);
      break;
    case Action::measure:  // a ruler
      pen.draw.AddRect({pen.c.x - 1.1F * r, pen.c.y - 0.5F * r},
                       {pen.c.x + 1.1F * r, pen.c.y + 0.5F * r}, pen.shade, 0, 0, 0.8F * pen.thick);
      for (int n = -1; n <= 1; ++n) {
        const float x = pen.c.x + 0.55F * static_cast<float>(n) * r;
        pen.draw.AddLine({x, pen.c.y - 0.5F * r}, {x, pen.c.y + (n == 0 ? 0.15F : -0.05F) * r},
                         pen.shade, 0.8F * pen.thick);
      }
      break;
    case Action::mirror:  // two halves, a plane between them
      for (const float side : {-1.0F, 1.0F})
        pen.draw.AddTriangle({pen.c.x + 0.3F * side * r, pen.c.y - 0.7F * r},
                             {pen.c.x + 0.3F * side * r, pen.c.y + 0.7F * r},
                             {pen.c.x + 1.1F * side * r, pen.c.y + 0.7F * r}, pen.shade,
                             0.8F * pen.thick);
      for (const float y : {-1.0F, -0.35F, 0.3F, 0.95F})
        pen.draw.AddLine({pen.c.x, pen.c.y + (y - 0.1F) * r}, {pen.c.x, pen.c.y + (y + 0.2F) * r},
                         pen.shade, 0.8F * pen.thick);
      break;
    default:
      break;
  }
}

// icons for pages
void page_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  switch (action) {
    case Action::export_:  // an arrow down into a tray
      pen.draw.AddLine({pen.c.x, pen.c.y - 0.9F * r}, {pen.c.x, pen.c.y}, pen.shade, pen.thick);
      pen.draw.AddTriangleFilled({pen.c.x - 0.5F * r, pen.c.y - 0.1F * r},
                                 {pen.c.x + 0.5F * r, pen.c.y - 0.1F * r},
                                 {pen.c.x, pen.c.y + 0.5F * r}, pen.shade);
      for (const float side : {-0.85F, 0.85F})
        pen.draw.AddLine({pen.c.x + side * r, pen.c.y + 0.2F * r},
                         {pen.c.x + side * r, pen.c.y + 0.9F * r}, pen.shade, pen.thick);
      pen.draw.AddLine({pen.c.x - 0.85F * r, pen.c.y + 0.85F * r},
                       {pen.c.x + 0.85F * r, pen.c.y + 0.85F * r}, pen.shade, pen.thick);
      break;
    case Action::settings:  // three sliders
      for (int n = 0; n < 3; ++n) {
        const float y = pen.c.y + (static_cast<float>(n) - 1) * 0.65F * r;
        const float k = n == 1 ? 0.4F : -0.35F;
        pen.draw.AddLine({pen.c.x - 0.9F * r, y}, {pen.c.x + 0.9F * r, y}, pen.shade,
                         0.7F * pen.thick);
        pen.draw.AddCircleFilled({pen.c.x + k * r, y}, 0.26F * r, pen.shade, 12);
      }
      break;
    case Action::help: {
      ImFont* font = ImGui::GetFont();
      const float size = 2.0F * r;
      const ImVec2 wide = font->CalcTextSizeA(size, 1e9F, 0, "?");
      pen.draw.AddText(font, size, {pen.c.x - wide.x / 2, pen.c.y - size / 2}, pen.shade, "?");
      break;
    }
    case Action::leave:  // a door and an arrow out of it
      pen.draw.AddLine({pen.c.x + 0.8F * r, pen.c.y}, {pen.c.x - 0.3F * r, pen.c.y}, pen.shade,
                       pen.thick);
      pen.draw.AddTriangleFilled({pen.c.x - 0.9F * r, pen.c.y},
                                 {pen.c.x - 0.2F * r, pen.c.y - 0.5F * r},
                                 {pen.c.x - 0.2F * r, pen.c.y + 0.5F * r}, pen.shade);
      break;
    default:
      break;
  }
}

// icons for burr, water and view
void operation_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  const ImVec2 c = pen.c;
  switch (action) {
    case Action::kind: {  // a diamond
      const ImVec2 corners[] = {
          {c.x, c.y - r}, {c.x + 0.8F * r, c.y}, {c.x, c.y + r}, {c.x - 0.8F * r, c.y}};
      pen.draw.AddConvexPolyFilled(corners, 4, pen.shade);
      break;
    }
    case Action::rack: {  // three tools beside each other
      const float top[] = {-0.2F, -0.9F, 0.1F};
      for (int n = 0; n < 3; ++n) {
        const float x = c.x + 0.75F * static_cast<float>(n - 1) * r;
        pen.draw.AddLine({x, c.y - r}, {x, c.y + 0.9F * r}, pen.shade, 0.6F * pen.thick);
        pen.draw.AddRectFilled({x - 0.24F * r, c.y + top[n] * r}, {x + 0.24F * r, c.y + r},
                               pen.shade, 0.15F * r);
      }
      break;
    }
    case Action::coolant:  // a drop
      pen.draw.AddCircleFilled({c.x, c.y + 0.35F * r}, 0.6F * r, pen.shade, 20);
      pen.draw.AddTriangleFilled({c.x, c.y - r}, {c.x + 0.55F * r, c.y + 0.15F * r},
                                 {c.x - 0.55F * r, c.y + 0.15F * r}, pen.shade);
      break;
    case Action::slices:  // three pictures, one above the other
      for (int n = -1; n <= 1; ++n) {
        const float y = c.y + 0.75F * static_cast<float>(n) * r;
        pen.draw.AddRect({c.x - 0.9F * r, y - 0.3F * r}, {c.x + 0.9F * r, y + 0.3F * r}, pen.shade,
                         0, 0, 0.6F * pen.thick);
      }
      break;
    case Action::see_through:  // a ball behind a pane
      pen.draw.AddCircleFilled({c.x + 0.25F * r, c.y + 0.25F * r}, 0.45F * r, pen.shade, 16);
      pen.draw.AddRect({c.x - 0.95F * r, c.y - 0.95F * r}, {c.x + 0.95F * r, c.y + 0.95F * r},
                       pen.shade, 0.3F * r, 0, 0.8F * pen.thick);
      break;
    case Action::suction:  // a tube, and what it draws in
      pen.draw.AddLine({c.x + r, c.y - r}, {c.x - 0.1F * r, c.y + 0.1F * r}, pen.shade,
                       1.4F * pen.thick);
      for (const float at : {-0.9F, -0.35F, 0.2F})
        pen.draw.AddCircleFilled({c.x + at * r, c.y + (0.55F + 0.25F * at) * r}, 0.17F * r,
                                 pen.shade, 8);
      break;
    case Action::keep:  // a box with a mark
      pen.draw.AddRect({c.x - 0.9F * r, c.y - 0.9F * r}, {c.x + 0.9F * r, c.y + 0.9F * r},
                       pen.shade, 0.2F * r, 0, 0.8F * pen.thick);
      pen.draw.AddLine({c.x - 0.5F * r, c.y}, {c.x - 0.1F * r, c.y + 0.4F * r}, pen.shade,
                       pen.thick);
      pen.draw.AddLine({c.x - 0.1F * r, c.y + 0.4F * r}, {c.x + 0.55F * r, c.y - 0.45F * r},
                       pen.shade, pen.thick);
      break;
    default:
      break;
  }
}

// icons for what the user reads
void reading_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  const ImVec2 c = pen.c;
  switch (action) {
    case Action::views:  // an eye
      for (const float way : {-1.0F, 1.0F})
        pen.draw.AddBezierCubic({c.x - r, c.y}, {c.x - 0.45F * r, c.y + 0.85F * way * r},
                                {c.x + 0.45F * r, c.y + 0.85F * way * r}, {c.x + r, c.y}, pen.shade,
                                0.8F * pen.thick);
      pen.draw.AddCircleFilled(c, 0.32F * r, pen.shade, 12);
      break;
    case Action::structures:  // a list with colours
      for (const float at : {-0.65F, 0.0F, 0.65F}) {
        pen.draw.AddCircleFilled({c.x - 0.7F * r, c.y + at * r}, 0.2F * r, pen.shade, 10);
        pen.draw.AddLine({c.x - 0.25F * r, c.y + at * r}, {c.x + r, c.y + at * r}, pen.shade,
                         0.7F * pen.thick);
      }
      break;
    case Action::task:  // a sheet of paper with text
      pen.draw.AddRect({c.x - 0.7F * r, c.y - r}, {c.x + 0.7F * r, c.y + r}, pen.shade, 0.15F * r,
                       0, 0.7F * pen.thick);
      for (const float at : {-0.45F, 0.0F, 0.45F})
        pen.draw.AddLine({c.x - 0.4F * r, c.y + at * r}, {c.x + 0.4F * r, c.y + at * r}, pen.shade,
                         0.6F * pen.thick);
      break;
    case Action::picture:  // a camera
      pen.draw.AddRect({c.x - r, c.y - 0.55F * r}, {c.x + r, c.y + 0.75F * r}, pen.shade, 0.2F * r,
                       0, 0.7F * pen.thick);
      pen.draw.AddRectFilled({c.x - 0.35F * r, c.y - 0.85F * r}, {c.x + 0.35F * r, c.y - 0.5F * r},
                             pen.shade);
      pen.draw.AddCircle({c.x, c.y + 0.1F * r}, 0.35F * r, pen.shade, 16, 0.7F * pen.thick);
      break;
    case Action::sound:  // a loudspeaker
      pen.draw.AddRectFilled({c.x - 0.9F * r, c.y - 0.35F * r}, {c.x - 0.4F * r, c.y + 0.35F * r},
                             pen.shade);
      pen.draw.AddTriangleFilled({c.x - 0.7F * r, c.y}, {c.x + 0.1F * r, c.y - 0.85F * r},
                                 {c.x + 0.1F * r, c.y + 0.85F * r}, pen.shade);
      pen.draw.PathArcTo(c, 0.65F * r, -0.8F, 0.8F, 12);
      pen.draw.PathStroke(pen.shade, 0, 0.6F * pen.thick);
      break;
    case Action::menu:  // three bars
      for (const float at : {-0.6F, 0.0F, 0.6F})
        pen.draw.AddLine({c.x - 0.9F * r, c.y + at * r}, {c.x + 0.9F * r, c.y + at * r}, pen.shade,
                         pen.thick);
      break;
    default:
      break;
  }
}

using Button = BarButton;
using Line = BarLine;

// icons of the page that plays a recording
void replay_icon(const Pen& pen, Action action) {
  const float r = pen.r;
  const ImVec2 c = pen.c;
  // a filled arrow head; way: -1 to the left, 1 to the right
  const auto head = [&](float x, float way) {
    pen.draw.AddTriangleFilled({x + 0.55F * way * r, c.y}, {x - 0.35F * way * r, c.y - 0.7F * r},
                               {x - 0.35F * way * r, c.y + 0.7F * r}, pen.shade);
  };
  const float way =
      action == Action::step_back || action == Action::stroke_back || action == Action::earlier
          ? -1.0F
          : 1.0F;
  switch (action) {
    case Action::step_back:
    case Action::step_on:
      head(c.x, way);
      break;
    case Action::stroke_back:  // an arrow head against a line
    case Action::stroke_on:
      head(c.x - 0.2F * way * r, way);
      pen.draw.AddLine({c.x + 0.7F * way * r, c.y - 0.75F * r},
                       {c.x + 0.7F * way * r, c.y + 0.75F * r}, pen.shade, pen.thick);
      break;
    case Action::beside:  // two pictures beside each other
      for (const float side : {-0.55F, 0.55F})
        pen.draw.AddRect({c.x + (side - 0.42F) * r, c.y - 0.75F * r},
                         {c.x + (side + 0.42F) * r, c.y + 0.75F * r}, pen.shade, 0, 0,
                         0.7F * pen.thick);
      break;
    case Action::compare:  // a table
      pen.draw.AddRect({c.x - r, c.y - 0.8F * r}, {c.x + r, c.y + 0.8F * r}, pen.shade, 0, 0,
                       0.7F * pen.thick);
      pen.draw.AddLine({c.x - r, c.y - 0.25F * r}, {c.x + r, c.y - 0.25F * r}, pen.shade,
                       0.6F * pen.thick);
      pen.draw.AddLine({c.x + 0.1F * r, c.y - 0.8F * r}, {c.x + 0.1F * r, c.y + 0.8F * r},
                       pen.shade, 0.6F * pen.thick);
      break;
    case Action::earlier:  // a bar on a line of time, moved along it
    case Action::later:
      pen.draw.AddLine({c.x - r, c.y + 0.8F * r}, {c.x + r, c.y + 0.8F * r}, pen.shade,
                       0.6F * pen.thick);
      pen.draw.AddLine({c.x - 0.8F * way * r, c.y - 0.1F * r},
                       {c.x + 0.3F * way * r, c.y - 0.1F * r}, pen.shade, pen.thick);
      pen.draw.AddTriangleFilled({c.x + 0.95F * way * r, c.y - 0.1F * r},
                                 {c.x + 0.2F * way * r, c.y - 0.65F * r},
                                 {c.x + 0.2F * way * r, c.y + 0.45F * r}, pen.shade);
      break;
    case Action::first_view:  // a house
      pen.draw.AddTriangleFilled({c.x - r, c.y}, {c.x + r, c.y}, {c.x, c.y - 0.9F * r}, pen.shade);
      pen.draw.AddRectFilled({c.x - 0.6F * r, c.y}, {c.x + 0.6F * r, c.y + 0.8F * r}, pen.shade);
      break;
    case Action::labels:  // half of a ball in colour
      pen.draw.AddCircle(c, 0.8F * r, pen.shade, 20, 0.8F * pen.thick);
      pen.draw.PathArcTo(c, 0.8F * r, -0.5F * kPi, 0.5F * kPi, 16);
      pen.draw.PathFillConvex(pen.shade);
      break;
    case Action::hide:  // a panel, crossed out
      pen.draw.AddRect({c.x - 0.8F * r, c.y - 0.6F * r}, {c.x + 0.8F * r, c.y + 0.6F * r},
                       pen.shade, 0.2F * r, 0, 0.7F * pen.thick);
      pen.draw.AddLine({c.x - 0.9F * r, c.y + 0.9F * r}, {c.x + 0.9F * r, c.y - 0.9F * r},
                       pen.shade, pen.thick);
      break;
    default:
      break;
  }
}

// Icons are drawn, so that no font with icons is needed. c: middle, r: half the size.
void icon(ImDrawList& draw, Action action, ImVec2 c, float r, ImU32 shade) {
  const Pen pen = {draw, c, r, shade};
  burr_icon(pen, action);
  work_icon(pen, action);
  page_icon(pen, action);
  operation_icon(pen, action);
  reading_icon(pen, action);
  replay_icon(pen, action);
}

class Bar {
 public:
  Bar(Ui& ui, std::optional<Action>& pressed, std::vector<BarPlace>* places)
      : ui_(ui), pressed_(pressed), places_(places), u_(ui.unit()) {}

  // the icon above its name
  void tall(const Button& b, bool chosen = false) {
    const ImVec2 p = ImGui::GetCursorScreenPos(), size = {66 * u_, 34 * u_};
    body(b, p, size, chosen);
    const ImU32 shade = chosen ? ink::kAccent : ink::kText;
    icon(*ImGui::GetWindowDrawList(), b.action, {p.x + size.x / 2, p.y + 11 * u_}, 8 * u_, shade);
    ui_.write(p.x + size.x / 2, p.y + 19 * u_, Ui::Letter::small, chosen ? ink::kText : ink::kDim,
              word(b.name), 0.5F);
  }

  // two buttons side by side, for less and more, below the name of what they change
  void pair(Word name, const Button& less, const Button& more, bool less_chosen = false,
            bool more_chosen = false) {
    const ImVec2 p = ImGui::GetCursorScreenPos();
    ui_.write(p.x + 33 * u_, p.y + 1 * u_, Ui::Letter::small, ink::kDim, word(name), 0.5F);
    two({p.x, p.y + 18 * u_}, less, more, less_chosen, more_chosen);
  }

  // the same without a name
  void row(const Button& left, const Button& right, bool left_chosen = false,
           bool right_chosen = false) {
    two(ImGui::GetCursorScreenPos(), left, right, left_chosen, right_chosen);
  }

  void gap(float points) { ImGui::Dummy({1, points * u_}); }

 private:
  void two(ImVec2 p, const Button& left, const Button& right, bool left_chosen, bool right_chosen) {
    int n = 0;
    for (const Button* b : {&left, &right}) {
      const ImVec2 at = {p.x + static_cast<float>(n++) * 35 * u_, p.y};
      ImGui::SetCursorScreenPos(at);
      const bool chosen = b == &left ? left_chosen : right_chosen;
      body(*b, at, {31 * u_, 26 * u_}, chosen);
      icon(*ImGui::GetWindowDrawList(), b->action, {at.x + 15.5F * u_, at.y + 13 * u_}, 7 * u_,
           chosen ? ink::kAccent : ink::kText);
    }
  }

  void body(const Button& b, ImVec2 p, ImVec2 size, bool chosen) {
    ImGui::PushID(static_cast<int>(b.action));
    if (ImGui::InvisibleButton("##b", size)) pressed_ = b.action;
    if (places_ != nullptr) places_->push_back({b.action, p.x, p.y, size.x, size.y});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 q = {p.x + size.x, p.y + size.y};
    if (ImGui::IsItemHovered()) {
      draw.AddRectFilled(p, q, ink::kOver, 6 * u_);
      std::string name = word(b.name);
      if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
      ImGui::SetTooltip("%s  ( %s )", name.c_str(), b.key);
    } else if (size.x < 40 * u_) {
      draw.AddRectFilled(p, q, ink::kButton, 6 * u_);
    }
    if (chosen) {  // a frame, so that not only colour shows the choice
      draw.AddRectFilled(p, q, ink::rgb(86, 180, 233, 40), 6 * u_);
      draw.AddRect(p, q, ink::kAccent, 6 * u_, 0, 1.5F * u_);
    }
    ImGui::PopID();
  }

  Ui& ui_;
  std::optional<Action>& pressed_;
  std::vector<BarPlace>* places_;
  float u_;
};

// The order of an operation: burr, water, view, what is read and kept; then what changes bone in
// other ways; then the program.
std::vector<Line> lines() {
  return {
      {{}, {Action::cut, Word::cut, "1"}, {}},
      {{}, {Action::rack, Word::rack, "7"}, {}},
      {Word::burr,
       {Action::smaller, Word::smaller, smaller_key()},
       Button{Action::larger, Word::larger, larger_key()}},
      {{}, {Action::kind, Word::help_kind, "K"}, Button{Action::coolant, Word::help_coolant, "I"}},
      {{}, {Action::suction, Word::help_suction, "6"}, Button{Action::touch, Word::touch, "3"}},
      {Word::speed, {Action::slower, Word::slower, ","}, Button{Action::faster, Word::faster, "."}},
      {Word::stroke, {Action::undo, Word::undo, "U"}, Button{Action::redo, Word::redo, "Y"}},
      {Word::help_view,
       {Action::slices, Word::help_slices, "V"},
       Button{Action::see_through, Word::help_see_through, "T"}},
      {{},
       {Action::views, Word::menu_views, "F, F5 - F8"},
       Button{Action::structures, Word::help_names, "F4"}},
      {Word::bar_session,
       {Action::task, Word::help_task, "O"},
       Button{Action::keep, Word::key_save, "S"}},
      {{},
       {Action::picture, Word::help_picture, "P"},
       Button{Action::sound, Word::help_sound, "M"}},
      {Word::help_tools,
       {Action::measure, Word::measure, "D"},
       Button{Action::mirror, Word::mirror, "X"}},
      {{}, {Action::add, Word::add, "2"}, Button{Action::smooth, Word::smooth, "5"}},
      {{}, {Action::back, Word::back, "4"}, Button{Action::reset, Word::reset, "R"}, 4},
      {{},
       {Action::export_, Word::export_word, "E"},
       Button{Action::settings, Word::settings, "F2"}},
      {{}, {Action::menu, Word::menu_all, "F10"}, Button{Action::help, Word::help, "F1"}},
      {{}, {Action::leave, Word::leave, "Q"}, {}},
  };
}

bool is_on(const ToolbarState& state, Action action) {
  switch (action) {
    case Action::cut:
      return state.mode == tick::ToolMode::cut;
    case Action::add:
      return state.mode == tick::ToolMode::add;
    case Action::touch:
      return state.mode == tick::ToolMode::touch;
    case Action::back:
      return state.mode == tick::ToolMode::restore;
    case Action::smooth:
      return state.mode == tick::ToolMode::smooth;
    case Action::measure:
      return state.measures;
    case Action::mirror:
      return state.mirrors;
    case Action::kind:
      return state.diamond;
    case Action::coolant:
      return state.coolant;
    case Action::suction:
      return state.suction;
    case Action::slices:
      return state.slices;
    case Action::see_through:
      return state.see_through;
    case Action::views:
      return state.views;
    case Action::structures:
      return state.structures;
    case Action::task:
      return state.task;
    case Action::sound:
      return state.sound;
    case Action::menu:
      return state.menu;
    case Action::rack:
      return state.rack;
    default:
      return false;
  }
}

}  // namespace

std::vector<Action> toolbar_actions() {
  std::vector<Action> all;
  for (const Line& line : lines()) {
    all.push_back(line.left.action);
    if (line.right) all.push_back(line.right->action);
  }
  return all;
}

std::optional<Action> draw_bar(Ui& ui, const std::vector<BarLine>& lines, float high, float free,
                               const std::function<bool(Action)>& is_on,
                               std::vector<BarPlace>* places) {
  std::optional<Action> pressed;
  const float u = ui.unit();
  const float h = high * u, w = 82 * u;
  const float y = std::max(6 * u, (free - h) / 2);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * u, 8 * u});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * u, 3 * u});
  ui.panel("##tools", 10 * u, y, w, h);
  Bar bar(ui, pressed, places);
  for (const Line& line : lines) {
    const bool left = is_on(line.left.action);
    if (!line.right)
      bar.tall(line.left, left);
    else if (line.heading)
      bar.pair(*line.heading, line.left, *line.right, left, is_on(line.right->action));
    else
      bar.row(line.left, *line.right, left, is_on(line.right->action));
    if (line.gap > 0) bar.gap(line.gap);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return pressed;
}

std::optional<Action> draw_toolbar(Ui& ui, const ToolbarState& state) {
  constexpr float kHigh = 645, kStrip = 78;  // [points]
  return draw_bar(ui, lines(), kHigh, ui.height() - kStrip * ui.unit(),
                  [&state](Action action) { return is_on(state, action); });
}

}  // namespace burr::app

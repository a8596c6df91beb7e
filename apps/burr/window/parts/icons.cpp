#include "window/parts/icons.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace

void icon(ImDrawList& draw, Action action, ImVec2 c, float r, ImU32 shade) {
  const Pen pen = {draw, c, r, shade};
  burr_icon(pen, action);
  work_icon(pen, action);
  page_icon(pen, action);
  operation_icon(pen, action);
  reading_icon(pen, action);
  replay_icon(pen, action);
}
}  // namespace burr::app

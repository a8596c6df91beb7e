#include "window/mill/step_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "window/parts/measuring.h"

namespace burr::app {
namespace {

using guidance::MarkKind;

constexpr ImU32 kShade = ink::rgb(0, 0, 0, 150);

render::Colour render_colour(MarkKind kind) {
  const guidance::MarkColour colour = guidance::colour_of(kind);
  return {colour.red, colour.green, colour.blue};
}

void write(const Ui& ui, ImVec2 at, ImU32 ink, const std::string& text) {
  const float u = ui.unit();
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const ImFont* font = ui.font(Ui::Letter::small);
  draw.AddText(font, font->FontSize, {at.x + u, at.y + u}, kShade, text.c_str());
  draw.AddText(font, font->FontSize, at, ink, text.c_str());
}

}  // namespace

ImU32 ink_of(MarkKind kind) {
  const guidance::MarkColour colour = guidance::colour_of(kind);
  const auto byte = [](float part) { return static_cast<unsigned>(255 * part + 0.5F); };
  return ink::rgb(byte(colour.red), byte(colour.green), byte(colour.blue));
}

void draw_sign(ImDrawList& draw, ImVec2 at, float r, float u, MarkKind kind, ImU32 shade) {
  switch (kind) {
    case MarkKind::target:
      draw.AddCircle(at, r, shade, 48, 2 * u);
      break;
    case MarkKind::plane:  // two lines, as the sides of a cut
      draw.AddLine({at.x - r, at.y - 0.4F * r}, {at.x + r, at.y - 0.4F * r}, shade, 2 * u);
      draw.AddLine({at.x - r, at.y + 0.4F * r}, {at.x + r, at.y + 0.4F * r}, shade, 2 * u);
      break;
    case MarkKind::spare: {  // a ring with a bar: do not enter
      const float c = 0.7071F * r;
      draw.AddCircle(at, r, shade, 32, 2 * u);
      draw.AddLine({at.x - c, at.y - c}, {at.x + c, at.y + c}, shade, 2 * u);
      break;
    }
    case MarkKind::place:
      draw.AddLine({at.x - r, at.y}, {at.x + r, at.y}, shade, 1.5F * u);
      draw.AddLine({at.x, at.y - r}, {at.x, at.y + r}, shade, 1.5F * u);
      break;
  }
}

Word legend_of(MarkKind kind) {
  switch (kind) {
    case MarkKind::target:
      return Word::legend_target;
    case MarkKind::plane:
      return Word::legend_plane;
    case MarkKind::spare:
      return Word::legend_spare;
    case MarkKind::place:
      break;
  }
  return Word::legend_place;
}

std::string mark_text(const guidance::StepMark& mark) {
  const std::string name = place_name(mark.name);
  switch (mark.kind) {
    case MarkKind::target:
      return say(Word::mark_target, name);
    case MarkKind::plane:
      return say(Word::mark_plane, name);
    case MarkKind::spare:
      return say(Word::mark_spare, name);
    case MarkKind::place:
      break;
  }
  return name;
}

void StepLight::on(guidance::StepMarks marks, render::Scene& scene) {
  off(scene);
  on_ = true;
  marks_ = std::move(marks);
  const auto light = [&](const std::vector<volume::TissueId>& tissues, MarkKind kind) {
    for (const volume::TissueId id : tissues)
      if (id < scene.tissue_colours.size()) {
        colours_.emplace_back(id, scene.tissue_colours[id]);
        scene.tissue_colours[id] = render_colour(kind);
      }
  };
  light(marks_.target, MarkKind::target);
  light(marks_.spare, MarkKind::spare);  // last: what is to be spared is never shown as a target
}

void StepLight::off(render::Scene& scene) {
  for (auto one = colours_.rbegin(); one != colours_.rend(); ++one)
    scene.tissue_colours[one->first] = one->second;
  colours_.clear();
  marks_ = {};
  on_ = false;
}

void StepLight::draw(const Ui& ui, const render::Camera& camera, float covered) const {
  if (!on_) return;
  const float u = ui.unit();
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  // what lies behind the slices has no sign over them
  draw.PushClipRect({0, 0}, {ui.width() - covered, ui.height()});
  for (const auto& line : marks_.outline) {
    const auto a = on_picture(camera, line[0], ui.width(), ui.height());
    const auto b = on_picture(camera, line[1], ui.width(), ui.height());
    if (a && b) draw.AddLine(*a, *b, ink_of(MarkKind::plane), 2.5F * u);
  }
  for (const guidance::StepMark& mark : marks_.marks) {
    const auto middle = on_picture(camera, mark.at, ui.width(), ui.height());
    const auto edge =
        on_picture(camera, mark.at + mark.radius * camera.right(), ui.width(), ui.height());
    if (!middle || !edge) continue;                   // behind the eye
    const bool plane = mark.kind == MarkKind::plane;  // its lines show it
    // a ring has the size of what it is about, any other sign one that is seen
    const float r = mark.kind == MarkKind::target
                        ? std::max(std::hypot(edge->x - middle->x, edge->y - middle->y), 6 * u)
                        : 6 * u;
    if (!plane) {
      draw_sign(draw, {middle->x + u, middle->y + u}, r, u, mark.kind, kShade);
      draw_sign(draw, *middle, r, u, mark.kind, ink_of(mark.kind));
    }
    if (mark.name.empty()) continue;
    write(ui, {std::round(middle->x + r + 5 * u), std::round(middle->y - 8 * u)}, ink_of(mark.kind),
          mark_text(mark));
  }
  draw.PopClipRect();
}

}  // namespace burr::app

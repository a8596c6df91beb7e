#include "window/mill/views_bar.h"

#include <array>
#include <string>

#include "burr/render/microscope.h"
#include "shared/word_names.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

// Icons are drawn, so that no font with icons is needed. c: middle, r: half the size.
void icon(ImDrawList& draw, ViewKind kind, ImVec2 c, float r, ImU32 shade) {
  const float thick = 0.2F * r;
  switch (kind) {
    case ViewKind::microscope:  // a field with cross hairs
      draw.AddCircle(c, 0.95F * r, shade, 24, thick);
      draw.AddCircle(c, 0.4F * r, shade, 16, 0.8F * thick);
      for (const auto& [x, y] : {std::pair{1.F, 0.F}, {-1.F, 0.F}, {0.F, 1.F}, {0.F, -1.F}})
        draw.AddLine({c.x + 0.6F * r * x, c.y + 0.6F * r * y},
                     {c.x + 0.95F * r * x, c.y + 0.95F * r * y}, shade, thick);
      break;
    case ViewKind::whole: {  // corners around a ball
      draw.AddCircleFilled(c, 0.42F * r, shade, 16);
      for (const float x : {-1.F, 1.F})
        for (const float y : {-1.F, 1.F}) {
          const ImVec2 p = {c.x + 0.95F * r * x, c.y + 0.85F * r * y};
          draw.AddLine(p, {p.x - 0.5F * r * x, p.y}, shade, thick);
          draw.AddLine(p, {p.x, p.y - 0.5F * r * y}, shade, thick);
        }
      break;
    }
    case ViewKind::endoscope:  // a rod and its cone of light
      draw.AddLine({c.x - r, c.y + r}, {c.x - 0.1F * r, c.y + 0.1F * r}, shade, 2 * thick);
      draw.AddTriangle({c.x, c.y}, {c.x + r, c.y - 0.35F * r}, {c.x + 0.35F * r, c.y - r}, shade,
                       0.8F * thick);
      break;
    case ViewKind::free:  // an arrow around
      draw.PathArcTo(c, 0.8F * r, -2.6F, 2.0F, 24);
      draw.PathStroke(shade, 0, thick);
      draw.AddTriangleFilled({c.x - 0.75F * r, c.y - 0.95F * r}, {c.x - 0.2F * r, c.y - 0.35F * r},
                             {c.x - 0.95F * r, c.y - 0.15F * r}, shade);
      break;
  }
}

bool button(Ui& ui, const char* id, ImVec2 size, bool chosen, const std::string& says) {
  const float u = ui.unit();
  const ImVec2 p = ImGui::GetCursorScreenPos(), q = {p.x + size.x, p.y + size.y};
  const bool pressed = ImGui::InvisibleButton(id, size);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(p, q, ImGui::IsItemHovered() ? ink::kOver : ink::kButton, 6 * u);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", says.c_str());
  if (chosen) {  // a frame, so that not only colour shows the choice
    draw.AddRectFilled(p, q, ink::rgb(86, 180, 233, 40), 6 * u);
    draw.AddRect(p, q, ink::kAccent, 6 * u, 0, 1.5F * u);
  }
  return pressed;
}

}  // namespace

ViewsBar draw_views_bar(Ui& ui, ViewKind kind, double field, const std::optional<double>& beyond) {
  struct Entry {
    ViewKind kind;
    Word name;
    const char* key;
  };
  constexpr std::array<Entry, 4> kEntries = {{{ViewKind::microscope, Word::view_microscope, "F9"},
                                              {ViewKind::whole, Word::view_whole, "F11"},
                                              {ViewKind::endoscope, Word::view_endoscope, "F12"},
                                              {ViewKind::free, Word::view_free, "Shift F11"}}};
  ViewsBar out;
  const float u = ui.unit();
  const bool scope = kind == ViewKind::microscope;
  const bool deep = scope && beyond;
  const float w = 8 * u + 4 * 37 * u + 4 * u, h = (deep ? 106 : scope ? 74 : 42) * u;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * u, 8 * u});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * u, 4 * u});
  ui.panel("##views", 104 * u, ui.height() - hud_height(ui) - h - 6 * u, w, h);
  for (const Entry& entry : kEntries) {
    if (&entry != kEntries.data()) ImGui::SameLine();
    const ImVec2 p = ImGui::GetCursorScreenPos(), size = {33 * u, 26 * u};
    const bool chosen = entry.kind == kind;
    const std::string says = std::string(word(entry.name)) + "  ( " + entry.key + " )";
    if (button(ui, entry.key, size, chosen, says)) out.view = entry.kind;
    icon(*ImGui::GetWindowDrawList(), entry.kind, {p.x + size.x / 2, p.y + size.y / 2}, 8 * u,
         chosen ? ink::kAccent : ink::kText);
  }
  // a row of "-", a text and "+"
  const auto row = [&](const char* less, const char* more, Word less_does, Word more_does,
                       const std::string& text) {
    int pressed = 0;
    const ImVec2 p = ImGui::GetCursorScreenPos(), size = {26 * u, 26 * u};
    const auto sign = [&](ImVec2 at, bool plus) {
      ImDrawList& draw = *ImGui::GetWindowDrawList();
      const ImVec2 c = {at.x + size.x / 2, at.y + size.y / 2};
      draw.AddLine({c.x - 6 * u, c.y}, {c.x + 6 * u, c.y}, ink::kText, 1.8F * u);
      if (plus) draw.AddLine({c.x, c.y - 6 * u}, {c.x, c.y + 6 * u}, ink::kText, 1.8F * u);
    };
    if (button(ui, less, size, false, word(less_does))) pressed = -1;
    sign(p, false);
    const float right = p.x + 4 * 37 * u - 4 * u;
    ImGui::SetCursorScreenPos({right - size.x, p.y});
    if (button(ui, more, size, false, word(more_does))) pressed = 1;
    sign({right - size.x, p.y}, true);
    ui.write(0.5F * (p.x + right), p.y + 6 * u, Ui::Letter::small, ink::kText, text, 0.5F);
    return pressed;
  };
  if (scope)
    out.magnify =
        row("##less", "##more", Word::view_less, Word::view_more,
            say(Word::view_field, render::kFields[render::kFirstField] / field, 1e3 * field));
  if (deep)
    out.refocus = row("##nearer", "##farther", Word::focus_nearer, Word::focus_farther,
                      say(Word::focus_at, 1e3 * *beyond));
  ImGui::End();
  ImGui::PopStyleVar(2);
  return out;
}

}  // namespace burr::app

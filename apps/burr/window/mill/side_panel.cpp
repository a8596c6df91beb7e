#include "window/mill/side_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "shared/word_names.h"
#include "window/mill/cross_button.h"
#include "window/mill/step_light.h"
#include "window/parts/hud.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
using volume::TissueKind;

constexpr float kPadding = 12, kRow = 23, kLegend = 159;  // [points]

// The shape tells the kind, not the colour alone: soft is a disc, solid a square, air a ring.
void swatch(ImDrawList& draw, ImVec2 at, float r, TissueKind kind, ImU32 colour) {
  if (kind == TissueKind::soft)
    draw.AddCircleFilled(at, r, colour, 20);
  else if (kind == TissueKind::solid)
    draw.AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r}, colour, 0.3F * r);
  else
    draw.AddCircle(at, 0.8F * r, colour, 20, 0.4F * r);
}

// an eye; crossed out where hidden
void eye(ImDrawList& draw, ImVec2 c, float u, bool hidden, ImU32 colour) {
  draw.AddBezierCubic({c.x - 7 * u, c.y}, {c.x - 3 * u, c.y - 6 * u}, {c.x + 3 * u, c.y - 6 * u},
                      {c.x + 7 * u, c.y}, colour, 1.3F * u);
  draw.AddBezierCubic({c.x - 7 * u, c.y}, {c.x - 3 * u, c.y + 6 * u}, {c.x + 3 * u, c.y + 6 * u},
                      {c.x + 7 * u, c.y}, colour, 1.3F * u);
  if (hidden)
    draw.AddLine({c.x - 6 * u, c.y + 6 * u}, {c.x + 6 * u, c.y - 6 * u}, colour, 1.6F * u);
  else
    draw.AddCircleFilled(c, 2.4F * u, colour, 12);
}

// a pin: a disc on a point; filled where it is set
void pin_sign(ImDrawList& draw, ImVec2 c, float u, bool set, ImU32 colour) {
  draw.AddLine({c.x, c.y}, {c.x, c.y + 7 * u}, colour, 1.4F * u);
  if (set)
    draw.AddCircleFilled({c.x, c.y - 2 * u}, 4 * u, colour, 16);
  else
    draw.AddCircle({c.x, c.y - 2 * u}, 3.6F * u, colour, 16, 1.3F * u);
}

Word heading_of(const Structures::Row& row) {
  if (row.spare) return Word::list_spare;
  if (row.kind == TissueKind::soft) return Word::list_soft;
  return row.kind == TissueKind::solid ? Word::list_solid : Word::list_air;
}

std::string millimetres(double distance) { return fmt::format("{:.1f} mm", 1e3 * distance); }

// One row of the list, at the cursor.
void draw_row(Ui& ui, const Structures& structures, const Structures::Row& row, bool pinned,
              bool distances, float wide, StructuresPressed& pressed) {
  const float u = ui.unit(), high = kRow * u;
  const ImVec2 p = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImGui::PushID(row.id);
  const float left = p.x + 26 * u, right = p.x + wide - 26 * u;
  if (ImGui::InvisibleButton("##name", {wide, high})) {
    const float x = ImGui::GetIO().MousePos.x;
    if (x < left && row.kind == TissueKind::soft)
      pressed.toggle = row.id;
    else if (x >= left)
      pressed.pin = row.id;
  }
  if (ImGui::IsItemHovered()) {
    draw.AddRectFilled(p, {p.x + wide, p.y + high}, ink::kOver, 4 * u);
    const bool at_eye = ImGui::GetIO().MousePos.x < left && row.kind == TissueKind::soft;
    ImGui::SetTooltip("%s", word(at_eye   ? (row.hidden ? Word::list_show : Word::list_hide)
                                 : pinned ? Word::list_unpin
                                          : Word::list_pin));
  }
  ImGui::PopID();
  const float middle = p.y + high / 2;
  if (row.kind == TissueKind::soft)
    eye(draw, {p.x + 11 * u, middle}, u, row.hidden, row.hidden ? ink::kDim : ink::kText);
  swatch(draw, {left + 8 * u, middle}, 5.5F * u, row.kind, swatch_of(structures.tissue(row.id)));
  std::string far;
  if (distances && row.distance) far = millimetres(*row.distance);
  const float end = right - (far.empty() ? 0 : ui.width_of(Letter::body, far) + 8 * u);
  draw.PushClipRect({left, p.y}, {end, p.y + high}, true);
  ui.write(left + 22 * u, p.y + 3 * u, Letter::body, row.hidden ? ink::kDim : ink::kText,
           structures.name(row.id));
  draw.PopClipRect();
  const ImU32 shade = row.spare && row.distance && *row.distance < 2e-3 ? ink::kWarn : ink::kDim;
  ui.write(right, p.y + 3 * u, Letter::body, shade, far, 1);
  pin_sign(draw, {p.x + wide - 12 * u, middle}, u, pinned, pinned ? ink::kAccent : ink::kDim);
}

// The signs that the picture has besides the structures.
void draw_legend(Ui& ui, float x, float y) {
  const float u = ui.unit();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto line = [&](int n, Word says) {
    const float at = y + static_cast<float>(n) * 21 * u;
    ui.write(x + 30 * u, at, Letter::small, ink::kDim, word(says));
    return ImVec2{x + 12 * u, at + 8 * u};
  };
  const ImVec2 hand = line(0, Word::legend_hand);
  draw.AddCircleFilled(hand, 4.5F * u, ink::rgb(64, 166, 255), 16);
  const ImVec2 force = line(1, Word::legend_force);
  draw.AddLine({force.x - 9 * u, force.y}, {force.x + 3 * u, force.y}, ink::rgb(255, 115, 38),
               2.5F * u);
  draw.AddTriangleFilled({force.x + 2 * u, force.y - 5 * u}, {force.x + 2 * u, force.y + 5 * u},
                         {force.x + 9 * u, force.y}, ink::rgb(255, 115, 38));
  const ImVec2 ring = line(2, Word::legend_burr);
  draw.AddCircle(ring, 5 * u, ink::kAccent, 20, 1.4F * u);
  int n = 3;
  using guidance::MarkKind;
  for (const MarkKind kind : {MarkKind::target, MarkKind::plane, MarkKind::spare, MarkKind::place})
    draw_sign(draw, line(n++, legend_of(kind)), 5 * u, u, kind, ink_of(kind));
}

}  // namespace

ImU32 swatch_of(const volume::Tissue& tissue) {
  const auto byte = [](float part) {
    return static_cast<unsigned>(std::clamp(part, 0.0F, 1.0F) * 255 + 0.5F);
  };
  return ink::rgb(byte(tissue.colour[0]), byte(tissue.colour[1]), byte(tissue.colour[2]));
}

std::optional<Leaf> draw_side_tabs(Ui& ui, Leaf now, bool task, bool steps, bool structures) {
  struct Tab {
    Leaf leaf;
    Word name;
    const char* key;
    bool there;
  };
  std::optional<Leaf> pressed;
  const float u = ui.unit(), high = 36 * u;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {4 * u, 4 * u});
  ui.panel("##leaves", kSideLeft * u, kSideTop * u, kSideWide * u, high);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  float x = (kSideLeft + 5) * u;
  const float y = kSideTop * u + 4 * u;
  for (const Tab& tab :
       {Tab{Leaf::task, Word::leaf_task, "O", task}, Tab{Leaf::steps, Word::leaf_steps, "O", steps},
        Tab{Leaf::structures, Word::leaf_structures, "F4", structures}}) {
    if (!tab.there) continue;
    const std::string name = word(tab.name);
    const ImVec2 size = {ui.width_of(Letter::body, name) + 24 * u, high - 8 * u};
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton(name.c_str(), size)) pressed = tab.leaf;
    const bool over = ImGui::IsItemHovered();
    if (over) ImGui::SetTooltip("%s  ( %s )", name.c_str(), tab.key);
    if (over || tab.leaf == now)
      draw.AddRectFilled({x, y}, {x + size.x, y + size.y},
                         tab.leaf == now ? ink::rgb(86, 180, 233, 60) : ink::kOver, 5 * u);
    if (tab.leaf == now)
      draw.AddRectFilled({x + 6 * u, y + size.y - 2.5F * u}, {x + size.x - 6 * u, y + size.y},
                         ink::kAccent);
    ui.write(x + 12 * u, y + 6 * u, Letter::body, tab.leaf == now ? ink::kText : ink::kDim, name);
    x += size.x + 3 * u;
  }
  if (draw_cross(ui, (kSideLeft + kSideWide - 32) * u, y)) pressed = Leaf::none;
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

StructuresPressed draw_structures(Ui& ui, const Structures& structures, const PinnedLabels& pins,
                                  bool distances) {
  StructuresPressed pressed;
  const float u = ui.unit(), y = kSideLeafTop * u;
  const std::vector<Structures::Row>& rows = structures.rows();
  std::size_t lines = rows.size();
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (n == 0 || heading_of(rows[n]) != heading_of(rows[n - 1])) ++lines;
  const float room = ui.height() - hud_height(ui) - y - kSideFoot * u;
  const float legend = kLegend * u, top = 30 * u;
  const float high = std::min(room, static_cast<float>(lines) * kRow * u + legend + top + 12 * u);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, 0);
  ui.panel("##structures", kSideLeft * u, y, kSideWide * u, high);
  const float x = (kSideLeft + kPadding) * u, wide = (kSideWide - 2 * kPadding) * u;
  ui.write(x, y + 8 * u, Letter::small, ink::kDim, word(Word::list_hint));
  if (distances)
    ui.write(x + wide - 26 * u, y + 8 * u, Letter::small, ink::kDim, word(Word::list_distance), 1);
  ImGui::SetCursorScreenPos({x, y + top});
  ImGui::BeginChild("##rows", {wide + 6 * u, high - top - legend});
  const float inner = ImGui::GetContentRegionAvail().x - 6 * u;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (n == 0 || heading_of(rows[n]) != heading_of(rows[n - 1])) {
      const ImVec2 p = ImGui::GetCursorScreenPos();
      ImGui::Dummy({inner, kRow * u});
      ui.write(p.x, p.y + 5 * u, Letter::small, rows[n].spare ? ink::kWarn : ink::kAccent,
               word(heading_of(rows[n])));
    }
    draw_row(ui, structures, rows[n], pins.pinned(rows[n].id), distances, inner, pressed);
  }
  ImGui::EndChild();
  const float foot = y + high - legend;
  ImGui::GetWindowDrawList()->AddLine({x, foot}, {x + wide, foot}, ink::kLine, u);
  draw_legend(ui, x, foot + 9 * u);
  ImGui::End();
  ImGui::PopStyleVar(2);
  return pressed;
}

}  // namespace burr::app

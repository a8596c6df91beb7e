#include "window/mill/mill_names.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "shared/word_names.h"
#include "window/mill/side_panel.h"
#include "window/parts/hud.h"

namespace burr::app {

using volume::TissueId;

MillNames::MillNames(const MillSite& site, MillCase& work_case, const Pointer& pointer,
                     MillView& view)
    : scene_(site.scene),
      options_(site.options),
      notes_(site.notes),
      over_(site.over),
      case_(work_case),
      pointer_(pointer),
      view_(view) {}

void MillNames::look(bool lists, bool pressing) {
  const Clock::time_point now = Clock::now();
  if (now - looked_ < std::chrono::milliseconds(100)) return;
  looked_ = now;
  under_.reset();
  under_in_slice_.reset();
  if (!case_.names_offered() || !over_.panels || over_.page() || pointer_.over_panel()) return;
  if (lists && options_.allowed.distance)
    view_.structures().measure(scene_.burr.world_from_tool.p, scene_.burr.radius);
  const Eigen::Vector2d at = pointer_.in_picture();
  if (const auto point = view_.slices().point_at(scene_, at.x(), at.y())) {
    const TissueId id = view_.structures().at(*point);
    if (id != 0) under_in_slice_ = id;
    return;
  }
  if (!pressing) under_ = view_.structures().under(scene_, pointer_.mouse());
}

void MillNames::pin(TissueId id) {
  if (const auto place = view_.structures().place(id)) pins_.toggle(id, *place);
}

void MillNames::pin_under_pointer() {
  if (!case_.names_offered()) return case_.say_refused();
  if (under_)
    pins_.toggle(under_->id, under_->at);
  else if (under_in_slice_)
    pin(*under_in_slice_);
  else
    notes_.note(word(Word::names_nothing));
}

void MillNames::draw_name(const Ui& ui, bool pressing) const {
  const auto id = under_ ? std::optional(under_->id) : under_in_slice_;
  if (!id || pressing || pointer_.over_panel()) return;
  const float u = ui.unit(), high = 24 * u;
  const std::string name = view_.structures().name(*id);
  const float wide = ui.width_of(Ui::Letter::body, name) + 34 * u;
  const Eigen::Vector2d at = pointer_.in_picture();
  float x = static_cast<float>(at.x()) + 20 * u, y = static_cast<float>(at.y()) - 40 * u;
  x = std::min(x, ui.width() - wide - 4 * u);
  if (y < 4 * u) y = static_cast<float>(at.y()) + 26 * u;
  y = std::min(y, ui.height() - hud_height(ui) - high - 4 * u);  // the strip stays readable
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({x, y}, {x + wide, y + high}, ink::kPanel, 5 * u);
  draw.AddRectFilled({x + 8 * u, y + 7 * u}, {x + 18 * u, y + 17 * u},
                     swatch_of(view_.structures().tissue(*id)), 2 * u);
  const ImFont* font = ui.font(Ui::Letter::body);
  draw.AddText(font, font->FontSize,
               {std::round(x + 26 * u), std::round(y + (high - font->FontSize) / 2)}, ink::kText,
               name.c_str());
}

void MillNames::draw_pins(const Ui& ui, float left) const {
  if (pins_.empty() || !case_.names_offered()) return;
  const float u = ui.unit();
  const float top = view_.cube_top() + kCube + 8;  // the cube and the button above it stay free
  pins_.draw(
      ui, scene_.camera,
      {left * u, ui.width() - view_.column() - 10 * u, top * u,
       ui.height() - hud_height(ui) - 44 * u},
      [this](TissueId id) { return view_.structures().name(id); },
      [this](TissueId id) { return swatch_of(view_.structures().tissue(id)); });
}

}  // namespace burr::app

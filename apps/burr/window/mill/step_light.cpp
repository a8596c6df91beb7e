#include "window/mill/step_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "shared/word_names.h"
#include "window/parts/measuring.h"

namespace burr::app {
namespace {

constexpr render::Colour kLit = {guidance::kLitColour[0], guidance::kLitColour[1],
                                 guidance::kLitColour[2]};
}  // namespace

void StepLight::on(const scenario::Step& step, const scenario::CaseLesson& lesson,
                   const volume::TissueTable& tissues, render::Scene& scene) {
  off(scene);
  on_ = true;
  rings_ = guidance::rings_of(step, lesson);
  for (const volume::TissueId id : guidance::lit_tissues(step, lesson, tissues))
    if (id < scene.tissue_colours.size()) {
      colours_.emplace_back(id, scene.tissue_colours[id]);
      scene.tissue_colours[id] = kLit;
    }
}

void StepLight::off(render::Scene& scene) {
  for (const auto& [id, colour] : colours_) scene.tissue_colours[id] = colour;
  colours_.clear();
  rings_.clear();
  on_ = false;
}

void StepLight::draw(const Ui& ui, const render::Camera& camera) const {
  if (!on_) return;
  const float u = ui.unit();
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  constexpr ImU32 kRing = ink::rgb(90, 240, 115), kShade = ink::rgb(0, 0, 0, 150);
  for (const guidance::Ring& ring : rings_) {
    const auto middle = on_picture(camera, ring.at, ui.width(), ui.height());
    const auto edge =
        on_picture(camera, ring.at + ring.radius * camera.right(), ui.width(), ui.height());
    if (!middle || !edge) continue;  // behind the eye
    const float r = std::max(std::hypot(edge->x - middle->x, edge->y - middle->y), 6 * u);
    draw.AddCircle({middle->x + u, middle->y + u}, r, kShade, 48, 2 * u);
    draw.AddCircle(*middle, r, kRing, 48, 2 * u);
    if (ring.name.empty()) continue;
    const ImFont* font = ui.font(Ui::Letter::small);
    const std::string name = place_name(ring.name);
    const ImVec2 at = {std::round(middle->x + r + 5 * u), std::round(middle->y - 8 * u)};
    draw.AddText(font, font->FontSize, {at.x + u, at.y + u}, kShade, name.c_str());
    draw.AddText(font, font->FontSize, at, kRing, name.c_str());
  }
}

}  // namespace burr::app

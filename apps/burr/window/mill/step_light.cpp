#include "window/mill/step_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "burr/workshop/label_check.h"
#include "window/mill/measuring.h"
#include "window/shell/anatomy.h"

namespace burr::app {
namespace {

constexpr render::Colour kLit = {0.35F, 0.95F, 0.45F};
constexpr double kPlace = 0.8e-3;  // radius of the ring around a point [m]

void add_shape(const scenario::Shape& shape, const std::string& name, std::vector<Ring>& rings) {
  using scenario::ShapeKind;
  switch (shape.kind) {
    case ShapeKind::ball:
      rings.push_back({shape.a.at, shape.radius, name});
      return;
    case ShapeKind::capsule:
      rings.push_back({shape.a.at, shape.radius, name});
      rings.push_back({shape.b.at, shape.radius, {}});
      return;
    case ShapeKind::box:
      rings.push_back({shape.a.at, 0.5 * shape.size.minCoeff(), name});
      return;
    case ShapeKind::tube: {
      const auto last = static_cast<double>(shape.points.size() - 1);
      const auto from = static_cast<std::size_t>(std::lround(shape.from * last)),
                 to = static_cast<std::size_t>(std::lround(shape.to * last));
      for (std::size_t n = from; n <= to; ++n)
        rings.push_back({shape.points[n], shape.radius, n == from ? name : std::string()});
      return;
    }
    case ShapeKind::half_space:
    case ShapeKind::within:
    case ShapeKind::between:
      return;
  }
}

void add_named(const std::string& name, const scenario::Lesson& lesson, std::vector<Ring>& rings) {
  const scenario::CaseRegion* region = lesson.region(name);
  if (region != nullptr)
    for (const scenario::Shape& shape : region->add) add_shape(shape, name, rings);
  if (const scenario::Landmark* place = lesson.landmark(name))
    for (const math::Vec3& point : place->points)
      rings.push_back(
          {point, kPlace, region == nullptr && &point == &place->points.front() ? name : ""});
}

}  // namespace

std::vector<Ring> rings_of(const scenario::Step& step, const scenario::Lesson& lesson) {
  std::vector<Ring> rings;
  for (const std::string& name : step.show) add_named(name, lesson, rings);
  if (step.show.empty() && !step.region.empty()) add_named(step.region, lesson, rings);
  return rings;
}

void StepLight::on(const scenario::Step& step, const scenario::Lesson& lesson,
                   const volume::TissueTable& tissues, render::Scene& scene) {
  off(scene);
  on_ = true;
  rings_ = rings_of(step, lesson);
  std::vector<std::string> names = step.show;
  if (names.empty() && !step.structure.empty()) names.push_back(step.structure);
  for (const std::string& name : names)
    if (const scenario::Structure* structure = lesson.structure(name))
      for (const volume::TissueId id : workshop::tissues_of(*structure, tissues))
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
  for (const Ring& ring : rings_) {
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

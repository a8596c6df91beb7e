#include "window/mill/pinned_labels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "window/parts/measuring.h"

namespace burr::app {
namespace {

constexpr float kGap = 4;  // between plates [pixel]

// Sets the heights of one side's plates, which are in the order of their points.
void stack(std::vector<Plate>& side, float high, const PlateArea& area) {
  float free = area.top;
  for (Plate& plate : side) {
    plate.at.y = std::max(plate.at.y, free);
    free = plate.at.y + high + kGap;
  }
  float end = area.bottom;
  for (auto plate = side.rbegin(); plate != side.rend(); ++plate) {
    plate->at.y = std::min(plate->at.y, end - high);
    end = plate->at.y - kGap;
  }
}

}  // namespace

std::vector<Plate> plates_for(const std::vector<ImVec2>& points, const std::vector<float>& widths,
                              float high, const PlateArea& area) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].y < points[b].y; });
  std::vector<Plate> left, right;
  for (const std::size_t n : order) {
    const bool at_left = points[n].x < (area.left + area.right) / 2;
    (at_left ? left : right)
        .push_back(
            {n, at_left, {at_left ? area.left : area.right - widths[n], points[n].y - high / 2}});
  }
  stack(left, high, area);
  stack(right, high, area);
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

bool PinnedLabels::toggle(volume::TissueId id, const math::Vec3& at) {
  if (std::erase_if(pins_, [id](const Pin& pin) { return pin.id == id; }) > 0) return false;
  pins_.push_back({id, at});
  return true;
}

bool PinnedLabels::pinned(volume::TissueId id) const {
  return std::any_of(pins_.begin(), pins_.end(), [id](const Pin& pin) { return pin.id == id; });
}

void PinnedLabels::draw(const Ui& ui, const render::Camera& camera, const PlateArea& area,
                        const Name& name, const ColourOf& colour) const {
  const float u = ui.unit(), high = 22 * u;
  std::vector<ImVec2> points;
  std::vector<float> widths;
  std::vector<std::string> names;
  std::vector<volume::TissueId> ids;
  for (const Pin& pin : pins_) {
    const auto at = on_picture(camera, pin.at, ui.width(), ui.height());
    if (!at || at->x < area.left || at->x > area.right || at->y < 0 || at->y > area.bottom)
      continue;
    points.push_back(*at);
    names.push_back(name(pin.id));
    widths.push_back(ui.width_of(Ui::Letter::small, names.back()) + 28 * u);
    ids.push_back(pin.id);
  }
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const ImFont* font = ui.font(Ui::Letter::small);
  constexpr ImU32 kShade = ink::rgb(0, 0, 0, 150);
  for (const Plate& plate : plates_for(points, widths, high, area)) {
    const ImVec2 from = {plate.at.x + (plate.left ? widths[plate.pin] : 0), plate.at.y + high / 2},
                 to = points[plate.pin];
    draw.AddLine({from.x + u, from.y + u}, {to.x + u, to.y + u}, kShade, 1.5F * u);
    draw.AddLine(from, to, ink::kText, 1.2F * u);
    draw.AddCircle(to, 3.5F * u, kShade, 16, 3 * u);
    draw.AddCircle(to, 3.5F * u, ink::kText, 16, 1.3F * u);
    draw.AddRectFilled(plate.at, {plate.at.x + widths[plate.pin], plate.at.y + high}, ink::kPanel,
                       5 * u);
    draw.AddRectFilled({plate.at.x + 7 * u, plate.at.y + 7 * u},
                       {plate.at.x + 15 * u, plate.at.y + 15 * u}, colour(ids[plate.pin]), 2 * u);
    draw.AddText(
        font, font->FontSize,
        {std::round(plate.at.x + 21 * u), std::round(plate.at.y + (high - font->FontSize) / 2)},
        ink::kText, names[plate.pin].c_str());
  }
}

}  // namespace burr::app

#include "window/mill/pointer.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <utility>

namespace burr::app {

void Pointer::begin() {
  desk_.mouse(mouse_x_, mouse_y_);
  aim_at_mouse();
}

void Pointer::measure_window() {
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &width_, &height_);
}

void Pointer::moved_to(int x, int y) {
  mouse_leads();
  mouse_x_ = x;
  mouse_y_ = y;
  if (!over_slices()) aim_at_mouse();
}

void Pointer::mouse_leads() {
  mouse_moved_ = true;
  if (std::exchange(leads_, false)) SDL_ShowCursor(SDL_ENABLE);
}

void Pointer::lead() {
  if (leads_) return;
  leads_ = true;
  const bool nowhere =
      !mouse_moved_ || aim_x_ < 0 || aim_y_ < 0 || aim_x_ >= width_ || aim_y_ >= height_ ||
      desk_.ui().over_panel(static_cast<float>(aim_x_), static_cast<float>(aim_y_));
  pad_x_ = nowhere ? 0.5 * width_ : aim_x_;
  pad_y_ = nowhere ? 0.5 * height_ : aim_y_;
  mouse_x_ = static_cast<int>(pad_x_);
  mouse_y_ = static_cast<int>(pad_y_);
  aim_at_mouse();
  SDL_ShowCursor(SDL_DISABLE);
}

void Pointer::move(double right, double up) {
  if (right == 0 && up == 0) return;
  lead();
  step_to(pad_x_ + right * height_, pad_y_);
  step_to(pad_x_, pad_y_ - up * height_);
  aim_at_mouse();
}

// Moves the point, unless a panel or a slice is there.
void Pointer::step_to(double x, double y) {
  x = std::clamp(x, 0.0, width_ - 1.0);
  y = std::clamp(y, 0.0, height_ - 1.0);
  if (desk_.ui().over_panel(static_cast<float>(x), static_cast<float>(y))) return;
  const int was_x = std::exchange(mouse_x_, static_cast<int>(x));
  const int was_y = std::exchange(mouse_y_, static_cast<int>(y));
  if (over_slices()) {
    mouse_x_ = was_x;
    mouse_y_ = was_y;
    return;
  }
  pad_x_ = x;
  pad_y_ = y;
}

Eigen::Vector2d Pointer::in_picture() const {
  return {static_cast<double>(mouse_x_) * desk_.renderer().width() / std::max(1, width_),
          static_cast<double>(mouse_y_) * desk_.renderer().height() / std::max(1, height_)};
}

bool Pointer::over_slices() const {
  const Eigen::Vector2d at = in_picture();
  const double x = at.x(), y = at.y();
  return std::any_of(scene_.insets.begin(), scene_.insets.end(), [&](const render::Inset& inset) {
    return x >= inset.x && x < inset.x + inset.width && y >= inset.y && y < inset.y + inset.height;
  });
}

// In light and dark, so that it is visible on bone and on background.
void Pointer::draw(bool pressing) const {
  if (!leads_) return;
  const float u = desk_.ui().unit();
  const float from_window =
      static_cast<float>(desk_.renderer().width()) / static_cast<float>(std::max(1, width_));
  const ImVec2 at = {static_cast<float>(pad_x_) * from_window,
                     static_cast<float>(pad_y_) * from_window};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  constexpr ImU32 kDark = ink::rgb(0, 0, 0, 200), kLight = ink::rgb(255, 255, 255);
  for (const auto& [ink, wide] : {std::pair{kDark, 4 * u}, std::pair{kLight, 1.75F * u}}) {
    list.AddCircle(at, 11 * u, ink, 32, wide);
    for (const auto& [x, y] : {std::pair{1.F, 0.F}, {-1.F, 0.F}, {0.F, 1.F}, {0.F, -1.F}})
      list.AddLine({at.x + 8 * u * x, at.y + 8 * u * y}, {at.x + 15 * u * x, at.y + 15 * u * y},
                   ink, wide);
  }
  if (!pressing) return;
  list.AddCircleFilled(at, 4.5F * u, kDark);
  list.AddCircleFilled(at, 3 * u, kLight);
}

}  // namespace burr::app

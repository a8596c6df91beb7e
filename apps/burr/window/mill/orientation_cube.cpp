#include "window/mill/orientation_cube.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace burr::app {
namespace {

using math::Vec3;
constexpr double kPi = std::numbers::pi;

Vec3 vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// Where a point of the cube (-1..1) is on the screen, seen without perspective.
struct Projection {
  Vec3 right, above, backward;
  ImVec2 middle;
  float scale;
  [[nodiscard]] ImVec2 operator()(const Vec3& p) const {
    return {middle.x + scale * static_cast<float>(p.dot(right)),
            middle.y - scale * static_cast<float>(p.dot(above))};
  }
};

std::array<ImVec2, 4> corners(const Projection& seen, const Vec3& out) {
  const Vec3 a(out.y(), out.z(), out.x()), b = out.cross(a);
  return {seen(out + a + b), seen(out - a + b), seen(out - a - b), seen(out + a - b)};
}

bool inside(const std::array<ImVec2, 4>& quad, const ImVec2& p) {
  int ways = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    const ImVec2 &a = quad[n], &b = quad[(n + 1) % 4];
    ways += (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0 ? 1 : -1;
  }
  return std::abs(ways) == 4;
}

}  // namespace

const std::array<CubeFace, 6>& cube_faces() {
  static constexpr std::array<CubeFace, 6> kFaces = {{{'A', {0, -1, 0}, 0, 0},
                                                      {'L', {1, 0, 0}, kPi / 2, 0},
                                                      {'P', {0, 1, 0}, kPi, 0},
                                                      {'R', {-1, 0, 0}, -kPi / 2, 0},
                                                      {'S', {0, 0, 1}, 0, kPi / 2},
                                                      {'I', {0, 0, -1}, 0, -kPi / 2}}};
  return kFaces;
}

const CubeFace* draw_cube(Ui& ui, const render::Camera& camera, float x, float y) {
  const float u = ui.unit(), edge = kCube * u;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ui.panel("##cube", x - edge, y, edge, edge);
  ImGui::PopStyleVar();
  const Projection seen = {camera.right(),
                           camera.above(),
                           camera.backward(),
                           {x - edge / 2, y + edge / 2},
                           edge * 0.27F};
  ImGui::SetCursorScreenPos({x - edge, y});
  const bool pressed = ImGui::InvisibleButton("##face", {edge, edge});
  const bool over = ImGui::IsItemHovered();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const CubeFace* chosen = nullptr;
  for (const CubeFace& face : cube_faces()) {
    const double towards = vec(face.out).dot(seen.backward);
    if (towards <= 0.02) continue;
    const std::array<ImVec2, 4> quad = corners(seen, vec(face.out));
    const bool at = over && inside(quad, mouse);
    const auto light = static_cast<unsigned>(58 + 52 * towards);
    draw.AddConvexPolyFilled(quad.data(), 4,
                             at ? ink::rgb(60, 110, 145) : ink::rgb(light, light + 5, light + 10));
    draw.AddPolyline(quad.data(), 4, ink::rgb(200, 205, 210, 170), ImDrawFlags_Closed, u);
    if (towards > 0.25) {
      const ImVec2 middle = seen(vec(face.out));
      ui.write(middle.x, middle.y - ui.height_of(Ui::Letter::strong) / 2, Ui::Letter::strong,
               ink::kText, std::string(1, face.letter), 0.5F);
    }
    if (at && pressed) chosen = &face;
  }
  ImGui::End();
  return chosen;
}

void ViewTurn::begin(const render::Camera& from, const CubeFace& to, Clock::time_point now) {
  running_ = true;
  begun_ = now;
  azimuth_ = from.azimuth;
  elevation_ = from.elevation;
  // from above and from below, the nearest of the four sides stays at the lower edge
  const bool pole = to.elevation != 0;
  const double azimuth = pole ? std::round(from.azimuth / (kPi / 2)) * (kPi / 2) : to.azimuth;
  azimuth_by_ = std::remainder(azimuth - from.azimuth, 2 * kPi);
  elevation_by_ = to.elevation - from.elevation;
}

void ViewTurn::step(render::Camera& camera, Clock::time_point now) {
  if (!running_) return;
  constexpr double kSeconds = 0.3;
  const double t =
      std::clamp(std::chrono::duration<double>(now - begun_).count() / kSeconds, 0.0, 1.0);
  const double share = t * t * (3 - 2 * t);
  render::orbit(camera, azimuth_ + share * azimuth_by_ - camera.azimuth,
                elevation_ + share * elevation_by_ - camera.elevation);
  running_ = t < 1;
}

}  // namespace burr::app

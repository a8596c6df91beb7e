#include "window/parts/measuring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/word_names.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kNear = 1e-4, kFar = 10;  // for the projection only  [m]

// white with a black border, so that it is visible on bone and on background
void line(ImDrawList& draw, const Ui& ui, ImVec2 a, ImVec2 b) {
  draw.AddLine(a, b, ink::rgb(0, 0, 0, 200), 4.5F * ui.unit());
  draw.AddLine(a, b, ink::kText, 2 * ui.unit());
}

void ring(ImDrawList& draw, const Ui& ui, ImVec2 c) {
  draw.AddCircle(c, 5 * ui.unit(), ink::rgb(0, 0, 0, 200), 20, 4.5F * ui.unit());
  draw.AddCircle(c, 5 * ui.unit(), ink::kText, 20, 2 * ui.unit());
}

void label(ImDrawList& draw, const Ui& ui, ImVec2 at, const std::string& text) {
  const float u = ui.unit(), w = ui.width_of(Ui::Letter::strong, text),
              h = ui.height_of(Ui::Letter::strong);
  const float x = std::clamp(at.x + 14 * u, 4 * u, std::max(4 * u, ui.width() - w - 12 * u));
  const float y = std::clamp(at.y - h / 2, 4 * u, std::max(4 * u, ui.height() - h - 4 * u));
  draw.AddRectFilled({x - 7 * u, y - 4 * u}, {x + w + 7 * u, y + h + 4 * u}, ink::kPanel, 5 * u);
  const ImFont* font = ui.font(Ui::Letter::strong);
  draw.AddText(font, font->FontSize, {std::round(x), std::round(y)}, ink::kText, text.c_str());
}

}  // namespace

std::optional<ImVec2> on_picture(const render::Camera& camera, const Vec3& p, float width,
                                 float height) {
  const Eigen::Vector4d q =
      render::clip_from_view(camera, static_cast<double>(width) / static_cast<double>(height),
                             kNear, kFar) *
      render::view_from_world(camera) * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  if (q.w() <= kNear) return std::nullopt;
  return ImVec2{static_cast<float>(0.5 * (1 + q.x() / q.w())) * width,
                static_cast<float>(0.5 * (1 - q.y() / q.w())) * height};
}

void Measuring::next() {
  const Measure then = what_ == Measure::off        ? Measure::distance
                       : what_ == Measure::distance ? Measure::angle
                       : what_ == Measure::angle    ? Measure::thickness
                                                    : Measure::off;
  stop();
  what_ = then;
}

void Measuring::pick(const Vec3& p) {
  if (!picks()) return;
  if (points_.size() == points_wanted()) points_.clear();
  points_.push_back(p);
}

void Measuring::probe(const volume::Bone& bone, const Vec3& tip, const Vec3& inward, double reach) {
  span_.reset();
  if (what_ == Measure::thickness) span_ = volume::thickness(bone, tip, inward, reach);
}

std::optional<double> Measuring::value() const {
  if (what_ == Measure::thickness && span_) return span_->length();
  if (!picks() || points_.size() < points_wanted()) return std::nullopt;
  if (what_ == Measure::distance) return (points_[1] - points_[0]).norm();
  const Vec3 a = points_[0] - points_[1], b = points_[2] - points_[1];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::string Measuring::words() const {
  const auto is = value();
  switch (what_) {
    case Measure::off:
      break;
    case Measure::distance:
      return is ? say(Word::measured_distance, 1e3 * *is) : std::string(word(Word::measure_two));
    case Measure::angle:
      return is ? say(Word::measured_angle, 180 / std::numbers::pi * *is)
                : std::string(word(Word::measure_three));
    case Measure::thickness:
      return is ? say(Word::measured_thickness, 1e3 * *is) : std::string(word(Word::measure_none));
  }
  return {};
}

void Measuring::draw(const Ui& ui, const render::Camera& camera) const {
  if (!on()) return;
  ImDrawList& over = *ImGui::GetBackgroundDrawList();
  std::vector<Vec3> points = points_;
  if (span_) points = {span_->in, span_->out};
  std::vector<ImVec2> seen;
  for (const Vec3& p : points)
    if (const auto at = on_picture(camera, p, ui.width(), ui.height())) seen.push_back(*at);
  if (seen.size() < points.size()) return;  // a point is behind the eye
  for (std::size_t n = 1; n < seen.size(); ++n) line(over, ui, seen[n - 1], seen[n]);
  for (const ImVec2& at : seen) ring(over, ui, at);
  if (!value()) return;
  // the text stands beside the middle of the line, or beside the vertex of the angle
  const ImVec2 at = what_ == Measure::angle ? seen[1]
                                            : ImVec2{0.5F * (seen.front().x + seen.back().x),
                                                     0.5F * (seen.front().y + seen.back().y)};
  label(over, ui, at,
        what_ == Measure::angle ? fmt::format("{:.1f}°", 180 / std::numbers::pi * *value())
                                : fmt::format("{:.2f} mm", 1e3 * *value()));
}

}  // namespace burr::app

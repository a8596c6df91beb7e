#include "window/parts/slices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "shared/word_names.h"

namespace burr::app {
namespace {

using render::Image;
using render::Plane;
using render::Slice;

constexpr Plane kPlanes[] = {Plane::axial, Plane::coronal, Plane::sagittal};
constexpr Word kNames[] = {Word::axial, Word::coronal, Word::sagittal};
// the patient's directions in these planes: left, right, top, bottom of the picture
constexpr const char* kSides[] = {"RLAP", "RLSI", "APSI"};
constexpr auto kPace = std::chrono::milliseconds(100);
constexpr int kMost = 256;  // longest side in pixels; a larger slice is stretched

void put(Image& image, int x, int y, const std::array<std::uint8_t, 3>& colour) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy(colour.begin(), colour.end(),
            image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x));
}

// Draws the burr's outline in the plane, and four marks that point at its middle.
void mark(Image& image, double radius_px) {
  constexpr std::array<std::uint8_t, 3> kRing = {86, 180, 233};
  const double x = 0.5 * image.width, y = 0.5 * image.height;
  const int steps = std::max(24, static_cast<int>(8 * radius_px));
  for (int n = 0; n < steps; ++n) {
    const double angle = 2 * M_PI * n / steps;
    put(image, static_cast<int>(x + radius_px * std::cos(angle)),
        static_cast<int>(y + radius_px * std::sin(angle)), kRing);
  }
  const int from = static_cast<int>(radius_px) + 3, to = from + image.width / 16;
  for (int d = from; d < to; ++d)
    for (const auto& [dx, dy] : {std::pair{d, 0}, {-d, 0}, {0, d}, {0, -d}})
      put(image, static_cast<int>(x) + dx, static_cast<int>(y) + dy, kRing);
}

}  // namespace

Slices::Slices(volume::Bone& bone, std::shared_ptr<const volume::Greys> greys)
    : slicer_(bone), greys_(std::move(greys)) {}

std::string Slices::window_words() const {
  return chosen_ == 0 ? std::string() : say(Word::slices_window, window_, level_);
}

std::string Slices::next_window() {
  if (greys_ == nullptr) return word(Word::slices_no_scan);
  chosen_ = (chosen_ + 1) % 3;
  drawn_ = {};
  if (chosen_ == 0) return word(Word::slices_model);
  // the usual windows for HU; otherwise the whole range, and its darker half
  const double all = greys_->top - greys_->least;
  constexpr double kBoneWidth = 4000, kBoneLevel = 700, kSoftWidth = 400, kSoftLevel = 40;
  const bool bone = chosen_ == 1;
  window_ = greys_->hounsfield ? (bone ? kBoneWidth : kSoftWidth) : (bone ? all : 0.5 * all);
  level_ = greys_->hounsfield ? (bone ? kBoneLevel : kSoftLevel)
                              : greys_->least + (bone ? 0.5 : 0.25) * all;
  return window_words();
}

void Slices::pull_window(double right, double up) {
  if (greys_ == nullptr) return;
  if (chosen_ == 0) next_window();
  const double all = greys_->top - greys_->least;
  window_ = std::clamp(window_ * std::exp(3 * right), 1e-3 * all, 4 * all);
  level_ = std::clamp(level_ + up * window_, greys_->least - all, greys_->top + all);
  drawn_ = {};
}

void Slices::paint_with(Paint paint) {
  if (!paint && !paint_) return;
  if (!paint != !paint_) drawn_ = {};
  paint_ = std::move(paint);
}

void Slices::zoom(int steps) {
  height_ = std::clamp(height_ * std::pow(1.25, -steps), 5e-3, 0.3);
  drawn_ = {};
}

void Slices::write_names(const render::Scene& scene, const Ui& ui, float from) const {
  const float u = ui.unit();
  // light on a dark plate, readable on bone and on air
  const auto write = [&](Ui::Letter size, float x, float y, const std::string& text) {
    const ImFont* font = ui.font(size);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    x = std::round(x);
    y = std::round(y);
    draw.AddRectFilled({x - 3 * u, y - u},
                       {x + ui.width_of(size, text) + 3 * u, y + ui.height_of(size) + u},
                       ink::rgb(0, 0, 0, 150), 3 * u);
    draw.AddText(font, font->FontSize, {x, y}, ink::kText, text.c_str());
  };
  constexpr auto kSmall = Ui::Letter::small;
  const float high = ui.height_of(kSmall);
  for (std::size_t n = 0; n < scene.insets.size(); ++n) {
    const float left = from + static_cast<float>(scene.insets[n].x),
                top = static_cast<float>(scene.insets[n].y),
                edge = static_cast<float>(scene.insets[n].width);
    write(Ui::Letter::strong, left + 10 * u, top + 8 * u,
          n == 0 && chosen_ != 0 ? fmt::format("{}  {}", word(kNames[n]), window_words())
                                 : word(kNames[n]));
    const float middle = top + (edge - high) / 2;
    const ImVec2 places[] = {{left + 10 * u, middle},
                             {left + edge - 10 * u, middle},
                             {left + edge / 2, top + 5 * u},
                             {left + edge / 2, top + edge - high - 5 * u}};
    for (std::size_t side = 0; side < 4; ++side) {
      const std::string letter(1, kSides[n][side]);
      write(kSmall, places[side].x - ui.width_of(kSmall, letter) / 2, places[side].y, letter);
    }
  }
}

std::optional<math::Vec3> Slices::point_at(const render::Scene& scene, double x, double y) const {
  for (std::size_t n = 0; n < scene.insets.size() && n < shown_.size(); ++n) {
    const render::Inset& inset = scene.insets[n];
    if (x < inset.x || x >= inset.x + inset.width || y < inset.y || y >= inset.y + inset.height)
      continue;
    return render::point_of(shown_[n], {x - inset.x, y - inset.y}, inset.width, inset.height);
  }
  return std::nullopt;
}

void Slices::update(render::Scene& scene, const math::Vec3& through, bool shown, bool labels,
                    int width, int height, int bottom) {
  scene.insets.clear();
  if (!shown) return;
  const int gap = std::max(6, height / 90);
  const int edge = (height - bottom - 4 * gap) / 3;
  if (edge < 60) return;  // too small to see anything
  const int pixels = std::min(edge, kMost);

  const Clock::time_point now = Clock::now();
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t at = (next_ + n) % 3;
    if (images_[at] != nullptr && images_[at]->width == pixels && now - drawn_[at] < kPace)
      continue;
    auto image = std::make_shared<Image>(Image{pixels, pixels, {}});
    Slice slice;
    slice.plane = kPlanes[at];
    slice.through = through;
    slice.height = height_;
    slice.labels = labels;
    if (chosen_ != 0) {
      slice.greys = greys_.get();
      slice.window = window_;
      slice.level = level_;
    }
    slicer_.draw(slice, *image);
    if (paint_) paint_(slice, *image);
    mark(*image, scene.burr.radius * pixels / height_);
    images_[at] = std::move(image);
    shown_[at] = slice;
    drawn_[at] = now;
    next_ = at + 1;
    break;
  }
  if (images_[0] == nullptr || images_[1] == nullptr || images_[2] == nullptr) return;
  for (std::size_t n = 0; n < 3; ++n) {
    const int y = gap + static_cast<int>(n) * (edge + gap);
    scene.insets.push_back({images_[n], width - gap - edge, y, edge, edge});
  }
}

}  // namespace burr::app

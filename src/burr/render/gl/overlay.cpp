#include "burr/render/gl/overlay.h"

#include <fmt/format.h>
#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "burr/render/gl/shaders.h"

namespace burr::render::gl {

namespace {

// Adds two triangles for the box from (x0, y0) to (x1, y1).
void add_box(std::vector<float>& xy, float x0, float y0, float x1, float y1) {
  xy.insert(xy.end(), {x0, y0, x1, y0, x1, y1, x0, y0, x1, y1, x0, y1});
}

// Adds a text; the letters of stb_easy_font are already boxes.
void add_text(std::vector<float>& xy, const std::string& text, float x, float y, float size) {
  struct Corner {
    float x, y, z;
    std::array<unsigned char, 4> colour;
  };
  std::vector<Corner> corners(20 * text.size() + 64);
  std::string copy = text;  // stb does not promise to leave it unchanged
  const int count = stb_easy_font_print(0, 0, copy.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  for (int q = 0; q < count; ++q) {
    const Corner& a = corners[static_cast<std::size_t>(4 * q)];
    const Corner& c = corners[static_cast<std::size_t>(4 * q + 2)];
    add_box(xy, x + size * a.x, y + size * a.y, x + size * c.x, y + size * c.y);
  }
}

float text_width(const std::string& text, float size) {
  std::string copy = text;
  return size * static_cast<float>(stb_easy_font_width(copy.data()));
}

std::vector<float> moved(std::vector<float> xy, float by) {
  for (float& value : xy) value += by;
  return xy;
}

// The picture without a circle that fits into it, as triangles.
std::vector<float> around(int width, int height) {
  constexpr int kSteps = 180;
  const float x = 0.5F * static_cast<float>(width), y = 0.5F * static_cast<float>(height);
  const float r = std::min(x, y) - 1, far = 1.1F * std::hypot(x, y);
  std::vector<float> xy;
  for (int n = 0; n < kSteps; ++n) {
    constexpr float kStep = 2 * std::numbers::pi_v<float> / kSteps;
    const float a = kStep * static_cast<float>(n), b = a + kStep;
    const float ax = std::cos(a), ay = std::sin(a), bx = std::cos(b), by = std::sin(b);
    xy.insert(xy.end(),
              {x + r * ax, y + r * ay, x + far * ax, y + far * ay, x + far * bx, y + far * by,
               x + r * ax, y + r * ay, x + far * bx, y + far * by, x + r * bx, y + r * by});
  }
  return xy;
}

// A ring between two radii, as triangles.
constexpr int kRingSteps = 60;
std::vector<float> ring(float x, float y, float inner, float outer) {
  std::vector<float> xy;
  for (int n = 0; n < kRingSteps; ++n) {
    constexpr float kStep = 2 * std::numbers::pi_v<float> / kRingSteps;
    const float a = kStep * static_cast<float>(n), b = a + kStep;
    const float ax = std::cos(a), ay = std::sin(a), bx = std::cos(b), by = std::sin(b);
    xy.insert(xy.end(), {x + inner * ax, y + inner * ay, x + outer * ax, y + outer * ay,
                         x + outer * bx, y + outer * by, x + inner * ax, y + inner * ay,
                         x + outer * bx, y + outer * by, x + inner * bx, y + inner * by});
  }
  return xy;
}

}  // namespace

double bar_length(double picture_width) {
  const double wanted = picture_width / 5;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double step : {5.0, 2.0})
    if (step * power <= wanted) return step * power;
  return power;
}

Status Overlay::make(bool es) {
  Result<Program> flat = Program::link(es, {kFlatVertex}, {kFlatFragment});
  if (!flat) return flat.error();
  flat_ = std::move(*flat);
  Result<Program> inset = Program::link(es, {kFlatVertex}, {kInsetFragment});
  if (!inset) return inset.error();
  inset_ = std::move(*inset);
  Result<Program> dark = Program::link(es, {kFlatVertex}, {kVignetteFragment});
  if (!dark) return dark.error();
  vignette_ = std::move(*dark);
  return fine();
}

void Overlay::draw(const Scene& scene, int width, int height, int left, int top, int wide,
                   int high) {
  if (scene.text.empty() && !scene.scale_bar && !scene.round && scene.insets.empty() &&
      scene.vignette <= 0)
    return;
  const float size = std::max(1.0F, std::round(static_cast<float>(height) / 480.0F));
  std::vector<float> xy;
  float y = 8 * size;
  for (const std::string& line : scene.text) {
    add_text(xy, line, 8 * size, y, size);
    y += 12 * size;
  }
  if (scene.scale_bar) {
    const double pixel = scene.camera.view_height() / height;  // at the target [m]
    const double length = bar_length(pixel * width);
    const auto w = static_cast<float>(length / pixel);
    const float x1 = static_cast<float>(width) - 12 * size, x0 = x1 - w;
    const float bottom = static_cast<float>(height) - 12 * size;
    add_box(xy, x0, bottom - 2 * size, x1, bottom);
    add_box(xy, x0, bottom - 5 * size, x0 + size, bottom);
    add_box(xy, x1 - size, bottom - 5 * size, x1, bottom);
    const double mm = length * 1e3;
    const std::string label =
        mm < 1 ? fmt::format("{:.0f} um", mm * 1e3) : fmt::format("{:.0f} mm", mm);
    add_text(xy, label, (x0 + x1 - text_width(label, size)) / 2, bottom - 14 * size, size);
  }

  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  // y is down in the text, up in OpenGL
  const Eigen::Vector4f clip_from_pixel(
      2.0F / static_cast<float>(wide), -2.0F / static_cast<float>(high),
      -1.0F - 2.0F * static_cast<float>(left) / static_cast<float>(wide),
      1.0F + 2.0F * static_cast<float>(top) / static_cast<float>(high));
  if (scene.vignette > 0) vignette(scene, width, height, clip_from_pixel);
  flat_.use();
  flat_.set("clip_from_pixel", clip_from_pixel);
  if (scene.round) quads(around(width, height), {0, 0, 0, 1});
  insets(scene, clip_from_pixel, size);
  flat_.use();
  quads(moved(xy, 0.75F * size), {0, 0, 0, 0.55F});
  quads(xy, {1, 1, 1, 0.92F});
  glDisable(GL_BLEND);
}

// It begins where the field of a microscope ends.
void Overlay::vignette(const Scene& scene, int width, int height,
                       const Eigen::Vector4f& clip_from_pixel) {
  const float x = 0.5F * static_cast<float>(width), y = 0.5F * static_cast<float>(height);
  const float from = 0.9F * std::min(x, y), to = std::hypot(x, y);
  vignette_.use();
  vignette_.set("clip_from_pixel", clip_from_pixel);
  vignette_.set("middle", Eigen::Vector2f(x, y));
  vignette_.set("reach", Eigen::Vector2f(from, to));
  vignette_.set("darkest", static_cast<float>(scene.vignette));
  // the chords of the ring stay inside and outside of what is darkened
  load(ring(x, y, 0.99F * from, 1.01F * to));
  glDrawArrays(GL_TRIANGLES, 0, 6 * kRingSteps);
}

void Overlay::insets(const Scene& scene, const Eigen::Vector4f& clip_from_pixel, float size) {
  sent_.resize(scene.insets.size());
  for (std::size_t n = 0; n < sent_.size(); ++n) {
    const Inset& inset = scene.insets[n];
    if (inset.image == nullptr || inset.image->rgb.empty()) continue;
    Sent& sent = sent_[n];
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, sent.texture.make());
    if (sent.image != inset.image) {
      sent.image = inset.image;
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, inset.image->width, inset.image->height, 0, GL_RGB,
                   GL_UNSIGNED_BYTE, inset.image->rgb.data());
      for (const GLenum way : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
        glTexParameteri(GL_TEXTURE_2D, way, GL_LINEAR);
      for (const GLenum way : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}})
        glTexParameteri(GL_TEXTURE_2D, way, GL_CLAMP_TO_EDGE);
    }
    const auto x = static_cast<float>(inset.x), y = static_cast<float>(inset.y);
    const auto w = static_cast<float>(inset.width), h = static_cast<float>(inset.height);
    std::vector<float> xy;
    add_box(xy, x - size, y - size, x + w + size, y + h + size);
    flat_.use();
    quads(xy, {0, 0, 0, 0.6F});
    xy.clear();
    add_box(xy, x, y, x + w, y + h);
    inset_.use();
    inset_.set("clip_from_pixel", clip_from_pixel);
    inset_.set("picture", 0);
    inset_.set("place", Eigen::Vector4f(x, y, w, h));
    load(xy);
    glDrawArrays(GL_TRIANGLES, 0, 6);
  }
}

void Overlay::load(const std::vector<float>& xy) {
  glBindVertexArray(array_.make());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.make());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(xy.size() * sizeof(float)), xy.data(),
               GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Overlay::quads(const std::vector<float>& xy, const Eigen::Vector4f& colour) {
  load(xy);
  flat_.set("colour", colour);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(xy.size() / 2));
}

}  // namespace burr::render::gl

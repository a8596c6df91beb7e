// The public functions of the renderer: start, pictures of any size, the window's picture.
#include "burr/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "burr/render/gl/renderer_work.h"
#include "burr/render/gl/shaders.h"

namespace burr::render {

using gl::Frame;
using gl::Piece;
using gl::Program;
using gl::Rect;
using math::Aabb;

namespace {

constexpr int kMostPicture = 65536;

}  // namespace

// ---- start

Status Renderer::Work::start() {
  constexpr const char* kColours = gl::kColourFunctions;
  const struct {
    Program* program;
    std::initializer_list<const char*> vertex, fragment;
  } all[] = {{&mesh, {gl::kMeshVertex}, {gl::kMeshFragment}},
             {&occlusion, {gl::kScreenVertex}, {gl::kOcclusionFragment}},
             {&soften, {gl::kScreenVertex}, {gl::kSoftenFragment}},
             {&shrink, {gl::kScreenVertex}, {kColours, gl::kShrinkFragment}}};
  for (const auto& one : all) {
    Result<Program> linked = Program::link(context->es(), one.vertex, one.fragment);
    if (!linked) return linked.error();
    *one.program = std::move(*linked);
  }
  for (const Status& made : {skins.start(context->es()), lighting.start(context->es()),
                             through.start(context->es()), overlay.make(context->es())})
    if (!made) return made;
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  most = std::min({kMostTarget, texture, viewport[0], viewport[1]});
  nothing.make();
  reads_depth = !context->es() && context->software();
  started = true;
  if (const Status made = focusing.start(context->es()); !made) return made;
  return join.start(context->es());
}

Status Renderer::Work::look_with(int which) {
  const auto change = [this](int other) {
    if (other == 0) return;
    Eye& there = others[static_cast<std::size_t>(other - 1)];
    std::swap(target, there.target);
    std::swap(through, there.through);
    std::swap(sheet, there.sheet);
    std::swap(stretched, there.stretched);
    std::swap(held, there.held);
    std::swap(changed, there.changed);
    std::swap(started, there.started);
  };
  change(eye);
  eye = which;
  change(eye);
  if (std::exchange(started, true)) return fine();
  return through.start(context->es());
}

Renderer::Renderer(std::unique_ptr<Work> work) : work_(std::move(work)) {}

Renderer::~Renderer() {
  if (work_ != nullptr) work_->context->make_current();
}

Result<std::unique_ptr<Renderer>> Renderer::offscreen(Api api) {
  auto context = gl::Context::offscreen(api);
  if (!context) return context.error();
  auto work = std::make_unique<Work>();
  work->context = std::move(*context);
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(work)));
  const Status started = renderer->work_->start();
  if (!started) return started.error();
  return renderer;
}

Result<std::unique_ptr<Renderer>> Renderer::window(const std::string& title, int width, int height,
                                                   bool quad_buffer) {
  auto context = gl::Context::window(title, width, height, quad_buffer);
  if (!context) return context.error();
  auto work = std::make_unique<Work>();
  work->context = std::move(*context);
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(work)));
  const Status started = renderer->work_->start();
  if (!started) return started.error();
  return renderer;
}
void Renderer::Work::update(const Scene& scene) {
  figures = {};
  std::vector<Aabb> sent;
  figures.patches_uploaded = skin.update(scene, sent);
  changed.insert(changed.end(), sent.begin(), sent.end());
  for (Eye& other : others)  // an eye without content is drawn whole
    if (other.held) other.changed.insert(other.changed.end(), sent.begin(), sent.end());
}

// ---- pictures

Result<Image> Renderer::image(const Scene& scene, int width, int height, int tile) {
  if (width < 1 || height < 1 || width > kMostPicture || height > kMostPicture)
    return error(
        Trouble::usage,
        fmt::format(
            "a picture of {} x {} pixels cannot be drawn; use 1 to {} pixels for width and height",
            width, height, kMostPicture));
  Work& w = *work_;
  w.context->make_current();
  w.update(scene);
  w.changed.clear();
  w.held.reset();
  w.skin.allow(0);

  const int factor = std::clamp(scene.look.supersample, 1, 8);
  const int stride = scene.look.occlusion_half ? 2 : 1;
  Frame whole;
  whole.picture_width = width * factor;
  whole.picture_height = height * factor;
  whole.view = view_from_world(scene.camera);
  const Aabb bone = bounds(scene);
  gl::set_depths(whole, scene.camera, bone);

  // tiles overlap by the reach of the hollows and of what is unsharp, in steps that keep the sampling pattern in place
  const int unsharp = scene.focus ? gl::most_unsharp(whole) : 0;
  const int margin = (margin_of(scene, whole) + unsharp + 7) / 8 * 8;
  const auto step_for = [&](int size) {
    if (tile > 0) return (tile * factor + 8 * factor - 1) / (8 * factor) * (8 * factor);
    if (size <= w.most) return size;
    return std::max(8 * factor, (w.most - 2 * margin) / (8 * factor) * (8 * factor));
  };
  const int step_x = step_for(whole.picture_width), step_y = step_for(whole.picture_height);

  Image image{width, height, {}};
  image.rgb.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const std::vector<Piece>& pieces = w.shapes.pieces(scene);
  for (int y = 0; y < whole.picture_height; y += step_y)
    for (int x = 0; x < whole.picture_width; x += step_x) {
      const Rect inner = {x, y, std::min(x + step_x, whole.picture_width),
                          std::min(y + step_y, whole.picture_height)};
      const Rect outer = inner.grown(margin).in({0, 0, whole.picture_width, whole.picture_height});
      Frame frame = whole;
      frame.left = outer.x0;
      frame.bottom = outer.y0;
      frame.width = outer.x1 - outer.x0;
      frame.height = outer.y1 - outer.y0;
      const auto part = [](int at, int size) { return 2.0 * at / size - 1; };
      frame.clip = clip_from_view(
          scene.camera, static_cast<double>(width) / height, frame.near, frame.far,
          {part(outer.x0, whole.picture_width), part(outer.x1, whole.picture_width),
           part(outer.y0, whole.picture_height), part(outer.y1, whole.picture_height)});
      const Result<bool> sized = w.target.resize(frame.width, frame.height, stride);
      if (!sized) return sized.error();
      if (sees_through(scene.look))
        if (const Status more = w.through.resize(frame.width, frame.height); !more)
          return more.error();
      Work::Parts parts;
      parts.extent = bone;
      parts.bone.add(frame.all());
      parts.grain = !scene.look.plain;
      parts.light_occlusion = has_occlusion(scene.look);
      if (parts.light_occlusion) parts.ambient_occlusion.add(frame.all());
      if (const Status painted = w.paint(scene, frame, parts, pieces); !painted)
        return painted.error();
      if (const Status sharp = w.focus(scene, frame); !sharp) return sharp.error();
      const int left = inner.x0 / factor, top = height - inner.y1 / factor;
      const Status done = w.put_on_sheet(
          scene,
          {inner.x0 - outer.x0, inner.y0 - outer.y0, inner.x1 - outer.x0, inner.y1 - outer.y0},
          factor, {(inner.x1 - inner.x0) / factor, (inner.y1 - inner.y0) / factor}, width, height,
          left, top);
      if (!done) return done.error();
      Work::read(w.sheet, image, left, top);
    }
  w.figures.redrawn = 1;
  if (glGetError() == GL_OUT_OF_MEMORY)
    return error(Trouble::io, "the graphics card ran out of memory; make the picture smaller");
  return image;
}
// ---- the window

void Renderer::Work::present(Stereo how) {
  if (!context->visible()) {
    glFinish();
    return;
  }
  const auto put = [](const gl::PictureBuffer& from) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from.at.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, from.width, from.height, 0, 0, from.width, from.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
  };
  if (how == Stereo::quad_buffer) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDrawBuffer(GL_BACK_RIGHT);
    put(others[0].sheet);
    glDrawBuffer(GL_BACK_LEFT);
    put(sheet);
    glDrawBuffer(GL_BACK);
  } else {
    put(*on_show);
  }
  context->swap();
}

Status Renderer::show(const Scene& scene, const std::function<void()>& over) {
  return show(scene, TwoEyes{}, over);
}

Status Renderer::show(const Scene& scene, const TwoEyes& eyes, const std::function<void()>& over) {
  Work& w = *work_;
  w.context->make_current();
  w.update(scene);
  const int wide = std::max(1, width()), high = std::max(1, height());
  const Stereo how = eyes.how == Stereo::quad_buffer && !quad_buffer() ? Stereo::off : eyes.how;
  w.on_show = &w.sheet;
  if (how == Stereo::off) {
    if (w.others[0].held) w.others[0] = {};
    if (const Status drawn = w.draw(scene, wide, high); !drawn) return drawn;
    if (over) over();  // the sheet is bound now
  } else {
    const Eyes cameras = eyes_of(scene.camera, eyes.eye_distance);
    Scene seen = scene;
    for (const int which : {0, 1}) {
      seen.camera = (which == 0) != eyes.swapped ? cameras.left : cameras.right;
      Status drawn = w.look_with(which);
      if (drawn) drawn = w.draw(seen, wide, high);
      if (drawn && over) over();
      if (!drawn) {
        static_cast<void>(w.look_with(0));
        return drawn;
      }
    }
    if (const Status back = w.look_with(0); !back) return back;
    if (how != Stereo::quad_buffer) {
      if (const Status sized = w.both.resize(wide, high); !sized) return sized;
      glBindVertexArray(w.nothing.get());
      w.join.draw(w.sheet, w.others[0].sheet, w.both, how, eyes.first_row);
      w.on_show = &w.both;
    }
  }
  w.present(how);
  if (glGetError() == GL_CONTEXT_LOST)
    return error(Trouble::io, "the connection to the graphics card was lost; start burr again");
  return fine();
}

Status Renderer::eye(const Scene& scene, int which, unsigned texture, int width, int height) {
  Work& w = *work_;
  w.context->make_current();
  const Figures so_far = w.figures;
  w.update(scene);
  Status drawn = w.look_with(2 + which);
  if (drawn) drawn = w.draw(scene, width, height);
  if (drawn) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, w.headset.make());
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, w.sheet.at.get());
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    // detach the texture from our framebuffer: it belongs to the caller
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFlush();
  }
  if (const Status back = w.look_with(0); drawn && !back) drawn = back;
  w.figures.redrawn = std::max(w.figures.redrawn, so_far.redrawn);
  w.figures.patches_uploaded += so_far.patches_uploaded;
  w.figures.patches_drawn += so_far.patches_drawn;
  w.figures.triangles_drawn += so_far.triangles_drawn;
  return drawn;
}

void Renderer::wait_for_screen(bool on) { work_->context->wait_for_screen(on); }
void Renderer::make_current() { work_->context->make_current(); }
bool Renderer::es() const { return work_->context->es(); }
bool Renderer::quad_buffer() const { return work_->context->quad_buffer(); }

void Renderer::skip_hidden(bool on) { work_->skip_hidden = on; }

void Renderer::title(const std::string& text) { work_->context->title(text); }

int Renderer::width() const {
  int wide = work_->idle_width, high = 0;
  if (work_->context->visible()) work_->context->size(wide, high);
  return wide;
}
int Renderer::height() const {
  int wide = 0, high = work_->idle_height;
  if (work_->context->visible()) work_->context->size(wide, high);
  return high;
}
void Renderer::resize_offscreen(int width, int height) {
  work_->idle_width = width;
  work_->idle_height = height;
}

std::string Renderer::gpu() const { return work_->context->gpu(); }
bool Renderer::software() const { return work_->context->software(); }
bool Renderer::refined() const {
  const auto done = [](const std::optional<Work::Held>& held) {
    return held->coarse.empty() && held->stale.empty();
  };
  const auto& other = work_->others[0].held;
  return work_->held && done(work_->held) && (!other || done(other));
}
Renderer::Figures Renderer::figures() const { return work_->figures; }

Image Renderer::shown() {
  Work& w = *work_;
  w.context->make_current();
  const gl::PictureBuffer& sheet = *w.on_show;
  Image image{sheet.width, sheet.height, {}};
  image.rgb.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                   3);
  Work::read(sheet, image, 0, 0);
  return image;
}

}  // namespace burr::render

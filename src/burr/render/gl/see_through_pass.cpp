#include "burr/render/gl/see_through_pass.h"

#include <array>
#include <utility>

#include "burr/render/gl/draw_target.h"
#include "burr/render/gl/shaders.h"

namespace burr::render::gl {

Status SeeThrough::start(bool es) {
  Result<Program> linked = Program::link(es, {kScreenVertex}, {kThroughFragment});
  if (!linked) return linked.error();
  through_ = std::move(*linked);
  return fine();
}

Status SeeThrough::resize(int wide, int high) {
  if (wide == width_ && high == height_) return fine();
  width_ = height_ = 0;  // in case it fails half-way
  shape(colour_, GL_RGBA8, wide, high, GL_RGBA, GL_UNSIGNED_BYTE);
  shape(normal_, GL_RGB10_A2, wide, high, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV);
  shape(depth_, GL_DEPTH_COMPONENT24, wide, high, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
  shape(lit_, GL_RGBA8, wide, high, GL_RGBA, GL_UNSIGNED_BYTE);
  for (const Status& made : {attach(geometry_, {colour_.get(), normal_.get()}, depth_.get()),
                             attach(lit_at_, {lit_.get()}, 0)})
    if (!made) return made.error();
  width_ = wide;
  height_ = high;
  return fine();
}

Skin::Drawn SeeThrough::paint(const Scene& scene, const Frame& frame, const Rect& r, const Of& of,
                              const std::function<void()>& tool) {
  if (r.empty()) return {};
  glBindFramebuffer(GL_FRAMEBUFFER, geometry_.get());
  glViewport(0, 0, frame.width, frame.height);
  scissor(r);
  const std::array<float, 4> none{};
  const float farthest = 1;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, none.data());
  glClearBufferfv(GL_COLOR, 1, none.data());
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  if (scene.clip)
    glDisable(GL_CULL_FACE);
  else
    glEnable(GL_CULL_FACE);
  of.programs.use({false, of.grain, scene.clip.has_value()}, scene, frame, of.skin.colours());
  const Skin::Drawn drawn = of.skin.draw_soft(scene.camera.eye(), planes_of(r, frame), true);
  glEnable(GL_CULL_FACE);
  tool();
  return drawn;
}

void SeeThrough::blend(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& front,
                       Lighting& lighting) {
  if (r.empty()) return;
  lighting.paint(scene, frame, r, {&colour_, &normal_, &depth_, &lit_at_}, {},
                 {.shadow = false, .others = true});
  glBindFramebuffer(GL_FRAMEBUFFER, front.lit_at->get());
  scissor(r);
  bind(0, *front.colour);
  bind(1, *front.normal);
  bind(2, lit_);
  through_.use();
  through_.set("colour_map", 0);
  through_.set("normal_map", 1);
  through_.set("behind", 2);
  through_.set("ray", ray_of(frame));
  through_.set("size", frame.width, frame.height);
  through_.set("opacity", static_cast<float>(scene.look.opacity));
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace burr::render::gl

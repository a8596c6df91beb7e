#include "burr/render/gl/draw_target.h"

#include <fmt/format.h>

#include <array>

namespace burr::render::gl {

void shape(Texture& texture, GLint inside, int width, int height, GLenum format, GLenum type) {
  texture = Texture();
  glBindTexture(GL_TEXTURE_2D, texture.make());
  glTexImage2D(GL_TEXTURE_2D, 0, inside, width, height, 0, format, type, nullptr);
  for (const GLenum way : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}})
    glTexParameteri(GL_TEXTURE_2D, way, GL_NEAREST);
  for (const GLenum way : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}})
    glTexParameteri(GL_TEXTURE_2D, way, GL_CLAMP_TO_EDGE);
}

Status attach(Framebuffer& framebuffer, std::initializer_list<GLuint> colours, GLuint depth) {
  framebuffer = Framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.make());
  std::array<GLenum, 2> outputs{};
  GLsizei count = 0;
  for (const GLuint colour : colours) {
    const GLenum place = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(count);
    glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, colour, 0);
    outputs[static_cast<std::size_t>(count++)] = place;
  }
  glDrawBuffers(count, outputs.data());
  if (depth != 0)
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
      glGetError() != GL_OUT_OF_MEMORY)
    return fine();
  return error(
      Trouble::io,
      "the graphics card has no memory for a picture of this size; make the picture smaller");
}

Result<bool> Target::resize(int wide, int high, int occlusion_stride) {
  if (wide == width && high == height && occlusion_stride == stride) return false;
  width = height = stride = 0;  // in case it fails half-way
  occlusion_width = (wide + occlusion_stride - 1) / occlusion_stride;
  occlusion_height = (high + occlusion_stride - 1) / occlusion_stride;

  for (Texture* one : {&bone_colour, &colour})
    shape(*one, GL_RGBA8, wide, high, GL_RGBA, GL_UNSIGNED_BYTE);
  for (Texture* one : {&bone_normal, &normal})
    shape(*one, GL_RGB10_A2, wide, high, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV);
  for (Texture* one : {&bone_depth, &depth})
    shape(*one, GL_DEPTH_COMPONENT24, wide, high, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
  shape(lit, GL_RGBA8, wide, high, GL_RGBA, GL_UNSIGNED_BYTE);
  shape(occlusion, GL_RGBA8, occlusion_width, occlusion_height, GL_RGBA, GL_UNSIGNED_BYTE);
  shape(soft, GL_RGBA8, occlusion_width, occlusion_height, GL_RGBA, GL_UNSIGNED_BYTE);
  for (const Status& made : {attach(bone, {bone_colour.get(), bone_normal.get()}, bone_depth.get()),
                             attach(geometry, {colour.get(), normal.get()}, depth.get()),
                             attach(occlusion_at, {occlusion.get()}, 0),
                             attach(soft_at, {soft.get()}, 0), attach(lit_at, {lit.get()}, 0)})
    if (!made) return made.error();
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  for (const Framebuffer* one : {&bone, &geometry}) {  // where nothing is drawn, nothing is near
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, one->get());
    glClearBufferfv(GL_DEPTH, 0, &farthest);
  }
  width = wide;
  height = high;
  stride = occlusion_stride;
  return true;
}

void Target::copy_bone(int x0, int y0, int x1, int y1) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, bone.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, geometry.get());
  // one output at a time: a blit writes to all that are enabled
  constexpr GLenum kColourOnly[] = {GL_COLOR_ATTACHMENT0, GL_NONE};
  constexpr GLenum kNormalOnly[] = {GL_NONE, GL_COLOR_ATTACHMENT1};
  constexpr GLenum kBoth[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glDrawBuffers(2, kColourOnly);
  glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glDrawBuffers(2, kNormalOnly);
  glBlitFramebuffer(x0, y0, x1, y1, x0, y0, x1, y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glDrawBuffers(2, kBoth);
}

Status PictureBuffer::resize(int wide, int high) {
  if (wide == width && high == height) return fine();
  width = height = 0;
  shape(colour, GL_RGBA8, wide, high, GL_RGBA, GL_UNSIGNED_BYTE);
  const Status made = attach(at, {colour.get()}, 0);
  if (!made) return made;
  width = wide;
  height = high;
  return fine();
}

}  // namespace burr::render::gl

#include "burr/render/gl/join.h"

#include "burr/render/gl/lighting.h"
#include "burr/render/gl/shaders.h"

namespace burr::render::gl {
namespace {

// how: as Stereo counts
constexpr const char* kJoinFragment = R"glsl(
uniform sampler2D left_eye, right_eye;
uniform int how, first_row;
uniform ivec2 size;
out vec4 colour;

float grey(vec4 c) { return dot(c.rgb, vec3(0.299, 0.587, 0.114)); }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (how == 1) {
    int wide = max(size.x / 2, 1);
    int first = min(2 * (at.x % wide), size.x - 1);
    ivec2 a = ivec2(first, at.y), b = ivec2(min(first + 1, size.x - 1), at.y);
    colour = at.x < size.x / 2
                 ? 0.5 * (texelFetch(left_eye, a, 0) + texelFetch(left_eye, b, 0))
                 : 0.5 * (texelFetch(right_eye, a, 0) + texelFetch(right_eye, b, 0));
  } else if (how == 2) {
    float r = grey(texelFetch(right_eye, at, 0));
    colour = vec4(grey(texelFetch(left_eye, at, 0)), r, r, 1.0);
  } else {
    bool odd = ((size.y - 1 - at.y + first_row) & 1) == 1;
    colour = odd ? texelFetch(right_eye, at, 0) : texelFetch(left_eye, at, 0);
  }
}
)glsl";
static_assert(static_cast<int>(Stereo::side_by_side) == 1 &&
              static_cast<int>(Stereo::anaglyph) == 2);

}  // namespace

Status EyeJoiner::start(bool es) {
  Result<Program> linked = Program::link(es, {kScreenVertex}, {kJoinFragment});
  if (!linked) return linked.error();
  program_ = std::move(*linked);
  return fine();
}

void EyeJoiner::draw(const PictureBuffer& left, const PictureBuffer& right, const PictureBuffer& to,
                     Stereo how, int first_row) {
  glBindFramebuffer(GL_FRAMEBUFFER, to.at.get());
  glViewport(0, 0, to.width, to.height);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  bind(0, left.colour);
  bind(1, right.colour);
  program_.use();
  program_.set("left_eye", 0);
  program_.set("right_eye", 1);
  program_.set("how", static_cast<int>(how));
  program_.set("first_row", first_row & 1);
  program_.set("size", to.width, to.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace burr::render::gl

#include "burr/render/gl/focus_pass.h"

#include <algorithm>

#include "burr/render/gl/lighting.h"
#include "burr/render/gl/shaders.h"

namespace burr::render::gl {
namespace {

// First a few looks around find the largest disc in front that may reach this sample. Then looks on a
// spiral within the sample's own disc collect what lies at its depth or behind it, and looks on
// another one what lies in front: of that, the share of its disc that covers this sample. Placed
// after kColourFunctions.
constexpr const char* kFocusFragment = R"glsl(
uniform sampler2D picture, depth_map;
uniform vec2 planes;   // near, far [m]
uniform vec2 lens;     // distance in focus [m], radius of the disc of what is infinitely far [sample]
uniform float most;    // [sample]
uniform ivec2 size;
out vec4 result;

const int kAround = 8, kLooks = 40;
const float kTurn = 2.39996323;  // the golden angle [rad]

float depth_of(ivec2 at) {
  float d = texelFetch(depth_map, at, 0).r;
  return planes.x * planes.y / (planes.y - d * (planes.y - planes.x));
}
float disc(float z) { return min(lens.y * abs(z - lens.x) / z, most); }
ivec2 inside(vec2 p) { return clamp(ivec2(floor(p)), ivec2(0), size - 1); }

// A depth whose disc is about as wide is taken for the same surface.
bool in_front(float far, float z, float mine) { return far < z && abs(disc(far) - mine) > 1.0; }
// The n-th look on a spiral within `reach`; r: how far away it is.
ivec2 look(int n, float reach, out float r) {
  r = reach * sqrt((float(n) - 0.5) / float(kLooks));
  float a = kTurn * float(n);
  return inside(gl_FragCoord.xy + r * vec2(cos(a), sin(a)));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float z = depth_of(at), mine = disc(z), wider = 0.0;
  for (int ring = 1; ring <= 3; ++ring)
    for (int n = 0; n < kAround; ++n) {
      float r = most * float(ring) / 3.0, a = 6.2831853 * (float(n) + 0.5 * float(ring)) / float(kAround);
      float far = depth_of(inside(gl_FragCoord.xy + r * vec2(cos(a), sin(a))));
      if (in_front(far, z, mine)) wider = max(wider, disc(far));
    }
  vec3 here = linear(texelFetch(picture, at, 0).rgb);
  if (mine > 0.5) {
    float weight = 1.0;
    for (int n = 1; n <= kLooks; ++n) {
      float r = 0.0;
      ivec2 there = look(n, mine + 0.5, r);
      float far = depth_of(there);
      if (in_front(far, z, mine)) continue;
      float w = clamp(min(disc(far), mine) - r + 0.5, 0.0, 1.0);
      here += w * linear(texelFetch(picture, there, 0).rgb);
      weight += w;
    }
    here /= weight;
  }
  if (wider > 0.5) {
    float cover = 0.0, area = (wider + 0.5) * (wider + 0.5) / float(kLooks);
    vec3 front = vec3(0.0);
    for (int n = 1; n <= kLooks; ++n) {
      float r = 0.0;
      ivec2 there = look(n, wider + 0.5, r);
      float far = depth_of(there), wide = disc(far);
      if (!in_front(far, z, mine)) continue;
      float w = clamp(wide - r + 0.5, 0.0, 1.0) * area / max(wide * wide, area);
      front += w * linear(texelFetch(picture, there, 0).rgb);
      cover += w;
    }
    if (cover > 0.0) here = mix(here, front / cover, min(cover, 1.0));
  }
  result = vec4(srgb(here), 1.0);
}
)glsl";

}  // namespace

int most_unsharp(const Frame& frame) { return std::max(2, frame.picture_height / 40); }

Status FocusPass::start(bool es) {
  Result<Program> linked = Program::link(es, {kScreenVertex}, {kColourFunctions, kFocusFragment});
  if (!linked) return linked.error();
  program_ = std::move(*linked);
  return fine();
}

Status FocusPass::draw(const Focus& focus, double view_height, const Frame& frame,
                       const Target& from, PictureBuffer& to) {
  if (const Status sized = to.resize(frame.width, frame.height); !sized) return sized;
  glBindFramebuffer(GL_FRAMEBUFFER, to.at.get());
  glViewport(0, 0, frame.width, frame.height);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  bind(0, from.lit);
  bind(1, from.depth);
  program_.use();
  program_.set("picture", 0);
  program_.set("depth_map", 1);
  program_.set("planes",
               Eigen::Vector2f(static_cast<float>(frame.near), static_cast<float>(frame.far)));
  const double radius = 0.5 * focus.aperture * frame.picture_height / view_height;
  program_.set("lens",
               Eigen::Vector2f(static_cast<float>(focus.distance), static_cast<float>(radius)));
  program_.set("most", static_cast<float>(most_unsharp(frame)));
  program_.set("size", frame.width, frame.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return fine();
}

}  // namespace burr::render::gl

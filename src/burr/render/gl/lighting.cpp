#include "burr/render/gl/lighting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/render/gl/shaders.h"

namespace burr::render::gl {

using math::Aabb;
using math::Vec3;

namespace {

// The tool's shadow has a limited reach, so that it can be redrawn where the tool moved and kept
// elsewhere. See passes() in gl/shaders.h.
constexpr double kShadowReach = 25e-3;  // from the tool, along the light [m]
constexpr double kShadowShaft =
    12e-3;  // length of a round burr's shaft that gives shadow, from the
            // head's centre [m]

float linear(float c) { return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F); }
Eigen::Vector3f light_of(const Light& light) {
  return static_cast<float>(light.strength) *
         Eigen::Vector3f(linear(light.colour[0]), linear(light.colour[1]), linear(light.colour[2]));
}
Eigen::Vector3f vector_of(const Colour& colour) { return {colour[0], colour[1], colour[2]}; }

void set_sky(Program& program, const Look& look, const Frame& frame) {
  const auto height = static_cast<float>(frame.picture_height);
  program.set("sky", Eigen::Vector2f(1.0F / height, static_cast<float>(frame.bottom) / height));
  program.set("sky_top", vector_of(look.background_top));
  program.set("sky_bottom", vector_of(look.background_bottom));
}

}  // namespace

std::vector<Vec3> shadow_of(const Scene& scene) {
  const Burr& burr = scene.burr;
  if (!burr.visible || !burr.world_from_tool.finite()) return {};
  const Vec3 light = scene.look.key.towards.normalized();
  const Vec3 towards = light.x() * scene.camera.right() + light.y() * scene.camera.above() +
                       light.z() * scene.camera.backward();
  const double r = burr.radius + 0.12 * kShadowReach + 0.1 * burr.radius;  // with the soft edge of
                                                                           // the shadow
  Aabb box = {{-r, -r, -r}, {r, r, kShadowShaft + r}};
  if (burr.other != nullptr) {
    box = shadow_box(*burr.other);
    if (box.empty()) return {};
    box = box.inflated(0.12 * kShadowReach);
  }
  std::vector<Vec3> points;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = burr.world_from_tool * box.corner(corner);
    points.push_back(p);
    points.push_back(p - (kShadowReach + r) * towards);
  }
  return points;
}

double occlusion_reach(const Scene& scene) {
  return scene.look.occlusion_reach * scene.camera.view_height();
}
float strict_of(const Scene& scene, const Frame& frame) {
  return static_cast<float>((frame.far - frame.near) / (0.5 * occlusion_reach(scene)));
}

void bind(GLuint unit, const Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture.get());
}

void scissor(const Rect& r) {
  glScissor(r.x0, r.y0, std::max(0, r.x1 - r.x0), std::max(0, r.y1 - r.y0));
}

Status Lighting::start(bool es) {
  Result<Program> linked =
      Program::link(es, {kScreenVertex}, {"#define PLAIN\n", kColourFunctions, kLightFragment});
  if (!linked) return linked.error();
  plain_ = std::move(*linked);
  linked = Program::link(es, {kScreenVertex}, {kSkyFragment});
  if (!linked) return linked.error();
  sky_ = std::move(*linked);
  constexpr const char* kOcclusion[] = {"", "#define HOLLOWS\n", "#define HOLLOWS\n#define HALF\n"};
  constexpr const char* kShadow[] = {"", "#define SHADOW\n", "#define SHADOW_MAP\n"};
  for (std::size_t ambient_occlusion = 0; ambient_occlusion < 3; ++ambient_occlusion)
    for (std::size_t shadow = 0; shadow < 3; ++shadow)
      for (const bool others : {false, true}) {
        linked =
            Program::link(es, {kScreenVertex},
                          {kOcclusion[ambient_occlusion], kShadow[shadow],
                           others ? "#define OTHERS\n" : "", kColourFunctions, kLightFragment});
        if (!linked) return linked.error();
        lights_[ambient_occlusion][shadow][others ? 1 : 0] = std::move(*linked);
      }
  return tool_shadow.start(es);
}

void Lighting::paint_sky(const Scene& scene, const Frame& frame, const Rect& r,
                         const Framebuffer& lit_at) {
  if (r.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, lit_at.get());
  glViewport(0, 0, frame.width, frame.height);
  scissor(r);
  sky_.use();
  set_sky(sky_, scene.look, frame);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Lighting::paint(const Scene& scene, const Frame& frame, const Rect& r, const Unlit& what,
                     const OcclusionMaps& ambient_occlusion, const Besides& besides) {
  if (r.empty()) return;
  const Look& look = scene.look;
  const std::size_t kind = ambient_occlusion.map == nullptr ? 0
                           : ambient_occlusion.stride == 1  ? 1
                                                            : 2;
  Program& light = look.plain ? plain_
                              : lights_[kind][!besides.shadow       ? 0
                                              : tool_shadow.drawn() ? 2
                                                                    : 1][besides.others ? 1 : 0];
  glBindFramebuffer(GL_FRAMEBUFFER, what.lit_at->get());
  glViewport(0, 0, frame.width, frame.height);
  scissor(r);
  bind(0, *what.colour);
  bind(1, *what.normal);
  bind(2, *what.depth);
  if (ambient_occlusion.map != nullptr) bind(3, *ambient_occlusion.map);

  light.use();
  light.set("colour_map", 0);
  light.set("normal_map", 1);
  light.set("depth_map", 2);
  light.set("occlusion_map", 3);
  light.set("ray", ray_of(frame));
  light.set("planes",
            Eigen::Vector2f(static_cast<float>(frame.near), static_cast<float>(frame.far)));
  light.set("size", frame.width, frame.height);
  light.set("occlusion_size", ambient_occlusion.width, ambient_occlusion.height);
  light.set("strict", strict_of(scene, frame));
  set_sky(light, look, frame);
  light.set("key_towards", Eigen::Vector3f(look.key.towards.normalized().cast<float>()));
  light.set("key_light", light_of(look.key));
  light.set("fill_towards", Eigen::Vector3f(look.fill.towards.normalized().cast<float>()));
  light.set("fill_light", light_of(look.fill));
  light.set("ambient", static_cast<float>(look.ambient));
  light.set("gloss", static_cast<float>(look.gloss));
  light.set("occlusion", static_cast<float>(look.occlusion));

  // head and shaft in the form that the shader needs for the shadow
  const Burr& burr = scene.burr;
  const Vec3 centre = (frame.view * burr.world_from_tool.p.homogeneous()).head<3>();
  const Vec3 axis = frame.view.block<3, 3>(0, 0) * (burr.world_from_tool.q * Vec3::UnitZ());
  Eigen::Vector4f ball;
  ball << centre.cast<float>(), static_cast<float>(burr.radius);
  light.set("ball", ball);
  light.set("shaft", Eigen::Vector3f(axis.cast<float>()));
  tool_shadow.set(light, 4);
  light.set("shadow_reach", static_cast<float>(kShadowReach));
  light.set("shaft_size",
            Eigen::Vector2f(static_cast<float>(std::min(burr.shaft_radius, burr.radius)),
                            static_cast<float>(std::min(burr.shaft_length, kShadowShaft))));
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace burr::render::gl

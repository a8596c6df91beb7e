#include "burr/render/gl/tool_shadow.h"

#include <algorithm>
#include <array>
#include <utility>

#include "burr/render/gl/draw_target.h"
#include "burr/render/gl/shaders.h"

namespace burr::render::gl {

using math::Aabb;
using math::Vec3;

namespace {

constexpr int kTexels = 256;           // along a side of the map
constexpr double kOfOtherTool = 3e-2;  // so much of it gives shadow, from its lowest point [m]

}  // namespace

Aabb shadow_box(const ToolLook& look) {
  Aabb box;
  for (const surface::Mesh* mesh : {&look.cuts, &look.rubs})
    for (const surface::Vertex& vertex : mesh->vertices) box.extend(vertex.p.cast<double>());
  if (!box.empty()) box.hi.z() = std::min(box.hi.z(), box.lo.z() + kOfOtherTool);
  return box;
}

Status ToolShadow::start(bool es) {
  Result<Program> linked = Program::link(es, {kShadowVertex}, {kShadowFragment});
  if (!linked) return linked.error();
  covers_ = std::move(*linked);
  return fine();
}

Status ToolShadow::draw(const Scene& scene, const Frame& frame, const std::vector<Piece>& pieces) {
  drawn_ = false;
  const Burr& burr = scene.burr;
  if (!burr.visible || burr.other == nullptr || scene.look.plain || !burr.world_from_tool.finite())
    return fine();
  const Aabb box = shadow_box(*burr.other);
  if (box.empty()) return fine();
  if (at_.get() == 0) {
    shape(depth_, GL_DEPTH_COMPONENT24, kTexels, kTexels, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    shape(map_, GL_RGB10_A2, kTexels, kTexels, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (const Status made = attach(at_, {map_.get()}, depth_.get()); !made) return made;
  }

  // axes of the map, in the view: across the light, and away from it
  const Vec3 away = -scene.look.key.towards.normalized();
  const Vec3 right = away.unitOrthogonal();
  Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
  turn.row(0).head<3>() = right.transpose();
  turn.row(1).head<3>() = away.cross(right).transpose();
  turn.row(2).head<3>() = away.transpose();
  const Eigen::Matrix4d light_from_world = turn * frame.view;
  Aabb seen;
  for (int corner = 0; corner < 8; ++corner)
    seen.extend(
        (light_from_world * (burr.world_from_tool * box.corner(corner)).homogeneous()).head<3>());
  const Vec3 edge = Vec3::Constant(0.1 * seen.extent().maxCoeff());
  Vec3 size = seen.extent() + 2 * edge;
  size.x() = size.y() =
      std::max(size.x(), size.y());  // square texels, as the levels of the map want
  const Vec3 from = 0.5 * (seen.lo + seen.hi - size);
  Eigen::Matrix4d map_from_light = Eigen::Matrix4d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    map_from_light(axis, axis) = 1 / size[axis];
    map_from_light(axis, 3) = -from[axis] / size[axis];
  }
  map_from_view_ = (map_from_light * turn).cast<float>();
  size_ = size.cast<float>();

  glBindFramebuffer(GL_FRAMEBUFFER, at_.get());
  glViewport(0, 0, kTexels, kTexels);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  const float farthest = 1;
  const std::array<float, 4> none{};
  glClearBufferfv(GL_COLOR, 0, none.data());
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  Eigen::Matrix4d clip_from_map = 2 * Eigen::Matrix4d::Identity();
  clip_from_map.col(3) = Eigen::Vector4d(-1, -1, -1, 1);
  covers_.use();
  for (const Piece& piece : pieces) {
    if (!piece.gives_shadow) continue;
    covers_.set("clip_from_model", Eigen::Matrix4f((clip_from_map * map_from_light *
                                                    light_from_world * piece.world_from_shape)
                                                       .cast<float>()));
    piece.shape->draw();
  }
  glDisable(GL_DEPTH_TEST);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, map_.get());
  glGenerateMipmap(GL_TEXTURE_2D);
  drawn_ = true;
  return fine();
}

void ToolShadow::set(Program& light, int unit) const {
  if (!drawn_) return;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLuint>(unit));
  glBindTexture(GL_TEXTURE_2D, map_.get());
  light.set("shadow_map", unit);
  light.set("map_from_view", map_from_view_);
  light.set("map_size", size_);
}

}  // namespace burr::render::gl

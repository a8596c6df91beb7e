#include "burr/render/gl/draped.h"

#include <vector>

namespace burr::render::gl {

namespace {

// kinds as in gl/skin_shaders.h: bone from 1 (dry) to 0.82 (wet)
constexpr float kMoist = 0.94F, kSteel = 0.83F;

}  // namespace

void Draped::send(const Drape& drape) {
  std::vector<float> packed;
  packed.reserve(drape.points.size() * 9);
  for (std::size_t n = 0; n < drape.points.size(); ++n)
    for (const float value : {drape.points[n].x(), drape.points[n].y(), drape.points[n].z(),
                              drape.normals[n].x(), drape.normals[n].y(), drape.normals[n].z(),
                              drape.colours[n][0], drape.colours[n][1], drape.colours[n][2]})
      packed.push_back(value);
  glBindVertexArray(array_.make());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.make());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(packed.size() * sizeof(float)),
               packed.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.make());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(drape.triangles.size() * sizeof(std::uint16_t)),
               drape.triangles.data(), GL_STATIC_DRAW);
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 9 * sizeof(float),
                          reinterpret_cast<const void*>(attribute * 3 * sizeof(float)));
  }
}

void Draped::draw(const std::shared_ptr<const Drape>& drape, const Frame& frame, Program& mesh) {
  if (drape == nullptr) return;
  if (sent_ != drape) {
    send(*drape);
    sent_ = drape;
  }
  mesh.use();
  const Eigen::Matrix4d clip_from_world = frame.clip * frame.view;
  mesh.set("clip_from_model", Eigen::Matrix4f(clip_from_world.cast<float>()));
  const Eigen::Matrix3d turn = frame.view.block<3, 3>(0, 0);
  mesh.set("view_from_model_n", Eigen::Matrix3f(turn.cast<float>()));
  glBindVertexArray(array_.get());
  const auto part = [&](std::size_t from, std::size_t to, float kind) {
    mesh.set("tint_kind", Eigen::Vector4f(1, 1, 1, kind));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(to - from), GL_UNSIGNED_SHORT,
                   reinterpret_cast<const void*>(from * sizeof(std::uint16_t)));
  };
  part(0, drape->first_steel, kMoist);
  part(drape->first_steel, drape->triangles.size(), kSteel);
}

}  // namespace burr::render::gl

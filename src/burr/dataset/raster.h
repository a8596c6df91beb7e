// dataset/raster.h - depth and labels of a scene, without a graphics card: for each pixel the nearest
// triangle at the pixel's middle.
//
//     Raster raster(640, 480);
//     raster.draw(scene, view, field_of_view);
//     raster.depth()[640 * y + x];               // along the camera's axis [m]; infinite: nothing
//
// Exact to the rounding of float, and the same on every machine, unlike the depth of a graphics card.
// Drawn: bone, soft structures and pieces with their tissue, the tools; no marks and no drape.
// Frame: world. Units: m. Thread: one at a time. Cost: a few ns a triangle, and its pixels.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/math/pose.h"
#include "burr/record/view.h"
#include "burr/render/scene.h"

namespace burr::dataset {

class Raster {
 public:
  static constexpr std::uint16_t kNothing = 256, kTool = 257;  // labels beside those of tissues

  Raster(int width, int height);

  // field_of_view: vertical angle [rad]; the view's own is not used
  void draw(const render::Scene& scene, const record::View& view, double field_of_view);

  // (height x width), top row first
  [[nodiscard]] std::span<const float> depth() const { return depth_; }
  [[nodiscard]] std::span<const std::uint16_t> labels() const { return labels_; }

 private:
  struct Corner {
    Eigen::Vector3f p;  // of the camera: right, down, ahead [m]
    std::uint16_t label = 0;
  };
  [[nodiscard]] Corner seen(const math::Vec3& p, std::uint16_t label) const;
  [[nodiscard]] bool outside(const math::Aabb& box) const;
  template <class Index>
  void draw_mesh(std::span<const render::SkinVertex> vertices, std::span<const Index> triangles);
  void draw_tool(const render::Burr& burr);
  void draw_ball(const math::Pose& at, double radius);
  void draw_turned(const math::Pose& at, std::span<const std::pair<double, double>> profile);
  void draw_look(const math::Pose& at, const render::ToolLook& look);
  void add(const Corner& a, const Corner& b, const Corner& c);
  void fill(const Corner& a, const Corner& b, const Corner& c);

  int width_, height_;
  float focal_ = 1;
  math::Vec3 eye_;
  math::Mat3 camera_from_world_;
  std::vector<float> nearness_;  // 1 / depth; 0: nothing
  std::vector<float> depth_;
  std::vector<std::uint16_t> labels_;
  std::vector<Corner> corners_;  // of the mesh being drawn
};

}  // namespace burr::dataset

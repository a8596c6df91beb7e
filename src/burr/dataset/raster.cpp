#include "burr/dataset/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "burr/render/handpiece.h"

namespace burr::dataset {
namespace {

constexpr float kNear = 0.2e-3F;  // what is nearer is cut off [m]
constexpr int kAround = 48;       // facets of a round tool

math::Vec3 on_circle(int step, double r, double z) {
  const double angle = 2 * std::numbers::pi * step / kAround;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

Raster::Raster(int width, int height) : width_(width), height_(height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  nearness_.resize(pixels);
  depth_.resize(pixels);
  labels_.resize(pixels);
}

void Raster::draw(const render::Scene& scene, const record::View& view, double field_of_view) {
  focal_ = static_cast<float>(height_ / (2 * std::tan(field_of_view / 2)));
  eye_ = view.eye;
  camera_from_world_ << view.right.transpose(), -view.up.transpose(), -view.back.transpose();
  std::fill(nearness_.begin(), nearness_.end(), 0.0F);
  std::fill(labels_.begin(), labels_.end(), kNothing);
  for (const render::ScenePatch& patch : scene.patches) {
    if (!patch.mesh || outside(patch.box)) continue;
    draw_mesh<std::uint16_t>(patch.mesh->vertices(), patch.mesh->small_indices());
    draw_mesh<std::uint32_t>(patch.mesh->vertices(), patch.mesh->large_indices());
  }
  for (const render::SoftStructure& soft : scene.soft)
    if (soft.mesh && !soft.mesh->levels.empty() && !outside(soft.box))
      draw_mesh<std::uint32_t>(soft.mesh->vertices, soft.mesh->levels.front().indices);
  if (scene.burr.visible) draw_tool(scene.burr);
  if (scene.beside && scene.beside->look)
    draw_look(scene.beside->world_from_tool, *scene.beside->look);
  std::transform(nearness_.begin(), nearness_.end(), depth_.begin(), [](float nearness) {
    return nearness > 0 ? 1 / nearness : std::numeric_limits<float>::infinity();
  });
}

Raster::Corner Raster::seen(const math::Vec3& p, std::uint16_t label) const {
  return {(camera_from_world_ * (p - eye_)).cast<float>(), label};
}

bool Raster::outside(const math::Aabb& box) const {
  if (box.empty()) return true;
  // beyond the same edge of the picture with all corners
  const double x = 0.5 * width_ / focal_, y = 0.5 * height_ / focal_;
  std::array<int, 5> beyond = {};
  for (int n = 0; n < 8; ++n) {
    const math::Vec3 p = camera_from_world_ * (box.corner(n) - eye_);
    beyond[0] += p.x() > x * p.z() ? 1 : 0;
    beyond[1] += -p.x() > x * p.z() ? 1 : 0;
    beyond[2] += p.y() > y * p.z() ? 1 : 0;
    beyond[3] += -p.y() > y * p.z() ? 1 : 0;
    beyond[4] += p.z() < kNear ? 1 : 0;
  }
  return std::find(beyond.begin(), beyond.end(), 8) != beyond.end();
}

template <class Index>
void Raster::draw_mesh(std::span<const render::SkinVertex> vertices,
                       std::span<const Index> triangles) {
  if (triangles.empty()) return;
  corners_.clear();
  for (const render::SkinVertex& vertex : vertices)
    corners_.push_back(seen(vertex.p.cast<double>(), render::tissue_of(vertex)));
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    add(corners_[triangles[t]], corners_[triangles[t + 1]], corners_[triangles[t + 2]]);
}

void Raster::draw_tool(const render::Burr& burr) {
  if (!burr.world_from_tool.finite()) return;
  if (burr.other) return draw_look(burr.world_from_tool, *burr.other);
  draw_ball(burr.world_from_tool, burr.radius);
  draw_turned(burr.world_from_tool, render::shaft_profile(burr.radius, burr.shaft_radius));
  const math::Pose held = {burr.world_from_tool * math::Vec3(0, 0, render::kShaftOut),
                           burr.world_from_tool.q};
  for (const render::Profile& part : {render::collet_profile(), render::nose_profile(),
                                      render::grip_profile(), render::tail_profile()})
    draw_turned(held, part);
}

void Raster::draw_ball(const math::Pose& at, double radius) {
  render::Profile profile;
  for (int n = 0; n <= kAround / 2; ++n) {
    const double angle = 2 * std::numbers::pi * n / kAround;
    profile.emplace_back(-radius * std::cos(angle), radius * std::sin(angle));
  }
  draw_turned(at, profile);
}

void Raster::draw_turned(const math::Pose& at, std::span<const std::pair<double, double>> profile) {
  for (std::size_t n = 0; n + 1 < profile.size(); ++n) {
    const auto [z0, r0] = profile[n];
    const auto [z1, r1] = profile[n + 1];
    for (int i = 0; i < kAround; ++i) {
      const Corner a = seen(at * on_circle(i, r0, z0), kTool),
                   b = seen(at * on_circle(i + 1, r0, z0), kTool),
                   c = seen(at * on_circle(i + 1, r1, z1), kTool),
                   d = seen(at * on_circle(i, r1, z1), kTool);
      add(a, b, c);
      add(a, c, d);
    }
  }
}

void Raster::draw_look(const math::Pose& at, const render::ToolLook& look) {
  if (!at.finite()) return;
  for (const surface::Mesh* mesh : {&look.cuts, &look.rubs}) {
    corners_.clear();
    for (const surface::Vertex& vertex : mesh->vertices)
      corners_.push_back(seen(at * math::Vec3(vertex.p.cast<double>()), kTool));
    for (std::size_t t = 0; t + 2 < mesh->triangles.size(); t += 3)
      add(corners_[mesh->triangles[t]], corners_[mesh->triangles[t + 1]],
          corners_[mesh->triangles[t + 2]]);
  }
}

void Raster::add(const Corner& a, const Corner& b, const Corner& c) {
  const std::array<const Corner*, 3> corners = {&a, &b, &c};
  const auto in_front = std::count_if(corners.begin(), corners.end(),
                                      [](const Corner* one) { return one->p.z() >= kNear; });
  if (in_front == 0) return;
  if (in_front == 3) return fill(a, b, c);
  // the part in front of the near plane: three or four corners
  std::array<Corner, 4> left;
  std::size_t many = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const Corner &from = *corners[n], &to = *corners[(n + 1) % 3];
    if (from.p.z() >= kNear) left[many++] = from;
    if ((from.p.z() >= kNear) == (to.p.z() >= kNear)) continue;
    const float share = (kNear - from.p.z()) / (to.p.z() - from.p.z());
    left[many++] = {from.p + share * (to.p - from.p), from.label};
    left[many - 1].p.z() = kNear;
  }
  for (std::size_t n = 2; n < many; ++n) fill(left[0], left[n - 1], left[n]);
}

void Raster::fill(const Corner& a, const Corner& b, const Corner& c) {
  const auto x = [this](const Corner& one) {
    return focal_ * one.p.x() / one.p.z() + 0.5F * static_cast<float>(width_);
  };
  const auto y = [this](const Corner& one) {
    return focal_ * one.p.y() / one.p.z() + 0.5F * static_cast<float>(height_);
  };
  const float ax = x(a), ay = y(a), bx = x(b), by = y(b), cx = x(c), cy = y(c);
  const float area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  if (area == 0 || !std::isfinite(area)) return;
  // pixels whose middle (n + 1/2) lies in the box around it
  const auto first = [](float low) {
    return std::max(0, static_cast<int>(std::ceil(std::max(low, 0.0F) - 0.5F)));
  };
  const auto last = [](float high, int size) {
    return static_cast<int>(std::floor(std::min(high, static_cast<float>(size)) - 0.5F));
  };
  const int x0 = first(std::min({ax, bx, cx})),
            x1 = std::min(last(std::max({ax, bx, cx}), width_), width_ - 1);
  const int y0 = first(std::min({ay, by, cy})),
            y1 = std::min(last(std::max({ay, by, cy}), height_), height_ - 1);
  const float na = 1 / a.p.z(), nb = 1 / b.p.z(), nc = 1 / c.p.z();
  for (int row = y0; row <= y1; ++row)
    for (int column = x0; column <= x1; ++column) {
      const float px = static_cast<float>(column) + 0.5F, py = static_cast<float>(row) + 0.5F;
      const float wa = ((bx - px) * (cy - py) - (cx - px) * (by - py)) / area;
      const float wb = ((cx - px) * (ay - py) - (ax - px) * (cy - py)) / area;
      const float wc = 1 - wa - wb;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      const float nearness = wa * na + wb * nb + wc * nc;  // linear in the picture
      const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                             static_cast<std::size_t>(column);
      if (nearness <= nearness_[at]) continue;
      nearness_[at] = nearness;
      labels_[at] = wa >= wb && wa >= wc ? a.label : wb >= wc ? b.label : c.label;
    }
}

}  // namespace burr::dataset

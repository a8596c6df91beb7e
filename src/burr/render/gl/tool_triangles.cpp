#include "burr/render/gl/tool_triangles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "burr/math/rotation.h"
#include "burr/render/handpiece.h"

namespace burr::render::gl {

using math::Vec3;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kFlutes = 10;
constexpr Colour kSteel = {0.58F, 0.60F, 0.63F}, kGrains = {0.42F, 0.38F, 0.30F};
constexpr Colour kChip = {0.90F, 0.84F, 0.72F};  // of bone
constexpr Colour kCollet = {0.34F, 0.35F, 0.37F}, kSatin = {0.66F, 0.67F, 0.68F},
                 kGrip = {0.20F, 0.22F, 0.25F};

// A surface over (u, v) in [0, 1]^2: u goes once around +z counter-clockwise, v from -z to +z.
// Normals by differences, so that flutes reflect correctly. darkens: grooves, by that much per depth.
void send_round(Shape& shape, int around, int along,
                const std::function<Vec3(double u, double v)>& point, double darkens = 0) {
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<float> shades;
  std::vector<std::uint16_t> triangles;
  constexpr double kStep = 1e-4;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i <= around; ++i) {
      const double u = static_cast<double>(i) / around, v = static_cast<double>(j) / along;
      const double w = std::clamp(v, 2 * kStep, 1 - 2 * kStep);  // a pole has no direction
      const Vec3 du = point(u + kStep, w) - point(u - kStep, w);
      const Vec3 dv = point(u, w + kStep) - point(u, w - kStep);
      points.push_back(point(u, v).cast<float>());
      normals.push_back(du.cross(dv).normalized().cast<float>());
      shades.push_back(static_cast<float>(std::max(0.2, 1 - darkens * (1 - point(u, v).norm()))));
    }
  const auto index = [&](int i, int j) { return static_cast<std::uint16_t>(j * (around + 1) + i); };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i)
      for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
        triangles.push_back(index(i + a, j + b));
  shape.send(points, normals, triangles, shades);
}

Vec3 on_circle(double u, double r, double z) {
  return {r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), z};
}

// A turned shape: radius r at each z of the profile.
void send_turned(Shape& shape, const Profile& z_r) {
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<std::uint16_t> triangles;
  constexpr int kAround = 32;
  for (std::size_t k = 0; k + 1 < z_r.size(); ++k) {
    const auto [z0, r0] = z_r[k];
    const auto [z1, r1] = z_r[k + 1];
    const auto base = static_cast<int>(points.size());
    const double dz = z1 - z0, dr = r1 - r0, length = std::hypot(dz, dr);
    for (int i = 0; i <= kAround; ++i) {
      const double u = static_cast<double>(i) / kAround;
      const Vec3 n = on_circle(u, dz / length, -dr / length);
      points.push_back(on_circle(u, r0, z0).cast<float>());
      points.push_back(on_circle(u, r1, z1).cast<float>());
      normals.insert(normals.end(), 2, n.cast<float>());
    }
    for (int i = 0; i < kAround; ++i)
      for (const int o : {0, 2, 3, 0, 3, 1})
        triangles.push_back(static_cast<std::uint16_t>(base + 2 * i + o));
  }
  shape.send(points, normals, triangles);
}

Eigen::Matrix4d placed(const math::Pose& pose, double scale_xy, double scale_z) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<3, 3>(0, 0) = pose.q.toRotationMatrix() * Vec3(scale_xy, scale_xy, scale_z).asDiagonal();
  m.block<3, 1>(0, 3) = pose.p;
  return m;
}

}  // namespace

void Shape::send(const std::vector<Eigen::Vector3f>& points,
                 const std::vector<Eigen::Vector3f>& normals,
                 const std::vector<std::uint16_t>& triangles, const std::vector<float>& shades) {
  std::vector<float> packed;
  packed.reserve(points.size() * 9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float shade = shades.empty() ? 1.0F : shades[i];
    for (const float value : {points[i].x(), points[i].y(), points[i].z(), normals[i].x(),
                              normals[i].y(), normals[i].z(), shade, shade, shade})
      packed.push_back(value);
  }
  count_ = static_cast<GLsizei>(triangles.size());
  glBindVertexArray(array_.make());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.make());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(packed.size() * sizeof(float)),
               packed.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.make());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint16_t)), triangles.data(),
               GL_STATIC_DRAW);
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 9 * sizeof(float),
                          reinterpret_cast<const void*>(attribute * 3 * sizeof(float)));
  }
}

void Shape::draw() const {
  glBindVertexArray(array_.get());
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_SHORT, nullptr);
}

void Shapes::make() {
  made_ = true;
  const auto sphere = [](double u, double v) {
    const double lat = (v - 0.5) * kPi;
    return on_circle(u, std::cos(lat), std::sin(lat));
  };
  send_round(ball_, 48, 24, sphere);

  // Flutes wind a little around the head. They are deepest at its equator and end towards the
  // poles; their edges lie on the ball itself.
  send_round(
      head_, 160, 40,
      [&](double u, double v) {
        const double lat = (v - 0.5) * kPi, wave = u * kFlutes + 0.6 * (v - 0.5);
        const double saw = wave - std::floor(wave);
        const double depth = 0.24 * std::cos(lat) * std::pow(1 - saw, 1.5);
        return Vec3(sphere(u, v) * (1 - depth));
      },
      3.2);
  // Grains of a diamond burr: their tips lie on the ball itself, the gaps a few hundredths of its
  // radius below.
  send_round(
      grains_, 96, 48,
      [&](double u, double v) {
        const double waves = std::sin(2 * kPi * 31 * u + 7 * std::sin(40 * v)) *
                             std::sin(2 * kPi * 24 * v + 5 * std::sin(2 * kPi * 9 * u));
        return Vec3(sphere(u, v) * (1 - 0.02 * (1 - waves)));
      },
      9);
  send_turned(rod_, {{0, 0}, {0, 1}, {1, 1}, {1, 0}});
  send_turned(tip_, {{0, 0}, {0, 1}, {1, 0}});
  send_turned(collet_, collet_profile());
  send_turned(nose_, nose_profile());
  send_turned(grip_, grip_profile());
  send_turned(tail_, tail_profile());
}

void Shapes::make_shaft(const Burr& burr) {
  const double wanted[2] = {burr.radius, burr.shaft_radius};
  if (std::equal(wanted, wanted + 2, shaft_of_)) return;
  std::copy(wanted, wanted + 2, shaft_of_);

  send_turned(shaft_, shaft_profile(burr.radius, burr.shaft_radius));
}

void Shapes::add(const Shape& shape, const Eigen::Matrix4d& world_from_shape, const Colour& colour,
                 bool steel, bool on_top, const std::vector<math::Aabb>& boxes_shape) {
  Piece piece{&shape, world_from_shape, colour, steel, false, on_top, false, {}};
  for (const math::Aabb& box : boxes_shape) {
    auto& corners = piece.boxes.emplace_back();
    for (int corner = 0; corner < 8; ++corner)
      corners[static_cast<std::size_t>(corner)] =
          (world_from_shape * box.corner(corner).homogeneous()).head<3>();
  }
  pieces_.push_back(std::move(piece));
}

const std::vector<Piece>& Shapes::pieces(const Scene& scene) {
  if (!made_) make();
  pieces_.clear();
  const math::Aabb ball = {{-1, -1, -1}, {1, 1, 1}};

  if (scene.burr.visible && scene.burr.world_from_tool.finite()) add_tool(scene.burr);
  if (scene.beside && scene.beside->look && scene.beside->world_from_tool.finite())
    add_other(beside_, scene.beside->world_from_tool, scene.beside->look);
  add_chips(scene.chips);
  for (const Marker& marker : scene.markers) {
    if (!marker.p.allFinite()) continue;
    add(ball_, placed({marker.p, math::Quat::Identity()}, marker.radius, marker.radius),
        marker.colour, false, marker.on_top, {ball});
  }
  for (const Rod& rod : scene.rods) add_rod(rod);
  if (scene.mirrored) add_mirrored(*scene.mirrored, scene.burr);
  return pieces_;
}

namespace {

void send_mesh(Shape& shape, const surface::Mesh& mesh) {
  std::vector<Eigen::Vector3f> points, normals;
  for (const surface::Vertex& vertex : mesh.vertices) {
    points.push_back(vertex.p);
    normals.push_back(vertex.n);
  }
  std::vector<std::uint16_t> triangles;
  for (const std::uint32_t corner : mesh.triangles)
    triangles.push_back(static_cast<std::uint16_t>(corner));
  shape.send(points, normals, triangles);
}

// Boxes around the mesh, one above the other along z.
std::vector<math::Aabb> boxes_around(const surface::Mesh& mesh) {
  constexpr double kHigh = 8e-3;  // of one [m]
  math::Aabb all;
  for (const surface::Vertex& vertex : mesh.vertices) all.extend(vertex.p.cast<double>());
  std::vector<math::Aabb> boxes;
  if (all.empty()) return boxes;
  const int count = std::max(1, static_cast<int>(all.extent().z() / kHigh));
  for (int n = 0; n < count; ++n) {
    math::Aabb box = all;
    box.lo.z() = all.lo.z() + all.extent().z() * n / count;
    box.hi.z() = all.lo.z() + all.extent().z() * (n + 1) / count;
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

void Shapes::add_other(Sent& sent, const math::Pose& at,
                       const std::shared_ptr<const ToolLook>& look) {
  if (sent.look != look) {
    sent.look = look;
    send_mesh(sent.cuts, look->cuts);
    send_mesh(sent.rubs, look->rubs);
    sent.cuts_boxes = boxes_around(look->cuts);
    sent.rubs_boxes = boxes_around(look->rubs);
  }
  const Eigen::Matrix4d there = placed(at, 1, 1);
  if (!sent.cuts_boxes.empty()) add(sent.cuts, there, kSteel, true, false, sent.cuts_boxes);
  if (!sent.rubs_boxes.empty()) add(sent.rubs, there, kSatin, true, false, sent.rubs_boxes);
}

void Shapes::add_chips(const std::shared_ptr<const surface::Mesh>& chips) {
  if (sent_chips_ != chips) {
    sent_chips_ = chips;
    chips_boxes_.clear();
    if (chips != nullptr && !chips->vertices.empty()) {
      send_mesh(chips_, *chips);
      // one around each few millimetres of them: they lie apart
      constexpr std::size_t kTogether = 88;  // vertices of one chip
      for (std::size_t first = 0; first < chips->vertices.size(); first += kTogether) {
        math::Aabb& box = chips_boxes_.emplace_back();
        for (std::size_t v = first; v < std::min(first + kTogether, chips->vertices.size()); ++v)
          box.extend(chips->vertices[v].p.cast<double>());
      }
    }
  }
  if (chips_boxes_.empty()) return;
  add(chips_, Eigen::Matrix4d::Identity(), kChip, true, false, chips_boxes_);
  pieces_.back().bone = true;
}

void Shapes::add_tool(const Burr& burr) {
  if (burr.other != nullptr) {
    add_other(held_, burr.world_from_tool, burr.other);
    for (Piece& piece : pieces_) piece.gives_shadow = true;  // the tool comes first
    return;
  }
  make_shaft(burr);
  math::Pose turned = burr.world_from_tool;
  turned.q = turned.q * math::Quat(Eigen::AngleAxisd(burr.turn, Vec3::UnitZ()));
  add(burr.diamond ? grains_ : head_, placed(turned, burr.radius, burr.radius),
      burr.diamond ? kGrains : kSteel, !burr.diamond, false, {{{-1, -1, -1}, {1, 1, 1}}});
  // boxes along the axis, because one around a slanted tool would be mostly empty
  const auto slices = [](double r, double from, double to) {
    std::vector<math::Aabb> boxes;
    const int count = std::max(1, static_cast<int>((to - from) / (2 * r)));
    const double step = (to - from) / count;
    for (int n = 0; n < count; ++n)
      boxes.push_back({{-r, -r, from + n * step}, {r, r, from + (n + 1) * step}});
    return boxes;
  };
  const math::Pose& tool = burr.world_from_tool;
  add(shaft_, placed(tool, 1, 1), kSteel, true, false,
      slices(burr.shaft_radius, 0, std::max(kShaftOut, 12 * burr.radius)));
  const math::Pose held = {tool * Vec3(0, 0, kShaftOut), tool.q};
  add(collet_, placed(held, 1, 1), kCollet, true, false, slices(2.8e-3, -1.5e-3, 5e-3));
  std::vector<math::Aabb> nose;
  const Profile widths = nose_profile();
  for (std::size_t n = 1; n < widths.size(); ++n)
    for (const math::Aabb& box : slices(std::max(widths[n - 1].second, widths[n].second),
                                        widths[n - 1].first, widths[n].first))
      nose.push_back(box);
  add(nose_, placed(held, 1, 1), kSatin, true, false, nose);
  add(grip_, placed(held, 1, 1), kGrip, true, false, slices(8.2e-3, 46e-3, 95e-3));
  add(tail_, placed(held, 1, 1), kSatin, true, false, slices(8.4e-3, 95e-3, 150e-3));
}

void Shapes::add_rod(const Rod& rod) {
  const math::Aabb tube = {{-1, -1, 0}, {1, 1, 1}};
  const Vec3 d = rod.b - rod.a;
  const double length = d.norm();
  if (!(length > 0) || !d.allFinite()) return;
  const math::Quat q = math::shortest_rotation(Vec3::UnitZ(), d);
  // an arrow's head takes its share of the length
  const double head = rod.arrow ? std::min(6 * rod.radius, 0.6 * length) : 0;
  add(rod_, placed({rod.a, q}, rod.radius, length - head), rod.colour, false, rod.on_top, {tube});
  if (rod.arrow)
    add(tip_, placed({rod.b - d * (head / length), q}, 2.4 * rod.radius, head), rod.colour, false,
        rod.on_top, {tube});
}

// Only lines, so that the image is not mistaken for the burr: rings around its head, a line for its
// shaft, a frame around the plane. Light and dark alternate, to be visible on bone and on air.
void Shapes::add_mirrored(const Mirrored& mirrored, const Burr& burr) {
  constexpr Colour kInks[] = {{1.0F, 0.98F, 0.80F}, {0.05F, 0.06F, 0.10F}};
  constexpr int kAround = 20, kAlong = 6, kDashes = 18;
  const auto line = [&](const Vec3& from, const Vec3& to, int n) {
    add_rod({from, to, mirrored.line, kInks[n % 2], false, true});
  };
  const math::Pose& at = mirrored.world_from_tool;
  if (burr.visible && at.finite()) {
    for (int ring = 0; ring < 3; ++ring) {
      const auto point = [&](int n) {
        Vec3 p = Vec3::Zero();
        p[(ring + 1) % 3] = burr.radius * std::cos(2 * kPi * n / kAround);
        p[(ring + 2) % 3] = burr.radius * std::sin(2 * kPi * n / kAround);
        return at * p;
      };
      for (int n = 0; n < kAround; ++n) line(point(n), point(n + 1), n);
    }
    const double end = std::min(burr.shaft_length, 12 * burr.radius);
    const auto along = [&](int n) {
      return at * Vec3(0, 0, burr.radius + (end - burr.radius) * n / kAlong);
    };
    for (int n = 0; n < kAlong; ++n) line(along(n), along(n + 1), n);
  }
  for (std::size_t side = 0; side < 4; ++side) {
    const Vec3& from = mirrored.corners[side];
    const Vec3 way = (mirrored.corners[(side + 1) % 4] - from) / kDashes;
    for (int n = 0; n < kDashes; ++n) line(from + n * way, from + (n + 1) * way, n);
  }
}

}  // namespace burr::render::gl

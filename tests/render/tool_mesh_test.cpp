// The mesh of a tool is the surface of its distance: on it, with its normals, closed, and of the
// volume of the body.
#include "burr/render/tool_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace burr::render {
namespace {

using math::Vec3;
using tool::Shape;
using tool::ShapeKind;

constexpr double kMm = 1e-3;

struct Kind {
  const char* name;
  Shape shape;
  double volume_mm3;
};
const Kind kKinds[] = {
    {"ball", {ShapeKind::ball, 0, 0, 0, 2 * kMm}, 4.0 / 3 * M_PI * 8},
    {"capsule", {ShapeKind::capsule, 0, 0, 3 * kMm, 1 * kMm}, M_PI * 6 + 4.0 / 3 * M_PI},
    {"cylinder", {ShapeKind::cylinder, 2 * kMm, 0, 3 * kMm, 0}, M_PI * 4 * 6},
    {"frustum",
     {ShapeKind::frustum, 1 * kMm, 2.5 * kMm, 3 * kMm, 0},
     M_PI * 6 / 3 * (1 + 2.5 + 6.25)},
    {"rounded cylinder",
     {ShapeKind::cylinder, 2 * kMm, 0, 3 * kMm, 0.5 * kMm},
     // Steiner: core, its area times the rounding, half of its edges, the ball
     M_PI * 24 + 0.5 * (2 * M_PI * 4 + 4 * M_PI * 6) + 0.25 * (M_PI * M_PI * 2 + M_PI * 6) +
         4.0 / 3 * M_PI * 0.125},
    {"tube", {ShapeKind::tube, 2 * kMm, 1.4 * kMm, 3 * kMm, 0}, M_PI*(4 - 1.96) * 6},
    {"box", {ShapeKind::box, 1 * kMm, 2 * kMm, 3 * kMm, 0}, 48},
    {"wedge", {ShapeKind::wedge, 1 * kMm, 2 * kMm, 6 * kMm, 0}, 24},
};

double volume_of(const surface::Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vec3 a = mesh.vertices[mesh.triangles[t]].p.cast<double>(),
               b = mesh.vertices[mesh.triangles[t + 1]].p.cast<double>(),
               c = mesh.vertices[mesh.triangles[t + 2]].p.cast<double>();
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

// Vertices and normals against the distance; every triangle faces outward.
void expect_on_surface(const Shape& shape, double off_mm) {
  const surface::Mesh mesh = mesh_of(shape);
  ASSERT_GT(mesh.triangles.size(), 0U);
  for (const surface::Vertex& vertex : mesh.vertices) {
    const tool::Distance d = tool::distance(shape, vertex.p.cast<double>());
    ASSERT_NEAR(1e3 * d.phi, 0, off_mm);
    ASSERT_NEAR(vertex.n.norm(), 1, 1e-5);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const surface::Vertex *a = &mesh.vertices[mesh.triangles[t]],
                          *b = &mesh.vertices[mesh.triangles[t + 1]],
                          *c = &mesh.vertices[mesh.triangles[t + 2]];
    const Vec3 n = (b->p - a->p).cast<double>().cross((c->p - a->p).cast<double>());
    if (n.norm() < 1e-14) continue;
    const Vec3 mean = (a->n + b->n + c->n).cast<double>().normalized();
    ASSERT_GT(n.normalized().dot(mean), 0.9);
    // a little outside the facet one is outside the shape
    const Vec3 middle = (a->p + b->p + c->p).cast<double>() / 3;
    ASSERT_GT(tool::distance(shape, middle + 0.05 * kMm * n.normalized()).phi, 0);
    ASSERT_LT(tool::distance(shape, middle - 0.05 * kMm * n.normalized()).phi, 0);
  }
}

TEST(ToolMesh, IsTheSurfaceOfItsDistance) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    expect_on_surface(kind.shape, 1e-3);
  }
  SCOPED_TRACE("vesica");
  expect_on_surface({ShapeKind::vesica, 1.5 * kMm, 0, 5 * kMm, 0.1 * kMm}, 1e-3);
  {
    SCOPED_TRACE("rounded tube");
    expect_on_surface({ShapeKind::tube, 2 * kMm, 1.4 * kMm, 3 * kMm, 0.2 * kMm}, 1e-3);
  }
  SCOPED_TRACE("half shell");
  expect_on_surface({ShapeKind::half_shell, 2 * kMm, 0.4 * kMm, 0, 0.2 * kMm}, 1e-3);
}

TEST(ToolMesh, HoldsTheVolumeOfItsBody) {
  for (const Kind& kind : kKinds)
    EXPECT_NEAR(1e9 * volume_of(mesh_of(kind.shape)), kind.volume_mm3, 0.03 * kind.volume_mm3)
        << kind.name;
}

TEST(ToolMesh, PartsLieWhereTheToolHasThem) {
  tool::Tool tool;
  const math::Quat turned(Eigen::AngleAxisd(0.7, Vec3::UnitX()));
  ASSERT_TRUE(
      tool::add_part(tool, {kKinds[3].shape, {Vec3(1, 2, 3) * kMm, turned}, tool::Role::cuts}));
  ASSERT_TRUE(tool::add_part(tool, {kKinds[1].shape, {}, tool::Role::rubs}));
  const surface::Mesh cuts = mesh_of(tool, tool::Role::cuts);
  EXPECT_EQ(cuts.vertices.size(), mesh_of(kKinds[3].shape).vertices.size());
  for (const surface::Vertex& vertex : cuts.vertices) {
    const tool::Part& part = tool.parts[0];
    const Vec3 p = part.tool_from_part.inverse() * Vec3(vertex.p.cast<double>());
    EXPECT_NEAR(tool::distance(part.shape, p).phi, 0, 1e-6);
  }
  EXPECT_NEAR(1e9 * volume_of(cuts), kKinds[3].volume_mm3, 0.03 * kKinds[3].volume_mm3);
}

}  // namespace
}  // namespace burr::render

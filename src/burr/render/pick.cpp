#include "burr/render/pick.h"

#include <limits>

#include "burr/render/ray_box.h"

namespace burr::render {

using math::Vec3;

namespace {

void pick_in(const SkinMesh& mesh, const Ray& ray, const std::optional<ClipPlane>& clip,
             Hit& nearest) {
  for (std::size_t t = 0; t + 2 < mesh.index_count(); t += 3) {
    const SkinVertex& a = mesh.vertices()[mesh.index(t)];
    const SkinVertex& b = mesh.vertices()[mesh.index(t + 1)];
    const SkinVertex& c = mesh.vertices()[mesh.index(t + 2)];

    // Moeller & Trumbore 1997, front faces only
    const Vec3 pa = a.p.cast<double>();
    const Vec3 ab = b.p.cast<double>() - pa, ac = c.p.cast<double>() - pa;
    const Vec3 across = ray.direction.cross(ac);
    const double area = ab.dot(across);
    if (area <= 0) continue;
    const Vec3 from = ray.origin - pa;
    const double u = from.dot(across);
    if (u < 0 || u > area) continue;
    const Vec3 over = from.cross(ab);
    const double v = ray.direction.dot(over);
    if (v < 0 || u + v > area) continue;
    const double distance = ac.dot(over) / area;
    if (distance < 0 || distance >= nearest.distance) continue;
    if (clip && clip->n.dot(ray.origin + distance * ray.direction - clip->p) > 0) continue;

    nearest.distance = distance;
    nearest.p = ray.origin + distance * ray.direction;
    nearest.n = ((area - u - v) * normal_of(a).cast<double>() + u * normal_of(b).cast<double>() +
                 v * normal_of(c).cast<double>())
                    .normalized();
    nearest.tissue = tissue_of(a);
  }
}

}  // namespace

std::optional<Hit> pick(const Scene& scene, const Ray& ray) {
  const Vec3 inverse = ray.direction.cwiseInverse();
  Hit nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  for (const ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr || entry(patch.box, ray, inverse) >= nearest.distance) continue;
    pick_in(*patch.mesh, ray, scene.clip, nearest);
  }
  if (nearest.distance == std::numeric_limits<double>::infinity()) return std::nullopt;
  return nearest;
}

}  // namespace burr::render

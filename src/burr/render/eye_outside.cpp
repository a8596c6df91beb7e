#include "burr/render/eye_outside.h"

#include "burr/render/pick.h"

namespace burr::render {

using math::Vec3;

namespace {

constexpr double kFar = 1;       // beyond every bone [m]
constexpr double kAhead = 2e-3;  // of the bone, where the eye is put [m]

// How far the outermost bone lies from the eye in this direction; 0: none does. The ray comes from
// outside, because a surface is hit only from its front.
double bone_towards(const Scene& scene, const Vec3& eye, const Vec3& direction) {
  const auto hit = pick(scene, {eye + kFar * direction, -direction});
  return hit && hit->distance < kFar ? kFar - hit->distance : 0;
}

}  // namespace

bool keep_eye_outside(Scene& scene) {
  if (scene.camera.placed) return false;
  const Vec3 eye = scene.camera.eye(), back = scene.camera.backward();
  const double behind = bone_towards(scene, eye, back);
  if (behind <= 0) return false;
  for (int way = 0; way < 27; ++way) {
    const math::Ijk to(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
    if (way != 13 && bone_towards(scene, eye, to.cast<double>().normalized()) <= 0) return false;
  }
  scene.camera.distance += behind + kAhead;
  return true;
}

}  // namespace burr::render

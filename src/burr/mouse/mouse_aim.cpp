#include "burr/mouse/mouse_aim.h"

#include "burr/math/rotation.h"
#include "burr/render/room.h"

namespace burr::mouse {
namespace {

using math::Vec3;

constexpr double kFollow = 0.2;   // share of a new normal: a rough bone must not shake the hand
constexpr double kInHole = 3e-3;  // from the burr to the bone under the point, at most  [m]

// Whether nothing lies between the eye and the middle of the burr.
bool is_seen(const render::Scene& scene, const Vec3& burr) {
  const Vec3 way = burr - scene.camera.eye();
  const double far = way.norm();
  const auto hit = render::pick(scene, {scene.camera.eye(), way / far});
  return !hit || hit->distance >= far;
}

}  // namespace

MouseHand::Aim MouseAim::at(const render::Scene& scene, const render::Ray& eye,
                            const std::optional<Push>& push, bool left_handed) {
  auto hit = render::pick(scene, eye);
  double surface = 0;
  // soft tissue and retractor are in the way of the hand, but nobody feels them
  if (scene.drape != nullptr) {
    const auto covered = render::hit(*scene.drape, eye);
    if (covered && (!hit || *covered < hit->distance))
      return over_drape(scene, eye, *covered, left_handed);
  }
  if (hit) {
    normal_ = ((1 - kFollow) * normal_ + kFollow * hit->n).normalized();
    point_ = hit->p;
    surface = hit->distance;
  } else {  // over the background: as deep in the picture as the last work
    const Vec3 ahead = -scene.camera.backward();
    const Vec3 near = point_.value_or(scene.camera.target);
    surface = (near - eye.origin).dot(ahead) / eye.direction.dot(ahead);
    normal_ = ((1 - kFollow) * normal_ - kFollow * ahead).normalized();
  }
  below_.reset();
  if (hit && !push) below_ = hit->p - 0.5 * scene.burr.radius * normal_;
  if (hit && push) {
    in_work_ = true;
    MouseHand::Aim aim = lean(hit->p, scene.camera, left_handed);
    const double under =
        other() ? grip_->reach_along(aim.world_from_tool.q, -normal_) : scene.burr.radius;
    aim.world_from_tool.p += (under - push->depth) * normal_;
    aim.pedal = push->spindle;
    return aim;
  }
  MouseHand::Aim aim = lean(hover(scene, eye, hit, surface), scene.camera, left_handed);
  aim.hovers = true;
  return aim;
}

// Above the drape, at `covered` along the ray; nothing can be pressed there.
MouseHand::Aim MouseAim::over_drape(const render::Scene& scene, const render::Ray& eye,
                                    double covered, bool left_handed) {
  below_.reset();
  in_work_ = false;
  normal_ = ((1 - kFollow) * normal_ + kFollow * scene.camera.backward()).normalized();
  const double reach = this->reach(scene) + air_;
  const auto room = render::room_before(scene, eye, std::max(covered - reach, 0.0), reach);
  const Vec3 tip = room ? Vec3(eye.origin + *room * eye.direction) : scene.burr.world_from_tool.p;
  MouseHand::Aim aim = lean(tip, scene.camera, left_handed);
  aim.hovers = true;
  return aim;
}

// surface: along the ray [m]
Vec3 MouseAim::hover(const render::Scene& scene, const render::Ray& eye,
                     const std::optional<render::Hit>& hit, double surface) {
  const double radius = reach(scene);
  const Vec3& burr = scene.burr.world_from_tool.p;
  const auto room = render::room_before(scene, eye, surface, radius + air_);
  const bool roomy = room && surface - *room < 2 * (radius + air_);
  in_work_ = in_work_ && hit && !roomy && (burr - hit->p).norm() < radius + kInHole &&
             is_seen(scene, burr);
  if (in_work_) return burr;
  return room ? Vec3(eye.origin + *room * eye.direction) : burr;
}

MouseHand::Aim MouseAim::held_at(const Vec3& tip, const Vec3& out, double spindle,
                                 const render::Camera& camera, bool left_handed) {
  below_.reset();
  normal_ = ((1 - kFollow) * normal_ + kFollow * out).normalized();
  point_ = tip;
  MouseHand::Aim aim = lean(tip, camera, left_handed);
  aim.pedal = spindle;
  return aim;
}

void MouseAim::touches(const Vec3& p, const std::optional<Vec3>& normal) {
  point_ = p;
  below_.reset();
  if (normal) normal_ = *normal;
}

// The handle leans away from the view, to the side of the user's hand.
MouseHand::Aim MouseAim::lean(const Vec3& tip, const render::Camera& camera,
                              bool left_handed) const {
  if (other()) {
    MouseHand::Aim aim;
    aim.world_from_tool = {tip, grip_->turn(normal_, camera, left_handed)};
    return aim;
  }
  const double side = left_handed ? -0.7 : 0.7;
  const Vec3 handle = (normal_ + side * camera.right() + 0.2 * camera.above()).normalized();
  MouseHand::Aim aim;
  aim.world_from_tool.p = tip;
  aim.world_from_tool.q = math::shortest_rotation(Vec3::UnitZ(), handle);
  return aim;
}

}  // namespace burr::mouse

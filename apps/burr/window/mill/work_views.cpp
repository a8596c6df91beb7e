#include "window/mill/work_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/render/eye_outside.h"
#include "burr/render/room.h"
#include "burr/workshop/opening.h"

namespace burr::app {

using math::Vec3;

namespace {

constexpr double kAngle = 0.5;       // of the whole and the free view [rad]
constexpr double kEndoscope = 2e-3;  // its radius [m]
constexpr double kAhead = 10e-3;     // from its tip to what it looks at [m]
constexpr double kFacing = 0.35;     // cosine: seen flatter than this, the drape is left out
constexpr double kDark = 0.7;        // of the vignette

bool has_entry(const WindowOptions& options) {
  return options.work_case && options.work_case->at && options.work_case->into;
}

}  // namespace

Views::Views(const WindowOptions& options, const render::Camera& first)
    : first_kind_(has_entry(options) ? ViewKind::microscope : ViewKind::whole),
      first_(first),
      outward_(first.backward()) {
  if (!has_entry(options)) return;
  const scenario::Case& work = *options.work_case;
  outward_ = -work.into->normalized();
  first_ = render::microscope_view(*work.at, outward_, render::kFields[render::kFirstField]);
  opening_ = workshop::opening_of(work, options.lesson ? &*options.lesson : nullptr);
}

void Views::first(render::Scene& scene, double aspect) {
  microscope_.reset();
  go(first_kind_, scene, first_.target, aspect);
}

void Views::face(render::Scene& scene, const Vec3& at, const Vec3& outward, double radius) {
  constexpr double kSeen = 0.9, kMiddle = 0.3;  // cosine; share of the picture's height
  constexpr double kHigh = 2.6;                 // of the picture, in radii
  const render::Camera& now = scene.camera;
  const Vec3 off = at - now.target;
  const double aside = (off - off.dot(now.backward()) * now.backward()).norm();
  if (now.backward().dot(outward) > kSeen && aside < kMiddle * now.view_height() &&
      now.view_height() > kHigh * radius)
    return;
  double field = render::kFields.front();
  for (std::size_t n = 0; n <= render::kFirstField; ++n)
    if (render::kFields[n] >= kHigh * radius) field = render::kFields[n];
  scene.camera = render::microscope_view(at, outward, field);
  kind_ = ViewKind::microscope;
  dress(scene);
}

void Views::go(ViewKind kind, render::Scene& scene, const Vec3& work, double aspect) {
  render::Camera& camera = scene.camera;
  if (kind_ == ViewKind::microscope && kind != kind_) microscope_ = camera;
  switch (kind) {
    case ViewKind::microscope:
      camera = microscope_ ? *microscope_
               : first_kind_ == kind
                   ? first_
                   : render::microscope_view(work, outward_, render::kFields[render::kFirstField]);
      break;
    case ViewKind::whole: {
      camera = {};
      camera.field_of_view = kAngle;
      camera = render::whole_view(scene, first_.azimuth, first_.elevation, aspect);
      render::zoom(camera, 0.85);
      render::pan(camera, 0, -0.05);  // the strip covers the lower edge
      // the same picture, but one that goes nearer ends at the place of work, not inside the bone
      const double nearer = (first_.target - camera.target).dot(camera.backward());
      if (nearer > 0 && nearer < 0.8 * camera.distance) {
        camera.target += nearer * camera.backward();
        camera.distance -= nearer;
      }
      break;
    }
    case ViewKind::endoscope: {
      // along the line from the present eye to the work, as near as the tip has room
      const Vec3 way = work - camera.eye();
      const double far = way.norm();
      if (!(far > 0)) break;
      const render::Ray ray = {camera.eye(), way / far};
      const auto room = render::room_before(scene, ray, std::max(far - kAhead, 0.0), kEndoscope);
      const Vec3 tip = ray.origin + room.value_or(std::max(far - kAhead, 0.0)) * ray.direction;
      camera = render::endoscope_view(tip, ray.direction);
      break;
    }
    case ViewKind::free: {
      const double height = camera.view_height();
      camera.field_of_view = kAngle;
      camera.distance = std::clamp(height / (2 * std::tan(0.5 * kAngle)), 20e-3, 1.0);
      break;
    }
  }
  kind_ = kind;
  dress(scene);
}

void Views::placed(const render::Scene& scene) {
  kind_ = render::is_microscope(scene.camera) ? ViewKind::microscope : ViewKind::free;
}

bool Views::magnify(double by, render::Scene& scene) {
  if (kind_ != ViewKind::microscope) return false;
  wheel_ += by;
  const auto steps = static_cast<int>(std::trunc(wheel_));
  wheel_ -= steps;
  if (steps == 0) return true;
  const auto now = static_cast<int>(render::field_step(scene.camera));
  const int next = std::clamp(now + steps, 0, static_cast<int>(render::kFields.size()) - 1);
  render::set_field(scene.camera, render::kFields[static_cast<std::size_t>(next)]);
  return true;
}

bool Views::refocus(double by) {
  if (kind_ != ViewKind::microscope) return false;
  deep_ = true;
  beyond_ = std::clamp(beyond_ + by * kFine, -kMostBeyond, kMostBeyond);
  return true;
}

void Views::dress(render::Scene& scene) {
  if (!bare_) bare_ = scene.look;
  render::Look light = *bare_;
  const bool scope = kind_ == ViewKind::microscope || kind_ == ViewKind::endoscope;
  if (scope) render::light_coaxially(light);
  scene.look.key = light.key;
  scene.look.fill = light.fill;
  scene.look.ambient = light.ambient;
  scene.look.background_top = light.background_top;
  scene.look.background_bottom = light.background_bottom;
  scene.round = kind_ == ViewKind::endoscope;
  scene.vignette = kind_ == ViewKind::microscope ? kDark : 0;
  if (kind_ == ViewKind::microscope && opening_ && drape_ == nullptr) {
    scene.drape = nullptr;
    drape_ = render::drape_over(scene, *opening_);
  }
}

void Views::look(render::Scene& scene) {
  // an endoscope belongs into hollows
  if (kind_ != ViewKind::endoscope && !render::same(scene.camera, seen_))
    render::keep_eye_outside(scene);
  seen_ = scene.camera;
  // in see-through bone, and from beside or behind it, the drape would only hide
  const bool shown = kind_ == ViewKind::microscope && scene.look.opacity >= 1 && !scene.clip &&
                     scene.camera.backward().dot(outward_) > kFacing;
  scene.drape = shown ? drape_ : nullptr;
  scene.focus =
      deep() ? std::optional(render::microscope_focus(scene.camera, beyond_)) : std::nullopt;
}

void Views::end(render::Scene& scene) const {
  scene.drape = nullptr;
  scene.focus.reset();
  scene.round = false;
  scene.vignette = 0;
  if (!bare_) return;
  const double opacity = scene.look.opacity;
  scene.look = *bare_;
  scene.look.opacity = opacity;
}

}  // namespace burr::app

#include "burr/metrics/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/math/sums.h"
#include "burr/metrics/look_along.h"
#include "burr/metrics/near.h"
#include "burr/metrics/solidity.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kEvery = 0.1;                 // [s]
constexpr double kTurned = 0.984807753012208;  // cos 10 degrees
constexpr double kZoomed = 1.1;

bool is_clear(const volume::Bone& bone, const Vec3& from, const Vec3& eye) {
  const volume::Grid& grid = bone.grid();
  const Vec3 p = grid.grid_from_world(from), way = grid.grid_from_world(eye) - p;
  const double length = math::norm(way);
  if (!std::isfinite(length)) return false;  // no way that ends
  if (!(length > 0)) return true;
  const Vec3 w = way / length;
  for (double l = 0.25; l < length; l += 0.5) {
    const Vec3 q = p + l * w;
    bool gone = false;
    for (int a = 0; a < 3; ++a)
      gone = gone || (q[a] < -1 && w[a] <= 0) || (q[a] > grid.size[a] && w[a] >= 0);
    if (gone) return true;
    if (solidity_of(volume::sample(bone, q)) >= 0.5) return false;
  }
  return true;
}

}  // namespace

std::vector<EyeSample> eyes_of(std::span<const record::View> views, double rate_hz) {
  std::vector<EyeSample> eyes;
  for (const record::View& view : views) {
    EyeSample eye{static_cast<double>(view.tick) / rate_hz, view.eye, -view.back,
                  view.magnification};
    if (!record::check(view)) eye.eye.setConstant(std::numeric_limits<double>::quiet_NaN());
    eyes.push_back(eye);
  }
  return eyes;
}

double share_in_sight(const volume::Bone& bone, const Vec3& centre, double radius,
                      const Vec3& eye) {
  int clear = is_clear(bone, centre, eye) ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double way : {-0.8, 0.8})
      clear += is_clear(bone, centre + way * radius * Vec3::Unit(axis), eye) ? 1 : 0;
  return clear / 7.0;
}

bool VisibilityMaker::add(const Moment& now) {
  const bool first = !(last_.dt > 0);
  const bool over = !first && std::floor(now.t / kEvery) != std::floor(last_.t / kEvery);
  volume_ += now.removed;
  last_ = now;
  return over && volume_ > 0;
}

void VisibilityMaker::look(const volume::Bone& bone) {
  while (eye_ + 1 < eyes_.size() && eyes_[eye_ + 1].t <= last_.t) ++eye_;
  const double volume = volume_;
  volume_ = 0;
  if (eyes_.empty() || eyes_[eye_].t > last_.t) return;  // nobody had looked yet
  if (!eyes_[eye_].eye.allFinite()) return;
  if (!last_.radius_known()) {
    radius_missing_ = true;
    return;
  }
  const double v = share_in_sight(bone, last_.centre, last_.tool.radius, eyes_[eye_].eye);
  all_ += volume;
  sum_ += v * volume;
  if (v >= 0.5) {
    seen_ += volume;
    return;
  }
  worst_.push_back({last_.t, v, volume, last_.centre});
  std::stable_sort(worst_.begin(), worst_.end(),
                   [](const auto& a, const auto& b) { return a.volume > b.volume; });
  if (worst_.size() > 3) worst_.resize(3);
}

Assessed<Visibility> VisibilityMaker::finish() const {
  if (eyes_.empty()) return NotAssessable{"the recording does not say where the eye was"};
  if (!(all_ > 0) && radius_missing_) return NotAssessable{kNoRadius};
  if (!(all_ > 0)) return NotAssessable{"nothing was removed while the eye was known"};
  return Visibility{all_, seen_ / all_, sum_ / all_, worst_};
}

Result<Assessed<Visibility>> visibility_of(record::Player& player, volume::Bone& bone,
                                           std::span<const EyeSample> eyes, Progress& progress) {
  VisibilityMaker maker(eyes);
  if (const Status looked =
          look_along(player, bone, maker, "measuring what was in sight", progress);
      !looked)
    return looked.error();
  if (maker.end()) {
    if (const Status shown = player.bone_at(player.seconds(), bone); !shown) return shown.error();
    maker.look(bone);
  }
  return maker.finish();
}

Assessed<ViewChanges> view_changes(std::span<const EyeSample> eyes, double seconds) {
  if (!(seconds > 0)) return NotAssessable{"the recording is empty"};
  double zoom = 0, turn = 0;
  const EyeSample* first = nullptr;
  EyeSample was;
  for (const EyeSample& now : eyes) {
    if (!now.eye.allFinite() || !now.forward.allFinite() || !(now.magnification > 0) ||
        !std::isfinite(now.magnification))
      continue;
    if (first == nullptr) {
      first = &now;
      was = now;
    }
    const double ratio = now.magnification / was.magnification;
    if (ratio > kZoomed || ratio < 1 / kZoomed) {
      ++zoom;
      was.magnification = now.magnification;
    }
    if (math::dot(now.forward, was.forward) < kTurned) {
      ++turn;
      was.forward = now.forward;
    }
  }
  if (first == nullptr) return NotAssessable{"the recording does not say where the eye was"};
  return ViewChanges{60 * zoom / seconds, 60 * turn / seconds};
}

}  // namespace burr::metrics

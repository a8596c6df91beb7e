#include "burr/metrics/way.h"

#include "burr/math/sums.h"
#include "burr/metrics/near.h"

namespace burr::metrics {
namespace {

constexpr double kPause = 2, kNearBone = 5e-3;  // [s], [m]
constexpr double kPole = 0.3;                   // sine

}  // namespace

void TimesMaker::end_pause() {
  if (pause_ > kPause) {
    ++hesitation_.count;
    hesitation_.seconds += pause_;
  }
  pause_ = 0;
}

void TimesMaker::add(const Moment& now) {
  times_.total += now.dt;
  if (!now.touching) times_.free += now.dt;
  if (now.cutting()) {
    times_.cutting += now.dt;
    if (now.tool.irrigated) times_.irrigated += now.dt;
    if (math::squared_norm(now.normal) > 0.25) {
      times_.volume += now.removed;
      if (math::norm(now.shaft.cross(now.normal)) < kPole) times_.pole_volume += now.removed;
    }
  }
  if (bone_ == nullptr) return;
  radius_ = radius_ || now.radius_known();
  const bool near =
      now.radius_known() && bone_->at(now.centre).distance - now.tool.radius <= kNearBone;
  if (now.cutting() || !near || now.gap) end_pause();
  if (!now.cutting() && near) pause_ += now.dt;
}

Times TimesMaker::finish() {
  end_pause();
  Times out = times_;
  if (bone_ == nullptr || bone_->empty())
    out.hesitation = NotAssessable{"the distance to the bone is not known"};
  else if (!radius_)
    out.hesitation = NotAssessable{kNoRadius};
  else
    out.hesitation = hesitation_;
  return out;
}

Paths paths_of(const Track& track) {
  Paths out;
  track.for_each_piece([&](const auto& piece) {
    for (std::size_t n = 1; n < piece.size(); ++n) {
      const double step = math::norm(piece[n].p - piece[n - 1].p);
      out.all += step;
      if (!piece[n].touching && !piece[n - 1].touching) out.free += step;
    }
  });
  return out;
}

}  // namespace burr::metrics

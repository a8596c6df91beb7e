#include "burr/render/wound.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace burr::render {

using math::Aabb;
using math::Ijk;
using math::Vec3;

namespace {

constexpr int kEdge = 64;    // cells along a side
constexpr int kRoom = 12;    // of the tool to the grid's side, at least  [cell]
constexpr int kLevels = 32;  // a dress is told in: fewer are sent more seldom

std::uint8_t level(float v) {
  const auto step = static_cast<int>(std::lround(std::clamp(v, 0.0F, 1.0F) * kLevels));
  return static_cast<std::uint8_t>(step * 255 / kLevels);
}

// of a point from the line between two
double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length = way.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(way) / length, 0.0, 1.0) : 0.0;
  return (p - a - s * way).norm();
}

}  // namespace

Wound::Wound(double voxel) : cell_(std::max(0.5e-3, 2 * voxel)) {}

void Wound::forget() {
  cells_.clear();
  low_ = high_ = Ijk::Zero();
  last_.reset();
  dressed_at_ = -1e9;
}

std::size_t Wound::index(int i, int j, int k) const {
  return static_cast<std::size_t>((k * kEdge + j) * kEdge + i);
}

// The grid goes along with the tool; what falls out of it is forgotten.
void Wound::centre(const Vec3& p) {
  const Ijk at = (p / cell_).array().floor().cast<int>();
  if (cells_.empty()) {
    cells_.assign(static_cast<std::size_t>(kEdge * kEdge * kEdge), {});
    first_ = at - Ijk::Constant(kEdge / 2);
    return;
  }
  const Ijk inside = at - first_;
  if (inside.minCoeff() >= kRoom && inside.maxCoeff() < kEdge - kRoom) return;
  const Ijk by = inside - Ijk::Constant(kEdge / 2);
  std::vector<State> moved(cells_.size());
  const Ijk low = (low_ - by).cwiseMax(0), high = (high_ - by).cwiseMin(kEdge);
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i)
        moved[index(i, j, k)] = cells_[index(i + by.x(), j + by.y(), k + by.z())];
  cells_ = std::move(moved);
  first_ += by;
  low_ = low;
  high_ = high.cwiseMax(low);
}

void Wound::dull(double seconds) {
  const auto fresh = static_cast<float>(seconds / kDulls),
             wet = static_cast<float>(seconds / kDries);
  Ijk low = high_, high = low_;
  for (int k = low_.z(); k < high_.z(); ++k)
    for (int j = low_.y(); j < high_.y(); ++j)
      for (int i = low_.x(); i < high_.x(); ++i) {
        State& state = cells_[index(i, j, k)];
        if (state.fresh <= 0 && state.wet <= 0) continue;
        state.fresh = std::max(0.0F, state.fresh - fresh);
        state.wet = std::max(0.0F, state.wet - wet);
        low = low.cwiseMin(Ijk(i, j, k));
        high = high.cwiseMax(Ijk(i + 1, j + 1, k + 1));
      }
  low_ = low.cwiseMin(high);
  high_ = high;
}

// change(cell, distance of its middle from the line a-b)
template <class Change>
void Wound::each_near(const Vec3& a, const Vec3& b, double reach, const Change& change) {
  const Vec3 lo = a.cwiseMin(b).array() - reach, hi = a.cwiseMax(b).array() + reach;
  const Ijk low = ((lo / cell_).array().floor().cast<int>().matrix() - first_).cwiseMax(0);
  const Ijk high = ((hi / cell_).array().ceil().cast<int>().matrix() - first_).cwiseMin(kEdge);
  if ((low.array() >= high.array()).any()) return;
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i) {
        const Vec3 p = cell_ * ((Ijk(i, j, k) + first_).cast<double>() + Vec3::Constant(0.5));
        const double d = distance(p, a, b);
        if (d <= reach) change(cells_[index(i, j, k)], d);
      }
  const bool none = (low_.array() >= high_.array()).any();
  low_ = none ? low : low_.cwiseMin(low).eval();
  high_ = none ? high : high_.cwiseMax(high).eval();
}

void Wound::see(const Tick& tick) {
  if (!tick.tip.allFinite() || !std::isfinite(tick.t)) return;
  if (last_ && tick.t < last_->t) forget();
  const double seconds = last_ ? tick.t - last_->t : 0;
  const bool cut = last_ && tick.removed > last_->removed;
  if (!cells_.empty()) dull(seconds);
  if (cut || tick.irrigated) soak_and_cut(tick, seconds, cut);
  last_ = tick;
}

void Wound::soak_and_cut(const Tick& tick, double seconds, bool cut) {
  centre(tick.tip);
  // where the tool was in between is known as long as it was not long
  constexpr double kKnown = 0.3;
  const Vec3 from = last_ && seconds <= kKnown ? last_->tip : tick.tip;
  if (cut)  // a cell and a bit more, so that what is between cells is fresh all through
    each_near(from, tick.tip, tick.radius + 1.2 * cell_,
              [](State& state, double) { state.fresh = 1; });
  if (tick.irrigated) {
    const auto soaks = static_cast<float>(seconds / kSoaks);
    each_near(from, tick.tip, tick.radius + kSpray, [&](State& state, double d) {
      // less at the rim of the spray
      const double rim = (tick.radius + kSpray - d) / (0.4 * kSpray);
      const auto most = static_cast<float>(std::min(1.0, rim));
      state.wet = std::max(state.wet, std::min(most, state.wet + soaks));
    });
  }
}

Wound::State Wound::at(const Vec3& p) const {
  if (cells_.empty()) return {};
  const Vec3 q = p / cell_ - first_.cast<double>() - Vec3::Constant(0.5);
  const Ijk low = q.array().floor().cast<int>();
  if (low.minCoeff() < 0 || low.maxCoeff() + 1 >= kEdge) return {};
  const Vec3 part = q - low.cast<double>();
  State sum;
  for (int c = 0; c < 8; ++c) {
    const Ijk by(c & 1, (c >> 1) & 1, c >> 2);
    double weight = 1;
    for (int d = 0; d < 3; ++d) weight *= by[d] == 1 ? part[d] : 1 - part[d];
    const State& state = cells_[index(low.x() + by.x(), low.y() + by.y(), low.z() + by.z())];
    sum.fresh += static_cast<float>(weight) * state.fresh;
    sum.wet += static_cast<float>(weight) * state.wet;
  }
  return sum;
}

Aabb Wound::touched() const {
  Aabb box;
  if ((low_.array() >= high_.array()).any()) return box;
  box.extend(cell_ * (first_ + low_ - Ijk::Ones()).cast<double>());
  box.extend(cell_ * (first_ + high_ + Ijk::Ones()).cast<double>());
  return box;
}

void Wound::dress(Scene& scene, int patch) const {
  ScenePatch& entry = scene.patches[static_cast<std::size_t>(patch)];
  if (entry.mesh == nullptr) return;
  const Aabb box = touched();
  const bool reached = !box.empty() && (entry.box.lo.array() <= box.hi.array()).all() &&
                       (entry.box.hi.array() >= box.lo.array()).all();
  if (!reached) {
    entry.dress = nullptr;
    return;
  }
  std::vector<Dress> dress;
  dress.reserve(entry.mesh->vertices().size());
  bool any = false;
  for (const SkinVertex& vertex : entry.mesh->vertices()) {
    const State state = at(vertex.p.cast<double>());
    dress.push_back({level(state.fresh), level(state.wet)});
    any = any || dress.back() != Dress{};
  }
  if (!any)
    entry.dress = nullptr;
  else if (entry.dress == nullptr || *entry.dress != dress)
    entry.dress = std::make_shared<const std::vector<Dress>>(std::move(dress));
}

void Wound::dress(Scene& scene) const {
  for (std::size_t patch = 0; patch < scene.patches.size(); ++patch)
    dress(scene, static_cast<int>(patch));
}

void Wound::renew(Scene& scene, double now) {
  if (now - dressed_at_ < scene.quality.dress_s) return;
  dressed_at_ = now;
  dress(scene);
}

}  // namespace burr::render

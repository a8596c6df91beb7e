// The grid, and how time and tool change it. For how it is shown see wound_stain.cpp.
#include "burr/render/wound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

namespace burr::render {

using math::Aabb;
using math::Ijk;
using math::Vec3;

namespace {

constexpr double kSoftBorder = 6;  // of the grid, over which all fades [cell]
constexpr int kRoom = 12;          // least distance of the tool from the border of the grid [cell]
constexpr double kKnown = 0.3;     // longest pause across which the tool's path is interpolated [s]
constexpr double kStep = 0.1;      // time step of blood and paste: one cell per step [s]
constexpr double kLongest = 40;    // of the path, then its length begins again at 0 [m]
constexpr float kLeast = 1e-3F;    // less than this counts as nothing
constexpr float kPaste = 0.2F;     // dust is a paste where it is wetter than this

// Distance of a point from the line between two points.
double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length = way.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(way) / length, 0.0, 1.0) : 0.0;
  return (p - a - s * way).norm();
}

float left_after(double seconds, double time) {
  return static_cast<float>(std::exp(-seconds / time));
}

}  // namespace

std::vector<float> bleeding_of(const volume::TissueTable& tissues) {
  std::vector<float> bleeding;
  for (const volume::Tissue& tissue : tissues.tissues)
    bleeding.push_back(static_cast<float>(std::clamp(tissue.bleeds, 0.0, 1.0)));
  return bleeding;
}

Wound::Wound(double voxel, std::vector<float> bleeding)
    : cell_(std::max(0.5e-3, 2 * voxel)), voxel_(voxel), bleeding_(std::move(bleeding)) {}

void Wound::forget() {
  cells_.clear();
  chips_.forget();
  low_ = high_ = Ijk::Zero();
  first_tool_ = other_tool_ = {};
  cut_at_ = -1e9;
  before_.clear();
  up_.reset();
  flowed_ = 0;
  bleeds_ = pasty_ = false;
  stained_at_ = -1e9;
}

std::size_t Wound::index(int i, int j, int k) const {
  return static_cast<std::size_t>((k * kEdge + j) * kEdge + i);
}

// The grid moves with the tool; what leaves the grid is forgotten.
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
  std::vector<Cell> moved(cells_.size());
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
  const auto fresh = static_cast<float>(seconds / kDullTime),
             wet = static_cast<float>(seconds / kDryTime);
  const float clears = left_after(seconds, kClearTime), clots = left_after(seconds, kClotTime);
  Ijk low = high_, high = low_;
  for (int k = low_.z(); k < high_.z(); ++k)
    for (int j = low_.y(); j < high_.y(); ++j)
      for (int i = low_.x(); i < high_.x(); ++i) {
        Cell& cell = cells_[index(i, j, k)];
        State& look = cell.look;
        if (look.fresh <= 0 && look.wet <= 0 && look.dust <= 0 && look.blood <= 0 &&
            cell.open <= 0 && cell.off >= kFar && cell.ridges <= 0)
          continue;
        look.fresh = std::max(0.0F, look.fresh - fresh);
        look.wet = std::max(0.0F, look.wet - wet);
        look.blood = look.blood * clears < kLeast ? 0 : look.blood * clears;
        cell.open = cell.open * clots < kLeast ? 0 : cell.open * clots;
        if (look.fresh <= 0) cell.off = kFar;
        low = low.cwiseMin(Ijk(i, j, k));
        high = high.cwiseMax(Ijk(i + 1, j + 1, k + 1));
      }
  low_ = low.cwiseMin(high);
  high_ = high;
}

// Calls change(cell, distance of its middle from the line a-b), or with its middle as well.
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
        if (d > reach) continue;
        Cell& cell = cells_[index(i, j, k)];
        if constexpr (std::is_invocable_v<Change, Cell&, double, const Vec3&>)
          change(cell, d, p);
        else
          change(cell, d);
      }
  const bool none = (low_.array() >= high_.array()).any();
  low_ = none ? low : low_.cwiseMin(low).eval();
  high_ = none ? high : high_.cwiseMax(high).eval();
}

void Wound::see(const Tick& tick) {
  if (!tick.tip.allFinite() || !std::isfinite(tick.t)) return;
  std::optional<Tick>& last = first_tool_.last;
  if (last && tick.t < last->t) forget();
  const double seconds = last ? tick.t - last->t : 0;
  const double removed = last ? tick.removed - last->removed : 0;
  const double own = own_cut(tick);
  const bool added = last && tick.added > last->added;
  if (!cells_.empty()) dull(seconds);
  if (last && tick.undone > last->undone) undo(tick);
  if (removed > 0) {
    if (tick.t - cut_at_ > kStrokePause) begin_stroke();
    cut_at_ = tick.t;
  }
  if (own > 0 || added || tick.irrigated) {
    centre(tick.tip);
    const Vec3 from = last && seconds <= kKnown ? last->tip : tick.tip;
    if (own > 0) cut(first_tool_, tick, from, own);
    if (added) cover(tick, from);
    if (tick.irrigated) soak(tick, from, seconds);
  }
  settle(first_tool_, tick, seconds);
  if (bleeds_ || pasty_) bleed(seconds);
  last = tick;
}

// What the first tool alone removed since the tick before. The row of the other hand may be some ticks
// newer in a window, and the two sums round differently: so only what is above the most so far.
double Wound::own_cut(const Tick& tick) {
  constexpr double kRounding = 1e-15;  // [m^3]
  const double total = tick.removed - tick.others;
  if (!first_tool_.last) own_ = total;
  const double more = total - own_;
  if (more <= (tick.others > 0 ? kRounding : 0)) return 0;
  own_ = total;
  return more;
}

// The grid goes along with the first tool; what lies outside of it keeps its usual look.
void Wound::see_beside(const Tick& tick) {
  if (!tick.tip.allFinite() || !std::isfinite(tick.t)) return;
  std::optional<Tick>& last = other_tool_.last;
  const double seconds = last ? tick.t - last->t : 0;
  const double removed = last ? tick.removed - last->removed : 0;
  if (removed > 0) {
    if (cells_.empty()) centre(tick.tip);
    cut(other_tool_, tick, seconds <= kKnown ? last->tip : tick.tip, removed);
  }
  settle(other_tool_, tick, seconds);
  last = tick;
}

// Keeps what there is, as it was at the tick before.
void Wound::begin_stroke() {
  if (before_.size() == kStrokes) before_.erase(before_.begin());
  Before& now = before_.emplace_back();
  now.net = first_tool_.last->removed - first_tool_.last->undone;
  now.t = first_tool_.last->t;
  now.low = first_ + low_;
  now.high = first_ + high_.cwiseMax(low_);
  if (cells_.empty()) return;
  for (int k = low_.z(); k < high_.z(); ++k)
    for (int j = low_.y(); j < high_.y(); ++j)
      for (int i = low_.x(); i < high_.x(); ++i) now.cells.push_back(cells_[index(i, j, k)]);
}

// Takes away what the undone strokes left.
void Wound::undo(const Tick& tick) {
  constexpr double kSame = 1e-15;  // rounding of sums [m^3]
  const double net = tick.removed - tick.undone;
  while (!before_.empty() && before_.back().net > net + kSame) before_.pop_back();
  chips_.back_to(before_.empty() ? -1e9 : before_.back().t);
  first_tool_.airborne = other_tool_.airborne = 0;
  cut_at_ = -1e9;  // what is cut next is another stroke
  for (Cell& cell : cells_) {
    Cell bare;
    bare.look.wet = cell.look.wet;
    bare.skin = cell.skin;
    cell = bare;
  }
  if (cells_.empty() || before_.empty() || before_.back().net < net - kSame) return;
  const Before was = std::move(before_.back());
  before_.pop_back();
  auto from = was.cells.begin();
  for (int k = was.low.z(); k < was.high.z(); ++k)
    for (int j = was.low.y(); j < was.high.y(); ++j)
      for (int i = was.low.x(); i < was.high.x(); ++i) {
        if (from == was.cells.end()) break;  // there was nothing yet
        const Cell& old = *from++;
        const Ijk at = Ijk(i, j, k) - first_;
        if (at.minCoeff() < 0 || at.maxCoeff() >= kEdge) continue;
        Cell& cell = cells_[index(at.x(), at.y(), at.z())];
        const bool skin = cell.skin;
        const float wet = cell.look.wet;
        cell = old;
        cell.skin = skin;
        cell.look.wet = wet + static_cast<float>((tick.t - was.t) / kDryTime);  // for dull()
        low_ = low_.cwiseMin(at);
        high_ = high_.cwiseMax(at + Ijk::Ones());
      }
  dull(tick.t - was.t);
}

void Wound::cut(Source& source, const Tick& tick, const Vec3& from, double removed) {
  if (!up_) up_ = tick.up.norm() > 0 ? tick.up.normalized().eval() : Vec3::UnitZ();
  source.airborne += tick.dust * removed / kSolidShare;
  if (tick.chips) chips_.throw_from({tick.t, tick.tip, tick.forward, tick.edge, *up_}, removed);
  const Vec3 step = tick.tip - from;
  const Vec3 way = step.norm() > 1e-9 ? step.normalized().eval() : Vec3::Zero().eval();
  const auto begins = static_cast<float>(source.along - way.dot(from));
  source.along = std::fmod(source.along + step.norm(), kLongest);
  each_near(from, tick.tip, tick.radius + (kFar - 1) * cell_, [&](Cell& cell, double d) {
    cell.off = std::min(cell.off, static_cast<float>((d - tick.radius) / cell_));
    // a cell and a bit more, so that everything between cell centres is fresh
    if (d > tick.radius + 1.2 * cell_) return;
    if (tick.diamond) {
      cell.ridges = 0;
    } else if (way.x() != 0 || way.y() != 0 || way.z() != 0) {
      cell.ridges = 1;
      cell.along = begins;
      cell.way = way.cast<float>();
    }
    cell.look.fresh = 1;
    cell.look.dust = cell.look.blood = 0;  // swept away
  });
}

void Wound::cover(const Tick& tick, const Vec3& from) {
  each_near(from, tick.tip, tick.radius + 1.2 * cell_, [](Cell& cell, double) {
    cell.open = 0;
    cell.off = kFar;
    cell.ridges = 0;
    cell.look = {};
  });
}

void Wound::soak(const Tick& tick, const Vec3& from, double seconds) {
  chips_.rinse(tick.tip, tick.radius + kSprayReach, seconds);
  const auto soaks = static_cast<float>(seconds / kSoakTime);
  const float washed = left_after(seconds, kWashTime), rinsed = left_after(seconds, kRinseTime);
  each_near(from, tick.tip, tick.radius + kSprayReach, [&](Cell& cell, double d) {
    // less at the edge of the spray
    const double rim = (tick.radius + kSprayReach - d) / (0.4 * kSprayReach);
    const auto most = static_cast<float>(std::min(1.0, rim));
    State& look = cell.look;
    look.wet = std::max(look.wet, std::min(most, look.wet + soaks));
    look.dust *= 1 - most * (1 - rinsed);
    look.blood *= 1 - most * (1 - washed);
    for (float* left : {&look.dust, &look.blood})
      if (*left < kLeast) *left = 0;
    pasty_ = pasty_ || look.dust > 0;
  });
}

void Wound::suck(const Vec3& mouth, double radius, double seconds) {
  if (cells_.empty() || !mouth.allFinite() || !(seconds > 0)) return;
  chips_.suck(mouth, radius + kSuctionReach);
  const float left = left_after(seconds, kSuctionTime);
  // dust that still flies about the tool is drawn in by a mouth beside it, and never settles
  for (Source* source : {&first_tool_, &other_tool_})
    if (source->last &&
        (mouth - source->last->tip).norm() < radius + source->last->radius + kSuctionReach)
      source->airborne *= static_cast<double>(left);
  each_near(mouth, mouth, radius + kSuctionReach, [&](Cell& cell, double d) {
    const auto most =
        static_cast<float>(std::min(1.0, (radius + kSuctionReach - d) / kSuctionReach));
    State& look = cell.look;
    for (float* goes : {&look.wet, &look.dust, &look.blood}) {
      *goes *= 1 - most * (1 - left);
      if (*goes < kLeast) *goes = 0;
    }
  });
}

// Dust is thickest under the tool and zero at the edge: a cone with the volume that settles; of a saw,
// a cone on an ellipse along its stroke.
void Wound::settle(Source& source, const Tick& tick, double seconds) {
  double& airborne = source.airborne;
  if (airborne <= 0) return;
  const double down = airborne * (1 - std::exp(-seconds / kSettleTime));
  airborne = airborne - down < 1e-15 ? 0 : airborne - down;
  if (cells_.empty() || down <= 0) return;
  // water carries the rest away
  const double stays = tick.irrigated ? kPasteShare * down : down;
  const bool saws = tick.stroke != Vec3::Zero();
  const double reach = tick.radius + kDustReach;
  const double along = saws ? kAlong * reach : reach, across = saws ? kAcross * reach : reach;
  const double thickest = 3 * stays / (std::numbers::pi * along * across);
  const auto share = [&](const Vec3& p, double d) {  // 1 at the edge
    if (!saws) return d / reach;
    const Vec3 w = p - tick.tip;
    const double on = w.dot(tick.stroke);
    return std::hypot(on / along, (w - on * tick.stroke).norm() / across);
  };
  each_near(tick.tip, tick.tip, along, [&](Cell& cell, double d, const Vec3& p) {
    if (cell.off < 1.2F && d < tick.radius + 1.2 * cell_) return;  // the burr sweeps where it is
    const double at = share(p, d);
    if (at >= 1) return;
    const double thick = thickest * (1 - at);
    const auto hidden = static_cast<float>(1 - std::exp(-thick / kCoverThickness));
    cell.look.dust += (1 - cell.look.dust) * hidden;
  });
  pasty_ = pasty_ || tick.irrigated;
}

// ---- blood

void Wound::bleed(double seconds) {
  flowed_ += std::min(seconds, 5 * kStep);
  while (flowed_ >= kStep) {
    flowed_ -= kStep;
    if (bleeds_) flow(kStep);
    if (pasty_) run_paste(kStep);
  }
}

// What is more than a cell can hold flows to the surface beside it, one cell per step.
void Wound::flow(double seconds) {
  bleeds_ = false;
  running_.clear();
  for (int k = low_.z(); k < high_.z(); ++k)
    for (int j = low_.y(); j < high_.y(); ++j)
      for (int i = low_.x(); i < high_.x(); ++i) {
        Cell& cell = cells_[index(i, j, k)];
        if (cell.open > 0) {
          bleeds_ = true;
          cell.look.blood += static_cast<float>(seconds / kFillTime) * cell.open;
        }
        if (cell.look.blood > 1) running_.push_back(index(i, j, k));
      }
  const Vec3 down = -up_.value_or(Vec3::UnitZ());
  constexpr double kUphill = 0.35;  // share of the weight of a way that leads down
  for (const std::size_t from : running_) {
    const auto n = static_cast<int>(from);
    const Ijk at(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
    if (at.minCoeff() < 1 || at.maxCoeff() + 1 >= kEdge) {
      cells_[from].look.blood = 1;  // flows out of the grid
      continue;
    }
    std::array<std::pair<Cell*, float>, 26> ways;
    std::size_t count = 0;
    float sum = 0;
    for (int way = 0; way < 27; ++way) {
      const Ijk by(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
      if (way == 13) continue;
      Cell& to = cells_[index(at.x() + by.x(), at.y() + by.y(), at.z() + by.z())];
      const double falls = by.cast<double>().normalized().dot(down);
      // a full neighbour passes blood on, but an empty one takes more
      const double weight = std::max(0.0, falls + kUphill) * (1.1 - std::min(1.0F, to.look.blood));
      if (!to.skin || weight <= 0) continue;
      ways[count++] = {&to, static_cast<float>(weight)};
      sum += static_cast<float>(weight);
    }
    const float more = cells_[from].look.blood - 1;
    if (sum > 0)
      for (std::size_t w = 0; w < count; ++w)
        ways[w].first->look.blood += more * ways[w].second / sum;
    cells_[from].look.blood = 1;  // where there is no way on, it runs off unseen
    low_ = low_.cwiseMin(at - Ijk::Ones());
    high_ = high_.cwiseMax(at + Ijk::Constant(2));
  }
}

// Dust in water creeps down the surface, the faster the steeper it is; where it is flat it lies.
void Wound::run_paste(double seconds) {
  pasty_ = false;
  running_.clear();
  for (int k = low_.z(); k < high_.z(); ++k)
    for (int j = low_.y(); j < high_.y(); ++j)
      for (int i = low_.x(); i < high_.x(); ++i) {
        const Cell& cell = cells_[index(i, j, k)];
        if (cell.look.dust <= kLeast || cell.look.wet < kPaste) continue;
        pasty_ = true;
        const bool inside = std::min({i, j, k}) > 0 && std::max({i, j, k}) + 1 < kEdge;
        if (cell.skin && inside) running_.push_back(index(i, j, k));
      }
  const Vec3 down = -up_.value_or(Vec3::UnitZ());
  const auto share = static_cast<float>(1 - std::exp(-seconds / kPasteTime));
  for (const std::size_t from : running_) {
    const auto n = static_cast<int>(from);
    const Ijk at(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge));
    Cell* best = nullptr;
    float steepest = 0.3F;  // the sine of the slope on which it stays
    for (int way = 0; way < 27; ++way) {
      const Ijk by(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
      if (way == 13) continue;
      Cell& to = cells_[index(at.x() + by.x(), at.y() + by.y(), at.z() + by.z())];
      const auto falls = static_cast<float>(by.cast<double>().normalized().dot(down));
      if (!to.skin || falls <= steepest) continue;
      best = &to;
      steepest = falls;
    }
    if (best == nullptr) continue;
    State &here = cells_[from].look, &there = best->look;
    const float runs = share * steepest * here.dust * (1 - there.dust);
    here.dust -= runs;
    there.dust += runs;
    there.wet = std::max(there.wet, 0.7F * here.wet);  // it takes its water with it
    low_ = low_.cwiseMin(at - Ijk::Ones());
    high_ = high_.cwiseMax(at + Ijk::Constant(2));
  }
}

// ---- queries

// The mean of the eight cells around a place.
Wound::Cell Wound::mean_at(const Vec3& p) const {
  if (cells_.empty()) return {};
  const Vec3 q = p / cell_ - first_.cast<double>() - Vec3::Constant(0.5);
  const Ijk low = q.array().floor().cast<int>();
  if (low.minCoeff() < 0 || low.maxCoeff() + 1 >= kEdge) return {};
  const Vec3 part = q - low.cast<double>();
  Cell mean;
  mean.off = 0;
  // what the grid holds ends softly before its border
  const double inside = std::min(q.minCoeff(), kEdge - 1 - q.maxCoeff());
  const auto kept = static_cast<float>(std::clamp(inside / kSoftBorder, 0.0, 1.0));
  float surface = 0;  // blood is on the surface only, not beside it
  for (int c = 0; c < 8; ++c) {
    const Ijk by(c & 1, (c >> 1) & 1, c >> 2);
    double product = 1;
    for (int d = 0; d < 3; ++d) product *= by[d] == 1 ? part[d] : 1 - part[d];
    const auto weight = static_cast<float>(product);
    const Cell& cell = cells_[index(low.x() + by.x(), low.y() + by.y(), low.z() + by.z())];
    mean.look.fresh += weight * cell.look.fresh;
    mean.look.wet += weight * cell.look.wet;
    mean.look.dust += weight * cell.look.dust;
    mean.off += weight * cell.off;
    if (!cell.skin) continue;
    mean.look.blood += weight * std::min(1.0F, cell.look.blood);
    surface += weight;
  }
  if (surface > 0) mean.look.blood /= surface;
  for (float* of : {&mean.look.fresh, &mean.look.wet, &mean.look.dust, &mean.look.blood})
    *of *= kept;
  return mean;
}

Wound::State Wound::at(const Vec3& p) const { return mean_at(p).look; }

Aabb Wound::touched() const {
  Aabb box;
  if ((low_.array() >= high_.array()).any()) return box;
  box.extend(cell_ * (first_ + low_ - Ijk::Ones()).cast<double>());
  box.extend(cell_ * (first_ + high_ + Ijk::Ones()).cast<double>());
  return box;
}

}  // namespace burr::render

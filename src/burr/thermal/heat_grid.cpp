#include "burr/thermal/heat_grid.h"

#include <algorithm>
#include <cmath>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/thermal/dose.h"

namespace burr::thermal {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kStepShare = 0.9;  // of the longest stable step; conductances are floats
constexpr int kTries = 4;           // to read a brick that the servo is writing, in one look()

double open_side(float share, float beside) {
  return std::max(0.0, static_cast<double>(share) - static_cast<double>(beside));
}

}  // namespace

HeatGrid::HeatGrid(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings)
    : settings_(settings),
      bone_(bone),
      changed_(bone.add_watcher()),
      box_(cells_around(bone.grid(), work, settings.cell)),
      reader_(bone, box_, settings),
      in_row_(static_cast<std::size_t>(box_.count.y() * box_.count.z())) {
  BURR_CHECK(settings.longest_step > 0);
  const std::size_t size = box_.size();
  for (auto* each : {&rise_, &next_, &capacity_, &warmth_, &dose_}) each->resize(size);
  for (auto* each : {&peak_, &k_, &share_, &g_[0], &g_[1], &g_[2], &area_, &film_})
    each->resize(size);
  parts_.resize(size);
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    while (!read(brick)) {
    }
  link(-Ijk::Ones(), box_.count + Ijk::Ones());
}

// ---- the bone

bool HeatGrid::read(volume::BrickIndex brick) {
  if (!reader_.read(brick, found_)) return false;
  for (const MatterReader::Found& each : found_) set(each.cell, each.matter);
  return true;
}

bool HeatGrid::read_changes() {
  changed_.take_all(
      [&](std::size_t brick) { due_.push_back(static_cast<volume::BrickIndex>(brick)); });
  // each brick once
  std::sort(due_.begin(), due_.end());
  due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
  std::erase_if(due_, [&](volume::BrickIndex brick) {
    for (int tries = 0; tries < kTries; ++tries) {
      if (!read(brick)) continue;
      if (!found_.empty())
        link(found_.front().cell - Ijk::Ones(), found_.back().cell + 2 * Ijk::Ones());
      return true;
    }
    return false;
  });
  return due_.empty();
}

void HeatGrid::set(const Ijk& cell, const Matter& matter) {
  const std::size_t at = box_.at(cell);
  k_[at] = static_cast<float>(matter.conductivity);
  share_[at] = static_cast<float>(matter.share);
  if (!box_.contains(cell)) return;  // the surrounding layer has no heat of its own

  remember(at);
  const double before = capacity_[at], now = matter.capacity;
  if (now < before)
    ledger_.removed += (before - now) * rise_[at];
  else if (now > before)
    rise_[at] *= before / now;
  if (now == 0) rise_[at] = next_[at] = dose_[at] = peak_[at] = 0;

  int& in_row = in_row_[static_cast<std::size_t>(cell.y() + box_.count.y() * cell.z())];
  in_row += (now > 0 ? 1 : 0) - (before > 0 ? 1 : 0);
  capacity_[at] = now;
  warmth_[at] = now > 0 ? 1 / now : 0;
  parts_[at] = {matter.tissue, matter.part};
}

// Records the highest values of a cell's tissues before some of them are removed.
void HeatGrid::remember(std::size_t cell) {
  const double ever = settings_.start_c + std::max(static_cast<double>(peak_[cell]), rise_[cell]);
  for (std::size_t p = 0; p < kMostParts && parts_[cell].tissue[p] != 0; ++p) {
    TissueHeat& gone = removed_peak_[parts_[cell].tissue[p]];
    gone.ever_c = gone.there ? std::max(gone.ever_c, ever) : ever;
    gone.cem43_min = std::max(gone.cem43_min, dose_[cell]);
    gone.there = true;
  }
}

// Computes the conductances of the cells [lo, end) and of those that they border on.
void HeatGrid::link(const Ijk& lo, const Ijk& end) {
  const Ijk from = lo.cwiseMax(-Ijk::Ones()), to = end.cwiseMin(box_.count + Ijk::Ones());
  const std::array<std::size_t, 3> next = {1, box_.row, box_.slice};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    Ijk last = to;
    last[axis] = std::min(last[axis], box_.count[axis]);
    for (int k = from.z(); k < last.z(); ++k)
      for (int j = from.y(); j < last.y(); ++j)
        for (int i = from.x(); i < last.x(); ++i) {
          const std::size_t at = box_.at(i, j, k);
          const double mine = k_[at], other = k_[at + next[a]];
          const double product = mine * other;
          g_[a][at] =
              static_cast<float>(product > 0 ? 2 * box_.edge * product / (mine + other) : 0.0);
        }
  }
  const Ijk inner = from.cwiseMax(Ijk::Zero()), stop = to.cwiseMin(box_.count);
  for (int k = inner.z(); k < stop.z(); ++k)
    for (int j = inner.y(); j < stop.y(); ++j)
      for (int i = inner.x(); i < stop.x(); ++i) open_to_air(box_.at(i, j, k));
}

void HeatGrid::open_to_air(std::size_t cell) {
  area_[cell] = film_[cell] = 0;
  if (capacity_[cell] == 0) return;
  const std::array<std::size_t, 3> next = {1, box_.row, box_.slice};
  double squares = 0, sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double open = open_side(share_[cell], share_[cell - next[a]]) +
                        open_side(share_[cell], share_[cell + next[a]]);
    squares += open * open;
    sum += static_cast<double>(g_[a][cell]) + static_cast<double>(g_[a][cell - next[a]]);
  }
  const double area = box_.edge * box_.edge * std::sqrt(squares);
  const double k = k_[cell], h = settings_.coolant_film;
  const double film = k > 0 && h > 0 ? area / (1 / h + box_.edge / (2 * k)) : 0;
  area_[cell] = static_cast<float>(area);
  film_[cell] = static_cast<float>(film);
  fastest_ = std::max(fastest_, (sum + film) * warmth_[cell]);
}

// ---- heat

double HeatGrid::deposit(const Vec3& p, double radius, double energy) {
  const Vec3 middle = box_.cell_from_grid(bone_.grid().grid_from_world(p));
  const double reach = std::max(1.0, radius / box_.edge);  // [cell]
  if (!std::isfinite(energy)) return 0;
  const auto weigh = [&](const auto& give) {
    if (!middle.allFinite() || !std::isfinite(reach)) return;
    const Vec3 least = (middle.array() - reach).ceil().max(0.0);
    const Vec3 most = (middle.array() + reach).floor().min(box_.count.array().cast<double>() - 1);
    if ((least.array() > most.array()).any()) return;
    const Ijk lo = least.cast<int>(), hi = most.cast<int>();
    for (int k = lo.z(); k <= hi.z(); ++k)
      for (int j = lo.y(); j <= hi.y(); ++j)
        for (int i = lo.x(); i <= hi.x(); ++i) {
          const double far = math::squared_norm(Vec3(i, j, k) - middle) / (reach * reach);
          const std::size_t at = box_.at(i, j, k);
          if (far < 1 && capacity_[at] > 0) give(at, 1 - far);
        }
  };
  double all = 0;
  weigh([&](std::size_t at, double weight) { all += weight * capacity_[at]; });
  if (all <= 0) {
    ledger_.missed += energy;
    return 0;
  }
  // by heat capacity: the same temperature rise for a full cell and for one with little matter
  weigh([&](std::size_t at, double weight) { rise_[at] += energy * weight / all; });
  ledger_.into += energy;
  return energy;
}

void HeatGrid::irrigate(const Vec3& p) {
  nozzle_ = box_.cell_from_grid(bone_.grid().grid_from_world(p));
  wet_ = nozzle_.allFinite();
}

double HeatGrid::longest_stable_step() const {
  return fastest_ > 0 ? kStepShare / fastest_ : settings_.longest_step;
}

void HeatGrid::advance(double seconds) {
  if (!(seconds > 0)) return;
  const double longest = std::min(settings_.longest_step, longest_stable_step());
  const double steps = std::ceil(seconds / longest * (1 - 1e-12));
  for (double n = 0; n < steps; ++n) step(seconds / steps);
}

void HeatGrid::step(double dt) {
  conduct(dt);
  leave_box(dt);
  cool(dt);
  add_dose(dt);
  rise_.swap(next_);
}

void HeatGrid::conduct(double dt) {
  const std::size_t row = box_.row, slice = box_.slice;
  const auto n = static_cast<std::size_t>(box_.count.x());
  for (int k = 0; k < box_.count.z(); ++k)
    for (int j = 0; j < box_.count.y(); ++j) {
      if (in_row_[static_cast<std::size_t>(j + box_.count.y() * k)] == 0) continue;
      const std::size_t at = box_.at(0, j, k);
      const double* t = &rise_[at];
      const double* warmth = &warmth_[at];
      const float *gx = &g_[0][at], *gy = &g_[1][at], *gz = &g_[2][at];
      const float *gx0 = gx - 1, *gy0 = gy - row, *gz0 = gz - slice;
      double* __restrict to = &next_[at];
      for (std::size_t i = 0; i < n; ++i) {
        const double here = t[i];
        const double power = static_cast<double>(gx[i]) * (t[i + 1] - here) +
                             static_cast<double>(gx0[i]) * (*(t + i - 1) - here) +
                             static_cast<double>(gy[i]) * (t[i + row] - here) +
                             static_cast<double>(gy0[i]) * (*(t + i - row) - here) +
                             static_cast<double>(gz[i]) * (t[i + slice] - here) +
                             static_cast<double>(gz0[i]) * (*(t + i - slice) - here);
        to[i] = here + dt * warmth[i] * power;
      }
    }
}

// Counts the heat that conduct() let out through the six sides.
void HeatGrid::leave_box(double dt) {
  double power = 0;
  const std::array<std::size_t, 3> next = {1, box_.row, box_.slice};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Ijk cell;
    for (cell[v] = 0; cell[v] < box_.count[v]; ++cell[v])
      for (cell[u] = 0; cell[u] < box_.count[u]; ++cell[u]) {
        cell[axis] = 0;
        const std::size_t low = box_.at(cell);
        power += static_cast<double>(g_[a][low - next[a]]) * rise_[low];
        cell[axis] = box_.count[axis] - 1;
        const std::size_t high = box_.at(cell);
        power += static_cast<double>(g_[a][high]) * rise_[high];
      }
  }
  ledger_.conducted += dt * power;
}

void HeatGrid::cool(double dt) {
  if (!wet_) return;
  const double reach = settings_.wet_radius / box_.edge;  // [cell]
  const double coolant = settings_.coolant_c - settings_.start_c;
  const Vec3 least = (nozzle_.array() - reach).ceil().max(0.0);
  const Vec3 most = (nozzle_.array() + reach).floor().min(box_.count.array().cast<double>() - 1);
  if ((least.array() > most.array()).any()) return;
  const Ijk lo = least.cast<int>(), hi = most.cast<int>();
  double taken = 0;
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const std::size_t at = box_.at(i, j, k);
        if (film_[at] <= 0 || math::squared_norm(Vec3(i, j, k) - nozzle_) > reach * reach) continue;
        const double energy = dt * static_cast<double>(film_[at]) * (rise_[at] - coolant);
        next_[at] -= energy * warmth_[at];
        taken += energy;
      }
  ledger_.convected += taken;
}

void HeatGrid::add_dose(double dt) {
  const double least = kLeastDoseC - settings_.start_c, minutes = dt / 60;
  for (int k = 0; k < box_.count.z(); ++k)
    for (int j = 0; j < box_.count.y(); ++j) {
      if (in_row_[static_cast<std::size_t>(j + box_.count.y() * k)] == 0) continue;
      for (std::size_t at = box_.at(0, j, k), end = box_.at(box_.count.x(), j, k); at < end; ++at) {
        peak_[at] = std::max(peak_[at], static_cast<float>(std::max(rise_[at], next_[at])));
        const double mean = 0.5 * (rise_[at] + next_[at]);
        if (mean >= least) dose_[at] += minutes * cem43_rate(settings_.start_c + mean);
      }
    }
}

void HeatGrid::start_over() {
  for (auto* each : {&rise_, &next_, &dose_}) std::fill(each->begin(), each->end(), 0.0);
  std::fill(peak_.begin(), peak_.end(), 0.0F);
  ledger_ = {};
  removed_peak_ = {};
  wet_ = false;
}

// ---- reading

Vec3 HeatGrid::centre(const Ijk& cell) const {
  return bone_.grid().world_from_grid(box_.grid_from_cell(cell.cast<double>()));
}

Ijk HeatGrid::cell_at(const Vec3& p) const {
  const Vec3 p_cell = box_.cell_from_grid(bone_.grid().grid_from_world(p));
  return (p_cell.array() + 0.5).floor().max(-1e9).min(1e9).cast<int>();
}

bool HeatGrid::has_matter(const Ijk& cell) const {
  return box_.contains(cell) && capacity_[box_.at(cell)] > 0;
}

double HeatGrid::temperature_c(const Ijk& cell) const {
  return settings_.start_c + (box_.contains(cell) ? rise_[box_.at(cell)] : 0);
}

double HeatGrid::cem43_min(const Ijk& cell) const {
  return box_.contains(cell) ? dose_[box_.at(cell)] : 0;
}

double HeatGrid::wet_area() const {
  double sum = 0;
  for (const float area : area_) sum += static_cast<double>(area);
  return sum;
}

HeatLedger HeatGrid::ledger() const {
  HeatLedger ledger = ledger_;
  for (std::size_t at = 0; at < rise_.size(); ++at) ledger.stored += capacity_[at] * rise_[at];
  return ledger;
}

void HeatGrid::summarise(HeatSummary& out) const {
  out.ledger = ledger_;
  out.tissue = removed_peak_;
  for (TissueHeat& tissue : out.tissue) tissue.now_c = settings_.start_c;
  std::array<bool, 256> now = {};
  const double warm = settings_.warm_c - settings_.start_c;
  const double cell_m3 = box_.edge * box_.edge * box_.edge;
  double hottest = 0, stored = 0;
  Ijk where = Ijk::Zero();
  bool any = false;
  for (int k = 0; k < box_.count.z(); ++k)
    for (int j = 0; j < box_.count.y(); ++j) {
      if (in_row_[static_cast<std::size_t>(j + box_.count.y() * k)] == 0) continue;
      for (int i = 0; i < box_.count.x(); ++i) {
        const std::size_t at = box_.at(i, j, k);
        if (capacity_[at] == 0) continue;
        const double rise = rise_[at];
        stored += capacity_[at] * rise;
        if (!any || rise > hottest) {
          hottest = rise;
          where = {i, j, k};
          any = true;
        }
        const double t = settings_.start_c + rise;
        const double ever = settings_.start_c + std::max(static_cast<double>(peak_[at]), rise);
        const Parts& parts = parts_[at];
        for (std::size_t p = 0; p < kMostParts && parts.tissue[p] != 0; ++p) {
          TissueHeat& tissue = out.tissue[parts.tissue[p]];
          bool& seen = now[parts.tissue[p]];
          tissue.now_c = seen ? std::max(tissue.now_c, t) : t;
          tissue.ever_c = tissue.there ? std::max(tissue.ever_c, ever) : ever;
          tissue.cem43_min = std::max(tissue.cem43_min, dose_[at]);
          if (rise > warm) tissue.warm_m3 += static_cast<double>(parts.part[p]) * cell_m3;
          tissue.there = seen = true;
        }
      }
    }
  out.ledger.stored = stored;
  out.hottest_c = settings_.start_c + hottest;
  out.hottest = any ? centre(where) : Vec3(Vec3::Zero());
}

}  // namespace burr::thermal

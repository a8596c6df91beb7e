#include "burr/thermal/heating.h"

#include <algorithm>
#include <cmath>

namespace burr::thermal {
namespace {

constexpr std::int64_t kLatestNs = 4'000'000'000'000'000'000;  // a century; twice that still fits

double heat_share_of(const HeatShare& shares, Edge edge) {
  switch (edge) {
    case Edge::flute:
      return shares.flute;
    case Edge::diamond:
      return shares.diamond;
    case Edge::rubbing:
      return shares.rubbing;
  }
  return 0;
}

}  // namespace

Heating::Heating(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings)
    : settings_(settings), grid_(bone, work, settings) {
  sum_up();
}

bool Heating::take(const HeatRow& row) {
  const std::int64_t time_ns = std::clamp<std::int64_t>(row.time_ns, 0, kLatestNs);
  ++rows_;
  if (row.start_over || !begun_) start_over(time_ns);
  const bool newer = pass(time_ns);

  if (row.beside)
    ;  // the row of the first hand's tool says where the coolant runs
  else if (row.irrigated)
    grid_.irrigate(row.place);
  else
    grid_.dry();
  if (row.energy > 0 && std::isfinite(row.energy)) {
    spent_ += row.energy;
    grid_.deposit(row.place, settings_.heat_ball_ratio * row.radius,
                  heat_share_of(settings_.heat_share, row.edge) * row.energy);
  }
  return newer;
}

void Heating::start_over(std::int64_t time_ns) {
  begun_ = true;
  grid_.read_changes();
  grid_.start_over();
  now_ns_ = time_ns;
  skip_ns_ = 0;
  steps_ = 0;
  spent_ = 0;
}

// Computes the whole steps before this time of the rows. A time that runs backwards counts as no
// time.
bool Heating::pass(std::int64_t time_ns) {
  bool newer = false;
  skip_ns_ += std::max<std::int64_t>(0, time_ns - skip_ns_ - now_ns_ - kLongestGapNs);
  while (time_ns - skip_ns_ - now_ns_ >= kHeatStepNs) {
    grid_.read_changes();
    grid_.advance(1e-9 * static_cast<double>(kHeatStepNs));
    now_ns_ += kHeatStepNs;
    if (++steps_ < kStepsPerSummary) continue;
    steps_ = 0;
    sum_up();
    newer = true;
  }
  return newer;
}

const HeatSummary& Heating::sum_up() {
  grid_.summarise(summary_);
  summary_.ledger.spent = spent_;
  summary_.time_ns = now_ns_ + skip_ns_;
  summary_.rows = rows_;
  return summary_;
}

}  // namespace burr::thermal

#include "burr/metrics/heat.h"

#include <cmath>
#include <cstddef>

#include "burr/math/sums.h"

namespace burr::metrics {
namespace {

constexpr double kRow = 10e-3;     // [s]
constexpr double kLook = 0.1;      // between two states of the bone [s]
constexpr double kBeyond = 10e-3;  // of the box [m]

}  // namespace

HeatMaker::HeatMaker(volume::Bone& bone, const math::Aabb& work,
                     const thermal::HeatSettings& settings)
    : bone_(bone), heating_(bone, work, settings) {}

void HeatMaker::add(const Moment& now) {
  if (now.power > 0) {
    row_.energy += now.power * now.dt;
    row_.place = now.centre - now.tool.radius * now.normal;
    row_.edge =
        now.tool.kind == tool::BurrKind::diamond ? thermal::Edge::diamond : thermal::Edge::flute;
  } else if (row_.energy <= 0) {
    row_.place = now.centre;  // where the coolant runs
  }
  if (last_row_ >= 0 && now.t - last_row_ < kRow - 0.5 * now.dt) return;
  last_row_ = now.t;
  row_.time_ns = std::llround(now.t * 1e9);
  row_.radius = now.tool.radius;
  row_.irrigated = now.tool.irrigated;
  spent_ += row_.energy;
  static_cast<void>(heating_.take(row_));
  row_.energy = 0;
}

Assessed<Heat> HeatMaker::finish() {
  if (row_.energy > 0) {
    spent_ += row_.energy;
    static_cast<void>(heating_.take(row_));
    row_.energy = 0;
  }
  if (!(spent_ > 0)) return NotAssessable{"the recording holds no power that went into the bone"};
  const thermal::HeatSummary& summary = heating_.sum_up();
  Heat out;
  out.ledger = summary.ledger;
  const auto& tissues = bone_.tissues().tissues;
  for (std::size_t id = 1; id < tissues.size() && id < summary.tissue.size(); ++id) {
    const thermal::TissueHeat& one = summary.tissue[id];
    if (one.there) out.tissues.push_back({tissues[id].name, one.ever_c, one.cem43_min});
  }
  return out;
}

Result<Assessed<Heat>> heat_of(record::Player& player, volume::Bone& bone,
                               const thermal::HeatSettings& settings, Progress& progress) {
  math::Aabb work;
  Moment now;
  MomentReader first(player);
  while (first.next(now)) {
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    if (now.power > 0) work.extend(now.centre);
  }
  if (work.empty())
    return Assessed<Heat>(NotAssessable{"the recording holds no power that went into the bone"});
  HeatMaker maker(bone, work.inflated(kBeyond), settings);
  MomentReader second(player);
  double looked = 0;
  while (second.next(now)) {
    if (now.t - looked >= kLook) {
      looked = now.t;
      if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
      progress.report(static_cast<double>(now.tick) / static_cast<double>(player.end_tick()),
                      "measuring the heat");
      if (const Status shown = player.bone_at(now.t, bone); !shown) return shown.error();
    }
    maker.add(now);
  }
  return maker.finish();
}

}  // namespace burr::metrics

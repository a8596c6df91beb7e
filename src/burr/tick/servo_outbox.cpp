#include "burr/tick/servo_outbox.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace burr::tick {
namespace {

constexpr double kHeatEvery = 10e-3;  // a row to the worker that computes the heat  [s]
constexpr double kQueueTime = 0.05;   // a tick writes dt / kQueueTime of the waiting bricks  [s]

}  // namespace

Outbox::Outbox(const volume::Bone& bone, edit::ChangedQueue& changed, const Controls& controls)
    : bone_(bone),
      changed_(changed),
      controls_(controls),
      dt_(1.0 / controls.settings.rate_hz),
      burr_radius_(controls.settings.burr.radius) {}

// What the tools spent meanwhile, and where last.
void Outbox::note_heat(std::uint64_t tick, const Cutting& cutting, const Cutting* second) BURR_RT {
  if (heat_ == nullptr) return;
  const Cutting::Warming now = cutting.warming();
  const auto beside = [&](std::size_t which, const Cutting::Warming& warming) BURR_RT {
    if (!(warming.power > 0)) return;
    thermal::HeatRow& row = heat_beside_[which];
    row.beside = true;
    row.energy += warming.power * dt_;
    row.place = warming.place;
    row.edge = warming.edge;
    row.radius = warming.radius;
  };
  beside(0, cutting.rubbing());
  if (second != nullptr) {
    beside(1, second->warming());
    beside(2, second->rubbing());
  }
  if (now.radius > 0) heat_row_.radius = now.radius;
  if (now.power > 0) {
    heat_row_.energy += now.power * dt_;
    heat_row_.place = now.place;
    heat_row_.edge = now.edge;
  } else if (heat_row_.energy <= 0) {
    heat_row_.place = now.place;  // where the coolant runs
  }
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::round(kHeatEvery / dt_)));
  if (tick % every != 0 && !heat_row_.start_over) return;
  heat_row_.time_ns = std::llround(static_cast<double>(tick) * dt_ * 1e9);
  heat_row_.irrigated = controls_.irrigated;
  static_cast<void>(heat_->push(heat_row_));
  for (thermal::HeatRow& row : heat_beside_) {
    row.time_ns = heat_row_.time_ns;
    if (row.energy > 0) static_cast<void>(heat_->push(row));
    row.energy = 0;
  }
  heat_row_.energy = 0;
  heat_row_.start_over = false;
}

void Outbox::write_bricks(std::size_t most, std::uint64_t tick, bool with_tissue) BURR_RT {
  if (recorder_rings_.bricks == nullptr) {
    while (changed_.pop() != volume::kNoBrick) {
    }
    return;
  }
  for (std::size_t n = 0; n < most && changed_.size() > 0; ++n) {
    if (recorder_rings_.bricks->size() == recorder_rings_.bricks->capacity())
      return;  // it waits in the queue, nothing is lost
    const volume::BrickIndex brick = changed_.pop();
    BrickRow row;
    row.tick = tick;
    row.brick = brick;
    std::memcpy(&row.field, bone_.brick_field(brick), sizeof row.field);
    row.has_tissue = with_tissue;
    if (row.has_tissue)
      std::memcpy(row.tissue.data(), bone_.brick_tissue(brick), row.tissue.size());
    recorder_rings_.bricks->push(row);
  }
}

void Outbox::publish(const TickRow& row, bool with_tissue) BURR_RT {
  // so each changed brick is written within 100 ms; at least one a tick
  const auto ticks =
      static_cast<std::size_t>(std::max(1.0, kQueueTime * controls_.settings.rate_hz));
  write_bricks(changed_.size() / ticks + 1, row.tick, with_tissue);
  if (recorder_rings_.ticks != nullptr) recorder_rings_.ticks->push(row);
  view_.publish(row);
  if (watch_ != nullptr) watch_->publish(row);
}

void Outbox::flush_bricks(std::uint64_t tick, bool with_tissue) BURR_RT {
  write_bricks(changed_.size(), tick, with_tissue);
}

}  // namespace burr::tick

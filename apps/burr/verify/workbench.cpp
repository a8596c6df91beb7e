#include "workbench.h"

#include <algorithm>
#include <cmath>

#include "burr/volume/sample.h"

namespace burr::app {

using math::Vec3;

Workbench::Workbench(const phantom::Depth& depth, const volume::Grid& grid,
                     const volume::TissueTable& tissues, const WorkSettings& settings)
    : Workbench(phantom::bone_from_distance(grid, tissues, depth), settings) {}

Workbench::Workbench(std::unique_ptr<volume::Bone> bone, const WorkSettings& settings)
    : settings_(settings),
      bone_(std::move(bone)),
      surface_(*bone_, {}, 2, quiet_),
      undo_(*bone_, 64),
      writer_(*bone_, surface_, undo_, nullptr),
      carver_(writer_, {}),
      touch_by_(surface_,
                {.radius = settings.radius,
                 .slip = settings.slip_m_s / settings.rate_hz,
                 .push_out_speed = 5 / settings.rate_hz},
                settings.touch),
      force_{settings.stiffness, settings.damping},
      hand_(arm_, touch_by_.constraint(), force_, {.rate_hz = settings.rate_hz, .limit = {}}) {
  hand_.use(touch_by_.now());
}

std::vector<Workbench::Row> Workbench::work(const device::HandPath& path,
                                            const device::ArmSettings& arm, bool cut) {
  const double dt = 1 / settings_.rate_hz;
  arm_.follow_path(path, arm);
  std::vector<Row> rows;
  const auto ticks = static_cast<std::size_t>(std::llround(path.duration() / dt));
  double waiting = 0;  // energy that the next cut will use
  undo_.begin_stroke(0);
  for (std::size_t n = 0; n <= ticks; ++n) {
    std::uint32_t flags = 0;
    static_cast<void>(hand_.read(false, flags));  // a simulated arm is always valid
    Row row;
    row.t = static_cast<double>(n) * dt;
    row.hand = hand_.state().world_from_tool.p;
    if (!hand_.engaged()) hand_.begin_at({row.hand, math::Quat::Identity()});
    hand_.filter_velocity();
    touch_by_.show(tick_++);
    hand_.feel();
    const haptics::Touch& touch = hand_.touch();
    row.proxy = touch.proxy;
    if (watch) watch(touch, row.hand);
    row.force = hand_.wanted();
    arm_.write_force(row.force);
    row.push = touch.touching ? std::max(0.0, row.force.dot(touch.normal)) : 0;

    if (cut && row.push > 0) {
      const double spent =
          dt * edit::cutting_power(row.push, settings_.spindle, settings_.radius,
                                   volume::Tissue{}.cutting_friction, touch.normal,
                                   touch.normal.unitOrthogonal(), settings_.removal);
      energy_ += spent;
      waiting += spent;
    }
    if (cut && tick_ % static_cast<std::uint64_t>(settings_.carve_every) == 0 && waiting > 0 &&
        touch.touching) {
      const volume::Grid& grid = bone_->grid();
      edit::Cut one;
      one.centre = grid.grid_from_world(touch.proxy);
      one.push = grid.frame.q.conjugate() * (-touch.normal);
      one.radius = settings_.radius / grid.voxel;
      one.energy = waiting;
      one.dt = settings_.carve_every * dt;
      waiting = 0;
      carver_.carve(one, flags);
    }
    surface_.refresh(1e3 * dt * settings_.carve_every);
    row.energy = energy_;
    row.removed = carver_.ledger().removed;
    rows.push_back(row);
  }
  undo_.end_stroke();
  return rows;
}

device::HandPath path_through(const std::vector<Knot>& knots) {
  device::HandPath path;
  for (std::size_t n = 0; n < knots.size(); ++n) {
    device::PathPoint point;
    point.t = knots[n].t;
    point.world_from_tool.p = knots[n].p;
    point.pedal = n > 0 ? 1 : 0;
    path.points.push_back(point);
  }
  return path;
}

double depth_of_hole(const volume::Bone& bone, double x, double y, double top) {
  const double step = 0.02 * bone.grid().voxel;
  double above = 0;
  for (double z = top + 3 * bone.grid().voxel; z > top - 20e-3; z -= step) {
    const double here =
        volume::sample(bone, bone.grid().grid_from_world({x, y, z})) - volume::kIsoShare;
    if (here >= 0) return top - (z + step * here / std::max(1e-12, here - above));
    above = here;
  }
  return 20e-3;
}

double wave_at(const std::vector<double>& values, double rate_hz, double f) {
  double mean = 0;
  for (const double value : values) mean += value;
  mean /= static_cast<double>(values.size());
  double re = 0, im = 0, weight = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    // Hann window, so that a slow drift does not leak into this frequency
    const double w = 0.5 - 0.5 * std::cos(2 * M_PI * (static_cast<double>(n) + 0.5) /
                                          static_cast<double>(values.size()));
    const double angle = 2 * M_PI * f * static_cast<double>(n) / rate_hz;
    re += w * (values[n] - mean) * std::cos(angle);
    im += w * (values[n] - mean) * std::sin(angle);
    weight += w;
  }
  return 2 * std::hypot(re, im) / weight;
}

}  // namespace burr::app

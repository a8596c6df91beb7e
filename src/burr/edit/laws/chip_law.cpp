#include "burr/edit/laws/chip_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "burr/math/elementary.h"
#include "burr/math/sums.h"
#include "burr/volume/sample.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::CuttingForce;

// Bone this near to the burr counts as being cut: the proxy rests on the surface to a few
// hundredths of a voxel, and the cutting ball reaches ahead of it by as much (carve.h, advance).
constexpr double kReach = 50e-6, kLeastReach = 0.5;  // [m], [voxel]
constexpr double kGolden = 0.6180339887498949;
constexpr int kRounds = 40;
constexpr double kClose = 1e-9;  // accuracy, relative to the push

double edge_share(double chip, const CuttingForce& force) BURR_RT {
  return 1 - math::exponential(-chip / force.edge_onset);
}

double radial(double chip, const CuttingForce& force) BURR_RT {
  return force.chip_radial * chip + force.edge_radial * edge_share(chip, force);
}

double radial_slope(double chip, const CuttingForce& force) BURR_RT {
  return force.chip_radial +
         force.edge_radial / force.edge_onset * math::exponential(-chip / force.edge_onset);
}

double tangential(double chip, const CuttingForce& force) BURR_RT {
  return force.chip_tangential * chip + force.edge_tangential * edge_share(chip, force);
}

double tangential_slope(double chip, const CuttingForce& force) BURR_RT {
  return force.chip_tangential +
         force.edge_tangential / force.edge_onset * math::exponential(-chip / force.edge_onset);
}

// Where a rising, concave function with value 0 at 0 reaches `wanted`: Newton's method from the
// left never passes it.
template <class Value, class Slope>
double where(double wanted, const Value& value, const Slope& slope) BURR_RT {
  double at = 0;
  for (int n = 0; n < kRounds; ++n) {
    const double left = wanted - value(at), rise = slope(at);
    if (left <= kClose * wanted || !(rise > 0)) break;
    at += left / rise;
  }
  return at;
}

}  // namespace

// A Fibonacci spiral of points, evenly spread (Vogel 1979), denser near the push, because with
// light pressure the contact is a small cap.
Chips::Chips(const volume::Bone& bone) : bone_(bone) {
  const auto cosine_of = [](double n) {
    const double share = n / kPoints;
    return math::cosine(0.5 * std::numbers::pi * share * std::sqrt(share));
  };
  for (int n = 0; n < kPoints; ++n) {
    Point& point = points_[static_cast<std::size_t>(n)];
    point.cosine = cosine_of(n + 0.5);
    const double sine = std::sqrt(1 - point.cosine * point.cosine),
                 beta = 2 * std::numbers::pi * kGolden * n;
    point.u = sine * math::cosine(beta);
    point.v = sine * math::sine(beta);
    point.area = 2 * std::numbers::pi * (cosine_of(n) - cosine_of(n + 1));
  }
}

// Finds which pieces of the teeth are in bone, ring by ring around the push. Directions in grid
// axes.
void Chips::gather(const tool::Burr& burr, const Vec3& centre, const Vec3& normal, const Vec3& axis,
                   double pole, bool with_ripple) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const Vec3 at = grid.grid_from_world(centre);
  const double r = burr.radius, reach = std::max(kReach, kLeastReach * grid.voxel);
  const double steep = 2 * volume::kRamp * grid.voxel / reach, out = r / grid.voxel;
  // u, v: axes of the rings, fixed to the shaft and the normal; x, y: axes for the azimuth around
  // the shaft
  const Vec3 side = axis - math::dot(axis, normal) * normal;
  const Vec3 u = math::squared_norm(side) > 0.01 ? math::normalized(side) : normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
  for (int k = 0; k < kRings; ++k) {
    Ring& ring = rings_[static_cast<std::size_t>(k)];
    ring = {};
    ring.force = {0, 0, 0, 0, 0};
    for (int n = k * kPiecesPerRing; n < (k + 1) * kPiecesPerRing; ++n) {
      const Point& point = points_[static_cast<std::size_t>(n)];
      const double cosine = point.cosine, piece = r * r * point.area;  // [m^2]
      const Vec3 way = point.u * u + point.v * v - cosine * normal;
      const Vec3 p = at + out * way;
      const double in_bone =
          std::clamp(1 + (volume::sample(bone_, p) - volume::kIsoShare) * steep, 0.0, 1.0);
      if (in_bone <= 0) continue;
      // the tissue ahead of the piece, not of the air that it has made
      const Vec3 ahead = p + way;
      const math::Ijk cell = (ahead.array() + 0.5).floor().cast<int>();
      const volume::Tissue& tissue = bone_.tissues()[bone_.tissue(cell.x(), cell.y(), cell.z())];
      if (tissue.kind != volume::TissueKind::solid) continue;
      const Vec3 sliding = axis.cross(way);
      const double far = std::max(math::norm(sliding), pole);  // from the axis, over r
      const double edge = in_bone * piece * burr.teeth / (2 * std::numbers::pi * r * far);
      ring.edge += edge;
      ring.cosine += edge * cosine;
      ring.arm += edge * r * far;
      ring.area += in_bone * piece * cosine;
      ring.price += in_bone * piece * cosine * tissue.cutting_energy;
      ring.force.chip_tangential += edge * tissue.force.chip_tangential;
      ring.force.chip_radial += edge * tissue.force.chip_radial;
      ring.force.edge_tangential += edge * tissue.force.edge_tangential;
      ring.force.edge_radial += edge * tissue.force.edge_radial;
      ring.force.edge_onset += edge * tissue.force.edge_onset;
      ring.drag += edge / far * sliding;
      if (!with_ripple) continue;
      // e^(i z phi), by multiplying z times
      const double px = math::dot(way, x), py = math::dot(way, y),
                   across = math::hypotenuse(px, py);
      if (across <= 0) continue;
      double re = 1, im = 0;
      for (int z = 0; z < burr.teeth; ++z) {
        const double next = (re * px - im * py) / across;
        im = (re * py + im * px) / across;
        re = next;
      }
      // the piece has a width: near the shaft it spans many teeth
      const double span = 0.5 * burr.teeth * std::sqrt(piece) / (r * across);
      const double seen = span < std::numbers::pi ? edge * math::sine(span) / span : 0.0;
      ring.swing_re += seen * re;
      ring.swing_im += seen * im;
    }
    if (ring.edge <= 0) continue;
    ring.cosine /= ring.edge;
    CuttingForce& mean = ring.force;
    for (double* one : {&mean.chip_tangential, &mean.chip_radial, &mean.edge_tangential,
                        &mean.edge_radial, &mean.edge_onset})
      *one /= ring.edge;
  }
}

Cutting Chips::step(const tool::Burr& burr, const Vec3& centre, const Vec3& normal, double push,
                    const Spin& spin, double dt, const RemovalSettings& settings,
                    bool with_ripple) BURR_RT {
  Cutting cutting;
  feed_ = edge_ = rate_ = 0;
  if (!(push > 0) || !(spin.speed > 0) || burr.teeth < 1 || burr.kind != tool::BurrKind::cutting)
    return cutting;
  const math::Quat& world_from_grid = bone_.grid().frame.q;
  const math::Quat grid_from_world = world_from_grid.conjugate();
  gather(burr, centre, grid_from_world * normal, grid_from_world * spin.axis, settings.pole,
         with_ripple);
  const auto sum = [this](const auto& of) BURR_RT {
    double total = 0;
    for (const Ring& ring : rings_)
      if (ring.edge > 0) total += of(ring);
    return total;
  };
  edge_ = sum([](const Ring& ring) { return ring.edge; });
  if (edge_ <= 0) return cutting;

  const double feed_of_push = where(
      push,
      [&](double f) BURR_RT {
        return sum([f](const Ring& ring) {
          return ring.edge * ring.cosine * radial(f * ring.cosine, ring.force);
        });
      },
      [&](double f) BURR_RT {
        return sum([f](const Ring& ring) {
          return ring.edge * ring.cosine * ring.cosine * radial_slope(f * ring.cosine, ring.force);
        });
      });
  const auto torque_at = [&](double f) BURR_RT {
    return sum(
        [f](const Ring& ring) { return ring.arm * tangential(f * ring.cosine, ring.force); });
  };
  feed_ = feed_of_push;
  const double most = settings.max_power / spin.speed;  // torque at the motor's power
  if (torque_at(feed_) > most)
    feed_ = where(most, torque_at, [&](double f) BURR_RT {
      return sum([f](const Ring& ring) {
        return ring.arm * ring.cosine * tangential_slope(f * ring.cosine, ring.force);
      });
    });

  const double feed_speed = feed_ * burr.teeth * spin.speed / (2 * std::numbers::pi);  // [m/s]
  rate_ = feed_speed * sum([](const Ring& ring) { return ring.area; });
  cutting.energy = dt * feed_speed * sum([](const Ring& ring) { return ring.price; });
  cutting.torque = torque_at(feed_);
  cutting.power = cutting.torque * spin.speed;
  double re = 0, im = 0;
  for (const Ring& ring : rings_) {
    if (ring.edge <= 0) continue;
    const double force = tangential(feed_ * ring.cosine, ring.force);  // per length of edge
    cutting.drag += force * ring.drag;
    re += force * ring.swing_re;
    im += force * ring.swing_im;
  }
  cutting.drag = world_from_grid * cutting.drag;
  // the force along the normal is already the thrust of the spring
  cutting.drag -= math::dot(cutting.drag, normal) * normal;
  cutting.ripple = 2 * math::hypotenuse(re, im);
  return cutting;
}

}  // namespace burr::edit

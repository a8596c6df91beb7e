#include "burr/tick/law_call.h"

#include <cmath>

#include "burr/math/sums.h"

namespace burr::tick {
namespace {

using math::Vec3;

void put(const Vec3& from, double* to) BURR_RT {
  for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

}  // namespace

int RecordedLaw::answer(const burr_law_in_v1&, burr_law_out_v1& out) BURR_RT {
  put(row_.force, out.force);
  out.energy_j = row_.energy;
  out.torque_nm = row_.torque;
  return row_.state == LawRow::kActs ? 0 : 1;
}

bool possible(const burr_law_out_v1& out) BURR_RT {
  // written so that NaN fails
  const auto within = [](double value, double most) { return std::abs(value) <= most; };
  return within(out.force[0], BURR_LAW_MOST_FORCE) && within(out.force[1], BURR_LAW_MOST_FORCE) &&
         within(out.force[2], BURR_LAW_MOST_FORCE) && within(out.energy_j, BURR_LAW_MOST_ENERGY) &&
         within(out.torque_nm, BURR_LAW_MOST_TORQUE) && out.torque_nm >= 0;
}

LawCall::LawCall(const volume::Bone& bone, const Controls& controls, const Hand& hand)
    : bone_(bone), settings_(controls.settings), hand_(hand) {}

burr_law_in_v1 LawCall::input(double spin) const BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  burr_law_in_v1 in = {};
  in.size = sizeof in;
  in.version = 1;
  in.dt = 1 / settings_.rate_hz;
  put(hand_.state().world_from_tool.p, in.hand);
  put(touch.proxy, in.proxy);
  put(hand_.velocity(), in.velocity);
  put(hand_.axis(), in.axis);
  in.radius = settings_.burr.radius;
  in.spin_rad_s = spin;
  in.stiffness = settings_.force.stiffness;
  in.damping = settings_.force.damping;
  if (!touch.touching) return in;
  put(touch.normal, in.normal);
  in.depth = touch.depth;
  in.touching = 1;
  const volume::Grid& grid = bone_.grid();
  const Vec3 under = touch.proxy - (settings_.burr.radius + 0.5 * grid.voxel) * touch.normal;
  const math::Ijk at = (grid.grid_from_world(under).array() + 0.5).floor().cast<int>();
  in.tissue = bone_.tissue(at.x(), at.y(), at.z());
  in.price_j_m3 = bone_.tissues()[static_cast<volume::TissueId>(in.tissue)].cutting_energy;
  if (bone_.has_intensity()) in.hu = bone_.intensity(at.x(), at.y(), at.z());
  return in;
}

Vec3 LawCall::wanted(bool feels, double spin) BURR_RT {
  row_ = {};
  failed_now_ = false;
  const Vec3 own = hand_.wanted();
  if (settings_.law == nullptr || !feels || hand_.hovers() || settings_.tool >= 0) return own;
  row_.state = LawRow::kOff;
  if (off_) return Vec3::Zero();
  const burr_law_in_v1 in = input(spin);
  burr_law_out_v1 out = {};
  out.size = sizeof out;
  out.version = 1;
  put(own, out.force);
  out.energy_j = BURR_LAW_AS_BURR;
  if (settings_.law->answer(in, out) != 0 || !possible(out)) {
    off_ = failed_now_ = true;
    return Vec3::Zero();
  }
  row_.state = LawRow::kActs;
  row_.force = Vec3(out.force[0], out.force[1], out.force[2]);
  row_.energy = out.energy_j;
  row_.torque = out.torque_nm;
  return row_.force;
}

}  // namespace burr::tick

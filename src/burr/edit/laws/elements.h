// edit/laws/elements.h - the energy law for a tool of any shape: the power of every contact.
//
//     P = sum over contacts j of parts that cut:  eta mu_c f_j |v_j|          at most max_power
//     F = - sum  eta mu_c f_j v_j / |v_j|         of the bone on the tool, where the tool turns
//     M = sum  w_j x F_j
//
// v_j is the velocity of the tool's surface at the contact, without its part along the normal: of
// the drive (tool/cutter.h) for what turns or strokes, of the hand for an edge that is pushed. A
// stroke pulls and pushes in turn, so its mean force is 0, and its amplitude is the ripple. For one
// contact of a round burr this is removal.h, with |v| = w r sin(theta).
//
// Which contacts carry the load of a flat face is chance, only their sum is not; so the sum decides
// how much is cut, and the shape decides where (tool_body.h).
//
// Thread: servo. Units: SI. Frame: world. Source: removal.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "burr/edit/laws/removal.h"
#include "burr/math/sums.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tool/cutter.h"

namespace burr::edit {

// One contact of a part that cuts.
struct ElementContact {
  math::Vec3 arm = math::Vec3::Zero();      // from the tool's origin to the contact  [m]
  math::Vec3 normal = math::Vec3::UnitZ();  // unit, out of the bone
  double force = 0;                         // along the normal, >= 0                 [N]
  double friction = 0;                      // mu_c of the tissue there               [-]
};

// How the tool moves in this tick.
struct Stroke {
  math::Vec3 axis = math::Vec3::UnitZ();  // unit, of the tool: from the head to the hand
  math::Vec3 way = -math::Vec3::UnitZ();  // unit, of the stroke or the edge
  double speed = 0;                       // turning: of the spindle [rad/s]; strokes: of the teeth,
                                          // mean [m/s]; both with the pedal's share in it
  math::Vec3 hand = math::Vec3::Zero();   // velocity of the tool's origin             [m/s]
};

struct ElementCutting : Cutting {
  math::Vec3 moment = math::Vec3::Zero();  // of `drag` about the tool's origin  [N m]
};

// Velocity of the tool's surface over the bone at a contact.  [m/s]
[[nodiscard]] inline math::Vec3 surface_velocity(const tool::Cutter& cutter, const Stroke& stroke,
                                                 const math::Vec3& arm) BURR_RT {
  switch (cutter.drive) {
    case tool::Drive::turning:
      return -stroke.speed * stroke.axis.cross(arm);  // clockwise as seen from the hand
    case tool::Drive::oscillating:
    case tool::Drive::reciprocating:
      return stroke.speed * stroke.way;
    case tool::Drive::pushed:
    case tool::Drive::struck:
      break;
  }
  // an edge cuts in one direction only
  return std::max(0.0, math::dot(stroke.hand, stroke.way)) * stroke.way;
}

[[nodiscard]] inline ElementCutting element_law(const tool::Cutter& cutter, const Stroke& stroke,
                                                std::span<const ElementContact> contacts, double dt,
                                                const RemovalSettings& settings) BURR_RT {
  ElementCutting sum;
  double stroke_force = 0;
  for (const ElementContact& contact : contacts) {
    const math::Vec3 v = surface_velocity(cutter, stroke, contact.arm);
    const math::Vec3 along = v - math::dot(v, contact.normal) * contact.normal;
    const double is = math::norm(along);
    if (is <= 0) continue;
    const double force = cutter.efficiency * contact.friction * std::max(0.0, contact.force);
    sum.power += force * is;
    if (cutter.drive == tool::Drive::turning) {
      const math::Vec3 drag = -force / is * along;
      sum.drag += drag;
      sum.moment += contact.arm.cross(drag);
    } else {
      stroke_force += force;
    }
  }
  if (sum.power > settings.max_power) {
    const double share = settings.max_power / sum.power;
    sum.power = settings.max_power;
    sum.drag *= share;
    sum.moment *= share;
    stroke_force *= share;
  }
  sum.energy = sum.power * dt;
  sum.ripple = stroke_force;
  if (cutter.drive == tool::Drive::turning && stroke.speed != 0)
    sum.torque = sum.power / std::abs(stroke.speed);
  return sum;
}

}  // namespace burr::edit

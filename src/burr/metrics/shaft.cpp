#include "burr/metrics/shaft.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/metrics/look_along.h"
#include "burr/metrics/near.h"
#include "burr/volume/sample.h"

namespace burr::metrics {
namespace {

using math::Vec3;

constexpr double kEvery = 0.1;        // [s]
constexpr double kHandpiece = 26e-3;  // from the middle of the head [m]
constexpr int kAlongIt = 8;

// Unit directions around, an eighth of a turn apart: no sine, so the same bits everywhere.
constexpr double kHalf = 0.7071067811865476;
constexpr std::array<std::array<double, 2>, 8> kAround = {{{1, 0},
                                                           {kHalf, kHalf},
                                                           {0, 1},
                                                           {-kHalf, kHalf},
                                                           {-1, 0},
                                                           {-kHalf, -kHalf},
                                                           {0, -1},
                                                           {kHalf, -kHalf}}};

}  // namespace

void ShaftRestMaker::add(const Moment& now) {
  felt_ = felt_ || now.shaft_felt;
  if (now.gap) rested_ = false;
  if (now.shaft_rests) {
    if (!rested_) ++found_.contacts;
    found_.seconds += now.dt;
    if (now.twist > found_.largest_twist) {
      found_.largest_twist = now.twist;
      found_.largest_at = now.t;
    }
  }
  rested_ = now.shaft_rests;
}

Assessed<ShaftRest> ShaftRestMaker::finish() const {
  if (!felt_) return NotAssessable{kShaftNotFelt};
  return found_;
}

bool shaft_in_bone(const volume::Bone& bone, const Vec3& centre, const Vec3& axis, double head,
                   const DrawnShaft& shaft) {
  const double from = 2 * head, to = std::min(kHandpiece, shaft.length);
  if (!(from < to) || !(shaft.radius > 0)) return false;
  const Vec3 aside = std::abs(axis.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = math::normalized(Vec3(axis.cross(aside))), v = axis.cross(u);
  for (int n = 0; n < kAlongIt; ++n) {
    const Vec3 middle = centre + (from + (to - from) * n / (kAlongIt - 1.0)) * axis;
    for (const auto& [a, b] : kAround) {
      const Vec3 p = middle + shaft.radius * (a * u + b * v);
      if (volume::sample(bone, bone.grid().grid_from_world(p)) >= volume::kIsoShare) return true;
    }
  }
  return false;
}

bool ShaftInBoneMaker::add(const Moment& now) {
  const bool first = !(last_.dt > 0);
  const bool over = !first && std::floor(now.t / kEvery) != std::floor(last_.t / kEvery);
  since_ += now.dt;
  last_ = now;
  return over;
}

void ShaftInBoneMaker::look(const volume::Bone& bone) {
  const double since = since_;
  since_ = 0;
  if (!last_.radius_known()) return;
  found_.looked += since;
  if (!shaft_in_bone(bone, last_.centre, last_.shaft, last_.tool.radius, shaft_)) return;
  if (found_.times == 0) found_.first_at = last_.t;
  ++found_.times;
  found_.seconds += since;
}

Assessed<ShaftInBone> ShaftInBoneMaker::finish() const {
  if (!(found_.looked > 0)) return NotAssessable{kNoRadius};
  return found_;
}

Result<Assessed<ShaftInBone>> shaft_of(record::Player& player, volume::Bone& bone,
                                       Progress& progress) {
  const auto& recorded = player.info().shaft;
  if (!recorded || !(recorded->radius > 0))
    return Assessed<ShaftInBone>(
        NotAssessable{"the recording does not say how thick the shaft is"});
  ShaftInBoneMaker maker({recorded->radius, recorded->length});
  if (const Status looked = look_along(player, bone, maker, "looking for the shaft", progress);
      !looked)
    return looked.error();
  return maker.finish();
}

}  // namespace burr::metrics

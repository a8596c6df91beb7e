#include "burr/surgeon/surgeon_hand.h"

#include <algorithm>
#include <cmath>

#include "burr/math/rotation.h"
#include "burr/math/sums.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr double kSpring = 1000;    // between hand and burr, as the session has it [N/m]
constexpr double kYield = 60;       // pressing: newtons short of the force per speed [N s/m]
constexpr double kGoing = 150e-3;   // on the way [m/s]
constexpr double kLanding = 30e-3;  // on its last piece [m/s]
constexpr double kTouched = 0.25;   // the way has met the bone [N]
constexpr double kFastestPress = 20e-3, kSlowestPress = 1e-3;  // [m/s]
constexpr double kBrake = 0.2;     // it slows down this long before the goal ends [s]
constexpr double kLift = 2e-3;     // [m/s]
constexpr double kAhead = 0.5e-3;  // a stroke turns this far before the goal ends [m]
constexpr double kSlack = 0.1e-3;  // by more than this; it lifts where less is missing [m]
constexpr double kHeldUp = 0.1;    // slower than this share of its speed, a stroke is held up [-]
constexpr double kPatience = 0.2;  // and turns after so long [s]
constexpr double kBrief = 2e-3;    // between two turns: no stroke [m]
constexpr int kMostBrief = 3;      // one after the other
constexpr double kFarAway = 4e-3;  // beyond it the force is the whole one [m]
constexpr double kTurning = 4.0;   // of the shaft [1/s]
constexpr double kFills = 0.8;     // radius of what is added at a place, of the burr's [-]
constexpr double kAtWalls = 0.33;  // of how much higher it rises at a wall: what is heeded [-]
constexpr double kOver = 0.15;     // of the radius: so far it may come over the border, as what
                                   // lies between two places stays lower [-]
constexpr double kFelt = 0.05;     // a smaller force does not say where the burr touches [N]
constexpr double kGently = 0.15;   // of the pedal: material is added in thin layers [-]

}  // namespace

SurgeonHand::SurgeonHand(const Skill& skill, double dt, std::uint64_t seed, const Vec3& at,
                         const Vec3& shaft)
    : skill_(skill),
      tremor_(skill.tremor, dt, seed),
      drift_(skill.drift, dt, seed),
      uneven_(skill.force_noise, dt, seed),
      at_(at),
      last_(at),
      shaft_(shaft) {
  spec_.name = "scripted surgeon";
  spec_.workspace_radius = 0.2;
  // an arm that never tires: what the surgeon presses is what the bone gets
  spec_.peak_force = spec_.continuous_force = 8;
  spec_.thermal_budget = 1e6;
  spec_.max_stiffness = kSpring;
  delay_ = std::min(kMemory - 1, static_cast<std::size_t>(std::lround(skill.stop_delay / dt)));
  rooms_.fill(1);
}

void SurgeonHand::look_at(const FieldGrid* goal, const FieldGrid* near, bool adds) {
  goal_ = goal;
  adds_ = adds;
  near_ = near;
}

void SurgeonHand::begin(const Stroke& stroke, double burr_radius) {
  stroke_ = stroke;
  radius_ = burr_radius;
  phase_ = Phase::going;
  next_ = 0;
  stroked_ = 0;
  leaving_ = false;
}

void SurgeonHand::retreat(const Vec3& out, double distance) {
  stroke_.points = 0;
  stroke_.start = at_ + distance * out;
  stroke_.idle_way = true;
  phase_ = Phase::going;
  next_ = 0;
  stroked_ = 0;
  leaving_ = true;
}

double SurgeonHand::room(const Vec3& p) const BURR_RT {
  if (goal_ == nullptr) return 1;
  if (!adds_) return goal_->at(p) - radius_;
  const double felt = math::norm(force_);
  const Vec3 towards = felt > kFelt ? Vec3(-force_ / felt) : stroke_.into;  // what it touches
  return goal_->at(p + radius_ * towards) - ring(radius_, -math::dot(towards, stroke_.out));
}

// A deposit fills a ball of kFills radii about the place, outside of the burr (edit/carve.h). Seen from
// the place, it reaches kOpen beyond the tangent plane.
double SurgeonHand::ring(double radius, double down) BURR_RT {
  const double lean = std::acos(std::clamp(down, -1.0, 1.0));
  const double on_floor = kFills * kFills / 2;
  const double open =
      std::acos(kFills / 2);  // from the way out to the edge of the fill, on a floor
  const double top = kFills * std::cos(std::max(0.0, open - lean));
  return radius * (kAtWalls * (top - on_floor) - kOver);
}

void SurgeonHand::reach_bone() BURR_RT {
  phase_ = Phase::stroking;
  full_ = adds_;
  done_ = 0;
  sense_ = 1;
  rooms_.fill(adds_ ? 0 : 1);  // who adds looks first
  turned_ = held_up_ = 0;
  brief_ = 0;
}

void SurgeonHand::go(double dt) BURR_RT {
  const bool last = next_ >= stroke_.points;
  const Vec3 aim = last ? stroke_.start : stroke_.way[static_cast<std::size_t>(next_)];
  const Vec3 left = aim - at_;
  const double far = math::norm(left);
  const double step = (last && !leaving_ ? kLanding : kGoing) * dt;
  if (!leaving_ && last && math::dot(force_, left) < -kTouched * far) return reach_bone();
  if (far > step) {
    at_ += left * (step / far);
    return;
  }
  at_ = aim;
  if (!last) {
    ++next_;
  } else if (leaving_) {
    phase_ = Phase::waiting;
  } else {
    reach_bone();
  }
}

void SurgeonHand::stroke(double dt) BURR_RT {
  const Vec3 burr = at_ + force_ / kSpring;  // the burr lags behind the hand that presses it
  const double here = room(burr);
  rooms_[tick_ % kMemory] = static_cast<float>(here);
  const double seen =
      static_cast<double>(rooms_[(tick_ + kMemory - delay_) % kMemory]);  // T_stop ago
  ++tick_;
  stroked_ += dt;
  full_ = adds_ && seen <= 0;
  const double near = near_ != nullptr ? std::max(0.0, near_->at(burr) - radius_) : kFarAway;
  const double share = skill_.restraint + (1 - skill_.restraint) * std::min(1.0, near / kFarAway);
  const double wanted = skill_.force * share * uneven_.next();
  const double felt = std::max(0.0, -math::dot(force_, stroke_.into));
  double press = (wanted - felt) / kYield;
  press = std::min(press, std::clamp(here / kBrake, kSlowestPress, kFastestPress));
  at_ += seen < 0 ? Vec3(stroke_.out * (kLift * dt)) : Vec3(stroke_.into * (press * dt));

  // what stands in the way is cut away before the hand goes on
  const double against = std::max(0.0, -sense_ * math::dot(force_, stroke_.along));
  const double pace = skill_.speed * std::max(0.0, 1 - against / std::max(wanted, 0.1));
  const Vec3 onwards = stroke_.along * (sense_ * pace * dt);
  const bool over = done_ + sense_ * pace * dt > stroke_.length || done_ + sense_ * pace * dt < 0;
  // out of the plan: back. Who is out already may go where it is no worse, and lifts.
  const double ahead = room(burr + stroke_.along * (sense_ * kAhead));
  const bool leaves = ahead < -kSlack && ahead < here;
  // a hand that is held up sweeps back: the next pass takes a layer off what stood in the way
  held_up_ = pace < kHeldUp * skill_.speed ? held_up_ + dt : 0;
  if (over || leaves || held_up_ > kPatience) return turn(over || leaves);
  at_ += onwards;
  done_ += sense_ * pace * dt;
}

// at_end: of the stroke or of the plan. Where the plan has ended nearly all along the stroke, the hand would
// go to and fro on the spot: then the bout is over.
void SurgeonHand::turn(bool at_end) BURR_RT {
  const bool brief = std::abs(done_ - turned_) < std::min(kBrief, 0.5 * stroke_.length);
  brief_ = at_end && brief ? brief_ + 1 : 0;
  if (brief_ >= kMostBrief) stroked_ += kBout;
  turned_ = done_;
  held_up_ = 0;
  sense_ = -sense_;
}

device::HandState SurgeonHand::state(double dt) BURR_RT {
  if (phase_ == Phase::going) {
    go(dt);
  } else if (phase_ == Phase::stroking) {
    stroke(dt);
  }
  shaft_ = math::normalized(shaft_ + (stroke_.shaft - shaft_) * std::min(1.0, kTurning * dt));
  const Vec3 p = at_ + tremor_.next() + drift_.next();
  device::HandState hand;
  hand.world_from_tool = {p, math::shortest_rotation(Vec3::UnitZ(), shaft_)};
  hand.velocity = (p - last_) / dt;
  const bool works = phase_ == Phase::stroking || (phase_ == Phase::going && !stroke_.idle_way);
  hand.pedal = !works || full_ ? 0 : adds_ ? kGently : 1;
  last_ = p;
  return hand;
}

}  // namespace burr::surgeon

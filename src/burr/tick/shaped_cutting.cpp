// Cutting with a tool of any shape: its cutting parts carve (edit/tool_body.h), and the power of each
// contact says how much (edit/laws/elements.h). The rest of Cutting is in cutting.cpp.
#include <algorithm>
#include <cmath>

#include "burr/math/rotation.h"
#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/tick/cutting.h"

namespace burr::tick {
namespace {

using math::Vec3;

// A mallet's blow is spent over so long: the tool has to follow the cut meanwhile. Assumed.   [s]
constexpr double kBlowTime = 10e-3;
constexpr double kBlowPause = 0.5;  // from blow to blow, while the pedal is down               [s]
constexpr double kPedalDown = 0.5;  // from here on                                             [-]

// How far the cutting parts reach from the tool's origin.  [m]
double reach_of_cutting(const tool::Tool& tool) BURR_RT {
  double reach = 0;
  for (int p = 0; p < tool.count; ++p) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(p)];
    if (part.role != tool::Role::cuts) continue;
    const tool::BoundingBall ball = tool::bounding_ball(part.shape);
    reach = std::max(reach, math::norm(part.tool_from_part * ball.centre) + ball.radius);
  }
  return reach;
}

// The least of its widths.  [m]
double thickness_of(const tool::Part& part) BURR_RT {
  double least = 1;
  for (const Vec3& way : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
    least = std::min(least, tool::support(part.shape, way) + tool::support(part.shape, -way));
  return least;
}

}  // namespace

const tool::ShapedTool* Cutting::shaped() const BURR_RT {
  return settings_.tool < 0 ? nullptr : &settings_.tools[static_cast<std::size_t>(settings_.tool)];
}

int Cutting::teeth() const BURR_RT {
  return shaped() != nullptr ? shaped()->cutter.teeth : settings_.burr.teeth;
}

void Cutting::take_tool() BURR_RT {
  const tool::ShapedTool* tool = shaped();
  now_ = {};
  blow_left_ = 0;
  since_blow_ = 1e9;
  if (tool == nullptr) {
    spindle_.full_speed = burr_speed_;
    spindle_.motor = settings_.motor;
    return;
  }
  const tool::Cutter& cutter = tool->cutter;
  spindle_.full_speed = tool::full_speed(cutter);
  // behind a gear a slow drive is as strong as a fast one
  const double gear = settings_.removal.max_power / std::max(spindle_.full_speed, 1.0);
  if (settings_.motor.torque > 0) spindle_.motor.torque = std::max(settings_.motor.torque, gear);
  const double h = bone_.grid().voxel;
  body_ = edit::cutting_body(tool->tool, h);
  body_.sweep = cutter.drive == tool::Drive::turning ? edit::Sweep::turning : edit::Sweep::even;
  body_.least_weight = cutter.least_weight;
  body_reach_ = std::max(1.0, reach_of_cutting(tool->tool) / h);
}

// A blow when the pedal goes down, and again while it stays down.
void Cutting::swing_mallet() BURR_RT {
  if (hand_.state().pedal < kPedalDown) {
    since_blow_ = 1e9;
    return;
  }
  since_blow_ += dt_;
  if (since_blow_ < kBlowPause) return;
  since_blow_ = 0;
  blow_left_ = shaped()->cutter.blow_j;
}

// Do the cutting parts move over the bone?
bool Cutting::drive_moves(double push) const BURR_RT {
  if (settings_.mode != ToolMode::cut || push <= 0) return false;
  const tool::Cutter& cutter = shaped()->cutter;
  switch (cutter.drive) {
    case tool::Drive::turning:
    case tool::Drive::oscillating:
    case tool::Drive::reciprocating:
      return spindle_.speed() != 0;
    case tool::Drive::pushed:
      return math::dot(hand_.velocity(), Vec3(hand_.tool_turn() * cutter.way)) > 0;
    case tool::Drive::struck:
      break;
  }
  return blow_left_ > 0;
}

// How the tool in the hand moves.
edit::Stroke Cutting::stroke_now() const BURR_RT {
  const math::Quat turn = hand_.tool_turn();
  edit::Stroke stroke;
  stroke.axis = turn * Vec3(Vec3::UnitZ());
  stroke.hand = hand_.velocity();
  stroke.speed = spindle_.speed();
  if (shaped() == nullptr) return stroke;
  const tool::Cutter& cutter = shaped()->cutter;
  stroke.way = turn * cutter.way;
  const double full = tool::full_speed(cutter);
  if (cutter.drive != tool::Drive::turning && full > 0)
    stroke.speed = tool::stroke_speed(cutter) * std::abs(spindle_.speed()) / full;
  return stroke;
}

// A shaft that turns on bone, the body of a blade that strokes: friction along the spindle's sliding,
// -mu f v / |v|, with its torque and its heat; that of a stroke is 0 in the mean, but brakes and warms.
void Cutting::rub(const Vec3& touched) BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  const haptics::ToolContact* parts = hand_.parts();
  const bool moves = shaped() == nullptr || shaped()->cutter.drive != tool::Drive::struck;
  if (parts == nullptr || !parts->by_part || !parts->rests || !moves || spindle_.speed() == 0 ||
      !touch.touching || touch.slipping || touch.depth <= 0)
    return;
  last_load_ = std::max(0.0, math::dot(touched, touch.normal));
  const double per_stretch = last_load_ / touch.depth;
  const tool::Cutter turning;
  const tool::Cutter& cutter = shaped() == nullptr ? turning : shaped()->cutter;
  const edit::Stroke stroke = stroke_now();
  double most = 0;
  for (int a = 0; a < parts->active; ++a) {
    const haptics::SixContact& one = parts->contacts[static_cast<std::size_t>(a)];
    const tool::Part* part = nullptr;
    if (shaped() != nullptr) part = &shaped()->tool.parts[static_cast<std::size_t>(one.part)];
    // of a burr the head is the first part
    if (part != nullptr ? part->role != tool::Role::rubs : one.part == 0) continue;
    const Vec3 v = edit::surface_velocity(cutter, stroke, one.arm);
    const Vec3 along = v - math::dot(v, one.normal) * one.normal;
    const double speed = math::norm(along);
    if (speed <= 0 || one.load <= 0) continue;
    const double force = settings_.friction_turning * per_stretch * one.load;
    rubbing_.power += force * speed;
    if (cutter.drive == tool::Drive::turning) {
      const Vec3 drag = -force / speed * along;
      now_.drag += drag;
      cut_moment_ += one.arm.cross(drag);
    }
    if (one.load <= most) continue;
    most = one.load;
    rubbing_.place = hand_.tool() + one.arm;
    rubbing_.radius = part != nullptr ? thickness_of(*part) / 2 : settings_.burr.radius / 2;
  }
  rubbing_.edge = thermal::Edge::rubbing;
  now_.torque += rubbing_.power / std::abs(spindle_.speed());
}

// per_stretch: force of a contact over its load  [N/m]
edit::ElementCutting Cutting::by_elements(double per_stretch) BURR_RT {
  const tool::ShapedTool& tool = *shaped();
  const haptics::ToolContact& parts = *hand_.parts();
  std::array<edit::ElementContact, 6> contacts;
  std::size_t count = 0;
  double most = 0;
  for (int a = 0; a < parts.active; ++a) {
    const haptics::SixContact& one = parts.contacts[static_cast<std::size_t>(a)];
    if (tool.tool.parts[static_cast<std::size_t>(one.part)].role != tool::Role::cuts) continue;
    const Vec3 place = hand_.tool() + one.arm;
    const volume::Tissue& tissue = tissue_at(place - 0.5 * bone_.grid().voxel * one.normal);
    contacts[count++] = {one.arm, one.normal, per_stretch * one.load, tissue.cutting_friction};
    if (one.load > most) {
      warm_place_ = place;
      warm_radius_ = thickness_of(tool.tool.parts[static_cast<std::size_t>(one.part)]) / 2;
    }
    most = std::max(most, one.load);
  }
  edit::ElementCutting cutting = edit::element_law(
      tool.cutter, stroke_now(), std::span(contacts).first(count), dt_, settings_.removal);
  if (tool.cutter.drive == tool::Drive::struck) {
    cutting.energy = std::min(blow_left_, tool.cutter.blow_j * dt_ / kBlowTime);
    cutting.power = cutting.energy / dt_;
  }
  // a stroke brakes its drive by its power, too
  if (spindle_.speed() != 0) cutting.torque = cutting.power / std::abs(spindle_.speed());
  return cutting;
}

// Where the cutting parts are, and where the hand wants them to go.
void Cutting::place_body(edit::Cut& cut) BURR_RT {
  const volume::Grid& grid = bone_.grid();
  const math::Quat grid_from_world = grid.frame.q.conjugate();
  body_.grid_from_tool.p = cut.centre;
  body_.grid_from_tool.q = math::normalized(math::product(grid_from_world, hand_.tool_turn()));
  const Vec3 p =
      grid_from_world * Vec3(hand_.state().world_from_tool.p - hand_.tool()) / grid.voxel;
  const Vec3 t = -(grid_from_world * hand_.parts()->turn);
  const double length = math::norm(p) + math::norm(t) * body_reach_;
  body_.ahead = length > 0 ? Vec3(p / length) : Vec3(Vec3::Zero());
  body_.turn = length > 0 ? Vec3(t / length) : Vec3(Vec3::Zero());
  cut.body = &body_;
}

void Cutting::cut_shaped(double push, bool may, std::uint32_t& flags,
                         std::uint64_t path_mark) BURR_RT {
  const tool::Cutter& cutter = shaped()->cutter;
  if (cutter.drive == tool::Drive::struck) swing_mallet();
  const bool now = works(push, may) && hand_.parts() != nullptr;
  if (now) {
    if (!undo_.stroke_open()) undo_.begin_stroke(path_mark, carver_.removed_units());
    const haptics::Touch& touch = hand_.touch();
    const double carried = math::norm(hand_.parts()->head);
    const edit::ElementCutting cutting = by_elements(carried > 0 ? push / carried : 0);
    now_ = cutting;
    cut_moment_ = cutting.moment;
    edit::Cut cut;
    cut.centre = bone_.grid().grid_from_world(touch.proxy);
    cut.push = bone_.grid().frame.q.conjugate() * (-cut_normal_);
    cut.radius = body_reach_;
    cut.dt = dt_;
    cut.slices = slices_of(controls_.shed);
    cut.mirror = controls_.mirror;
    cut.energy = now_.energy;
    place_body(cut);
    carver_.carve(cut, flags);
  }
  // a blow that met no bone is spent as well
  blow_left_ = std::max(0.0, blow_left_ - cutter.blow_j * dt_ / kBlowTime);
}

}  // namespace burr::tick

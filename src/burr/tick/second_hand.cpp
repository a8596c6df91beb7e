#include "burr/tick/second_hand.h"

#include <algorithm>

#include "burr/rt/flags.h"
#include "burr/tick/tick_hash.h"

namespace burr::tick {
namespace {

using math::Vec3;

// of a ball's proxy in a tick: the first hand's tick is the one that must not be late
constexpr int kMoves = 6;
constexpr double kLever = 60e-3;  // of the spring of turning, as of the first hand's tools    [m]
constexpr int kOrientation = 6;   // degrees of freedom of a device that tells how it is turned
constexpr double kRecovery = 5;   // of bone that grew under the tool pushes it out     [voxel/s]

SecondHandSettings capped(SecondHandSettings settings, const device::DeviceSpec& spec,
                          double voxel) {
  settings.radius = std::max(settings.radius, 2 * voxel);
  settings.force.stiffness = std::min(settings.force.stiffness, spec.max_stiffness);
  settings.force.damping = std::min(settings.force.damping, spec.max_damping);
  return settings;
}

// The session's own laws, with this hand's tool and force.
Controls controls_of(const Controls& session, const SecondHandSettings& settings) {
  Controls own = session;
  ServoSettings& servo = own.settings;
  servo.tools.clear();
  servo.tool = -1;
  if (settings.tool) {
    servo.tools.push_back(*settings.tool);
    servo.tool = 0;
  }
  servo.burr = {};
  servo.burr.radius = settings.radius;
  servo.mode = ToolMode::cut;
  servo.removal.law = edit::RemovalLaw::energy;  // the others are for round burrs
  servo.force = settings.force;
  servo.limit = settings.limit;
  return own;
}

haptics::ProxySettings proxy_settings(const SecondHandSettings& settings, double rate_hz) {
  return {.radius = settings.radius,
          .friction_static = settings.friction,
          .friction_kinetic = settings.friction,
          .wedge = 0,
          .slip = settings.slip_m_s / rate_hz,
          .max_moves = kMoves,
          .push_out_speed = kRecovery / rate_hz};
}

Vec3 nowhere(const volume::IsoVertices& surface) {
  return surface.bone().grid().world_from_grid(Vec3::Constant(-1e4));
}

tool::Tool ball_of(double radius) {
  tool::Tool ball;
  BURR_CHECK(
      tool::add_part(ball, {{tool::ShapeKind::ball, 0, 0, 0, radius}, {}, tool::Role::rubs}));
  return ball;
}

std::unique_ptr<haptics::ToolTouch> touch_of(const volume::IsoVertices& surface,
                                             const SecondHandSettings& settings,
                                             const ServoSettings& servo) {
  haptics::ProxySettings proxy;
  proxy.slip = settings.slip_m_s / servo.rate_hz;
  proxy.push_out_speed = kRecovery / servo.rate_hz;
  proxy.parts_rub = servo.tool_friction;
  proxy.tool_close = servo.tool_close;
  proxy.planes = servo.tool_planes;
  proxy.wedge = servo.wedge;
  if (!settings.tool) {
    proxy.friction_static = proxy.friction_kinetic = settings.friction;
    proxy.max_moves = kMoves;
  }
  const tool::Tool tool = settings.tool ? settings.tool->tool : ball_of(settings.radius);
  return std::make_unique<haptics::ToolTouch>(surface, tool, proxy, kLever,
                                              math::Pose{nowhere(surface), math::Quat::Identity()});
}

}  // namespace

SecondHand::SecondHand(const SharedByHands& shared, device::Device& device,
                       const SecondHandSettings& settings)
    : settings_(capped(settings, device.spec(), shared.surface.bone().grid().voxel)),
      session_(shared.controls),
      writer_(shared.writer),
      controls_(controls_of(shared.controls, settings_)),
      proxy_(shared.surface, proxy_settings(settings_, controls_.settings.rate_hz),
             nowhere(shared.surface)),
      tool_(settings_.tool ? touch_of(shared.surface, settings_, controls_.settings) : nullptr),
      ball_(settings_.tool ? nullptr : touch_of(shared.surface, settings_, controls_.settings)),
      hand_(device, proxy_, controls_.settings.force,
            {.rate_hz = controls_.settings.rate_hz,
             .velocity_filter_hz = settings_.velocity_filter_hz,
             .limit = settings_.limit,
             .guarded = controls_.settings.guarded,
             .guard_slack = controls_.settings.guard_slack}),
      piece_(shared.piece),
      beside_(shared.beside) {
  piece_.join(device.spec().sensed >= kOrientation);
  const double lever = coupling_of(hand_.spec(), controls_.settings).lever;
  if (hand_.turned()) piece_.couple(HeldPiece::kSecond, lever);
  if (!tool_) return;
  hand_.use(*tool_, tool_.get());
  if (hand_.turned()) tool_->couple(lever);
  cutting_ = std::make_unique<Cutting>(shared.surface.bone(), shared.undo, shared.writer, controls_,
                                       hand_, 1);
  cutting_->set_beside(&shared.beside);
}

void SecondHand::read(bool lost, bool parted) BURR_RT {
  row_ = {};
  row_.tick = next_tick_++;
  lost_ = lost;
  usable_ = hand_.read(lost, row_.contact.flags);
  row_.hand = hand_.state();
  if (parted) hand_.lift();
  controls_.shed = session_.shed;
  controls_.mirror = session_.mirror;
  controls_.irrigated = session_.irrigated;
  const bool down = usable_ && hand_.state().pedal > 0;
  waits_ = piece_.lifted() || (waits_ && down);
  if (cutting_) cutting_->turn(usable_ && !waits_ ? hand_.state().pedal : 0);
}

// A piece that this hand grips is in it in place of its tool.
bool SecondHand::will_carry() BURR_RT {
  const bool holds = piece_.lifted() && piece_.grips(HeldPiece::kSecond, hand_.state(), usable_);
  grabs_ = holds && !holds_;
  const bool meets = ball_ && piece_.lifted();
  const bool differs = holds != holds_ || (!holds && meets != meets_);
  holds_ = holds;
  meets_ = meets;
  if (differs) {
    hand_.lift();
    take_what_is_its_own();
  }
  if (!holds) return false;
  if (!hand_.engaged()) {
    piece_.grab(hand_.state().world_from_tool);
    hand_.hold();
  }
  const double mu = beside_.friction();
  piece_.set_friction(mu, session_.settings.kinetic_share * mu);
  return true;
}

void SecondHand::take_what_is_its_own() BURR_RT {
  if (holds_)
    hand_.use(piece_);
  else if (tool_)
    hand_.use(*tool_, tool_.get());
  else if (meets_)
    hand_.use(*ball_, ball_.get());
  else
    hand_.use(proxy_);
}

bool SecondHand::will_feel() BURR_RT {
  const bool carries = will_carry();
  if (!usable_) {
    hand_.skip_touch();
    return false;
  }
  hand_.filter_velocity();
  if (carries) return true;
  if (!hand_.engage()) return false;
  if (cutting_) {
    const double mu = cutting_->friction();
    tool_->set_friction(mu, controls_.settings.kinetic_share * mu);
  }
  return true;
}

void SecondHand::feel_beside(Hand& first, bool feels) BURR_RT {
  const bool feels_too = will_feel();
  const Bodies bodies = !piece_.lifted()                        ? Bodies::tools
                        : piece_.holder() == HeldPiece::kSecond ? Bodies::tool_and_piece
                                                                : Bodies::piece_and_tool;
  // a tool that rests on the piece goes on to do so while hands take it and let it go
  if (bodies != bodies_) two_.part();
  bodies_ = bodies;
  if (feels_too && !feels && piece_.loose()) {
    if (!push_piece()) hand_.feel();
    return;
  }
  if (!feels || !feels_too) two_.part();
  if (feels && feels_too && feel_together(first)) return;
  if (feels) first.feel();
  if (feels_too) hand_.feel();
}

bool SecondHand::feel_together(Hand& first) BURR_RT {
  haptics::SixProxy *a = first.six(), *b = hand_.six();
  if (a == nullptr || b == nullptr) {
    two_.part();
    return false;
  }
  const haptics::HeldTool one = {*a, first.goal(), first.stiffness()},
                          other = {*b, hand_.goal(), hand_.stiffness()};
  if (!two_.near(one, other)) return false;
  haptics::SixTouch touch, touch_too;
  two_.step(one, other, touch, touch_too);
  first.feel(touch);
  hand_.feel(touch_too);
  return true;
}

// This hand's tool against a piece that nobody holds. False: they cannot meet in this tick.
bool SecondHand::push_piece() BURR_RT {
  haptics::SixProxy* tool = hand_.six();
  if (tool == nullptr) {
    two_.part();
    return false;
  }
  const haptics::HeldTool piece = piece_.as_loose(),
                          other = {*tool, hand_.goal(), hand_.stiffness()};
  if (!two_.near(piece, other)) return false;
  haptics::SixTouch touch, touch_too;
  two_.step(piece, other, touch, touch_too);
  piece_.pushed(touch);
  hand_.feel(touch_too);
  return true;
}

void SecondHand::send() BURR_RT {
  std::uint32_t& flags = row_.contact.flags;
  if (!cutting_ && !holds_) {
    sent_ = hand_.send(hand_.wanted(), flags);
    return;
  }
  const Vec3 guarded = hand_.limit_energy(hand_.wanted(), lost_ || !usable_ || grabs_, flags);
  Hand::Beside beside;
  if (!cutting_) {
    sent_ = hand_.send(guarded, beside, flags);
    touched_ = hand_.touch_part(sent_, beside);
    return;
  }
  beside.force = cutting_->drag(guarded) + cutting_->vibration();
  if (usable_) beside.twist = cutting_->torque();
  if (hand_.turned()) beside.moment = cutting_->moment();
  sent_ = hand_.send(guarded, beside, flags);
  touched_ = hand_.touch_part(sent_, beside);
}

// What the account gains meanwhile is this hand's doing.
void SecondHand::cut(bool may, std::uint64_t path_mark) BURR_RT {
  if (!cutting_) return;
  may = may && !waits_;
  const edit::Account before = writer_.account();
  cutting_->cut(row_.tick, touched_, may, path_mark, row_.contact.flags);
  const edit::Account& now = writer_.account();
  own_.asked += now.asked - before.asked;
  own_.not_cut += now.not_cut - before.not_cut;
  own_.removed += now.removed - before.removed;
  own_.energy += now.energy - before.energy;
  own_.debts[1] = now.debts[1];
}

void SecondHand::finish() BURR_RT {
  hand_.report(sent_, row_.contact);
  row_.tool.radius = settings_.radius;
  row_.tool.mode = cutting_ ? ToolMode::cut : ToolMode::touch;
  row_.tool.number = controls_.settings.tool;
  row_.ledger = own_.ledger(writer_.unit_m3());
  if (cutting_) {
    if (cutting_->spindle().stalled()) row_.contact.flags |= rt::kFlagStalled;
    row_.tool.full_speed = cutting_->spindle().full_speed;
    row_.spindle_rad_s = cutting_->spindle().speed();
    row_.cutting_nm = cutting_->now().torque;
    row_.cutting_w = cutting_->now().power;
  }
  row_.hash = last_hash_ = tick_hash(row_, last_hash_);
  hand_.faults().note(row_);
}

}  // namespace burr::tick

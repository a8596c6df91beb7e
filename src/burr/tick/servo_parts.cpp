#include "burr/tick/servo_parts.h"

#include <utility>

#include "burr/rt/flags.h"
#include "burr/tick/tick_hash.h"

namespace burr::tick {
namespace {

using math::Vec3;

constexpr double kRecovery = 5;  // of bone that grew under the burr pushes it out  [voxel/s]
// of the budgets of IsoSettings: they are those of a millisecond
constexpr double kRefreshRate = 1e3;

HandSettings hand_settings(const ServoSettings& settings) {
  return {.rate_hz = settings.rate_hz,
          .velocity_filter_hz = settings.velocity_filter_hz,
          .limit = settings.limit,
          .guarded = settings.guarded,
          .guard_slack = settings.guard_slack,
          .turned = settings.turn_hand && settings.torque_gain > 0};
}

haptics::ProxySettings proxy_settings(const ServoSettings& settings) {
  return {.radius = settings.burr.radius,
          .wedge = settings.wedge,
          .slip = settings.slip_m_s / settings.rate_hz,
          .parts_rub = settings.tool_friction,
          .tool_close = settings.tool_close,
          .planes = settings.tool_planes,
          .push_out_speed = kRecovery / settings.rate_hz};
}

constexpr int kOrientation = 6;  // degrees of freedom of a device that tells how it is turned

}  // namespace

ServoParts::ServoParts(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
                       const ServoSettings& settings, FoundInBone found)
    : surface_(surface),
      dt_(1.0 / settings.rate_hz),
      controls_{.settings = settings, .irrigated = settings.irrigated},
      changed_(bone),
      undo_(bone, settings.undo_bricks),
      writer_(bone, surface, undo_, &changed_, std::move(found.bricks)),
      touch_by_(surface, proxy_settings(settings), settings.touch, &controls_.settings.tools,
                settings.tool, std::move(found.mesher)),
      hand_(device, touch_by_.constraint(), controls_.settings.force, hand_settings(settings)),
      law_(bone, controls_, hand_),
      cutting_(bone, undo_, writer_, controls_, hand_),
      piece_(surface, proxy_settings(settings), haptics::ShaftTouch::kLever,
             device.spec().sensed >= kOrientation, settings.rate_hz),
      restore_(bone, surface, undo_, writer_, controls_.settings, hand_, piece_),
      outbox_(bone, changed_, controls_),
      orders_(bone.grid(), {controls_, hand_, touch_by_, cutting_, restore_, piece_, outbox_}) {
  hand_.use(touch_by_.now(), touch_by_.tool());
  if (settings.law != nullptr) cutting_.set_law(&law_.row());
  if (!hand_.turned()) return;
  const double lever = coupling_of(hand_.spec(), controls_.settings).lever;
  touch_by_.couple(lever);
  piece_.couple(HeldPiece::kFirst, lever);
}

void ServoParts::set_second(SecondHand* second) {
  second_ = second;
  cutting_.set_beside(second != nullptr ? second->cutting() : nullptr);
}

const TickRow& ServoParts::tick(bool lost) BURR_RT {
  row_ = {};
  row_.tick = next_tick_++;
  std::uint32_t& flags = row_.contact.flags;

  // the hand, and its commands
  const bool usable = hand_.read(lost, flags);
  row_.hand = hand_.state();
  orders_.take(row_.tick, flags);
  choose_touch();
  note_tool();
  cutting_.turn(usable && !restore_.lifted() ? hand_.state().pedal : 0);
  const std::int64_t taken = restore_.taken_by_second();
  if (second_ != nullptr) {
    second_->read(lost, restore_.active());
    second_->took(taken);
  }

  // touch
  const bool feels = will_feel(usable);
  if (second_ == nullptr) {
    if (feels) hand_.feel();
  } else {
    second_->feel_beside(hand_, feels);
  }
  piece_.rest(usable ? hand_.state().world_from_tool.p : piece_.position());

  // force, bounded, to the hand
  const Vec3 wanted = law_.wanted(feels && !piece_.lifted(), cutting_.spindle().speed());
  if (law_.failed_now()) hand_.release(rt::kFlagLaw, flags);
  if (law_.off()) flags |= rt::kFlagLaw;
  const Vec3 guarded = hand_.limit_energy(wanted, lost || !usable, flags);
  Hand::Beside beside;
  beside.force = cutting_.drag(guarded) + cutting_.vibration();
  if (usable) beside.twist = cutting_.torque();
  if (hand_.turned()) beside.moment = cutting_.moment();
  const Hand::Sent sent = hand_.send(guarded, beside, flags);
  const Vec3 touched = hand_.touch_part(sent, beside);
  if (second_ != nullptr) second_->send();

  // then the bone
  cut(touched);
  outbox_.note_heat(row_.tick, cutting_, second_ != nullptr ? second_->cutting() : nullptr);
  restore_.remember_path();

  // and the account of it all
  outbox_.note_released(hand_.released() && !piece_.lifted());
  finish_row(sent);
  hand_.faults().note(row_);
  if (second_ != nullptr) second_->finish();
  return row_;
}

void ServoParts::cut(const Vec3& touched) BURR_RT {
  const bool may = !restore_.active() && !restore_.lifted();
  cutting_.cut(row_.tick, touched, may, restore_.path_mark(), row_.contact.flags);
  if (second_ != nullptr) second_->cut(may, restore_.path_mark());
  // twice as much changes in a mirror or by a second tool, and the hand's side must not be later
  // for it
  const bool two = second_ != nullptr && second_->cutting() != nullptr;
  surface_.refresh((controls_.mirror.on() ? 2 : 1) * (two ? 2 : 1) * kRefreshRate * dt_ /
                   slices_of(controls_.shed));
}

void ServoParts::publish() BURR_RT {
  if (second_ != nullptr) {
    second_->publish();
    outbox_.publish_second(second_->row());
  }
  outbox_.publish(row_, tissue_changes());
}

// A piece that was lifted is in the hand in place of its tool, unless the other hand holds it: then the
// tool is in the hand again, and begins in free air.
void ServoParts::choose_touch() BURR_RT {
  const bool beside = piece_.lifted() && piece_.holder() == HeldPiece::kSecond;
  if (beside != beside_piece_) hand_.lift();
  beside_piece_ = beside;
  if (piece_.lifted() && !beside)
    hand_.use(piece_);
  else
    hand_.use(touch_by_.now(), touch_by_.tool());
}

// will_feel() with a piece.
bool ServoParts::will_carry(bool usable) BURR_RT {
  if (!piece_.grips(HeldPiece::kFirst, hand_.state(), usable)) {
    if (!beside_piece_) hand_.hold_nothing();
    return false;
  }
  if (!hand_.engaged()) {
    piece_.grab(hand_.state().world_from_tool);
    hand_.hold();
  }
  const double mu = cutting_.friction();
  piece_.set_friction(mu, controls_.settings.kinetic_share * mu);
  return true;
}

// The steps before touch; false: the hand feels nothing, or what restore.h gives it.
bool ServoParts::will_feel(bool usable) BURR_RT {
  if (!usable) {
    if (piece_.lifted()) static_cast<void>(will_carry(false));
    // a piece does not wait for a hand: the hand is released in any case
    if (restore_.moves_piece()) {
      restore_.step(row_.contact.flags);
      row_.contact.flags |= rt::kFlagRestoring;
    }
    hand_.skip_touch();
    return false;
  }
  hand_.filter_velocity();
  if (restore_.active()) {
    restore_.step(row_.contact.flags);
    row_.contact.flags |= rt::kFlagRestoring;
    return false;
  }
  if (piece_.lifted() && (will_carry(usable) || !beside_piece_))
    return piece_.holder() == HeldPiece::kFirst;
  if (hand_.hovers()) hand_.set_down();
  if (!hand_.engage()) return false;
  const double mu = cutting_.friction();
  touch_by_.now().set_friction(mu, controls_.settings.kinetic_share * mu);
  touch_by_.show(row_.tick);
  return true;
}

// What is in the hand after this tick's commands, obeyed or refused.
void ServoParts::note_tool() BURR_RT {
  const ServoSettings& now = controls_.settings;
  row_.tool.radius = now.burr.radius;
  row_.tool.full_speed = cutting_.spindle().full_speed;
  row_.tool.kind = now.burr.kind;
  row_.tool.mode = now.mode;
  row_.tool.mirror_axis = controls_.mirror.axis;
  row_.tool.mirror_twice = controls_.mirror.twice;
  row_.tool.irrigated = controls_.irrigated;
  row_.tool.number = now.tool;
}

void ServoParts::finish_row(const Hand::Sent& sent) BURR_RT {
  hand_.report(sent, row_.contact);
  std::uint32_t& flags = row_.contact.flags;
  if (surface_.exhausted()) flags |= rt::kFlagReserve;
  if (controls_.shed >= Shed::removal_2) flags |= rt::kFlagPutOff;
  if (cutting_.spindle().stalled()) flags |= rt::kFlagStalled;
  row_.piece = piece_.row();
  row_.law = law_.row();
  row_.ledger = writer_.ledger();
  row_.spindle_rad_s = cutting_.spindle().speed();
  row_.cutting_nm = cutting_.now().torque;
  row_.cutting_w = cutting_.now().power;
  // chained, so that the first tick at which two runs part is the first whose hash differs
  row_.hash = last_hash_ = tick_hash(row_, last_hash_);
}

void ServoParts::note_timing(double took_us, double late_us) BURR_RT {
  row_.took_us = static_cast<float>(took_us);
  row_.late_us = static_cast<float>(late_us);
  hand_.faults().renew(row_);
}

// ---- servo.h: each call goes to the parts

Servo::Servo(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
             const ServoSettings& settings, const std::shared_ptr<FoundInBone>& found)
    : parts_(std::make_unique<ServoParts>(bone, surface, device, settings,
                                          found ? std::move(*found) : FoundInBone{})) {}

Servo::~Servo() = default;

const TickRow& Servo::tick(bool lost) BURR_RT { return parts_->tick(lost); }
void Servo::set_shed(Shed shed) BURR_RT { parts_->set_shed(shed); }
Shed Servo::shed() const BURR_RT { return parts_->shed(); }
rt::Ring<Command>& Servo::commands() BURR_RT { return parts_->commands(); }
rt::Latest<TickRow>& Servo::view() BURR_RT { return parts_->view(); }
rt::Latest<FaultReport>& Servo::faults() BURR_RT { return parts_->faults(); }
double Servo::burr_radius() const BURR_RT { return parts_->burr_radius(); }
bool Servo::released() const BURR_RT { return parts_->released(); }
void Servo::set_recorder_rings(const RecorderRings& rings) { parts_->set_recorder_rings(rings); }
void Servo::set_second(SecondHand* second) { parts_->set_second(second); }
SharedByHands Servo::shared() { return parts_->shared(); }
void Servo::set_watch(rt::Latest<TickRow>* watch) { parts_->set_watch(watch); }
void Servo::set_heat(thermal::Worker* heat) { parts_->set_heat(heat); }
void Servo::set_brick_watch(edit::ChangedQueue* watch) { parts_->set_brick_watch(watch); }
edit::BoneWriter& Servo::writer() { return parts_->writer(); }
std::shared_ptr<FoundInBone> Servo::take_found() {
  return std::make_shared<FoundInBone>(parts_->take_found());
}
void Servo::note_timing(double took_us, double late_us) BURR_RT {
  parts_->note_timing(took_us, late_us);
}
void Servo::publish() BURR_RT { parts_->publish(); }
Servo::Work Servo::work() const BURR_RT { return parts_->work(); }
const ServoSettings& Servo::settings() const BURR_RT { return parts_->settings(); }
const edit::UndoStore& Servo::undo_store() const BURR_RT { return parts_->undo_store(); }
std::size_t Servo::bricks_to_write() const BURR_RT { return parts_->bricks_to_write(); }
bool Servo::restoring() const BURR_RT { return parts_->restoring(); }
const HeldPiece& Servo::piece() const { return parts_->piece(); }
bool Servo::lay_ready(const edit::MovedBricks& bricks) { return parts_->lay_ready(bricks); }
void Servo::take_back() { parts_->take_back(); }
MoveState Servo::move_state() const { return parts_->move_state(); }
std::uint64_t Servo::writes_begun() const { return parts_->writes_begun(); }
std::uint64_t Servo::writes_done() const { return parts_->writes_done(); }
void Servo::flush_bricks() BURR_RT { parts_->flush_bricks(); }
void Servo::commit_ahead() { parts_->commit_ahead(); }

}  // namespace burr::tick

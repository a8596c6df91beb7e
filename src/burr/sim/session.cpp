#include "burr/sim/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "burr/base/check.h"
#include "burr/device/device.h"
#include "burr/edit/bone_memory.h"
#include "burr/haptics/safety/coupling.h"
#include "burr/haptics/safety/watchdog.h"
#include "burr/record/recorder.h"
#include "burr/rt/clock.h"
#include "burr/sim/row_log.h"
#include "burr/thermal/heat_worker.h"
#include "burr/tick/controls.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/own_law.h"
#include "burr/tick/recorder_rings.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"
#include "burr/tick/setting_table.h"
#include "burr/tool/limits.h"

namespace burr::sim {
namespace {

constexpr std::int64_t kFadeNs = 5'000'000;  // from the detection of a loss to zero force
constexpr std::int64_t kGuardNs = 500'000;   // between two checks by the guard
// ticks between two waits for the heat, when not in real time
constexpr std::uint64_t kHeatWait = 1000;
constexpr std::uint64_t kStepsAtOnce = 64;  // of step(), between two that reserve memory
constexpr auto kAheadPause = std::chrono::milliseconds(5);  // between two calls that reserve memory

// A part thinner than a voxel could slip between the points of bone that it touches.
Status check_thickness(const char* whose, const tool::ShapedTool& tool, double voxel) {
  const double thinnest = tool::thinnest(tool.tool);
  if (thinnest >= voxel - 1e-9) return fine();
  return error(
      Trouble::usage,
      fmt::format("{} {}: its thinnest part is {:.2f} mm, thinner than a voxel of {:.3f} mm; use "
                  "voxels of {:.3f} mm or finer (of a region around the work, if memory is short)",
                  whose, tool.name, 1e3 * thinnest, 1e3 * voxel, std::floor(1e6 * thinnest) / 1e3));
}

Status check_tools(const tick::ServoSettings& servo, double voxel) {
  if (servo.tools.size() > tool::kMostTools)
    return error(Trouble::usage, fmt::format("a session takes at most {} tools, not {}",
                                             tool::kMostTools, servo.tools.size()));
  if (servo.tool >= static_cast<int>(servo.tools.size()))
    return error(Trouble::internal, "the session has no tool of this number");
  for (const tool::ShapedTool& tool : servo.tools)
    if (Status good = check_thickness("the tool", tool, voxel); !good.ok()) return good;
  if (servo.tool < 0) return fine();
  const tool::ShapedTool& tool = servo.tools[static_cast<std::size_t>(servo.tool)];
  if (servo.removal.law != edit::RemovalLaw::energy)
    return error(
        Trouble::usage,
        fmt::format("the law of removal {} is for round burrs; leave it out with the tool {}",
                    edit::kLawNames[static_cast<std::size_t>(servo.removal.law)], tool.name));
  return fine();
}

}  // namespace

Session::Session(std::unique_ptr<volume::Bone> bone, std::unique_ptr<device::Device> device,
                 const SessionSettings& settings)
    : bone_(std::move(bone)),
      device_(std::move(device)),
      settings_(settings),
      memory_(std::make_unique<edit::BoneMemory>()) {}

Session::~Session() {
  stop();
  device_->close();
  if (second_device_) second_device_->close();
}

Result<std::unique_ptr<Session>> Session::make(std::unique_ptr<volume::Bone> bone,
                                               std::unique_ptr<device::Device> device,
                                               const SessionSettings& settings,
                                               Progress& progress) {
  const tick::ServoSettings& servo = settings.servo;
  if (Status good = tick::check_settings(servo); !good) return good.error();
  if (Status good = tick::check_settings(settings.surface); !good) return good.error();
  const double h = bone->grid().voxel, r = servo.burr.radius;
  if (r < 2 * h)
    return error(
        Trouble::usage,
        fmt::format("a burr of {:.2f} mm is smaller than 4 voxels of {:.3f} mm, so the voxels are "
                    "too coarse for it; use voxels of {:.3f} mm or finer (of a region around the "
                    "work, if memory is short), or a burr of {:.2f} mm or larger",
                    2e3 * r, 1e3 * h, std::floor(1e6 * r / 2) / 1e3, std::ceil(4e5 * h) / 100));
  if (Status good = check_tools(servo, h); !good.ok()) return good.error();

  if (settings.law) {
    if (settings.realtime)
      if (Status may = settings.law->fit_for_real_time(); !may) return may.error();
    if (Status begun = settings.law->begin(); !begun) return begun.error();
  }
  Status opened = device->open();
  if (!opened) return opened.error();
  std::unique_ptr<Session> session(new Session(std::move(bone), std::move(device), settings));
  const device::DeviceSpec& spec = session->device_->spec();
  if (Status good = tick::check_settings(spec); !good) return good.error();
  tick::ServoSettings capped = servo;
  capped.force.stiffness = tick::coupling_of(spec, servo).stiffness;
  capped.force.damping = std::min(servo.force.damping, spec.max_damping);
  capped.law = settings.law.get();
  session->settings_.servo = capped;
  session->surface_ = std::make_unique<volume::IsoVertices>(*session->bone_, settings.surface,
                                                            settings.threads, progress);
  if (progress.cancelled())
    return error(Trouble::interrupted,
                 "stopped while the surface was being prepared; nothing was written");
  session->servo_ =
      std::make_unique<tick::Servo>(*session->bone_, *session->surface_, *session->device_, capped);
  if (settings.heat) {
    session->heat_ = std::make_unique<thermal::Worker>(*session->bone_, settings.heat->work,
                                                       settings.heat->settings);
    session->servo_->set_heat(session->heat_.get());
  }
  // a real hand's link releases the force itself after loss_timeout; the guard is a second
  // protection
  const double timeout = (spec.simulated ? 1 : 2) * spec.loss_timeout;
  session->watchdog_ =
      std::make_unique<haptics::Watchdog>(static_cast<std::int64_t>(timeout * 1e9), kFadeNs);
  return session;
}

Status Session::add_second_hand(std::unique_ptr<device::Device> device,
                                const tick::SecondHandSettings& settings) {
  BURR_CHECK(second_ == nullptr && recorder_ == nullptr && !running());
  if (settings.tool)
    if (Status good = check_thickness("the second tool", *settings.tool, bone_->grid().voxel);
        !good.ok())
      return good;
  if (Status good = tick::check_settings(settings); !good) return good;
  const Status opened = device->open();
  if (!opened) return opened;
  if (Status good = tick::check_settings(device->spec()); !good) {
    device->close();
    return good;
  }
  second_device_ = std::move(device);
  second_device_->stop_pacing();
  second_ = std::make_unique<tick::SecondHand>(servo_->shared(), *second_device_, settings);
  servo_->set_second(second_.get());
  return fine();
}

void Session::command(const tick::Command& command) {
  static_cast<void>(servo_->commands().push(command));
}

tick::MoveState Session::move_state() const { return servo_->move_state(); }
std::uint64_t Session::writes() const { return servo_->writes_done(); }
std::uint64_t Session::writes_begun() const { return servo_->writes_begun(); }
bool Session::view(tick::TickRow& newest) { return servo_->view().take(newest); }
bool Session::fault(tick::FaultReport& report) { return servo_->faults().take(report); }
bool Session::heat(thermal::HeatSummary& newest) { return heat_ && heat_->take(newest); }
double Session::burr_radius() const { return servo_->burr_radius(); }

bool Session::move_piece(const edit::PieceMove& move,
                         std::shared_ptr<const edit::MovedBricks> bricks) {
  return send({tick::CommandKind::move_piece, static_cast<double>(move.piece), move},
              std::move(bricks));
}

bool Session::lift_piece(const edit::PieceMove& move,
                         std::shared_ptr<const edit::MovedBricks> bricks) {
  return send({tick::CommandKind::lift_piece, static_cast<double>(move.piece), move},
              std::move(bricks));
}

bool Session::take_splinter(const edit::PieceMove& move, bool second,
                            std::shared_ptr<const edit::MovedBricks> bricks) {
  return send({tick::CommandKind::take_splinter, second ? 1.0 : 0.0, move}, std::move(bricks));
}

bool Session::send(const tick::Command& command, std::shared_ptr<const edit::MovedBricks> bricks) {
  BURR_CHECK(bricks != nullptr);
  if (!servo_->lay_ready(*bricks)) return false;
  moving_ = std::move(bricks);
  if (servo_->commands().push(command)) return true;
  servo_->take_back();
  return false;
}

void Session::set_recorder(record::Recorder* recorder) {
  recorder_ = recorder;
  tick::RecorderRings rings;
  if (recorder != nullptr)
    rings = {&recorder->ticks(), &recorder->commands(), &recorder->bricks(), recorder->second()};
  servo_->set_recorder_rings(rings);
}

void Session::loop(std::uint64_t ticks) {
  rt::WallClock wall(settings_.servo.rate_hz);
  rt::NoWaitClock simulated(settings_.servo.rate_hz);
  rt::TickClock* own = settings_.realtime ? device_->clock(settings_.servo.rate_hz) : nullptr;
  rt::TickClock& clock = own != nullptr       ? *own
                         : settings_.realtime ? static_cast<rt::TickClock&>(wall)
                                              : simulated;
  if (settings_.realtime) watchdog_->rearm(rt::monotonic_ns());
  tick::ShedSettings shed = settings_.shed;
  shed.has_realtime_priority = shed.has_realtime_priority || rt::has_realtime_priority();
  tick::ShedGovernor governor(clock.period_ns(), shed);
  math::Vec3 last_force = math::Vec3::Zero(), last_torque = math::Vec3::Zero();

  for (std::uint64_t n = 0;
       n < ticks && !stop_.load(std::memory_order_relaxed) && !device_->finished(); ++n) {
    if (between_ && !settings_.realtime && done_.load() % between_every_ == 0) between_();
    const rt::TickTime time = clock.wait();
    bool lost = false;
    if (settings_.realtime) {
      const std::int64_t now = rt::monotonic_ns();
      static_cast<void>(watchdog_->poll(now));  // the guard may have been late as well
      lost = watchdog_->tripped();
      if (lost) {
        watchdog_->rearm(now);
      } else {
        watchdog_->beat(now);
      }
    }
    const std::int64_t began = rt::monotonic_ns(), before = rt::thread_cpu_ns();
    const tick::TickRow& row = servo_->tick(lost);
    const std::int64_t took = rt::thread_cpu_ns() - before;
    servo_->note_timing(1e-3 * static_cast<double>(took), 1e-3 * static_cast<double>(time.late_ns));
    servo_->publish();

    stats_.add(took);
    ++shed_ticks_[static_cast<std::size_t>(servo_->shed())];
    if (settings_.realtime) {
      stats_.add_lateness(time.late_ns, clock.period_ns(), time.missed);
      governor.note(rt::monotonic_ns() - began, time.late_ns, time.missed);
      servo_->set_shed(governor.shed());
      shed_.store(governor.shed(), std::memory_order_relaxed);
    }
    last_force = row.contact.force;
    last_torque = row.contact.torque;
    count(row);
    if (!settings_.realtime && recorder_ != nullptr) recorder_->wait_for_room();
    if (!settings_.realtime && heat_ && n % kHeatWait == 0) heat_->settle();
  }
  // the last force fades within five milliseconds instead of dropping to zero at once
  const auto fade = static_cast<int>(std::ceil(5e-3 * settings_.servo.rate_hz));
  for (int n = 1; n <= fade; ++n) {
    static_cast<void>(clock.wait());
    const double left = 1 - static_cast<double>(n) / fade;
    device_->write_torque(last_torque * left);
    device_->write_force(last_force * left);
    if (!second_) continue;
    second_device_->write_torque(second_->row().contact.torque * left);
    second_device_->write_force(second_->row().contact.force * left);
  }
  settle();
  running_.store(false, std::memory_order_release);
}

void Session::count(const tick::TickRow& row) {
  const double force = row.contact.force.norm();
  peak_force_ = std::max(peak_force_, force);
  if (row.contact.touching) {
    force_sum_ += force;
    ++touching_;
  }
  flags_ |= row.contact.flags;
  ledger_ = row.ledger;
  done_.fetch_add(1, std::memory_order_relaxed);
  if (log_) log_->note(row);
}

// Rows that must still be recorded, and heat that must still be computed.
void Session::settle() {
  while (recorder_ != nullptr && servo_->bricks_to_write() > 0) {
    servo_->flush_bricks();
    recorder_->wait_for_room();
  }
  if (heat_) heat_->settle();
}

void Session::one_step() {
  const std::uint64_t n = done_.load(std::memory_order_relaxed);
  if (between_ && n % between_every_ == 0) between_();
  const tick::TickRow& row = servo_->tick(false);
  servo_->publish();
  ++shed_ticks_[static_cast<std::size_t>(servo_->shed())];
  count(row);
  if (recorder_ != nullptr) recorder_->wait_for_room();
  if (heat_ && n % kHeatWait == 0) heat_->settle();
}

std::uint64_t Session::step(std::uint64_t ticks, Progress& progress) {
  BURR_CHECK(!settings_.realtime && !running());
  std::uint64_t made = 0;
  while (made < ticks && !device_->finished() && !progress.cancelled()) {
    const std::uint64_t until = std::min(ticks, made + kStepsAtOnce);
    // what the thread `ahead` does in a session that runs
    bone_->commit_ahead();
    surface_->commit_ahead();
    servo_->commit_ahead();
    if (log_) log_->make_room(kStepsAtOnce);
    for (; made < until && !device_->finished(); ++made) one_step();
  }
  return made;
}

void Session::set_watch(rt::Latest<tick::TickRow>* watch) {
  watch_ = watch;
  servo_->set_watch(watch);
}

void Session::keep_in_memory(bool rows, bool voxels) {
  BURR_CHECK(!settings_.realtime && !running());
  servo_->set_brick_watch(nullptr);
  log_ = rows || voxels ? std::make_unique<RowLog>(*bone_, rows, voxels) : nullptr;
  if (voxels) servo_->set_brick_watch(&log_->crossed()->written());
}

edit::BoneState Session::bone_state() {
  BURR_CHECK(!running());
  memory_->note(servo_->undo_store());
  return memory_->now(*bone_);
}

Status Session::reset_to(const edit::BoneState& state) {
  BURR_CHECK(!running());
  const char* why = settings_.realtime     ? "is in real time"
                    : recorder_ != nullptr ? "is being recorded"
                    : second_device_       ? "has a second hand"
                    : heat_                ? "computes heat"
                                           : nullptr;
  if (why != nullptr)
    return error(Trouble::usage,
                 fmt::format("this session {}, so it cannot start over; make another one", why));
  if (settings_.law)
    if (Status begun = settings_.law->begin(); !begun) return begun;
  memory_->note(servo_->undo_store());
  memory_->put_back(state, servo_->writer());
  surface_->refresh_all();
  device_->close();
  if (Status opened = device_->open(); !opened) return opened;
  const auto found = servo_->take_found();
  servo_.reset();  // before the next one takes its memory
  servo_ = std::make_unique<tick::Servo>(*bone_, *surface_, *device_, settings_.servo, found);
  servo_->set_watch(watch_);
  moving_ = nullptr;
  if (log_) {
    log_->start_over();
    if (log_->crossed() != nullptr) servo_->set_brick_watch(&log_->crossed()->written());
  }
  done_ = 0;
  shed_ = tick::Shed::none;
  stats_.clear();
  shed_ticks_ = {};
  peak_force_ = force_sum_ = 0;
  touching_ = 0;
  flags_ = 0;
  ledger_ = {};
  return fine();
}

// Releases the force when no tick has come in time.
void Session::guard() {
  while (running_.load(std::memory_order_acquire)) {
    const double scale = watchdog_->poll(rt::monotonic_ns());
    if (scale < 1) {
      device_->scale_force(scale);
      if (second_) second_device_->scale_force(scale);
    }
    std::this_thread::sleep_for(std::chrono::nanoseconds(kGuardNs));
  }
}

// Reserves the memory that cutting will need before the servo needs it.
void Session::commit_ahead() {
  while (running_.load(std::memory_order_acquire)) {
    bone_->commit_ahead();
    surface_->commit_ahead();
    servo_->commit_ahead();
    std::this_thread::sleep_for(kAheadPause);
  }
}

void Session::begin(std::uint64_t ticks) {
  stop_ = false;
  running_ = true;
  thread_ = std::make_unique<rt::Thread>(
      rt::ThreadRequest{.name = "servo", .realtime = settings_.realtime},
      [this, ticks] { loop(ticks); });
  grant_ = thread_->grant();
  if (settings_.realtime)
    guard_ = std::make_unique<rt::Thread>(
        rt::ThreadRequest{.name = "guard", .realtime = true, .priority = 85}, [this] { guard(); });
  ahead_ = std::make_unique<rt::Thread>(rt::ThreadRequest{.name = "ahead", .stack_bytes = 0},
                                        [this] { commit_ahead(); });
}

void Session::run(double seconds, Progress& progress) {
  const auto ticks =
      static_cast<std::uint64_t>(std::llround(std::max(0.0, seconds) * settings_.servo.rate_hz));
  const std::uint64_t before = done_.load();
  begin(ticks);
  while (running_.load(std::memory_order_acquire)) {
    if (progress.cancelled()) stop_ = true;
    if (ticks > 0)
      progress.report(static_cast<double>(done_.load() - before) / static_cast<double>(ticks),
                      "milling");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  stop();
  progress.report(1, "milling");
}

void Session::start() {
  if (running_.load()) return;
  stop();
  begin(UINT64_MAX);
}

void Session::stop() {
  stop_ = true;
  if (thread_) thread_->join();
  thread_.reset();
  running_ = false;
  if (guard_) guard_->join();
  guard_.reset();
  if (ahead_) ahead_->join();
  ahead_.reset();
}

std::unique_ptr<volume::Bone> Session::bone_before() const {
  auto before = std::make_unique<volume::Bone>(bone_->grid(), bone_->tissues(), bone_->used_slots(),
                                               0, false);
  for (volume::BrickIndex brick = 0; brick < bone_->brick_count(); ++brick) {
    const volume::Field* field = bone_->brick_field(brick);
    if (field == nullptr) continue;
    const edit::KeptBrick* kept = servo_->undo_store().original_of(brick);
    const volume::TissueId* tissue = kept != nullptr ? kept->tissue : bone_->brick_tissue(brick);
    before->build_brick(brick, kept != nullptr ? kept->field.voxel : field, tissue);
  }
  before->pack();
  return before;
}

Outcome Session::outcome() const {
  Outcome outcome;
  outcome.ticks = done_.load();
  outcome.seconds = static_cast<double>(outcome.ticks) / settings_.servo.rate_hz;
  outcome.peak_force = peak_force_;
  outcome.mean_force = touching_ > 0 ? force_sum_ / static_cast<double>(touching_) : 0;
  outcome.ledger = ledger_;
  outcome.flags = flags_;
  if (heat_) outcome.heat_rows_lost = heat_->dropped();
  outcome.timing = stats_.summary();
  outcome.scheduling = grant_.sentence;
  outcome.shed_ticks = shed_ticks_;
  for (int step = 0; step < tick::kShedSteps; ++step)
    if (shed_ticks_[static_cast<std::size_t>(step)] > 0)
      outcome.most_shed = static_cast<tick::Shed>(step);
  return outcome;
}

}  // namespace burr::sim

#include "burr/device/openhaptics/touch.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <thread>
#include <utility>

#include "burr/device/bounded.h"

namespace burr::device::openhaptics {
namespace {

using math::Vec3;

// a library may report errors without end; stop reading them after this many
constexpr int kMostOldErrors = 32;
constexpr int kLostFrames = 500;  // bad frames in a row until the device is opened again
constexpr std::int64_t kSilentNs = 1'000'000'000;  // time without a call until it is opened again
constexpr int kCalibrationEvery = 100;             // frames between two checks while the
                                                   // calibration is missing
constexpr int kWarmFrames = 1000;                  // frames for which the warning about warm motors
                                                   // stays
constexpr double kFarthest = 1.0;                  // no arm is longer [m]
constexpr double kPremiumTorque = 0.188;           // CHAI3D's table [N m]
constexpr auto kKeep = std::chrono::milliseconds(500);
constexpr auto kLook = std::chrono::milliseconds(5);

// Limits of the models; an unknown model gets those of the weakest. Peak force and stiffness:
// CHAI3D, CPhantomDevices.cpp. Damping: CHAI3D's 4 N s/m for the Touch is used for all; CHAI3D
// allows the others 5. A Premium of any kind gets the limits of the Premium 1.5 6DOF, the safe
// side: CHAI3D allows a Premium 3.0 6DOF 22 N and 1000 N/m. Continuous force and radius: published
// figures whose source is not recorded. The radius limits nothing. (CHAI3D has other radii: 100 mm
// for Omni and Desktop, 120 mm for the Premium 1.5.)
struct Model {
  const char* part_of_name;
  double peak, continuous, stiffness, damping, radius;
};
constexpr Model kModels[] = {
    {"Premium", 8.5, 1.4, 800, 4, 190e-3},  {"Desktop", 7.9, 1.75, 1000, 4, 80e-3},
    {"Touch X", 7.9, 1.75, 1000, 4, 80e-3}, {"Omni", 3.3, 0.88, 700, 4, 75e-3},
    {"Touch", 3.3, 0.88, 400, 4, 75e-3},
};
constexpr const Model& kWeakest = kModels[std::size(kModels) - 1];

std::string string_of(const Hd& hd, Code what) {
  const char* said = hd.GetString(what);
  return said != nullptr ? said : "";
}

// The library has one scheduler for all devices; it runs while a device is open.
std::mutex& scheduler() {
  static std::mutex one;
  return one;
}
int running = 0;  // protected by scheduler()

}  // namespace

Touch::Touch(TouchSettings settings)
    : LinkedDevice(settings.link, settings.now), settings_(std::move(settings)) {}

Status Touch::open() {
  close();
  auto hd = load(settings_.hd_file);
  if (!hd) return hd.error();
  hd_ = *hd;
  auto started = start();
  if (!started) return started.error();
  spec_ = std::move(*started);
  stop_ = false;
  watch_thread_ = std::make_unique<rt::Thread>(rt::ThreadRequest{.name = "touch", .stack_bytes = 0},
                                               [this] { keep(); });
  return fine();
}

void Touch::close() {
  stop_ = true;
  if (watch_thread_) watch_thread_->join();
  watch_thread_.reset();
  end();
}

// ---- opening and closing the device

Result<DeviceSpec> Touch::start() {
  const std::lock_guard lock(scheduler());
  for (int n = 0; n < kMostOldErrors && hd_->GetError().code != kNoError; ++n) {
  }
  const char* name = settings_.name.empty() ? nullptr : settings_.name.c_str();
  handle_ = hd_->InitDevice(name);
  ErrorInfo fault = hd_->GetError();
  if (handle_ == kNoDevice && name == nullptr) {  // old drivers need the device's name
    handle_ = hd_->InitDevice("Default PHANToM");
    const ErrorInfo again = hd_->GetError();
    if (handle_ != kNoDevice) fault = again;
  }
  const std::string which =
      settings_.name.empty() ? "the default Touch" : "the Touch \"" + settings_.name + "\"";
  if (handle_ == kNoDevice || (fault.code != kNoError && !is_about_force(fault.code))) {
    if (handle_ != kNoDevice) hd_->DisableDevice(handle_);
    handle_ = kNoDevice;
    return error(
        Trouble::io,
        fault.code == kNoError
            ? fmt::format("{} was not found; plug it in, and check that Touch Setup lists it",
                          which)
            : fmt::format("{} cannot be used: {}", which, words(fault.code)));
  }
  hd_->MakeCurrentDevice(handle_);
  DeviceSpec spec = describe();
  peak_ = spec.peak_force;
  peak_torque_ = spec.peak_torque;
  turns_ = peak_torque_ > 0;
  hd_->Enable(kForceOutput);
  trouble_ = kNoError;
  bad_frames_ = 0;
  calibration_ = hd_->CheckCalibration();
  calibrate();
  called_ns_ = rt::monotonic_ns();
  loop_ = hd_->ScheduleAsynchronous(&Touch::tick, this, kPriority);
  if (running++ == 0) hd_->StartScheduler();
  for (int n = 0; n < kMostOldErrors; ++n) {
    const Code code = hd_->GetError().code;
    if (code == kNoError) break;
    if (is_about_force(code)) continue;
    hd_->Unschedule(loop_);
    if (--running == 0) hd_->StopScheduler();
    hd_->Disable(kForceOutput);
    hd_->DisableDevice(handle_);
    handle_ = kNoDevice;
    return error(Trouble::io, fmt::format("{} cannot be used: {}", which, words(code)));
  }
  return spec;
}

void Touch::end() {
  if (handle_ == kNoDevice) return;
  const std::lock_guard lock(scheduler());
  hd_->Unschedule(loop_);
  if (--running == 0) hd_->StopScheduler();
  hd_->MakeCurrentDevice(handle_);
  hd_->Disable(kForceOutput);
  hd_->DisableDevice(handle_);
  handle_ = kNoDevice;
}

// The limits from the table, but no more than the device itself reports.
DeviceSpec Touch::describe() const {
  const int axes = pushes();  // first, so that an error is its own
  const std::string model = string_of(*hd_, kModel);
  const Model* known = &kWeakest;
  for (const Model& one : kModels)
    if (model.find(one.part_of_name) != std::string::npos) {
      known = &one;
      break;
    }
  const auto at_most = [this](Code what, double table) {
    double said = 0;
    hd_->GetDoublev(what, &said);
    return std::isfinite(said) && said > 0.1 ? std::min(said, table) : table;
  };
  DeviceSpec spec;
  spec.name = model.empty() ? "Touch" : model;
  spec.serial = string_of(*hd_, kSerial);
  spec.simulated = false;
  spec.sensed = 6;
  spec.actuated = axes;
  spec.peak_torque = spec.actuated == 6 ? kPremiumTorque : 0;
  spec.peak_force = at_most(kNominalForce, known->peak);
  spec.continuous_force = std::min(spec.peak_force, at_most(kNominalContinuous, known->continuous));
  spec.thermal_budget = 5 * spec.peak_force * spec.peak_force;
  spec.max_stiffness = known->stiffness;
  spec.max_damping = known->damping;
  spec.workspace_radius = known->radius;
  spec.loss_timeout = settings_.link.loss_timeout;
  int rate = 0;
  hd_->GetIntegerv(kUpdateRate, &rate);
  spec.native_rate = rate >= 500 && rate <= 10'000 ? rate : 1000;
  spec.software = versions();
  return spec;
}

// An old library may not know these parameters, which is no problem; a device that is gone reports
// that again later.
std::string Touch::versions() const {
  const std::string hd = string_of(*hd_, kVersion), driver = string_of(*hd_, kDriver);
  for (int n = 0; n < kMostOldErrors && is_refused(hd_->GetError().code); ++n) {
  }
  return fmt::format("HD API{}{}", hd.empty() ? "" : " " + hd,
                     driver.empty() ? "" : ", driver " + driver);
}

// Number of degrees of freedom with motors; three if the device cannot say.
int Touch::pushes() const {
  int said = 0;
  hd_->GetIntegerv(kOutputDof, &said);
  const bool knows = hd_->GetError().code == kNoError;
  return knows && said == 6 ? 6 : 3;
}

// Twice a second: checks that the device is there, and opens a lost one again.
void Touch::keep() {
  auto next = std::chrono::steady_clock::now() + kKeep;
  while (!stop_.load(std::memory_order_relaxed)) {
    std::this_thread::sleep_for(kLook);
    if (std::chrono::steady_clock::now() < next) continue;
    next = std::chrono::steady_clock::now() + kKeep;
    const bool silent = rt::monotonic_ns() - called_ns_.load(std::memory_order_relaxed) > kSilentNs;
    if (handle_ != kNoDevice && !silent &&
        bad_frames_.load(std::memory_order_relaxed) < kLostFrames)
      continue;
    end();
    link_.mark_lost();
    const auto again = start();
    std::string trouble = again ? "" : again.error().text;
    if (again && (again->serial != spec_.serial || again->peak_force != spec_.peak_force)) {
      end();
      trouble =
          "Another Touch is plugged in now; plug in the one with which the session began, or begin "
          "a new session.";
    }
    const std::lock_guard lock(trouble_mutex_);
    found_ = std::move(trouble);
  }
}

// ---- the callback

unsigned Touch::tick(void* self) {
  static_cast<Touch*>(self)->exchange();
  return kContinue;
}

void Touch::note(Code code) BURR_RT {
  if (code == kWarmMotors) warm_frames_ = kWarmFrames;
  trouble_.store(code == kNoError && warm_frames_ > 0 ? Code{kWarmMotors} : code,
                 std::memory_order_relaxed);
  warm_frames_ = std::max(0, warm_frames_ - 1);
}

void Touch::calibrate() BURR_RT {
  if (calibration_.load(std::memory_order_relaxed) != kCalibrationUpdate) return;
  const Code style =
      hd_->CheckCalibrationStyle != nullptr ? hd_->CheckCalibrationStyle() : Code{kStyleAuto};
  if (style == kStyleInkwell) {
    calibration_ = kCalibrationByHand;
    return;
  }
  hd_->UpdateCalibration(style);
  calibration_ = hd_->CheckCalibration();
}

// False: the values read are no possible pose of a hand.
bool Touch::read(HandState& hand) BURR_RT {
  double transform[16] = {}, velocity[3] = {};
  int buttons = 0;
  hd_->GetDoublev(kTransform, transform);
  hd_->GetDoublev(kVelocity, velocity);
  hd_->GetIntegerv(kButtons, &buttons);
  const Eigen::Map<const Eigen::Matrix4d> world_from_stylus(transform);
  const math::Mat3 turn = world_from_stylus.topLeftCorner<3, 3>();
  hand.world_from_tool.p = 1e-3 * world_from_stylus.topRightCorner<3, 1>();
  hand.velocity = 1e-3 * Eigen::Map<const Vec3>(velocity);
  hand.buttons = static_cast<unsigned>(buttons) & ~kOwnBits;
  if (!turn.allFinite() || !hand.world_from_tool.p.allFinite() || !hand.velocity.allFinite())
    return false;
  if (std::abs(turn.determinant() - 1) > 0.1 || hand.world_from_tool.p.norm() > kFarthest)
    return false;
  hand.world_from_tool.q = math::Quat(turn).normalized();  // the library's matrix has small errors
  return true;
}

void Touch::exchange() BURR_RT {
  called_ns_.store(rt::monotonic_ns(), std::memory_order_relaxed);
  hd_->MakeCurrentDevice(handle_);
  hd_->BeginFrame(handle_);
  if (calibration_.load(std::memory_order_relaxed) != kCalibrationOk &&
      frames_++ % kCalibrationEvery == 0) {
    calibration_ = hd_->CheckCalibration();
    calibrate();
  }
  HandState hand;
  const bool believed = read(hand);
  const bool ready = calibration_.load(std::memory_order_relaxed) == kCalibrationOk;
  hand.valid = believed && ready && bad_frames_.load(std::memory_order_relaxed) == 0;
  const Vec3 force = bounded(link_.exchange(hand), peak_);
  hd_->SetDoublev(kForce, force.data());
  if (turns_) {
    const Vec3 torque = 1e3 * bounded(link_.torque(), peak_torque_);
    hd_->SetDoublev(kTorque, torque.data());
  }
  hd_->EndFrame(handle_);

  Code worst = kNoError;
  for (int n = 0; n < kMostOldErrors; ++n) {
    const Code code = hd_->GetError().code;
    if (code == kNoError) break;
    if (turns_ && is_refused(code)) {  // it takes no torque after all
      turns_ = false;
      continue;
    }
    if (worst == kNoError || worst == kWarmMotors) worst = code;
  }
  note(worst);
  if (worst == kNoError || worst == kWarmMotors) {
    bad_frames_.store(0, std::memory_order_relaxed);
  } else {
    // a force that the device released returns only through the ramp, as with a lost hand
    bad_frames_.fetch_add(1, std::memory_order_relaxed);
    link_.mark_lost();
  }
}

// ---- for the user

std::string Touch::trouble() const {
  {
    const std::lock_guard lock(trouble_mutex_);
    if (!found_.empty()) return found_;
  }
  if (const Code code = trouble_.load(std::memory_order_relaxed); code != kNoError)
    return words(code);
  if (calibration_.load(std::memory_order_relaxed) == kCalibrationByHand)
    return "The Touch must be calibrated: put its stylus into the inkwell for a moment.";
  if (calibration_.load(std::memory_order_relaxed) == kCalibrationUpdate)
    return "The Touch is being calibrated: move its stylus through its whole workspace.";
  return {};
}

}  // namespace burr::device::openhaptics

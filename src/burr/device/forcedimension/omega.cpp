#include "burr/device/forcedimension/omega.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

namespace burr::device::forcedimension {
namespace {

using math::Mat3;
using math::Vec3;

constexpr double kFarthest = 1.0;                     // no arm is longer [m]
constexpr int kMostErrors = 500;                      // failed reads in a row until the device is
                                                      // opened again
constexpr std::int64_t kLookEvery = 50'000'000;       // between two looks at the device's status
                                                      // [ns]
constexpr double kOpenAngle = 0.3, kOpenGap = 15e-3;  // a gripper opens at least this far [rad, m]
constexpr double kRest = 0.8;                         // share of the opening above which the pedal
                                                      // is zero
constexpr int kMostDevices = 64;
constexpr unsigned char kWatchdog = 240;  // 30 ms, of the 32 ms that the number can hold [1/8 ms]

// Limits of the models (chai3d's table). For all but the Falcon, the makers' sheets call the peak
// force continuous. An unknown model gets the limits of the weakest.
struct Model {
  int type;
  const char* name;
  double peak, continuous, stiffness, damping, radius;
};
constexpr double kTorque = 0.2;  // of a wrist with motors; from the table, for the sigma.7 [N m]
constexpr Model kModels[] = {
    {33, "omega.3", 12, 12, 5000, 30, 75e-3},    {34, "omega.6", 12, 12, 5000, 30, 75e-3},
    {36, "omega.6", 12, 12, 5000, 30, 75e-3},    {35, "omega.7", 12, 12, 5000, 30, 75e-3},
    {37, "omega.7", 12, 12, 5000, 30, 75e-3},    {63, "delta.3", 20, 20, 5000, 30, 150e-3},
    {206, "sigma.3", 12, 12, 4000, 30, 75e-3},   {104, "sigma.7", 12, 12, 4000, 30, 75e-3},
    {105, "sigma.7", 12, 12, 4000, 30, 75e-3},   {203, "lambda.3", 12, 12, 8000, 30, 112e-3},
    {131, "lambda.6", 12, 12, 8000, 30, 112e-3}, {132, "lambda.6", 12, 12, 8000, 30, 112e-3},
    {108, "lambda.7", 12, 12, 8000, 30, 112e-3}, {109, "lambda.7", 12, 12, 8000, 30, 112e-3},
    {60, "Falcon", 8, 3, 3000, 20, 40e-3},
};
constexpr Model kUnknown = {0, "Force Dimension device", 8, 3, 3000, 20, 40e-3};

const Model& model_of(int type) {
  const auto* known = std::find_if(std::begin(kModels), std::end(kModels),
                                   [type](const Model& one) { return one.type == type; });
  return known != std::end(kModels) ? *known : kUnknown;
}

// The devices that are open in this process: the library would open one a second time. Only one
// thread at a time may open or close, because the library goes through all devices.
std::mutex& opening() {
  static std::mutex one;
  return one;
}
std::set<std::pair<const void*, int>>& taken() {  // protected by opening()
  static std::set<std::pair<const void*, int>> ids;
  return ids;
}

// From the library's frame (x to the user, y right, z up) to ours (x right, y up, z to the user).
Vec3 ours(double x, double y, double z) BURR_RT { return {y, z, x}; }

const char* force_off_words(int cause) BURR_RT {
  switch (cause) {
    case 1:
      return "released the force because its force button was pressed; press it again.";
    case 2:
      return "was moved too fast and released the force; lift it from the bone and press its force "
             "button.";
    case 3:
      return "received no command for too long and released the force (watchdog); press its force "
             "button, and close other programs.";
    case 4:
      return "released the force because a program asked for it; close other programs that use it, "
             "and begin again.";
    case 5:
      return "lost its USB connection for a moment and released the force; press its force button.";
    case 6:
      return "feels no hand and released the force (dead-man switch); hold its handle.";
    default:
      return "released the force; press its force button.";
  }
}

}  // namespace

// ---- finding and preparing the device

Result<DeviceSpec> Omega::connect() {
  disconnect();
  if (!(settings_.rate >= 500 && settings_.rate <= 4000))
    return error(
        Trouble::usage,
        fmt::format("a rate of {} Hz is out of range for a Force Dimension device; use 500 to 4000",
                    settings_.rate));
  auto dhd = load(settings_.dhd_file);
  if (!dhd) return dhd.error();
  dhd_ = *dhd;

  const std::lock_guard lock(opening());
  Status found = find();
  if (!found) return found.error();
  DeviceSpec spec = describe();
  name_ = spec.name;
  Status ready = home();
  if (ready) ready = prepare(spec);
  if (!ready) {
    static_cast<void>(dhd_->EnableForce(0, static_cast<char>(id_)));  // homing leaves the motors on
    release_force(id_);
    id_ = -1;
    return ready.error();
  }
  serial_ = serial_of(id_);
  was_ready_ = true;
  return spec;
}

// Opens the wanted device into id_. If it was open before and has a serial number, it must be the
// same one: an index is only the order in which devices were plugged in.
Status Omega::find() {
  const int count = std::min(dhd_->GetDeviceCount(), kMostDevices);
  if (count <= 0)
    return error(Trouble::io,
                 "no Force Dimension device was found; plug it in, switch it on, and allow your "
                 "user to open it with a udev rule (docs/use/devices/force_dimension.md)");
  const int serial = settings_.serial >= 0 ? settings_.serial : serial_;
  if (serial < 0) {
    if (settings_.index < 0 || settings_.index >= count)
      return error(Trouble::usage,
                   fmt::format("there is no Force Dimension device {}; {} {} plugged in, counted "
                               "from 0",
                               settings_.index, count, count == 1 ? "is" : "are"));
    const char* why = nullptr;
    id_ = open(settings_.index, why);
    if (id_ >= 0) return fine();
    return error(Trouble::io, fmt::format("Force Dimension device {} {}", settings_.index, why));
  }
  if (dhd_->GetSerialNumber == nullptr)
    return error(Trouble::io, fmt::format("{}: this library does not report serial numbers; leave "
                                          "out the number, or install a newer Force Dimension SDK",
                                          dhd_->file));
  int locked = 0;
  for (int index = 0; index < count; ++index) {
    const char* why = nullptr;
    id_ = open(index, why);
    if (id_ < 0) {
      ++locked;
      continue;
    }
    if (serial_of(id_) == serial) return fine();
    release_force(id_);
    id_ = -1;
  }
  return error(
      Trouble::io,
      fmt::format("the Force Dimension device with serial number {} was not found{}; plug it in, "
                  "switch it on, and close other programs that use it",
                  serial,
                  locked > 0 ? fmt::format(" ({} of {} cannot be opened)", locked, count) : ""));
}

Result<DeviceList> Omega::list_devices(const OmegaSettings& settings) {
  auto dhd = load(settings.dhd_file);
  if (!dhd) return dhd.error();
  Omega one(settings);
  one.dhd_ = *dhd;
  const std::lock_guard lock(opening());
  DeviceList all;
  const int count = std::min(one.dhd_->GetDeviceCount(), kMostDevices);
  for (int index = 0; index < count; ++index) {
    const char* why = nullptr;
    const int id = one.open(index, why);
    const int serial = id >= 0 ? one.serial_of(id) : -1;
    if (id >= 0) one.release_force(id);
    if (serial >= 0)
      all.serials.push_back(serial);
    else
      ++all.nameless;
  }
  return all;
}

// Returns -1 if the device cannot be opened.
int Omega::open(int index, const char*& why) const {
  const char which = static_cast<char>(index);
  const int id = dhd_->homes() ? dhd_->DrdOpenID(which) : dhd_->OpenID(which);
  if (id < 0) {
    why = words(dhd_->ErrorGetLast());
    return -1;
  }
  if (taken().emplace(dhd_->library, id).second) return id;
  why = "is already in use by this burr; close that session, or choose another device.";
  return -1;
}

Status Omega::home() {
  const char id = static_cast<char>(id_);
  if (!dhd_->homes()) {
    if (settings_.is_homed) return fine();
    return error(
        Trouble::io,
        fmt::format("{}: burr cannot find out whether {} is homed (libdrd is missing); install "
                    "libdrd of the same SDK beside it, or home the arm by hand and use `is_homed`",
                    dhd_->file, name_));
  }
  if (dhd_->DrdIsInitialized(id)) return fine();
  if (was_ready_)
    return error(Trouble::io, fmt::format("{} is no longer homed; begin a new session, with "
                                          "`home_allowed` if its arm may move by itself",
                                          name_));
  if (!settings_.home_allowed)
    return error(Trouble::io,
                 fmt::format("{} is not homed: clear the space around its arm, take your hand off "
                             "it, and allow it to move by itself with `home_allowed`",
                             name_));
  const bool homed = !failed(dhd_->DrdAutoInit(id));
  const int trouble = homed ? kNoError : dhd_->ErrorGetLast();
  const bool stopped = !failed(dhd_->DrdStop(true, id));  // stops the regulation in any case
  if (homed && stopped && dhd_->DrdIsInitialized(id)) return fine();
  return error(Trouble::io, fmt::format("{} could not be homed: it {}", name_, words(trouble)));
}

// Switches the forces on last, after all limits are set.
Status Omega::prepare(const DeviceSpec& spec) {
  to_ = static_cast<char>(id_);
  peak_ = spec.peak_force;
  peak_torque_ = spec.peak_torque;
  torque_ = Vec3::Zero();
  wrist_ = dhd_->HasWrist(to_);
  gripper_ = nullptr;
  if (dhd_->HasGripper(to_)) {
    gripper_ = dhd_->GetGripperAngleRad != nullptr ? dhd_->GetGripperAngleRad : dhd_->GetGripperGap;
    open_ = dhd_->GetGripperAngleRad != nullptr ? kOpenAngle : kOpenGap;
  }
  armed_ = off_ = false;
  seen_power_ = seen_connected_ = seen_force_ = false;
  errors_ = 0;
  looked_ns_ = INT64_MIN;
  note(read_trouble_, nullptr);
  note(write_trouble_, nullptr);
  note(status_trouble_, nullptr);

  // write() limits too; models without these functions go on
  if (dhd_->SetMaxForce != nullptr) static_cast<void>(dhd_->SetMaxForce(peak_, to_));
  if (dhd_->SetMaxTorque != nullptr && peak_torque_ > 0)
    static_cast<void>(dhd_->SetMaxTorque(peak_torque_, to_));
  watch();
  static_cast<void>(dhd_->SetGravityCompensation(1, to_));
  static_cast<void>(dhd_->SetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, to_));
  if (failed(dhd_->EnableForce(1, to_)))
    return error(Trouble::io, fmt::format("{} {}", name_, words(dhd_->ErrorGetLast())));
  return fine();
}

// If this program dies or hangs, the arm's own firmware switches the forces off when none has been
// written for this time. A shorter watchdog that is already set stays. In some versions the call
// needs the library's expert mode, which is switched off again at once.
void Omega::watch() const {
  if (dhd_->SetWatchdog == nullptr) return;
  unsigned char is = 0;
  const bool known = dhd_->GetWatchdog != nullptr && !failed(dhd_->GetWatchdog(&is, to_));
  if (known && is > 0 && is <= kWatchdog) return;
  if (!failed(dhd_->SetWatchdog(kWatchdog, to_)) || dhd_->EnableExpertMode == nullptr ||
      dhd_->DisableExpertMode == nullptr)
    return;
  if (failed(dhd_->EnableExpertMode())) return;
  static_cast<void>(dhd_->SetWatchdog(kWatchdog, to_));
  static_cast<void>(dhd_->DisableExpertMode());
}

DeviceSpec Omega::describe() const {
  const char id = static_cast<char>(id_);
  const Model& model = model_of(dhd_->GetSystemType(id));
  const char* name = dhd_->GetSystemName != nullptr ? dhd_->GetSystemName(id) : nullptr;
  const int serial = serial_of(id_);
  DeviceSpec spec;
  spec.name = name != nullptr && *name != '\0' ? name : model.name;
  if (dhd_->IsLeftHanded(id) && spec.name.find("left") == std::string::npos)
    spec.name += " (left hand)";
  spec.serial = serial >= 0 ? std::to_string(serial) : "";
  spec.simulated = false;
  spec.sensed = dhd_->HasWrist(id) ? 6 : 3;
  const bool turns =
      spec.sensed == 6 && dhd_->HasActiveWrist != nullptr && dhd_->HasActiveWrist(id);
  spec.actuated = turns ? 6 : 3;
  spec.peak_torque = turns ? kTorque : 0;
  spec.peak_force = model.peak;
  spec.continuous_force = model.continuous;
  spec.thermal_budget = 5 * model.peak * model.peak;
  spec.max_stiffness = model.stiffness;
  spec.max_damping = model.damping;
  spec.workspace_radius = model.radius;
  spec.native_rate = settings_.rate;
  if (!dhd_->version.empty()) spec.software = "SDK " + dhd_->version;
  return spec;
}

int Omega::serial_of(int id) const {
  unsigned short serial = 0;
  if (dhd_->GetSerialNumber == nullptr ||
      failed(dhd_->GetSerialNumber(&serial, static_cast<char>(id))))
    return -1;
  return serial != 0 ? serial : -1;  // -1 for a device that was never given a number
}

void Omega::release_force(int id) {
  static_cast<void>(dhd_->homes() ? dhd_->DrdClose(static_cast<char>(id))
                                  : dhd_->Close(static_cast<char>(id)));
  taken().erase({dhd_->library, id});
}

void Omega::disconnect() {
  if (id_ < 0) return;
  static_cast<void>(dhd_->SetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, to_));
  static_cast<void>(dhd_->EnableForce(0, to_));
  const std::lock_guard lock(opening());  // only now, because another device may be homing
  release_force(id_);
  id_ = -1;
}

// ---- the exchange

void Omega::note(const char*& what, const char* words) BURR_RT {
  if (what != words) ++why_revision_;
  what = words;
}

// Handles a failed call. Returns whether the device may still be there.
bool Omega::tolerate(const char*& trouble) BURR_RT {
  const int code = dhd_->ErrorGetLast();
  note(trouble, words(code));
  return !is_gone(code);
}

// Reads the device's status. A status bit that was never good is never reported (some models fill
// in nothing). False: the device says that it is gone.
bool Omega::read_status() BURR_RT {
  const std::int64_t now = settings_.now();
  if (dhd_->GetStatus == nullptr || (looked_ns_ != INT64_MIN && now - looked_ns_ < kLookEvery))
    return true;
  looked_ns_ = now;
  int status[kMostStatus] = {};
  if (failed(dhd_->GetStatus(status, to_))) return true;  // read() will report what is wrong
  const int cause = status[kStatusForceOffCause];
  seen_power_ = seen_power_ || status[kStatusPower] != 0;
  seen_connected_ = seen_connected_ || status[kStatusConnected] != 0;
  seen_force_ = seen_force_ || status[kStatusForce] != 0;
  if (seen_connected_ && status[kStatusConnected] == 0) {
    note(status_trouble_, "is no longer connected; check its cable and its power.");
    return false;
  }
  const bool unpowered = seen_power_ && status[kStatusPower] == 0;
  const bool forceless = status[kStatusForce] == 0 && (seen_force_ || cause != 0);
  off_ = unpowered || forceless;
  note(status_trouble_, unpowered   ? "has no power; switch it on."
                        : forceless ? force_off_words(cause)
                                    : nullptr);
  return true;
}

// The gripper as pedal: closed is full, open is none. A gripper that is closed from the start
// counts only after it has been opened.
void Omega::read_gripper(HandState& hand) BURR_RT {
  double apart = 0;
  if (gripper_ == nullptr || failed(gripper_(&apart, to_)) || !std::isfinite(apart)) return;
  apart = std::abs(apart);  // a left-handed device counts the other way
  open_ = std::max(open_, std::min(apart, 2.0));
  const double pedal = std::clamp(1 - apart / (kRest * open_), 0.0, 1.0);
  armed_ = armed_ || pedal == 0;
  if (armed_) hand.pedal = pedal;
}

Wire::Read Omega::read(HandState& hand) BURR_RT {
  double x = 0, y = 0, z = 0, frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int code = wrist_ ? dhd_->GetPositionAndOrientationFrame(&x, &y, &z, frame, to_)
                          : dhd_->GetPosition(&x, &y, &z, to_);
  hand.valid = false;
  if (failed(code))
    return tolerate(read_trouble_) && ++errors_ < kMostErrors ? Read::hand : Read::lost;
  if (!read_status()) return Read::lost;
  errors_ = 0;

  // rows and columns in our order: the library's y, z, x
  Mat3 turn;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) turn(i, k) = frame[(i + 1) % 3][(k + 1) % 3];
  const Vec3 place = ours(x, y, z);
  double vx = 0, vy = 0, vz = 0;
  // the function fails until it has read the hand twice; the velocity is zero until then
  const bool knows_speed = !failed(dhd_->GetLinearVelocity(&vx, &vy, &vz, to_));
  hand.velocity = knows_speed ? ours(vx, vy, vz) : Vec3(Vec3::Zero());
  hand.buttons = dhd_->GetButtonMask(to_) & ~kOwnBits;
  read_gripper(hand);

  const bool sound = turn.allFinite() && place.allFinite() && hand.velocity.allFinite() &&
                     place.norm() < kFarthest && std::abs(turn.determinant() - 1) < 0.1 &&
                     (turn * turn.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 0.1;
  note(read_trouble_,
       sound ? nullptr : "reports an impossible position; move it, and home it again.");
  if (!sound) return Read::hand;
  hand.world_from_tool = {place, math::Quat(turn).normalized()};
  hand.valid = !off_ && write_trouble_ == nullptr;
  return Read::hand;
}

bool Omega::write(const Vec3& force) BURR_RT {
  const Vec3 push = off_ ? Vec3(Vec3::Zero()) : bounded(force, peak_);
  const Vec3 turn = off_ ? Vec3(Vec3::Zero()) : bounded(torque_, peak_torque_);
  const int code = dhd_->SetForceAndTorqueAndGripperForce(push.z(), push.x(), push.y(), turn.z(),
                                                          turn.x(), turn.y(), 0, to_);
  // not opened again, however long this lasts: that would switch on what the user switched off
  if (failed(code)) return tolerate(write_trouble_);
  note(write_trouble_, nullptr);
  return true;
}

std::string Omega::why() const {
  for (const char* words : {read_trouble_, write_trouble_, status_trouble_})
    if (words != nullptr) return name_ + " " + words;
  return {};
}

}  // namespace burr::device::forcedimension

// Built as four libraries: libdrd; with FAKE_DHD_OLD without GetStatus and newer functions; with
// FAKE_DHD_ALONE a libdhd without drd; with FAKE_DHD_BROKEN without a function that is needed.
#include "device/fake/fake_dhd.h"

#include <time.h>

#include <cmath>
#include <cstdlib>
#include <mutex>

#include "device/fake/own_way.h"

namespace burr::test {
namespace {

constexpr int kFirstId = 5;  // an id is not an index, whatever the real library does

// FAKE_DHD_SERIALS, "1001,1002": for a program that a test runs; exactly these devices are there.
void plug_in(FakeDhd& all) {
  const char* serials = std::getenv("FAKE_DHD_SERIALS");
  if (serials == nullptr) return;
  for (FakeArm& arm : all.arm) {
    char* end = nullptr;
    const long serial = std::strtol(serials, &end, 10);
    arm.present = end != serials;
    arm.serial = static_cast<unsigned short>(serial);
    serials = *end == ',' ? end + 1 : end;
  }
}

FakeDhd& state() {
  static FakeDhd one;
  static const bool plugged = (plug_in(one), true);
  static_cast<void>(plugged);
  return one;
}

thread_local int last_error = 0;

int fail(int code) {
  last_error = code;
  return -1;
}

void misuse(const char* what) {
  if (state().misuse++ == 0) state().misused = what;
}

std::int64_t now_ns() {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Indices count the devices that are plugged in, without gaps.
FakeArm* at_index(int index, int& id) {
  for (std::size_t n = 0; n < state().arm.size(); ++n)
    if (state().arm[n].present && index-- == 0) {
      id = kFirstId + static_cast<int>(n);
      return &state().arm[n];
    }
  return nullptr;
}

FakeArm* open_one(int id, const char* what) {
  const int n = id - kFirstId;
  if (id < kFirstId || n >= static_cast<int>(state().arm.size()) ||
      !state().arm[static_cast<std::size_t>(n)].open) {
    misuse(what);
    return nullptr;
  }
  return &state().arm[static_cast<std::size_t>(n)];
}

int done(const FakeArm& arm) { return arm.present ? arm.code : fail(2); }

int open_index(int index) {
  const std::lock_guard lock(state().lock);
  int id = -1;
  FakeArm* arm = at_index(index, id);
  if (arm == nullptr) return fail(5);
  if (arm->in_use) return fail(20);
  if (arm->open) return id;  // as the real one
  arm->open = true;
  arm->next_ns = 0;
  ++arm->opened;
  return id;
}

int close_id(int id) {
  const std::lock_guard lock(state().lock);
  FakeArm* arm = open_one(id, "closed what was not open");
  if (arm == nullptr) return fail(15);
  if (arm->present && arm->force_on) misuse("closed with its forces on");
  if (arm->present && !arm->forces.empty() &&
      (arm->forces.back().newton != std::array<double, 3>{} ||
       arm->forces.back().newton_metre != std::array<double, 3>{}))
    misuse("closed while it pushed");
  arm->open = arm->force_on = arm->gravity = false;
  ++arm->closed;
  return 0;
}

// For measurements with the whole program: with FAKE_DHD_MOTION=1 the hand moves by itself and
// presses the button, starting with the first reading after it was opened; FAKE_DHD_RATE=4000 sets
// the rate.
void move_by_itself(FakeArm& arm) {
  static const char* const motion = std::getenv("FAKE_DHD_MOTION");
  static const char* const rate = std::getenv("FAKE_DHD_RATE");
  if (motion == nullptr || *motion != '1') return;
  static std::uint64_t opened = 0;
  static std::int64_t began_ns = 0;
  if (opened != arm.opened) {
    opened = arm.opened;
    began_ns = now_ns();
  }
  if (rate != nullptr) arm.rate = std::atoi(rate);
  const math::Vec3 hand = own_way(1e-9 * static_cast<double>(now_ns() - began_ns));
  arm.place = {hand.z(), hand.x(), hand.y()};
  arm.buttons = 1;
}

int read_place(FakeArm& arm, double* x, double* y, double* z) {
  ++arm.reads;
  move_by_itself(arm);
  if (!arm.present) return fail(2);
  if (arm.read_error != 0) return fail(arm.read_error);
  *x = arm.place[0];
  *y = arm.place[1];
  *z = arm.place[2];
  arm.answers.tell(arm.place.data());
  return arm.code;
}

[[maybe_unused]] void put(FakeArm& arm, double x, double y, double z,
                          const std::array<double, 3>& torque) {
  const double twist =
      std::sqrt(torque[0] * torque[0] + torque[1] * torque[1] + torque[2] * torque[2]);
  if (!std::isfinite(twist)) misuse("a torque that is no number");
  if (twist > 0 && !arm.active_wrist) misuse("a torque on a wrist without motors");
  if (twist > 0 && (!arm.force_on || arm.regulates)) misuse("a torque while forces are off");
  if (!(twist <= arm.largest_torque)) arm.largest_torque = twist;
  const double size = std::sqrt(x * x + y * y + z * z);
  if (!std::isfinite(size)) misuse("a force that is no number");
  if (size > 0 && !arm.force_on) misuse("a force while forces are off");
  if (size > 0 && arm.regulates) misuse("a force while it moves by itself");
  if (!(size <= arm.largest_force)) arm.largest_force = size;
  if (arm.forces.capacity() < 8192) arm.forces.reserve(8192);
  if (arm.forces.size() >= 8192) arm.forces.erase(arm.forces.begin(), arm.forces.begin() + 4096);
  arm.forces.push_back({{x, y, z}, torque, now_ns()});
  arm.answers.take(arm.forces.back().newton.data());
  ++arm.writes;
}

}  // namespace
}  // namespace burr::test

using namespace burr::test;
#define DHD extern "C" __attribute__((visibility("default")))
using Lock = std::lock_guard<FakeLock>;

DHD FakeDhd* fake_dhd() { return &state(); }

DHD int dhdErrorGetLast() { return last_error; }

DHD int dhdGetDeviceCount() {
  const Lock lock(state().lock);
  int count = 0;
  for (const FakeArm& arm : state().arm) count += arm.present ? 1 : 0;
  return count;
}

DHD int dhdOpenID(char index) { return open_index(index); }
DHD int dhdClose(char id) { return close_id(id); }

DHD int dhdGetSystemType(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr ? arm->type : fail(15);
}

DHD bool dhdIsLeftHanded(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr && arm->left;
}

DHD bool dhdHasWrist(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr && arm->wrist;
}

DHD bool dhdHasActiveWrist(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr && arm->active_wrist;
}

DHD bool dhdHasGripper(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr && arm->gripper;
}

DHD int dhdEnableForce(unsigned char on, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "forces of what is not open");
  if (arm == nullptr) return fail(15);
  if (on != 0 && !arm->initialized) misuse("forces on of an arm that is not homed");
  if (on != 0 && !arm->gravity) misuse("forces on before the arm bears its own weight");
  if (arm->present) arm->force_on = on != 0;
  return done(*arm);
}

DHD int dhdSetGravityCompensation(int on, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "weight of what is not open");
  if (arm == nullptr) return fail(15);
  arm->gravity = on == 1;
  return done(*arm);
}

DHD int dhdGetPosition(double* x, double* y, double* z, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "read what is not open");
  return arm != nullptr ? read_place(*arm, x, y, z) : fail(15);
}

DHD int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double frame[3][3],
                                          char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "read what is not open");
  if (arm == nullptr) return fail(15);
  if (!arm->wrist) return fail(6);
  const int code = read_place(*arm, x, y, z);
  for (std::size_t n = 0; code >= 0 && n < 9; ++n) frame[n / 3][n % 3] = arm->frame[n];
  return code;
}

DHD int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "read what is not open");
  if (arm == nullptr) return fail(15);
  if (arm->velocity_error != 0) return fail(arm->velocity_error);
  *x = arm->velocity[0];
  *y = arm->velocity[1];
  *z = arm->velocity[2];
  return done(*arm);
}

DHD unsigned dhdGetButtonMask(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "read what is not open");
  return arm != nullptr ? arm->buttons : 0;
}

#ifndef FAKE_DHD_BROKEN
DHD int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double a, double b,
                                            double c, double grip, char id) {
  std::int64_t until = 0;
  int code = 0;
  {
    const Lock lock(state().lock);
    FakeArm* arm = open_one(id, "force on what is not open");
    if (arm == nullptr) return fail(15);
    if (grip != 0) misuse("a force on the gripper that nobody computed");
    if (!arm->present) return fail(2);
    if (arm->write_error != 0) return fail(arm->write_error);
    const std::int64_t came = now_ns();
    if (arm->watches && arm->watchdog > 0 && arm->force_on && arm->written_ns > 0 &&
        came - arm->written_ns > std::int64_t{125'000} * arm->watchdog)
      arm->off_cause = 3;
    arm->written_ns = came;
    put(*arm, x, y, z, {a, b, c});
    code = arm->code;
    if (arm->rate > 0) {
      const std::int64_t now = now_ns();
      arm->next_ns = std::max(now, arm->next_ns + 1'000'000'000 / arm->rate);
      until = arm->next_ns + std::int64_t{1'000'000} * arm->stall_ms;
      arm->stall_ms = 0;
    }
  }
  timespec wake = {};
  wake.tv_sec = until / 1'000'000'000;
  wake.tv_nsec = until % 1'000'000'000;
  if (until != 0) clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr);
  return code;
}
#endif

DHD void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
#if defined(FAKE_DHD_OLD)
  *minor = 5;
#else
  *minor = 17;
#endif
  *release = 1;
  *revision = 0;
}

#ifndef FAKE_DHD_OLD
DHD const char* dhdGetSystemName(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr ? arm->name.c_str() : nullptr;
}

DHD int dhdGetAvailableCount() { return dhdGetDeviceCount(); }

DHD int dhdGetSerialNumber(unsigned short* serial, char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  if (arm == nullptr) return fail(15);
  *serial = arm->serial;
  return done(*arm);
}

DHD int dhdGetStatus(int* status, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "asked what is not open");
  if (arm == nullptr) return fail(15);
  ++arm->asked;
  for (int n = 0; n < 17; ++n) status[n] = 0;
  if (!arm->tells) return 0;
  status[0] = arm->power;
  status[1] = arm->connected;
  status[2] = 1;
  status[5] = arm->force_on && arm->off_cause == 0 ? 1 : 0;
  status[10] = arm->gravity ? 1 : 0;
  status[14] = arm->off_cause;
  return done(*arm);
}

DHD int dhdSetWatchdog(unsigned char eighths, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "told what is not open");
  if (arm == nullptr) return fail(15);
  if (state().guards_watchdog && !state().expert) return fail(9);
  arm->watchdog = eighths;
  return done(*arm);
}

DHD int dhdGetWatchdog(unsigned char* eighths, char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  if (arm == nullptr) return fail(15);
  *eighths = static_cast<unsigned char>(arm->watchdog);
  return done(*arm);
}

DHD int dhdEnableExpertMode() {
  const Lock lock(state().lock);
  state().expert = true;
  return 0;
}

DHD int dhdDisableExpertMode() {
  const Lock lock(state().lock);
  state().expert = false;
  return 0;
}

DHD int dhdSetMaxForce(double newton, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "asked what is not open");
  if (arm == nullptr) return fail(15);
  if (arm->force_on && arm->homed == 0) misuse("the largest force, once forces are on");
  arm->most_force = newton;
  return done(*arm);
}

DHD int dhdSetMaxTorque(double newton_metre, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "asked what is not open");
  if (arm == nullptr) return fail(15);
  if (arm->force_on && arm->homed == 0) misuse("the largest torque, once forces are on");
  arm->most_torque = newton_metre;
  return done(*arm);
}
#endif

DHD int dhdGetGripperAngleRad(double* angle, char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "read what is not open");
  if (arm == nullptr || !arm->gripper) return fail(6);
  *angle = arm->apart;
  return done(*arm);
}

#ifndef FAKE_DHD_ALONE
DHD int drdOpenID(char index) { return open_index(index); }
DHD int drdClose(char id) { return close_id(id); }

DHD bool drdIsInitialized(char id) {
  const Lock lock(state().lock);
  const FakeArm* arm = open_one(id, "asked what is not open");
  return arm != nullptr && arm->initialized;
}

DHD int drdAutoInit(char id) {
  std::unique_lock lock(state().lock);
  FakeArm* arm = open_one(id, "homed what is not open");
  if (arm == nullptr) return fail(15);
  ++arm->homed;
  arm->regulates = arm->force_on = true;
  const std::int64_t start = now_ns();
  while (arm->homes_after >= 0 &&
         state().arm[static_cast<std::size_t>(arm->homes_after)].force_on) {
    if (now_ns() - start > 20'000'000'000) return fail(7);
    lock.unlock();
    std::this_thread::yield();
    lock.lock();
  }
  if (!arm->can_home) return fail(7);
  arm->initialized = true;
  return 0;
}

DHD int drdStop(bool leave_force_on, char id) {
  const Lock lock(state().lock);
  FakeArm* arm = open_one(id, "stopped what is not open");
  if (arm == nullptr) return fail(15);
  if (!leave_force_on) misuse("brakes on");
  arm->regulates = false;
  return 0;
}
#endif

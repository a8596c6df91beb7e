// device/forcedimension/dhd.h - the functions of Force Dimension's libraries that burr calls,
// loaded at run time.
//
// The declarations are our own, from published names and constants (SDK 3.17); nothing of the
// maker's is shipped. libdrd contains libdhd and the functions that move the arm by itself
// (homing). With libdhd alone burr cannot know whether the arm is homed. Every call names its
// device; the library's "current device" is never used. A loaded library stays loaded. Thread:
// load() any; the functions as the library says. Units: those of the library, which are SI.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::device::forcedimension {

// Return values of its functions that are not failures.
enum : int { kTimeGuard = 1, kMotorSaturated = 2 };  // successes, as 0 is
[[nodiscard]] constexpr bool failed(int code) { return code < 0; }

// Results of ErrorGetLast() after a failure.
enum Code : int {
  kNoError = 0,
  kErrorCom = 2,
  kErrorBusy = 3,
  kErrorNoDriver = 4,
  kErrorNoDevice = 5,
  kErrorNotAvailable = 6,
  kErrorTimeout = 7,
  kErrorGeometry = 8,
  kErrorNotReady = 12,
  kErrorConfiguration = 14,
  kErrorInUse = 20,
};

// Indices into the array that GetStatus() fills in.
enum : int { kStatusPower = 0, kStatusConnected = 1, kStatusForce = 5, kStatusForceOffCause = 14 };
inline constexpr int kMostStatus = 64;  // SDK 3.17 fills in 17; a newer one may fill in more

// Its functions, by the library's names without the prefix. Those after the words "may be nullptr"
// are nullptr where the library lacks them.
struct Dhd {
  int (*ErrorGetLast)();
  int (*GetDeviceCount)();
  int (*OpenID)(char index);
  int (*Close)(char id);
  int (*GetSystemType)(char id);
  bool (*IsLeftHanded)(char id);
  bool (*HasWrist)(char id);
  bool (*HasGripper)(char id);
  int (*EnableForce)(unsigned char on, char id);
  int (*SetGravityCompensation)(int on, char id);
  int (*GetPosition)(double* x, double* y, double* z, char id);
  int (*GetPositionAndOrientationFrame)(double* x, double* y, double* z, double frame[3][3],
                                        char id);
  int (*GetLinearVelocity)(double* x, double* y, double* z, char id);
  unsigned (*GetButtonMask)(char id);
  // [N], [N m], gripper force [N]; waits for one frame of the device
  int (*SetForceAndTorqueAndGripperForce)(double fx, double fy, double fz, double tx, double ty,
                                          double tz, double gripper, char id);

  // may be nullptr
  void (*GetSDKVersion)(int* major, int* minor, int* release, int* revision);
  int (*GetAvailableCount)();  // devices that no other program has opened
  int (*GetSerialNumber)(unsigned short* serial, char id);
  const char* (*GetSystemName)(char id);
  int (*GetStatus)(int* status, char id);
  int (*SetMaxForce)(double newton, char id);
  int (*SetMaxTorque)(double newton_metre, char id);
  bool (*HasActiveWrist)(char id);
  int (*GetGripperAngleRad)(double* angle, char id);
  int (*GetGripperGap)(double* metres, char id);
  // timeout in eighths of a millisecond, 0: off; of the arm itself, see Omega::watch()
  int (*SetWatchdog)(unsigned char eighths, char id);
  int (*GetWatchdog)(unsigned char* eighths, char id);
  int (*EnableExpertMode)();
  int (*DisableExpertMode)();

  // of libdrd: all of them are there, or none
  int (*DrdOpenID)(char index);
  int (*DrdClose)(char id);
  bool (*DrdIsInitialized)(char id);
  int (*DrdAutoInit)(char id);  // moves the arm
  int (*DrdStop)(bool leave_force_on, char id);

  const void* library = nullptr;
  std::string file;     // path of the library that was found
  std::string version;  // "3.17.5", or empty
  [[nodiscard]] bool homes() const { return DrdOpenID != nullptr; }
};

// path: of the library; empty: BURR_FORCEDIMENSION, else the first of candidates() that exists. The
// same file always gives the same pointer, which stays valid until the program ends. Error: what is
// missing.
[[nodiscard]] Result<const Dhd*> load(const std::string& path = {});

// Where load() looks: first by name through the loader, then in the folders that the maker and
// others use, newest version first.
[[nodiscard]] std::vector<std::string> candidates();

// The meaning of an error code and what to do, as a sentence without subject: "does not answer;
// ...". The text lives for ever, so that the tick may point to it.
[[nodiscard]] const char* words(int code);

// True: the device will not answer again until it is opened again.
[[nodiscard]] constexpr bool is_gone(int code) {
  return code == kErrorCom || code == kErrorNoDriver || code == kErrorNoDevice ||
         code == kErrorNotAvailable || code == kErrorTimeout;
}

}  // namespace burr::device::forcedimension

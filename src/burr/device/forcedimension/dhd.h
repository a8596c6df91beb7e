// device/forcedimension/dhd.h - the part of Force Dimension's libraries that burr calls, found when
// burr runs.
//
// The declarations are our own, from published names and constants (SDK 3.17); nothing of the
// maker's is shipped. libdrd is libdhd and what moves the arm by itself (homing); with libdhd alone
// burr cannot know whether the arm is homed. Every call names its device: the library's own idea of
// a current one is never used. What was loaded stays loaded. Thread: load() any; the functions as
// the library says. Units: its own, which are SI.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::device::forcedimension {

// What its functions give back.
enum : int { kTimeGuard = 1, kMotorSaturated = 2 };  // successes, as 0 is
[[nodiscard]] constexpr bool failed(int code) { return code < 0; }

// What ErrorGetLast() says after a failure.
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

// Places in what GetStatus() fills in.
enum : int { kStatusPower = 0, kStatusConnected = 1, kStatusForce = 5, kStatusForceOffCause = 14 };
inline constexpr int kMostStatus = 64;  // it fills in 17; a newer one may fill in more

// Its functions, by the library's own names without the prefix. nullptr where it has none: those
// after the word "or none".
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
  // newtons, newton metres, newtons of the gripper; waits for a frame of the device
  int (*SetForceAndTorqueAndGripperForce)(double fx, double fy, double fz, double tx, double ty,
                                          double tz, double gripper, char id);

  // or none
  void (*GetSDKVersion)(int* major, int* minor, int* release, int* revision);
  int (*GetAvailableCount)();  // that no other program has
  int (*GetSerialNumber)(unsigned short* serial, char id);
  const char* (*GetSystemName)(char id);
  int (*GetStatus)(int* status, char id);
  int (*SetMaxForce)(double newton, char id);
  int (*SetMaxTorque)(double newton_metre, char id);
  bool (*HasActiveWrist)(char id);
  int (*GetGripperAngleRad)(double* angle, char id);
  int (*GetGripperGap)(double* metres, char id);
  // in eighths of a millisecond, 0: none; the arm's own, see Omega::watch()
  int (*SetWatchdog)(unsigned char eighths, char id);
  int (*GetWatchdog)(unsigned char* eighths, char id);
  int (*EnableExpertMode)();
  int (*DisableExpertMode)();

  // of libdrd: all or none
  int (*DrdOpenID)(char index);
  int (*DrdClose)(char id);
  bool (*DrdIsInitialized)(char id);
  int (*DrdAutoInit)(char id);  // moves the arm
  int (*DrdStop)(bool leave_force_on, char id);

  const void* library = nullptr;
  std::string file;     // as it was found
  std::string version;  // "3.17.5", or empty
  [[nodiscard]] bool homes() const { return DrdOpenID != nullptr; }
};

// path: of the library; empty: BURR_FORCEDIMENSION, else the first of candidates(). The same
// pointer for the same file, for ever.
[[nodiscard]] Result<const Dhd*> load(const std::string& path = {});

// Where load() looks: by name for the loader, then in the folders that the maker and others use,
// the newest version first.
[[nodiscard]] std::vector<std::string> candidates();

// What an error code means and what to do, one sentence without a subject: "does not answer; ...".
// For ever, so that the tick may point at it.
[[nodiscard]] const char* words(int code);

// The device will not answer again before it is opened anew.
[[nodiscard]] constexpr bool is_gone(int code) {
  return code == kErrorCom || code == kErrorNoDriver || code == kErrorNoDevice ||
         code == kErrorNotAvailable || code == kErrorTimeout;
}

}  // namespace burr::device::forcedimension

// device/openhaptics/hd.h - the part of OpenHaptics' HD library that burr calls, found when burr
// runs.
//
// The declarations are our own, from published constants and the library's exported names (version
// 3.0); nothing of the maker's is shipped. The library stays loaded until the program ends: its
// driver does not bear to be loaded twice. Thread: load() main; the functions as the library says.
// Units: its own, mm and N.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::device::openhaptics {

using Handle = unsigned;               // of a device
using Code = unsigned;                 // of an error, an option, a value to ask for
using Callback = unsigned (*)(void*);  // once a tick, on the library's own thread
inline constexpr Handle kNoDevice = 0xFFFFFFFF;

struct ErrorInfo {  // returned by value, twelve bytes
  Code code = 0;
  int internal = 0;
  Handle device = 0;
};

enum : Code {
  kButtons = 0x2000,
  kPosition = 0x2050,
  kVelocity = 0x2051,   // 3 double, mm/s
  kTransform = 0x2052,  // 16 double, column after column, mm
  kVersion = 0x2500,
  kModel = 0x2501,
  kDriver = 0x2502,
  kSerial = 0x2504,
  kOutputDof = 0x2554,          // int
  kUpdateRate = 0x2600,         // int, Hz
  kNominalForce = 0x2603,       // double, N
  kNominalContinuous = 0x2604,  // double, N
  kForce = 0x2700,              // 3 double, N
  kTorque = 0x2701,             // 3 double, mN m; only with six degrees of freedom
  kForceOutput = 0x4000,
  kCalibrationOk = 0x5000,
  kCalibrationUpdate = 0x5001,
  kCalibrationByHand = 0x5002,
};
enum : Code { kStyleReset = 1, kStyleAuto = 2, kStyleInkwell = 4 };
inline constexpr unsigned kDone = 0, kContinue = 1;
inline constexpr unsigned short kPriority = 0x7FFF;  // the scheduler's default

enum : Code {
  kNoError = 0,
  kWarmMotors = 0x0200,
  kDeviceFault = 0x0300,
  kAlreadyInitiated = 0x0301,
};

// Its functions, by the library's own names without the prefix.
struct Hd {
  Handle (*InitDevice)(const char* name);
  void (*DisableDevice)(Handle);
  void (*MakeCurrentDevice)(Handle);
  void (*BeginFrame)(Handle);
  void (*EndFrame)(Handle);
  ErrorInfo (*GetError)();
  const char* (*GetErrorString)(Code);
  void (*Enable)(Code);
  void (*Disable)(Code);
  void (*GetDoublev)(Code, double*);
  void (*GetIntegerv)(Code, int*);
  void (*SetDoublev)(Code, const double*);
  const char* (*GetString)(Code);
  unsigned long (*ScheduleAsynchronous)(Callback, void* self, unsigned short priority);
  void (*Unschedule)(unsigned long);
  void (*StartScheduler)();
  void (*StopScheduler)();
  Code (*CheckCalibration)();
  void (*UpdateCalibration)(Code style);
  Code (*CheckCalibrationStyle)();  // nullptr where the library has none

  std::string file;  // as it was found
};

// path: of the library; empty: BURR_OPENHAPTICS, else as the system finds libHD.so. The same
// pointer for the same file, for ever.
[[nodiscard]] Result<const Hd*> load(const std::string& path = {});

// What an error code means and what to do, one sentence.
[[nodiscard]] std::string words(Code code);

// Only the force was refused or cut, by the device itself; the reading is good.
[[nodiscard]] constexpr bool is_about_force(Code code) { return code >> 8 == 0x02; }

// A call that this library or device does not know.
[[nodiscard]] constexpr bool is_refused(Code code) { return code >> 8 == 0x01; }

}  // namespace burr::device::openhaptics

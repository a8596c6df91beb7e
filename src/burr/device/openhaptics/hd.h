// device/openhaptics/hd.h - the functions of OpenHaptics' HD library that burr calls, loaded at run
// time.
//
// The declarations are our own, from published constants and the library's exported names (version
// 3.0); nothing of the maker's is shipped. The library stays loaded until the program ends: its
// driver fails if it is loaded twice. Thread: load() main; the functions as the library says.
// Units: those of the library, mm and N.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::device::openhaptics {

using Handle = unsigned;               // of a device
using Code = unsigned;                 // an error, an option or a parameter
using Callback = unsigned (*)(void*);  // called once a tick on the library's own thread
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
  kTransform = 0x2052,  // 16 double, column by column, mm
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

// Its functions, by the library's names without the prefix.
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
  Code (*CheckCalibrationStyle)();  // nullptr where the library lacks it

  std::string file;  // path of the library that was found
};

// path: of the library; empty: BURR_OPENHAPTICS, else the libHD.so that the system finds. The same
// file always gives the same pointer, which stays valid until the program ends. Error: what is
// missing.
[[nodiscard]] Result<const Hd*> load(const std::string& path = {});

// The meaning of an error code and what to do, in one sentence.
[[nodiscard]] std::string words(Code code);

// True: the device only refused or reduced the force; the reading is good.
[[nodiscard]] constexpr bool is_about_force(Code code) { return code >> 8 == 0x02; }

// True: this library or device does not know the call.
[[nodiscard]] constexpr bool is_refused(Code code) { return code >> 8 == 0x01; }

}  // namespace burr::device::openhaptics

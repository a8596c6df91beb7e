#include "burr/device/openhaptics/hd.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

namespace burr::device::openhaptics {
namespace {

constexpr const char* kNames[] = {"libHD.so", "libHD.so.3.0"};

// The maker's symbols have the prefix "hd".
template <class F>
bool find(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  return function != nullptr;
}

// nullptr: all found; else the name of the missing function.
const char* find_all(void* library, Hd& hd) {
#define BURR_HD(name) \
  if (!find(library, "hd" #name, hd.name)) return "hd" #name
  BURR_HD(InitDevice);
  BURR_HD(DisableDevice);
  BURR_HD(MakeCurrentDevice);
  BURR_HD(BeginFrame);
  BURR_HD(EndFrame);
  BURR_HD(GetError);
  BURR_HD(GetErrorString);
  BURR_HD(Enable);
  BURR_HD(Disable);
  BURR_HD(GetDoublev);
  BURR_HD(GetIntegerv);
  BURR_HD(SetDoublev);
  BURR_HD(GetString);
  BURR_HD(ScheduleAsynchronous);
  BURR_HD(Unschedule);
  BURR_HD(StartScheduler);
  BURR_HD(StopScheduler);
  BURR_HD(CheckCalibration);
  BURR_HD(UpdateCalibration);
#undef BURR_HD
  static_cast<void>(find(library, "hdCheckCalibrationStyle", hd.CheckCalibrationStyle));
  return nullptr;
}

std::string loaders_words() {
  const char* said = dlerror();
  return said != nullptr ? said : "no reason given";
}

}  // namespace

Result<const Hd*> load(const std::string& path) {
  static std::mutex one_at_a_time;
  static std::map<std::string, std::unique_ptr<Hd>> loaded;  // never freed, on purpose
  const std::lock_guard lock(one_at_a_time);

  std::string wanted = path;
  if (wanted.empty())
    if (const char* other = std::getenv("BURR_OPENHAPTICS"); other != nullptr) wanted = other;
  if (const auto known = loaded.find(wanted); known != loaded.end()) return known->second.get();

  void* library = nullptr;
  std::string file = wanted, trouble;
  if (!wanted.empty()) {
    library = dlopen(wanted.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) trouble = loaders_words();
  } else {
    for (const char* name : kNames) {
      file = name;
      library = dlopen(name, RTLD_NOW | RTLD_GLOBAL);
      if (library != nullptr) break;
      if (trouble.empty()) trouble = loaders_words();
    }
  }
  if (library == nullptr)
    return error(
        Trouble::io,
        fmt::format("OpenHaptics cannot be loaded ({}); install the Touch device driver and "
                    "OpenHaptics from 3D Systems, or name the library in BURR_OPENHAPTICS",
                    trouble));
  auto hd = std::make_unique<Hd>();
  hd->file = file;
  if (const char* missing = find_all(library, *hd); missing != nullptr)
    return error(Trouble::io, fmt::format("{}: has no {}, so it is not the HD library that burr "
                                          "needs (OpenHaptics 3.0 or later); install that one",
                                          file, missing));
  return loaded.emplace(wanted, std::move(hd)).first->second.get();
}

std::string words(Code code) {
  switch (code) {
    case 0x0000:
      return {};
    case 0x0100:
    case 0x0101:
    case 0x0102:
    case 0x0103:
      return fmt::format(
          "The Touch's library refused a call (0x{:04x}); it may be too old for burr: install a "
          "newer OpenHaptics.",
          code);
    case 0x0104:
      return "The Touch's library has lost the device; unplug it and plug it in again.";
    case kWarmMotors:
      return "The Touch's motors are warm; press less, or pause.";
    case 0x0201:
      return "The Touch was asked for more force than it can give and released the force.";
    case 0x0202:
      return "The Touch felt a blow and released the force; lift it from the bone.";
    case 0x0203:
      return "The Touch was moved too fast and released the force; slow down and lift it from the "
             "bone.";
    case 0x0204:
      return "The Touch could not produce the force and released it; lift it from the bone.";
    case kDeviceFault:
      return "The Touch reports a fault; switch it off and on, and run its own diagnostic program.";
    case kAlreadyInitiated:
      return "The Touch is in use by another program; close that program.";
    case 0x0302:
      return "The Touch does not answer; check its cable and its power.";
    case 0x0303:
      return "The Touch's connection is not set up; run Touch Setup and pair the device.";
    case 0x0304:
      return "The Touch's library found no timer; restart the computer.";
    case 0x0400:
    case 0x0401:
    case 0x0402:
      return fmt::format(
          "The Touch's library lost count of its frames (0x{:04x}); begin the session again, and "
          "report it if it happens again.",
          code);
    case 0x0500:
    case 0x0501:
      return fmt::format(
          "The Touch's library has no room for another loop (0x{:04x}); close other "
          "programs that use it.",
          code);
    case 0x0600:
      return "The Touch's library has no licence on this computer; install OpenHaptics as its "
             "maker describes.";
    default:
      return fmt::format("The Touch's library reports error 0x{:04x}.", code);
  }
}

}  // namespace burr::device::openhaptics

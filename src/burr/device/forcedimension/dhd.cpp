#include "burr/device/forcedimension/dhd.h"

#include <dlfcn.h>
#include <fmt/core.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <system_error>

namespace burr::device::forcedimension {
namespace {

constexpr const char* kNames[] = {"libdrd.so.3", "libdhd.so.3", "libdrd.so", "libdhd.so"};

template <class F>
bool find(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  return function != nullptr;
}

// nullptr: all found; else the name of the missing function.
const char* find_all(void* library, Dhd& dhd) {
#define BURR_NEEDED(name) \
  if (!find(library, "dhd" #name, dhd.name)) return "dhd" #name
#define BURR_OR_NONE(name) static_cast<void>(find(library, "dhd" #name, dhd.name))
  BURR_OR_NONE(GetSDKVersion);  // first, so that an error can name the version
  BURR_NEEDED(ErrorGetLast);
  BURR_NEEDED(GetDeviceCount);
  BURR_NEEDED(OpenID);
  BURR_NEEDED(Close);
  BURR_NEEDED(GetSystemType);
  BURR_NEEDED(IsLeftHanded);
  BURR_NEEDED(HasWrist);
  BURR_NEEDED(HasGripper);
  BURR_NEEDED(EnableForce);
  BURR_NEEDED(SetGravityCompensation);
  BURR_NEEDED(GetPosition);
  BURR_NEEDED(GetPositionAndOrientationFrame);
  BURR_NEEDED(GetLinearVelocity);
  BURR_NEEDED(GetButtonMask);
  BURR_NEEDED(SetForceAndTorqueAndGripperForce);
  BURR_OR_NONE(GetAvailableCount);
  BURR_OR_NONE(GetSerialNumber);
  BURR_OR_NONE(GetSystemName);
  BURR_OR_NONE(GetStatus);
  BURR_OR_NONE(SetMaxForce);
  BURR_OR_NONE(SetMaxTorque);
  BURR_OR_NONE(HasActiveWrist);
  BURR_OR_NONE(GetGripperAngleRad);
  BURR_OR_NONE(GetGripperGap);
  BURR_OR_NONE(SetWatchdog);
  BURR_OR_NONE(GetWatchdog);
  BURR_OR_NONE(EnableExpertMode);
  BURR_OR_NONE(DisableExpertMode);
#undef BURR_NEEDED
#undef BURR_OR_NONE
  const bool homes =
      find(library, "drdOpenID", dhd.DrdOpenID) && find(library, "drdClose", dhd.DrdClose) &&
      find(library, "drdIsInitialized", dhd.DrdIsInitialized) &&
      find(library, "drdAutoInit", dhd.DrdAutoInit) && find(library, "drdStop", dhd.DrdStop);
  if (!homes) dhd.DrdOpenID = nullptr;
  return nullptr;
}

std::string loaders_words() {
  const char* said = dlerror();
  return said != nullptr ? said : "no reason given";
}

std::string version_of(const Dhd& dhd) {
  if (dhd.GetSDKVersion == nullptr) return {};
  int major = 0, minor = 0, release = 0, revision = 0;
  dhd.GetSDKVersion(&major, &minor, &release, &revision);
  return fmt::format("{}.{}.{}", major, minor, release);
}

// ---- places to look

// The numbers in a file name: "libdhd.so.3.17.5" gives 3, 17, 5.
std::vector<int> numbers_in(std::string_view name) {
  std::vector<int> numbers;
  for (std::size_t n = 0; n < name.size(); ++n) {
    if (name[n] < '0' || name[n] > '9') continue;
    int number = 0;
    for (; n < name.size() && name[n] >= '0' && name[n] <= '9' && number < 100'000; ++n)
      number = 10 * number + (name[n] - '0');
    numbers.push_back(number);
  }
  return numbers;
}

// The libraries in a folder: libdrd before libdhd, newest first.
void look_in(const std::filesystem::path& folder, std::vector<std::string>& found) {
  for (const std::string_view stem : {"libdrd.so", "libdhd.so"}) {
    std::vector<std::string> here;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none))
      if (entry.path().filename().string().starts_with(stem)) here.push_back(entry.path().string());
    const std::size_t name = folder.string().size();
    std::sort(here.begin(), here.end(), [name](const std::string& a, const std::string& b) {
      return std::pair(numbers_in(a.substr(name)), a) > std::pair(numbers_in(b.substr(name)), b);
    });
    found.insert(found.end(), here.begin(), here.end());
  }
}

}  // namespace

std::vector<std::string> candidates() {
  std::vector<std::string> found(std::begin(kNames), std::end(kNames));
  if (const char* sdk = std::getenv("FDSDK"); sdk != nullptr) {
    utsname system = {};
    uname(&system);
    look_in(fmt::format("{}/lib/release/lin-{}-gcc", sdk, system.machine), found);
  }
  if (const char* home = std::getenv("HOME"); home != nullptr)
    look_in(std::string(home) + "/.local/lib", found);
  look_in("/usr/local/lib", found);
  return found;
}

Result<const Dhd*> load(const std::string& path) {
  static std::mutex one_at_a_time;
  static std::map<std::string, std::unique_ptr<Dhd>> loaded;  // never freed, on purpose
  const std::lock_guard lock(one_at_a_time);

  std::string wanted = path;
  if (wanted.empty())
    if (const char* other = std::getenv("BURR_FORCEDIMENSION"); other != nullptr) wanted = other;
  if (const auto known = loaded.find(wanted); known != loaded.end()) return known->second.get();

  void* library = nullptr;
  std::string file, trouble;
  for (const std::string& one : wanted.empty() ? candidates() : std::vector{wanted}) {
    file = one;
    library = dlopen(one.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library != nullptr) break;
    // report the first file that exists but cannot be loaded, rather than one that is absent
    const std::string said = loaders_words();
    const bool absent = said == one + ": cannot open shared object file: No such file or directory";
    if (trouble.empty() || !absent) trouble = said;
  }
  if (library == nullptr)
    return error(
        Trouble::io,
        fmt::format("Force Dimension's library cannot be loaded ({}); install the Force Dimension "
                    "SDK from its maker, or name libdrd.so in BURR_FORCEDIMENSION",
                    trouble));
  auto dhd = std::make_unique<Dhd>();
  dhd->library = library;
  dhd->file = file;
  const char* missing = find_all(library, *dhd);
  dhd->version = version_of(*dhd);
  if (missing != nullptr)
    return error(
        Trouble::io,
        fmt::format("{}: {} has no {}, so burr cannot use it; install the Force Dimension SDK 3.17 "
                    "or later",
                    file, dhd->version.empty() ? "the library" : "version " + dhd->version,
                    missing));
  return loaded.emplace(wanted, std::move(dhd)).first->second.get();
}

const char* words(int code) {
  switch (code) {
    case kErrorCom:
      return "does not answer; check its cable and its power.";
    case kErrorBusy:
      return "is busy; wait a moment, and switch it off and on if it stays busy.";
    case kErrorNoDriver:
      return "cannot be opened by your user; give permission with a udev rule "
             "(docs/use/devices/force_dimension.md).";
    case kErrorNoDevice:
      return "was disconnected; plug it in again.";
    case kErrorNotAvailable:
      return "is not available; close other programs that use it, and check its power.";
    case kErrorTimeout:
      return "no longer answers; check its cable and its power.";
    case kErrorGeometry:
      return "cannot compute the position of its handle; move it to the middle of its workspace.";
    case kErrorNotReady:
      return "is not ready; wait for its lamp, and switch it off and on if it does not become "
             "ready.";
    case kErrorConfiguration:
      return "has no valid configuration; run the maker's own test program.";
    case kErrorInUse:
      return "is in use by another program; close that program.";
    default:
      return "reports an error; run the maker's own test program, and switch it off and on.";
  }
}

}  // namespace burr::device::forcedimension

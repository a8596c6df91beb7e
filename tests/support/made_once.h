// tests/support/made_once.h - a folder that is costly to make, made once for all tests of one build.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "support/test_places.h"

namespace burr::test {

// The folder made/NAME of the build, filled by `make`. Each test runs in a process of its own, and several run at
// once: the first one makes the folder, the others wait for it. It is made anew after burr was built anew, and after
// `make` was interrupted. Tests must not write into it. Empty: it could not be made, so `make` returned false.
inline std::filesystem::path made_once(
    const std::string& name, const std::function<bool(const std::filesystem::path&)>& make) {
  namespace fs = std::filesystem;
  const fs::path build = test::build_dir();
  const fs::path folder = build / "made" / name;
  fs::create_directories(folder.parent_path());
  const int lock = ::open((folder.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock < 0 || ::flock(lock, LOCK_EX) != 0) return {};
  std::string built;
  for (const char* part : {"burr", "libburr.so", "libburr.a"})
    if (std::error_code absent; fs::exists(build / part, absent))
      built += std::to_string(fs::last_write_time(build / part).time_since_epoch().count()) + "\n";
  const fs::path stamp = folder / "built";
  std::ifstream in(stamp);
  bool whole = std::string(std::istreambuf_iterator<char>(in), {}) == built;
  if (!whole) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    whole = make(folder) && (std::ofstream(stamp) << built).flush().good();
  }
  ::close(lock);
  return whole ? folder : fs::path();
}

}  // namespace burr::test

#include "shared/page_source.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "shared/helper_process.h"

namespace burr::app {

namespace fs = std::filesystem;

namespace {

// The script that builds the page, where this program was built from its sources and not moved.
std::optional<std::string> builder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  const fs::path script = (program / "../../scripts/build_page.sh").lexically_normal();
  if (!fs::exists(script, none) || !fs::exists(program / "CMakeCache.txt", none)) return {};
  return script.string();
}

// It speaks for itself, on the same terminal.
bool build_with(std::string script) {
  char* words[] = {script.data(), nullptr};
  pid_t pid = -1;
  int status = 0;
  return ::posix_spawn(&pid, script.c_str(), nullptr, nullptr, words, environ) == 0 &&
         ::waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

PageSource::~PageSource() {
  std::error_code none;
  if (!unpacked_.empty()) fs::remove_all(unpacked_, none);
}

Result<BuiltPage> PageSource::open(const std::string& from) {
  std::error_code none;
  if (!from.empty()) {
    if (!fs::exists(from, none))
      return error(Trouble::usage, fmt::format("--from {}: there is nothing of this name", from));
    return fs::is_directory(from, none) ? page_in(from) : unpack(from);
  }
  auto page = built_page();
  if (page || page.error().trouble != Trouble::usage) return page;
  const auto script = builder();
  if (!script)
    return error(Trouble::usage,
                 page.error().text + ", or name an archive of it: --from burr-web-VERSION.tar.gz");
  if (!build_with(*script))
    return error(Trouble::io, "the page could not be built; the messages above say why");
  return built_page();
}

Result<BuiltPage> PageSource::unpack(const std::string& archive) {
  const std::string tar = program_in_path("tar");
  if (tar.empty())
    return error(Trouble::io, fmt::format("{}: the program tar, which unpacks it, is not there: "
                                          "apt-get install tar",
                                          archive));
  std::string place = (fs::temp_directory_path() / "burr_web_XXXXXX").string();
  if (::mkdtemp(place.data()) == nullptr)
    return error(Trouble::io, fmt::format("{}: no folder can be made in {}", archive,
                                          fs::temp_directory_path().string()));
  unpacked_ = place;
  HelperProcess child({tar, "--extract", "--gzip", "--no-same-owner", "--no-same-permissions",
                       "--file", fs::absolute(archive).string(), "--directory", place},
                      0);
  while (child.began() && !child.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!child.began() || !child.fine())
    return error(
        Trouble::data,
        fmt::format("{}: is no whole archive of the page (burr-web-VERSION.tar.gz); take it again",
                    archive));
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, none))
    if (entry.is_directory() && fs::exists(entry.path() / kSignOfPage, none))
      return page_in(entry.path());
  return error(Trouble::data,
               fmt::format("{}: holds no page of burr: no {} is in it", archive, kSignOfPage));
}

}  // namespace burr::app

#include "burr/workshop/law_file.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "burr/base/places.h"
#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/workshop/sha256.h"

namespace burr::workshop {
namespace {

constexpr std::size_t kLargest = std::size_t{64} << 20;         // of a library [byte]
constexpr std::size_t kLargestSettings = std::size_t{1} << 20;  // [byte]
constexpr const char* kHow = "docs/develop/how_to_add_a_force_law.md says how to build a law";
constexpr const char* kFirstLine = "burr law pass 1";

Result<std::string> bytes_of(const std::string& path, std::size_t most, const char* option) {
  std::error_code nobody_asks;
  if (const Status plain = base::check_plain_file(path, fmt::format("{} {}", option, path)); !plain)
    return plain.error();
  if (!std::filesystem::is_regular_file(path, nobody_asks))
    return error(Trouble::io, fmt::format("{} {}: there is no such file", option, path));
  const auto size = std::filesystem::file_size(path, nobody_asks);
  if (size > most)
    return error(
        fmt::format("{} {}: {} bytes are too many, at most {} are read", option, path, size, most));
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) return error(Trouble::io, fmt::format("{} {}: it cannot be read", option, path));
  return bytes;
}

// A file in memory, which nobody else can change.
Result<int> file_of(const std::string& bytes) {
  const int file = memfd_create("burr-law", MFD_CLOEXEC);
  std::size_t done = 0;
  while (file >= 0 && done < bytes.size()) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  if (file >= 0 && done == bytes.size()) return file;
  const Error why =
      error(Trouble::io, fmt::format("no memory for a law ({})", std::strerror(errno)));
  if (file >= 0) close(file);
  return why;
}

// The loader takes a library for one that it has already if the names are equal, and numbers of files come again:
// so each name is written in its own way.
std::string name_of(int file) {
  static std::atomic<unsigned> count = 0;
  std::string name = "/proc/self";
  for (unsigned bits = ++count; bits != 0; bits /= 2) name += bits % 2 != 0 ? "/." : "//.";
  return name + fmt::format("/fd/{}", file);
}

template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

std::string key_of(const tick::LawAbout& law) {
  return law.settings_sha256.empty() ? law.sha256 : law.sha256 + "-" + law.settings_sha256;
}

}  // namespace

Result<std::shared_ptr<LawFile>> LawFile::open(const std::string& path,
                                               const std::string& law_settings,
                                               const std::filesystem::path& passes) {
  std::shared_ptr<LawFile> law(new LawFile);
  auto bytes = bytes_of(path, kLargest, "`law`");
  if (!bytes) return bytes.error();
  law->path_ = path;
  law->passes_ = passes;
  law->about_ = {.kind = "compiled",
                 .name = base::printable(std::filesystem::path(path).filename().string()),
                 .sha256 = sha256(*bytes),
                 .settings_sha256 = {}};
  if (!law_settings.empty()) {
    auto text = bytes_of(law_settings, kLargestSettings, "`law_settings`");
    if (!text) return text.error();
    law->settings_path_ = law_settings;
    law->settings_ = std::move(*text);
    law->about_.settings_sha256 = sha256(law->settings_);
  }
  if (const Status loaded = law->load(*bytes); !loaded) return loaded.error();
  return law;
}

Status LawFile::load(const std::string& bytes) {
  const auto file = file_of(bytes);
  if (!file) return file.error();
  const std::string there = name_of(*file);
  library_ = dlopen(there.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) {
    std::string why = dlerror();
    if (why.starts_with(there)) why.erase(0, there.size());
    if (why.starts_with(": ")) why.erase(0, 2);
    close(*file);
    return error(fmt::format("`law` {}: it cannot be loaded ({}); {}", path_,
                             base::printable(why, 200), kHow));
  }
  close(*file);
  call_ = symbol<decltype(call_)>(library_, "burr_law_v1");
  new_ = symbol<decltype(new_)>(library_, "burr_law_v1_new");
  delete_ = symbol<decltype(delete_)>(library_, "burr_law_v1_delete");
  if (call_ == nullptr)
    return error(
        fmt::format("`law` {}: this library has no function burr_law_v1; {}", path_, kHow));
  if ((new_ == nullptr) != (delete_ == nullptr))
    return error(
        fmt::format("`law` {}: burr_law_v1_new and burr_law_v1_delete must both be there, or "
                    "neither; {}",
                    path_, kHow));
  if (new_ == nullptr && !settings_path_.empty())
    return error(Trouble::usage,
                 fmt::format("`law_settings` {}: the law {} takes no settings (it has no "
                             "burr_law_v1_new); leave them out",
                             settings_path_, about_.name));
  return fine();
}

LawFile::~LawFile() {
  end();
  if (library_ != nullptr) dlclose(library_);
}

void LawFile::end() {
  if (begun_ && delete_ != nullptr) delete_(state_);
  state_ = nullptr;
  begun_ = false;
}

Status LawFile::begin() {
  end();
  if (new_ != nullptr) {
    state_ = new_(settings_.c_str());
    if (state_ == nullptr)
      return error(fmt::format(
          "`law` {}: the law refused its settings{}", path_,
          settings_path_.empty() ? "; it wants a file as `law_settings`" : ", " + settings_path_));
  }
  begun_ = true;
  return fine();
}

Status LawFile::fit_for_real_time() const {
  if (has_passed(passes_, about_)) return fine();
  return error(
      Trouble::usage,
      fmt::format("`law` {}: a session in real time takes only a law that passed its trial "
                  "on this computer, again after each change",
                  path_));
}

std::filesystem::path law_passes() {
  const std::filesystem::path state = users_places().state;
  return state.empty() ? state : state / "laws";
}

Status remember_pass(const std::filesystem::path& passes, const tick::LawAbout& law,
                     const std::string& notes) {
  if (passes.empty())
    return error(Trouble::io,
                 "there is no folder to remember the trial in; set HOME or XDG_STATE_HOME");
  std::error_code trouble;
  std::filesystem::create_directories(passes, trouble);
  const std::filesystem::path file = passes / key_of(law);
  std::ofstream out(file, std::ios::trunc);
  out << kFirstLine << "\n" << key_of(law) << "\n" << notes;
  out.close();
  if (out) return fine();
  std::filesystem::remove(file, trouble);
  return error(Trouble::io,
               fmt::format("{}: cannot be written, so the trial is not remembered", file.string()));
}

bool has_passed(const std::filesystem::path& passes, const tick::LawAbout& law) {
  if (passes.empty() || law.sha256.empty()) return false;
  std::ifstream file(passes / key_of(law));
  std::string first, key;
  return std::getline(file, first) && std::getline(file, key) && first == kFirstLine &&
         key == key_of(law);
}

}  // namespace burr::workshop

#include "batch/result_files.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "batch/canonical.h"
#include "burr/base/new_file.h"
#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/base/version.h"
#include "burr/scenario/case.h"
#include "burr/workshop/sha256.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kResult = ".json", kTimes = ".time.json", kHalf = ".part-";

// Adds the build id of the program and of each of burr's libraries, as the linker wrote it.
int add_build_id(dl_phdr_info* object, std::size_t, void* text) {
  const std::string_view name = object->dlpi_name;
  if (!name.empty() && name.find("libburr") == std::string_view::npos) return 0;
  for (int n = 0; n < object->dlpi_phnum; ++n) {
    const auto& part = object->dlpi_phdr[n];
    if (part.p_type != PT_NOTE) continue;
    const auto* at = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    const char* end = at + part.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const char* owner = at + sizeof note;
      const char* what = owner + ((note.n_namesz + 3U) & ~3U);
      at = what + ((note.n_descsz + 3U) & ~3U);
      if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && at <= end &&
          std::memcmp(owner, "GNU", 4) == 0)
        static_cast<std::string*>(text)->append(what, note.n_descsz);
    }
  }
  return 0;
}

}  // namespace

nlohmann::json this_engine() {
  std::string ids;
  dl_iterate_phdr(add_build_id, &ids);
  return {{"version", base::version()},
          {"compiler", base::build()},
          {"build", ids.empty() ? "unknown" : workshop::sha256(ids).substr(0, 16)}};
}

fs::path ResultFiles::place(const char* kind, const std::string& id, const char* ending) const {
  const std::string two = fmt::format("{:02x}", scenario::text_hash(id) & 0xff);
  return folder_ / kind / two / (id + ending);
}
fs::path ResultFiles::result(const std::string& id) const {
  return place("results", id, kResult.data());
}
fs::path ResultFiles::times(const std::string& id) const {
  return place("results", id, kTimes.data());
}
fs::path ResultFiles::recording(const std::string& id) const {
  return place("recordings", id, ".mcap");
}
fs::path ResultFiles::failure(const std::string& id) const {
  return folder_ / "failed" / (id + std::string(kResult));
}

Result<std::optional<nlohmann::json>> ResultFiles::read(const fs::path& file) {
  if (const Status plain = base::check_plain_file(file.string()); !plain) return plain.error();
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    if (errno == ENOENT || errno == ENOTDIR) return std::optional<nlohmann::json>();
    return error(Trouble::io, fmt::format("{}: cannot be opened: {}",
                                          base::printable(file.string()), std::strerror(errno)));
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  auto value = nlohmann::json::parse(text, nullptr, false);
  if (!value.is_object() || !value.contains("id") || !value.contains("inputs"))
    return error(fmt::format("{}: is no result of `burr batch`; delete it, and do the row again",
                             base::printable(file.string())));
  return std::optional<nlohmann::json>(std::move(value));
}

Status ResultFiles::write(const fs::path& file, const nlohmann::json& value) {
  std::error_code trouble;
  fs::create_directories(file.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: the folder cannot be made: {}",
                             base::printable(file.parent_path().string()), trouble.message()));
  auto fresh = base::NewFile::create(file.string(), base::kForAll);
  if (!fresh) return fresh.error();
  fresh->write(canonical(value) + "\n");
  return fresh->put_in_place();
}

Result<ResultFiles::Found> ResultFiles::look() const {
  Found found;
  for (const char* kind : {"results", "failed", "recordings"}) {
    std::error_code trouble;
    const fs::path folder = folder_ / kind;
    if (!fs::exists(folder, trouble)) continue;
    fs::recursive_directory_iterator at(folder, trouble);
    for (; !trouble && at != fs::recursive_directory_iterator(); at.increment(trouble)) {
      const std::string name = at->path().filename().string();
      if (name.find(kHalf) != std::string::npos) {
        found.remains.push_back(at->path());
      } else if (name.ends_with(kResult) && !name.ends_with(kTimes) &&
                 std::string_view(kind) != "recordings") {
        auto& ids = std::string_view(kind) == "results" ? found.results : found.failures;
        ids.push_back(name.substr(0, name.size() - kResult.size()));
      }
    }
    if (trouble)
      return error(Trouble::io, fmt::format("{}: cannot be listed: {}",
                                            base::printable(folder.string()), trouble.message()));
  }
  std::sort(found.results.begin(), found.results.end());
  std::sort(found.failures.begin(), found.failures.end());
  return found;
}

}  // namespace burr::app

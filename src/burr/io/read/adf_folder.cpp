#include "burr/io/read/adf_folder.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

bool named_as_picture(const fs::path& path) { return lower(path.extension().string()) == ".png"; }

// One level, without order; nothing where it cannot be listed.
template <class F>
std::vector<fs::path> files_in(const fs::path& folder, F&& wanted) {
  constexpr std::size_t kMost = 100000;
  std::vector<fs::path> out;
  std::error_code trouble, kind;
  std::size_t seen = 0;
  for (fs::directory_iterator at(folder, trouble), end; !trouble && at != end && seen < kMost;
       at.increment(trouble), ++seen)
    if (wanted(at->path()) && at->is_regular_file(kind) && !at->is_symlink(kind))
      out.push_back(at->path());
  return out;
}

}  // namespace

bool named_as_adf(const fs::path& path) {
  const std::string ending = lower(path.extension().string());
  return ending == ".yaml" || ending == ".yml";
}

std::optional<fs::path> pictures_folder(const fs::path& adf, std::string_view name) {
  if (name.empty() || name.front() == '/' || name.find('\\') != std::string_view::npos ||
      name.find('\0') != std::string_view::npos)
    return std::nullopt;
  const fs::path relative = fs::path(name).lexically_normal();
  if (relative.empty() || relative.is_absolute()) return std::nullopt;
  std::size_t up = 0;
  for (const fs::path& part : relative) up += part == ".." ? 1 : 0;
  // the folder above is searched by its children only: ".." alone would open all of it
  if (up > 1 || relative == ".." || relative == "../") return std::nullopt;
  const fs::path own = adf.parent_path().empty() ? fs::path(".") : adf.parent_path();
  fs::path folder = (own / relative).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  return folder;
}

std::optional<fs::path> pictures_folder_in_text(const fs::path& adf) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  const auto bytes = first_bytes(adf, kLongest);
  if (!bytes) return std::nullopt;
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const std::size_t images = text.find("images:");
  if (images == std::string_view::npos) return std::nullopt;
  constexpr std::string_view kPath = "path:";
  std::size_t at = text.find(kPath, images);
  if (at == std::string_view::npos) return std::nullopt;
  at += kPath.size();
  std::string_view name = trimmed(text.substr(at, text.find_first_of("\n\r,}#", at) - at));
  if (name.size() >= 2 && (name.front() == '"' || name.front() == '\'') &&
      name.back() == name.front())
    name = name.substr(1, name.size() - 2);
  auto folder = pictures_folder(adf, name);
  std::error_code trouble;
  if (!folder || !fs::is_directory(fs::symlink_status(*folder, trouble))) return std::nullopt;
  // a link on the way must not lead out of the folder that the rule allows
  const fs::path own = adf.parent_path().empty() ? fs::path(".") : adf.parent_path();
  const fs::path allowed = fs::canonical(own, trouble).parent_path();
  const fs::path real = fs::canonical(*folder, trouble);
  const fs::path inside = real.lexically_relative(allowed);
  if (trouble || inside.empty() || *inside.begin() == ".." || inside == ".") return std::nullopt;
  return folder;
}

fs::path with_its_adf(const fs::path& path) {
  std::error_code trouble;
  if (!fs::is_directory(path, trouble)) return path;
  if (files_in(path, named_as_picture).empty() || !files_in(path, named_as_adf).empty())
    return path;
  const fs::path real = fs::canonical(path, trouble);
  if (trouble || !real.has_parent_path()) return path;
  fs::path found;
  for (const fs::path& adf : files_in(real.parent_path(), named_as_adf)) {
    const auto folder = pictures_folder_in_text(adf);
    if (!folder || !fs::equivalent(*folder, real, trouble)) continue;
    if (!found.empty()) return path;  // several
    found = adf;
  }
  return found.empty() ? path : found;
}

}  // namespace burr::io

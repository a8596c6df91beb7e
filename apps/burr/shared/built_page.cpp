#include "shared/built_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "burr/workshop/sha256.h"

namespace burr::app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRemedy =
    "install the package burr-web again, or take the archive again";

Result<std::string> bytes_of(const fs::path& file) {
  std::error_code none;
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  // what a link points to is no part of a page
  if (!in.good() || !fs::is_regular_file(fs::symlink_status(file, none)))
    return error(Trouble::io,
                 fmt::format("{}: is no file that can be read; {}", file.string(), kRemedy));
  return bytes;
}

// Stays in the folder of the page, wherever the list came from.
bool inside(const std::string& path) {
  const fs::path whole(path);
  return !path.empty() && whole.is_relative() && whole.lexically_normal() == whole &&
         *whole.begin() != ".." && path.back() != '/';
}

Error damaged(const fs::path& list, std::string_view field) {
  return error(Trouble::data, fmt::format("{}: its field \"{}\" is not that of a page of burr; {}",
                                          list.string(), field, kRemedy));
}

}  // namespace

Result<BuiltPage> built_page() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder : {program / "../web/published", program / "../share/burr/web"})
    if (fs::exists(folder / kSignOfPage, none)) return page_in(fs::canonical(folder, none));
  return error(Trouble::usage,
               "there is no page beside this program: install the package burr-web, or run "
               "scripts/build_page.sh in the folder of burr's sources");
}

Result<BuiltPage> page_in(const fs::path& folder) {
  const fs::path list = folder / kSignOfPage;
  const auto text = bytes_of(list);
  if (!text)
    return error(
        Trouble::data,
        fmt::format("{}: is no page of burr: it has no {}; name what `burr web` wrote, or an "
                    "archive burr-web-VERSION.tar.gz",
                    folder.string(), kSignOfPage));
  const auto about = nlohmann::json::parse(*text, nullptr, false);
  const auto string_of = [](const nlohmann::json& one) {
    return one.is_string() ? one.get<std::string>() : std::string();
  };
  if (!about.is_object()) return damaged(list, "files");
  BuiltPage page{folder, string_of(about.value("parts", nlohmann::json())), {}};
  if (!is_parts(page.parts)) return damaged(list, "parts");
  const auto files = about.value("files", nlohmann::json());
  if (!files.is_object() || files.empty()) return damaged(list, "files");
  for (const auto& [path, hash] : files.items()) {
    if (!inside(path) || string_of(hash).size() != 64) return damaged(list, "files");
    page.files[path] = string_of(hash);
  }
  return page;
}

bool is_parts(std::string_view name) {
  return name.size() == 18 && name.substr(0, 2) == "v-" &&
         name.find_first_not_of("0123456789abcdef", 2) == std::string_view::npos;
}

Result<std::string> list_of_page(const BuiltPage& page) {
  return bytes_of(page.folder / kSignOfPage);
}

Result<std::string> file_of_page(const BuiltPage& page, const std::string& path) {
  auto bytes = bytes_of(page.folder / path);
  if (!bytes) return bytes.error();
  if (workshop::sha256(*bytes) != page.files.at(path))
    return error(Trouble::data, fmt::format("{}: has changed since the page was made; {}",
                                            (page.folder / path).string(), kRemedy));
  return bytes;
}

}  // namespace burr::app

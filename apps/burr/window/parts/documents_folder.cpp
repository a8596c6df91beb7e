#include "window/parts/documents_folder.h"

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kName = "XDG_DOCUMENTS_DIR";

fs::path variable(const char* name) {
  const char* given = std::getenv(name);
  return given != nullptr && *given == '/' ? fs::path(given) : fs::path();
}

// The last line XDG_DOCUMENTS_DIR="$HOME/Dokument" of the file that xdg-user-dirs keeps.
fs::path of_desktop(const fs::path& home) {
  fs::path config = variable("XDG_CONFIG_HOME");
  if (config.empty() && !home.empty()) config = home / ".config";
  fs::path found;
  std::ifstream file(config / "user-dirs.dirs");
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line.compare(begin, kName.size(), kName) != 0) continue;
    const std::size_t open = line.find('"', begin), close = line.rfind('"');
    if (open == std::string::npos || close <= open) continue;
    const std::string value = line.substr(open + 1, close - open - 1);
    constexpr std::string_view kHome = "$HOME";
    if (value.rfind(kHome, 0) == 0)
      found = home.string() + value.substr(kHome.size());
    else if (!value.empty() && value.front() == '/')
      found = value;
  }
  return found;
}

}  // namespace

fs::path documents_folder() {
  const fs::path home = variable("HOME");
  std::error_code nobody_asks;
  for (const fs::path& one : {variable(kName.data()), of_desktop(home),
                              home.empty() ? fs::path() : home / "Documents", home})
    if (!one.empty() && fs::is_directory(one, nobody_asks)) return one;
  return fs::current_path(nobody_asks);
}

}  // namespace burr::app

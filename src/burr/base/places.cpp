#include "burr/base/places.h"

#include <cstdlib>

namespace burr {
namespace {

std::filesystem::path folder(const char* variable, const char* in_home) {
  const char* given = std::getenv(variable);
  // the specification: relative paths there are to be ignored
  if (given != nullptr && *given == '/') return std::filesystem::path(given) / "burr";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home != '/') return {};
  return std::filesystem::path(home) / in_home / "burr";
}

}  // namespace

DeskPlaces users_places() {
  return {folder("XDG_CONFIG_HOME", ".config"), folder("XDG_STATE_HOME", ".local/state"),
          folder("XDG_CACHE_HOME", ".cache"), folder("XDG_DATA_HOME", ".local/share")};
}

}  // namespace burr

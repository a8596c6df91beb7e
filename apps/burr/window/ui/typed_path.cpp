#include "window/ui/typed_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace burr::app {

std::string cleaned_path(std::string path) {
  const auto blank = [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; };
  while (!path.empty() && blank(path.back())) path.pop_back();
  while (!path.empty() && blank(path.front())) path.erase(0, 1);
  if (path.size() >= 2 && path.front() == path.back() &&
      (path.front() == '"' || path.front() == '\''))
    path = path.substr(1, path.size() - 2);
  if (path.rfind("file://", 0) == 0) path.erase(0, 7);
  if (const char* home = std::getenv("HOME"); home != nullptr && path.rfind("~/", 0) == 0)
    path = home + path.substr(1);
  return path;
}

std::string completed_path(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMost = 20'000;  // entries of a folder that are looked at
  const std::size_t slash = path.rfind('/');
  const std::string typed = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::string before = slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
  std::optional<std::string> common;
  bool folder = false;
  std::error_code trouble;
  int seen = 0;
  for (fs::directory_iterator
           at(before.empty() ? fs::path(".") : fs::path(cleaned_path(before)), trouble),
       end;
       !trouble && at != end && seen < kMost; at.increment(trouble), ++seen) {
    const std::string name = at->path().filename().string();
    if (name.compare(0, typed.size(), typed) != 0 || (typed.empty() && name[0] == '.')) continue;
    std::error_code nobody_asks;
    folder = !common && at->is_directory(nobody_asks);
    if (!common) {
      common = name;
      continue;
    }
    std::size_t same = 0;
    while (same < std::min(common->size(), name.size()) && (*common)[same] == name[same]) ++same;
    while (same > 0 && same < common->size() && ((*common)[same] & '\xC0') == '\x80') --same;
    common->resize(same);  // never half a letter
  }
  if (!common) return path;
  return before + *common + (folder ? "/" : "");
}

}  // namespace burr::app

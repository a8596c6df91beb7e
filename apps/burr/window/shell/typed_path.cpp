#include "window/shell/typed_path.h"

#include <cstdlib>

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

}  // namespace burr::app

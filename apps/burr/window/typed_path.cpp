#include "window/typed_path.h"

#include <imgui/imgui.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

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

bool path_field(const char* id, const char* hint, std::string& text, float width) {
  text.resize(std::max<std::size_t>(text.size(), 1));
  std::vector<char> buffer(4096, '\0');
  std::copy_n(text.c_str(), std::min(text.size(), buffer.size() - 1), buffer.begin());
  ImGui::SetNextItemWidth(width);
  const bool entered = ImGui::InputTextWithHint(id, hint, buffer.data(), buffer.size(),
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  text = buffer.data();
  return entered;
}

}  // namespace burr::app

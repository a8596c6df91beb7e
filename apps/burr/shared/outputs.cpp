#include "shared/outputs.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "burr/base/inputs.h"
#include "burr/base/printable.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHead = 512;  // bytes looked at
constexpr std::size_t kStlHeader = 80, kStlTriangle = 50;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool ends_with(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() && lower(path).ends_with(ending);
}

bool is_text(std::string_view head) {
  return std::none_of(head.begin(), head.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\r' && c != '\t';
  });
}

bool is_stl(std::string_view head, std::uintmax_t size) {
  if (head.starts_with("solid") && is_text(head)) return true;
  if (size < kStlHeader + 4 || head.size() < kStlHeader + 4) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + kStlHeader, sizeof count);
  return size == kStlHeader + 4 + kStlTriangle * std::uintmax_t{count};
}

// What the first bytes must be; none: text is expected.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kBeginnings = {
    {{".png", "\x89PNG"},
     {".ply", "ply"},
     {".3mf", "PK"},
     {".glb", "glTF"},
     {".nrrd", "NRRD"},
     {".mcap", "\x89MCAP0"},
     {".wav", "RIFF"},
     {".sqlite", "SQLite format 3"},
     {".hdf5", "\x89HDF"},
     {".h5", "\x89HDF"},
     {".bone", ""},
     {".html", "<"}}};

std::string_view ending_of(const Output& output) {
  for (const std::string& ending : output.endings)
    if (ends_with(output.path, ending)) return ending;
  return {};
}

bool is_kept(std::string_view ending) {
  return ending.ends_with(".mcap") || ending.ends_with(".nrrd") || ending == ".dcm";
}

Error refused(const Output& output, Trouble trouble, const std::string& why) {
  return error(trouble, fmt::format("{} {}: {}", output.option, base::printable(output.path), why));
}

Status check_place(const Output& output) {
  std::error_code trouble;
  const fs::path path = output.path;
  const auto status = fs::status(path, trouble);
  if (fs::is_directory(status))
    return refused(output, Trouble::usage, "is a folder; give the name of a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status))
    return refused(output, Trouble::usage,
                   "is a pipe or a device, which cannot hold the result; give the name of a file");
  fs::path place = path;
  if (fs::is_symlink(place, trouble)) place = fs::weakly_canonical(place, trouble);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, trouble))
    return refused(output, Trouble::io,
                   fmt::format("the folder {} does not exist; create it first",
                               base::printable(folder.string())));
  // a recording that cannot be written does not stop a session: the recorder reports it
  if (!output.path.ends_with(".mcap") && ::access(folder.c_str(), W_OK) != 0)
    return refused(output, Trouble::io, "no permission to write there; choose another folder");
  return fine();
}

Status check_one(const Output& output, const std::vector<std::string>& inputs, bool force) {
  const std::string_view ending = ending_of(output);
  if (!output.endings.empty() && ending.empty())
    return refused(output, Trouble::usage,
                   fmt::format("must end in {}", fmt::join(output.endings, " or ")));
  if (const Status place = check_place(output); !place) return place;
  std::error_code trouble;
  if (!fs::exists(output.path, trouble)) return fine();
  for (const std::string& input : inputs) {
    if (base::same_file(output.path, input))
      return refused(output, Trouble::usage,
                     "is a file that this command reads; choose another name");
    if (base::lies_in(output.path, input))
      return refused(output, Trouble::usage,
                     fmt::format("exists in the folder {}, which this command reads; choose a name "
                                 "outside of it",
                                 base::printable(input)));
  }
  if (!is_what_it_says(output.path))
    return refused(
        output, Trouble::usage,
        fmt::format(
            "exists and is not a {} file. burr does not replace a file of another "
            "kind; choose another name, or delete that file",
            ending.empty() ? fs::path(output.path).extension().string() : std::string(ending)));
  if (is_kept(ending) && !force && fs::file_size(output.path, trouble) > 0)
    return refused(output, Trouble::usage,
                   fmt::format("this {} exists; choose another name, or replace it with --force",
                               ending == ".mcap" ? "recording" : "volume"));
  return fine();
}

}  // namespace

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace a recording or a volume that exists");
}

bool is_what_it_says(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head(kHead, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  std::error_code trouble;
  const std::uintmax_t size = fs::file_size(path, trouble);
  if (size == 0 && !trouble) return true;
  if (ends_with(path, ".stl")) return is_stl(head, size);
  if (ends_with(path, ".mp4"))
    return head.substr(std::min<std::size_t>(4, head.size())).starts_with("ftyp");
  if (ends_with(path, ".dcm"))
    return head.substr(std::min<std::size_t>(128, head.size())).starts_with("DICM");
  if (ends_with(path, ".html")) {
    const auto first = head.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string::npos && head[first] == '<';
  }
  for (const auto& [ending, beginning] : kBeginnings)
    if (ends_with(path, ending)) return head.starts_with(beginning);
  return is_text(head);
}

Status check_outputs(const std::vector<std::string>& inputs, const std::vector<Output>& outputs,
                     bool force) {
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    const Output& output = outputs[n];
    if (output.path.empty()) continue;
    if (const Status good = check_one(output, inputs, force); !good) return good;
    for (std::size_t m = 0; m < n; ++m)
      if (outputs[m].path == output.path || base::same_file(outputs[m].path, output.path))
        return refused(output, Trouble::usage,
                       fmt::format("{} names the same file; give two names", outputs[m].option));
  }
  return fine();
}

}  // namespace burr::app

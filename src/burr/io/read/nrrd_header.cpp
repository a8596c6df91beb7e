// NRRD headers after https://teem.sourceforge.net/nrrd/format.html.
#include "burr/io/read/nrrd_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/io/read/beside.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

std::string field_name(std::string_view text) {
  std::string name = lower(trimmed(text));
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  if (name == "centerings") return "centers";
  return name;
}

// "slice.%03d": one number, nothing else; never passed to printf
bool numbered_name(const std::string& pattern, std::int64_t number, std::string& name) {
  const std::size_t percent = pattern.find('%');
  if (percent == std::string::npos || pattern.find('%', percent + 1) != std::string::npos)
    return false;
  std::size_t at = percent + 1;
  const bool zeros = at < pattern.size() && pattern[at] == '0';
  std::size_t width = 0;
  while (at < pattern.size() && pattern[at] >= '0' && pattern[at] <= '9' && width < 100)
    width = width * 10 + static_cast<std::size_t>(pattern[at++] - '0');
  if (at >= pattern.size() || (pattern[at] != 'd' && pattern[at] != 'u' && pattern[at] != 'i') ||
      width > 20)
    return false;
  std::string digits = std::to_string(number);
  if (digits.size() < width) digits.insert(0, width - digits.size(), zeros ? '0' : ' ');
  name = pattern.substr(0, percent) + digits + pattern.substr(at + 1);
  return true;
}

}  // namespace

Result<NrrdHeader> parse_nrrd(const std::string& text, const std::string& file) {
  NrrdHeader header;
  std::size_t at = 0;
  bool first = true, listing = false;
  while (at < text.size()) {
    std::size_t end = text.find('\n', at);
    const bool last = end == std::string::npos;
    if (last) end = text.size();
    const std::string_view line = trimmed(std::string_view(text).substr(at, end - at));
    at = last ? text.size() : end + 1;
    header.end = at;
    if (line.empty()) return header;
    if (first) {
      first = false;
      if (line.substr(0, 4) != "NRRD")
        return error(fmt::format("{}: does not begin with NRRD", file));
      continue;
    }
    if (listing) {
      header.file_list.emplace_back(line);
      continue;
    }
    if (line.front() == '#') continue;
    const std::size_t key = line.find(":="), field = line.find(": ");
    if (key != std::string_view::npos && (field == std::string_view::npos || key < field)) {
      header.keys[std::string(line.substr(0, key))] = std::string(trimmed(line.substr(key + 2)));
    } else if (const std::size_t colon = line.find(':'); colon != std::string_view::npos) {
      const std::string name = field_name(line.substr(0, colon));
      header.fields[name] = std::string(trimmed(line.substr(colon + 1)));
      if (name == "datafile" && header.fields[name].substr(0, 4) == "LIST") listing = true;
    }
  }
  return header;
}

Result<std::vector<std::filesystem::path>> nrrd_data_files(const NrrdHeader& header,
                                                           const std::filesystem::path& path,
                                                           std::vector<std::string>& notices) {
  std::vector<std::filesystem::path> files;
  const auto field = header.fields.find("datafile");
  if (field == header.fields.end()) return files;
  std::vector<std::string> names;
  const std::vector<std::string> parts = words(field->second);
  std::int64_t from = 0, to = 0, step = 1;
  const auto exact = data_file_beside(path, field->second);  // a name may look like a pattern
  if (exact && file_is_there(exact->path)) {
    names.push_back(field->second);
  } else if (!parts.empty() && parts[0] == "LIST") {
    names = header.file_list;
  } else if (parts.size() >= 4 && parts[0].find('%') != std::string::npos &&
             to_number(parts[1], from) && to_number(parts[2], to) && to_number(parts[3], step)) {
    constexpr std::int64_t kLargest = 1'000'000'000;
    const auto small = [](std::int64_t n) { return n >= -kLargest && n <= kLargest; };
    if (step == 0 || !small(from) || !small(to) || !small(step) ||
        std::abs(to - from) / std::abs(step) > 100000)
      return error(fmt::format("{}: data file: the range of numbers is wrong", short_name(path)));
    for (std::int64_t n = from; step > 0 ? n <= to : n >= to; n += step) {
      std::string name;
      if (!numbered_name(parts[0], n, name))
        return error(
            fmt::format("{}: data file: the pattern must hold exactly one number such as %03d",
                        short_name(path)));
      names.push_back(name);
    }
  } else {
    names.push_back(field->second);
  }
  for (const std::string& name : names) {
    auto file = data_file_beside(path, name);
    if (!file) return file.error();
    if (!file_is_there(file->path))
      return error(fmt::format(
          "{}: its data file {} is missing or not a regular file; put it in the same folder",
          short_name(path), short_name(file->path)));
    if (files.empty() && !file->notice.empty()) notices.push_back(file->notice);
    files.push_back(file->path);
  }
  return files;
}

}  // namespace burr::io

#include "burr/io/read/stack_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

bool digit(char c) { return c >= '0' && c <= '9'; }

// A name whose numbers were taken out: "jaw_#_rec#.tif", and they.
struct Parted {
  fs::path path;
  std::string pattern;
  std::vector<std::int64_t> numbers;
};

Parted parted(const fs::path& path) {
  constexpr std::size_t kMostDigits = 18;
  Parted out{path, path.parent_path().string() + "/", {}};
  const std::string stem = path.stem().string();
  for (std::size_t n = 0; n < stem.size();) {
    std::size_t end = n;
    while (end < stem.size() && digit(stem[end])) ++end;
    std::int64_t number = 0;
    const std::string digits = stem.substr(n, end - n);
    if (end > n && digits.size() <= kMostDigits && to_number(digits, number)) {
      out.pattern += '#';
      out.numbers.push_back(number);
    } else {
      out.pattern += end > n ? digits : std::string(1, stem[n]);
      end = std::max(end, n + 1);
    }
    n = end;
  }
  out.pattern += lower(path.extension().string());
  return out;
}

using Group = std::vector<Parted>;

// What a group looks like in a sentence: "slice#.tif (40)".
std::string words_of(const std::string& pattern, const Group& group) {
  return fmt::format("{} ({})", short_name(fs::path(pattern)), group.size());
}

// The place of the number that tells all names of the group apart; the last, if there are several. Error:
// there is none.
Result<std::size_t> counting_place(const Group& group, const std::string& folder) {
  const std::size_t places = group.front().numbers.size();
  std::size_t changing = 0;
  for (std::size_t p = places; p-- > 0;) {
    std::set<std::int64_t> seen;
    for (const Parted& one : group) seen.insert(one.numbers[p]);
    if (seen.size() == group.size()) return p;
    changing += seen.size() > 1 ? 1U : 0U;
  }
  if (changing > 1)
    return error(
        fmt::format("{}: the names of its pictures hold {} numbers that change ({}), so burr "
                    "does not know which is that of the slice; give a folder that holds one "
                    "stack",
                    folder, changing, short_name(group.front().path)));
  // the same number twice: "slice2" and "slice02"
  for (std::size_t a = 0; a < group.size(); ++a)
    for (std::size_t b = a + 1; b < group.size(); ++b)
      if (group[a].numbers == group[b].numbers)
        return error(fmt::format("{}: {} and {} have the same number; remove one of them", folder,
                                 short_name(group[a].path), short_name(group[b].path)));
  return error(fmt::format("{}: no number in the names of its pictures gives their order", folder));
}

}  // namespace

std::vector<std::int64_t> StackNames::missing() const {
  constexpr std::size_t kMost = 1000;
  std::vector<std::int64_t> out;
  for (std::size_t n = 1; n < numbers.size(); ++n)
    for (std::int64_t at = numbers[n - 1] + step; at < numbers[n] && out.size() < kMost; at += step)
      out.push_back(at);
  return out;
}

Result<StackNames> stack_names(const std::vector<fs::path>& files, const std::string& folder) {
  std::map<std::string, Group> groups;
  for (const fs::path& path : files) {
    Parted one = parted(path);
    groups[one.pattern].push_back(std::move(one));
  }
  const auto largest = std::max_element(
      groups.begin(), groups.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  Group& group = largest->second;
  // a few pictures of other names, as previews, are no second stack
  constexpr std::size_t kFew = 4;
  const std::size_t others = files.size() - group.size();
  const bool few = std::all_of(groups.begin(), groups.end(), [&](const auto& one) {
    return &one.second == &group || one.second.size() < kFew;
  });
  if (others > 0 && !(few && 4 * others <= group.size())) {
    constexpr std::size_t kNamed = 4;
    std::string list;
    std::size_t n = 0;
    for (const auto& [pattern, one] : groups)
      if (n++ < kNamed) list += (n > 1 ? ", " : "") + words_of(pattern, one);
    if (groups.size() > kNamed) list += fmt::format(" and {} more", groups.size() - kNamed);
    return error(
        fmt::format("{}: its pictures have names of {} kinds ({}), so they are not one stack; "
                    "give a folder that holds one stack",
                    folder, groups.size(), list));
  }
  StackNames out;
  out.left_out = others;
  if (group.size() == 1) {
    out.files = {group.front().path};
    out.numbers = {0};
    return out;
  }
  const auto place = counting_place(group, folder);
  if (!place) return place.error();
  std::sort(group.begin(), group.end(), [&](const Parted& a, const Parted& b) {
    return a.numbers[*place] < b.numbers[*place];
  });
  out.step = 0;
  for (const Parted& one : group) {
    if (!out.numbers.empty())
      out.step = std::gcd(out.step, one.numbers[*place] - out.numbers.back());
    out.files.push_back(one.path);
    out.numbers.push_back(one.numbers[*place]);
  }
  return out;
}

}  // namespace burr::io

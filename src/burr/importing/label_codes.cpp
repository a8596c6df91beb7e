#include "burr/importing/label_codes.h"

#include <fmt/core.h>

#include <safe_toml.h>
#include <algorithm>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/io/read/label_lists.h"
#include "burr/io/read/text.h"

namespace burr::importing {
namespace {

// The last digit of a number of SNOMED CT is a check digit after Verhoeff, so that a slip of the
// fingers shows.
bool checks(std::string_view digits) {
  static constexpr int kTimes[10][10] = {
      {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 4, 0, 6, 7, 8, 9, 5},
      {2, 3, 4, 0, 1, 7, 8, 9, 5, 6}, {3, 4, 0, 1, 2, 8, 9, 5, 6, 7},
      {4, 0, 1, 2, 3, 9, 5, 6, 7, 8}, {5, 9, 8, 7, 6, 0, 4, 3, 2, 1},
      {6, 5, 9, 8, 7, 1, 0, 4, 3, 2}, {7, 6, 5, 9, 8, 2, 1, 0, 4, 3},
      {8, 7, 6, 5, 9, 3, 2, 1, 0, 4}, {9, 8, 7, 6, 5, 4, 3, 2, 1, 0}};
  static constexpr int kTurned[8][10] = {
      {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 5, 7, 6, 2, 8, 3, 0, 9, 4},
      {5, 8, 0, 3, 7, 9, 6, 1, 4, 2}, {8, 9, 1, 6, 0, 4, 3, 5, 2, 7},
      {9, 4, 5, 3, 1, 2, 6, 8, 7, 0}, {4, 2, 8, 6, 5, 7, 3, 9, 0, 1},
      {2, 7, 9, 3, 8, 0, 6, 4, 1, 5}, {7, 0, 4, 6, 9, 1, 3, 2, 5, 8}};
  int sum = 0;
  for (std::size_t n = 0; n < digits.size(); ++n)
    sum = kTimes[sum][kTurned[n % 8][digits[digits.size() - 1 - n] - '0']];
  return sum == 0;
}

// "91609006 Mandible"
Result<io::DicomCode> code_in(const std::string& text, const std::string& where, const char* key) {
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::string number = text.substr(0, space);
  const std::size_t word = text.find_first_not_of(' ', space);
  const bool digits = number.find_first_not_of("0123456789") == std::string::npos;
  constexpr std::size_t kShortest = 6, kLongest = 16;  // of SNOMED CT; of a Code Value in DICOM
  if (!digits || number.size() < kShortest || number.size() > kLongest || word == std::string::npos)
    return error(
        fmt::format("{}: {} \"{}\" is no code; write the number of SNOMED CT and what it "
                    "means, as \"91609006 Mandible\"",
                    where, key, base::printable(text, 60)));
  if (!checks(number))
    return error(
        fmt::format("{}: {}: {} is no number of SNOMED CT: its check digit, the last one, does not "
                    "fit; look it up again",
                    where, key, number));
  return io::DicomCode{number, "SCT", text.substr(word)};
}

std::string plain(const std::string& name) {
  std::string out = io::lower(name);
  for (char& c : out)
    if (c == '_' || c == '-') c = ' ';
  return out;
}

}  // namespace

Result<std::vector<LabelCodes>> label_codes(const std::string& table_path) {
  std::vector<LabelCodes> out;
  if (table_path.empty()) return out;
  const auto text = base::text_of_file(table_path, std::uintmax_t{1} << 20,
                                       "a table of labels; check that this is the right file");
  if (!text) return text.error();
  if (!io::labels_in_lut(*text).empty()) return out;
  const std::string file = io::short_name(table_path);
  const auto read = parse_toml(*text, file);
  if (!read) return read.error();
  const auto* list = (*read)["label"].as_array();
  if (list == nullptr) return out;  // whoever reads the labels says what is wrong
  for (const auto& node : *list) {
    const auto* entry = node.as_table();
    if (entry == nullptr) continue;
    LabelCodes one;
    one.value = (*entry)["value"].value<std::int64_t>();
    one.name = (*entry)["name"].value_or(std::string());
    const std::string where =
        fmt::format("{}: label {}", file,
                    one.value ? std::to_string(*one.value) : base::printable(one.name, 60));
    for (const auto& [key, place] :
         {std::pair{"sct", &one.codes.type}, std::pair{"sct_category", &one.codes.category}}) {
      const toml::node* value = entry->get(key);
      if (value == nullptr) continue;
      if (!value->is_string())
        return error(fmt::format(
            "{}: {} must be text, the number of SNOMED CT and what it means: \"91609006 Mandible\"",
            where, key));
      auto code = code_in(value->value_or(std::string()), where, key);
      if (!code) return code.error();
      *place = std::move(*code);
    }
    if (one.codes.type || one.codes.category) out.push_back(std::move(one));
  }
  return out;
}

std::map<int, io::SegmentCodes> codes_of(const std::vector<LabelCodes>& table,
                                         const std::vector<io::Label>& labels) {
  std::map<int, io::SegmentCodes> out;
  for (const io::Label& label : labels)
    for (const LabelCodes& entry : table) {
      const bool fits = entry.value
                            ? *entry.value == (label.in_file != 0 ? label.in_file : label.value)
                            : plain(entry.name) == plain(label.name);
      if (fits) out[label.value] = entry.codes;
    }
  return out;
}

}  // namespace burr::importing

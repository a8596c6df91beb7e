#include "burr/io/read/letters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "burr/io/read/letters_tables.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr char32_t kNone = 0xFFFD;
constexpr std::size_t kRow = 94;  // letters in a row of a set of ISO 2022

void put_letter(std::string& out, char32_t code) {
  const auto byte = [&](char32_t bits) {
    out += static_cast<char>(static_cast<unsigned char>(bits));
  };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | code >> 6);
    byte(0x80 | (code & 0x3F));
  } else {
    if (code >= 0x10000) byte(0xF0 | code >> 18);
    byte(code >= 0x10000 ? 0x80 | (code >> 12 & 0x3F) : 0xE0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

std::uint8_t byte_at(std::string_view text, std::size_t place) {
  return place < text.size() ? static_cast<std::uint8_t>(text[place]) : 0;
}

// The letters of a text in UTF-8; nothing: it is none.
std::optional<std::u32string> codes_of(std::string_view text) {
  std::u32string out;
  for (std::size_t n = 0; n < text.size();) {
    const std::uint8_t first = byte_at(text, n);
    const std::size_t more = first < 0x80                    ? 0
                             : first >= 0xC2 && first < 0xE0 ? 1
                             : first >= 0xE0 && first < 0xF0 ? 2
                             : first >= 0xF0 && first < 0xF5 ? 3
                                                             : 4;
    if (more > 3 || n + more >= text.size()) return std::nullopt;
    constexpr std::array<unsigned, 4> kBits = {0x7F, 0x1F, 0x0F, 0x07};
    char32_t code = first & kBits[more];
    for (std::size_t k = 1; k <= more; ++k) {
      if ((byte_at(text, n + k) & 0xC0) != 0x80) return std::nullopt;
      code = code << 6 | (byte_at(text, n + k) & 0x3FU);
    }
    const bool too_long = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (too_long || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return std::nullopt;
    out += code;
    n += more + 1;
  }
  return out;
}

// ---- sets of letters

enum class Set : std::uint8_t { ascii, kana, japanese, japanese_more, korean, chinese, single };
struct Half {  // what one half of the codes, below or above 0x80, stands for
  Set set = Set::ascii;
  std::size_t which = 0;  // of the single sets: its place in kSingle
};

bool two_bytes(Set set) { return set != Set::ascii && set != Set::kana && set != Set::single; }

char32_t of_square(Set set, std::uint8_t first, std::uint8_t second) {
  const std::size_t row = (first & 0x7FU) - 0x21U, column = (second & 0x7FU) - 0x21U;
  if (row >= kRow || column >= kRow) return kNone;
  const std::size_t place = kRow * row + column;
  switch (set) {
    case Set::japanese:
      return letters::kJapanese[place];
    case Set::japanese_more:
      return letters::kJapaneseMore[place];
    case Set::korean:
      return letters::kKorean[place];
    default:
      return letters::kChineseSquare[place];
  }
}

char32_t of_byte(const Half& half, std::uint8_t byte) {
  constexpr std::size_t kHalf = 128;
  if (half.set == Set::kana) return byte >= 0xA1 && byte <= 0xDF ? 0xFF61 + byte - 0xA1U : kNone;
  if (half.set == Set::single && byte >= 0x80)
    return letters::kSingle[kHalf * half.which + byte - 0x80];
  return byte < 0x80 ? byte : kNone;
}

constexpr std::size_t kLatin1 = 0, kDos = 11;

// The set of a number of ISO, as "100" of "ISO_IR 100" and of "ISO 2022 IR 100".
struct Numbered {
  std::string_view number;
  Half below, above;
};
constexpr Numbered kNumbered[] = {
    {"6", {}, {}},
    {"100", {}, {Set::single, kLatin1}},
    {"101", {}, {Set::single, 1}},
    {"109", {}, {Set::single, 2}},
    {"110", {}, {Set::single, 3}},
    {"144", {}, {Set::single, 4}},
    {"127", {}, {Set::single, 5}},
    {"126", {}, {Set::single, 6}},
    {"138", {}, {Set::single, 7}},
    {"148", {}, {Set::single, 8}},
    {"166", {}, {Set::single, 9}},
    {"203", {}, {Set::single, 10}},
    {"13", {}, {Set::kana, 0}},
    {"87", {Set::japanese, 0}, {}},
    {"159", {Set::japanese_more, 0}, {}},
    {"149", {}, {Set::korean, 0}},
    {"58", {}, {Set::chinese, 0}},
};

// What follows the escape byte, and what it sets.
struct Escape {
  std::string_view bytes;
  bool above = false;
  Half half;
};
constexpr Escape kEscapes[] = {
    {"(B", false, {}},
    {"(J", false, {}},
    {")I", true, {Set::kana, 0}},
    {"$B", false, {Set::japanese, 0}},
    {"$@", false, {Set::japanese, 0}},
    {"$(B", false, {Set::japanese, 0}},
    {"$(D", false, {Set::japanese_more, 0}},
    {"$)C", true, {Set::korean, 0}},
    {"$)A", true, {Set::chinese, 0}},
    {"-A", true, {Set::single, kLatin1}},
    {"-B", true, {Set::single, 1}},
    {"-C", true, {Set::single, 2}},
    {"-D", true, {Set::single, 3}},
    {"-L", true, {Set::single, 4}},
    {"-G", true, {Set::single, 5}},
    {"-F", true, {Set::single, 6}},
    {"-H", true, {Set::single, 7}},
    {"-M", true, {Set::single, 8}},
    {"-T", true, {Set::single, 9}},
    {"-b", true, {Set::single, 10}},
};

// "ISO 2022 IR 87" or "ISO_IR 87"; nothing: another term.
const Numbered* numbered(std::string_view term) {
  term = trimmed(term);
  for (const std::string_view before : {"ISO 2022 IR ", "ISO_IR ", "ISO-IR ", "ISO IR "})
    if (term.starts_with(before)) {
      term.remove_prefix(before.size());
      const auto* const found =
          std::find_if(std::begin(kNumbered), std::end(kNumbered),
                       [&](const Numbered& one) { return one.number == term; });
      return found == std::end(kNumbered) ? nullptr : found;
    }
  return nullptr;
}

// A text whose halves change with the escape sequences of ISO 2022.
std::string of_iso_2022(std::string_view text, const Half& below, const Half& above) {
  std::string out;
  Half low = below, high = above;
  for (std::size_t n = 0; n < text.size();) {
    const std::uint8_t byte = byte_at(text, n);
    if (byte == 0x1B) {
      const std::string_view rest = text.substr(n + 1);
      const auto* const found =
          std::find_if(std::begin(kEscapes), std::end(kEscapes),
                       [&](const Escape& one) { return rest.starts_with(one.bytes); });
      n += 1 + (found == std::end(kEscapes) ? 0 : found->bytes.size());
      if (found != std::end(kEscapes)) (found->above ? high : low) = found->half;
      continue;
    }
    const Half& half = byte < 0x80 ? low : high;
    const bool control = byte < 0x21 || byte == 0x7F;
    if (two_bytes(half.set) && !control) {
      put_letter(out,
                 n + 1 < text.size() ? of_square(half.set, byte, byte_at(text, n + 1)) : kNone);
      n += 2;
      continue;
    }
    put_letter(out, control ? byte : of_byte(half, byte));
    // what separates names and their parts brings the first sets back
    if (byte == '\\' || byte == '^' || byte == '=' || (control && byte != ' ')) {
      low = below;
      high = above;
    }
    ++n;
  }
  return out;
}

// GB18030 and GBK.
std::string of_chinese(std::string_view text) {
  constexpr std::size_t kTrails = 0xFF - 0x40;
  std::string out;
  for (std::size_t n = 0; n < text.size();) {
    const std::uint8_t lead = byte_at(text, n), trail = byte_at(text, n + 1);
    if (lead < 0x81 || lead == 0xFF) {
      put_letter(out, lead < 0x80 ? char32_t{lead} : kNone);
      ++n;
    } else if (trail >= 0x40 && trail != 0xFF) {
      put_letter(out, letters::kChinese[kTrails * (lead - 0x81U) + trail - 0x40U]);
      n += 2;
    } else {  // one of the four-byte letters, which are rare
      put_letter(out, kNone);
      n += trail >= 0x30 && trail <= 0x39 ? 4 : 1;
    }
  }
  return out;
}

// Shift-JIS, where Windows and old Macs of Japan write.
std::string of_shift_jis(std::string_view text) {
  std::string out;
  for (std::size_t n = 0; n < text.size();) {
    const std::uint8_t lead = byte_at(text, n), trail = byte_at(text, n + 1);
    const bool pair = (lead >= 0x81 && lead <= 0x9F) || (lead >= 0xE0 && lead <= 0xEF);
    if (!pair) {
      put_letter(out, lead < 0x80 ? char32_t{lead} : of_byte({Set::kana, 0}, lead));
      ++n;
      continue;
    }
    n += 2;
    if (trail < 0x40 || trail == 0x7F || trail > 0xFC) {
      put_letter(out, kNone);
      continue;
    }
    const unsigned pairs = 2U * (lead - (lead <= 0x9F ? 0x81U : 0xC1U));
    const unsigned inside = trail - (trail > 0x7F ? 0x41U : 0x40U);
    put_letter(out,
               of_square(Set::japanese, static_cast<std::uint8_t>(0x21 + pairs + inside / kRow),
                         static_cast<std::uint8_t>(0x21 + inside % kRow)));
  }
  return out;
}

std::string of_single(std::string_view text, std::size_t which) {
  std::string out;
  for (const char c : text)
    put_letter(out, of_byte({Set::single, which}, static_cast<std::uint8_t>(c)));
  return out;
}

// Japanese letters and nothing that a text of Europe gives by chance: no Greek, no Cyrillic.
bool reads_as_japanese(std::string_view utf8) {
  const auto codes = codes_of(utf8);
  return codes && std::all_of(codes->begin(), codes->end(), [](char32_t code) {
           return code < 0x80 || (code >= 0x3000 && code < 0xA000) || code >= 0xFF00 ? code != kNone
                                                                                     : false;
         });
}

// ---- names that are one

// The row of a sorted table, whose rows have `width` numbers, that begins with the code; nullptr: none.
template <std::size_t width>
const std::uint16_t* row_of(std::span<const std::uint16_t> table, char32_t code) {
  std::size_t low = 0, high = table.size() / width;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (table[width * middle] == code) return &table[width * middle];
    (table[width * middle] < code ? low : high) =
        table[width * middle] < code ? middle + 1 : middle;
  }
  return nullptr;
}

void decompose(char32_t code, std::u32string& out) {
  constexpr char32_t kFirst = 0xAC00, kLast = 0xD7A3;  // syllables of Hangul
  if (code >= kFirst && code <= kLast) {
    const char32_t place = code - kFirst;
    out += static_cast<char32_t>(0x1100 + place / 588);
    out += static_cast<char32_t>(0x1161 + place % 588 / 28);
    if (place % 28 != 0) out += static_cast<char32_t>(0x11A7 + place % 28);
  } else if (const std::uint16_t* row = row_of<3>(letters::kDecomposed, code)) {
    decompose(row[1], out);
    if (row[2] != 0) out += char32_t{row[2]};
  } else {
    out += code;
  }
}

std::u32string folded(const std::u32string& name) {
  std::u32string out;
  for (char32_t code : name) {
    if (code >= 'A' && code <= 'Z') code += 'a' - 'A';
    if (const std::uint16_t* row = row_of<2>(letters::kSmall, code)) code = row[1];
    decompose(code, out);
  }
  const auto rank = [](char32_t code) {
    const std::uint16_t* row = row_of<2>(letters::kMarks, code);
    return row == nullptr ? 0 : int{row[1]};
  };
  for (std::size_t n = 0; n < out.size();) {
    std::size_t end = n;
    while (end < out.size() && rank(out[end]) != 0) ++end;
    std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(n),
                     out.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](char32_t a, char32_t b) { return rank(a) < rank(b); });
    n = end + 1;
  }
  return out;
}

// All that the bytes of a name may mean.
std::vector<std::u32string> readings_of(std::string_view name) {
  std::vector<std::u32string> out;
  if (const auto codes = codes_of(name)) return {folded(*codes)};
  for (const std::string& text :
       {of_shift_jis(name), of_single(name, kLatin1), of_single(name, kDos), of_chinese(name),
        of_iso_2022(name, {}, {Set::korean, 0})})
    if (const auto codes = codes_of(text); codes && codes->find(kNone) == std::u32string::npos)
      out.push_back(folded(*codes));
  return out;
}

}  // namespace

std::string utf8_of_dicom(std::string_view text, std::string_view character_set) {
  const std::string_view first = trimmed(character_set.substr(0, character_set.find('\\')));
  if (first == "GB18030" || first == "GBK") return of_chinese(text);
  if (first == "ISO_IR 192") return std::string(text);
  Half below, above;
  const Numbered* set = numbered(first);
  const bool escapes = text.find('\x1B') != std::string_view::npos;
  if (set == nullptr && !escapes) return std::string(text);
  if (set != nullptr) above = set->above;
  if (escapes) return of_iso_2022(text, below, above);
  // without any escape sequence, what should begin with one may be bytes of today, or of Windows
  const bool japanese = character_set.find("IR 13") != std::string_view::npos ||
                        character_set.find("IR 87") != std::string_view::npos;
  if (two_bytes(above.set) && codes_of(text)) return std::string(text);
  const std::string plain = of_iso_2022(text, below, above), windows = of_shift_jis(text);
  std::string none;
  put_letter(none, kNone);
  const bool other =
      japanese && plain.find(none) != std::string::npos && reads_as_japanese(windows);
  return other ? windows : plain;
}

std::string utf8_of_name(std::string_view name) {
  if (codes_of(name)) return std::string(name);
  std::string japanese = of_shift_jis(name);
  return reads_as_japanese(japanese) ? japanese : of_single(name, kDos);
}

std::string with_slashes(std::string name) {
  const bool old = !codes_of(name) && reads_as_japanese(of_shift_jis(name));
  for (std::size_t n = 0; n < name.size(); ++n) {
    const std::uint8_t byte = byte_at(name, n);
    if (old && ((byte >= 0x81 && byte <= 0x9F) || (byte >= 0xE0 && byte <= 0xEF)))
      ++n;
    else if (byte == '\\')
      name[n] = '/';
  }
  return name;
}

bool same_name(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const auto of_b = readings_of(b);
  for (const std::u32string& one : readings_of(a))
    if (std::find(of_b.begin(), of_b.end(), one) != of_b.end()) return true;
  return false;
}

}  // namespace burr::io

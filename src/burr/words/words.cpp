#include "burr/words/words.h"

#include <fmt/args.h>
#include <fmt/format.h>
#include <safe_toml.h>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <iterator>

namespace burr::words {
namespace {

constexpr const char* kKeys[] = {
#define BURR_WORD(key) #key,
#include "burr/words/word_keys.h"
#undef BURR_WORD
};
static_assert(std::size(kKeys) == static_cast<std::size_t>(Word::count_));

std::atomic<const Language*> now = nullptr;  // nullptr: English

std::vector<Language> read_all() {
  std::vector<Language> all;
  for (const WordFile& file : word_files())
    all.push_back(read_language(file, all.empty() ? nullptr : &all.front()));
  return all;
}

bool digit(char c) { return c >= '0' && c <= '9'; }

// The printf conversion that begins at text[at], such as "%.1f" or "%d"; "" for "%" and "50 % of".
std::string_view conversion(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (digit(text[end]) || text[end] == '.' || text[end] == '-')) ++end;
  if (end == text.size() || std::string_view("diuxeEfgGsc").find(text[end]) == text.npos) return {};
  return text.substr(at, end + 1 - at);
}

}  // namespace

std::vector<std::string> placeholders(std::string_view text) {
  const std::vector<std::string> broken = {"a brace without its other"};
  std::vector<std::string> all;
  int next = 0;
  bool counted = false, numbered = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (const std::string_view printed = c == '%' ? conversion(text, at) : ""; !printed.empty())
      all.emplace_back(printed);
    if (c != '{' && c != '}') continue;
    if (at + 1 < text.size() && text[at + 1] == c) {  // a doubled brace: a brace as text
      ++at;
      continue;
    }
    const std::size_t end = text.find('}', at);
    if (c == '}' || end == text.npos) return broken;
    const std::string_view inside = text.substr(at + 1, end - at - 1);
    const std::size_t colon = std::min(inside.find(':'), inside.size());
    const std::string_view number = inside.substr(0, colon);
    if (!std::all_of(number.begin(), number.end(), digit)) return broken;
    (number.empty() ? counted : numbered) = true;
    all.push_back(fmt::format("{{{}{}}}", number.empty() ? std::to_string(next++) : number,
                              inside.substr(colon)));
    at = end;
  }
  if (counted && numbered) return {"{} and {0} mixed"};
  std::sort(all.begin(), all.end());
  return all;
}

Language read_language(const WordFile& file, const Language* english) {
  const std::string name = std::string("words/") + file.code + ".toml";
  Language made{file.code, file.code, {}, {}};
  // the text for a missing one; in English, where none may be missing, its key
  for (std::size_t n = 0; n < std::size(kKeys); ++n)
    made.texts.emplace_back(english != nullptr ? english->texts[n] : kKeys[n]);
  const auto trouble = [&](const std::string& what) {
    made.troubles.push_back(name + ": " + what);
  };

  const auto table = parse_toml(file.text, name);
  if (!table) {
    made.troubles.push_back(table.error().text);
    return made;
  }
  if (const auto called = (*table)["language"].value_exact<std::string>())
    made.name = *called;
  else
    trouble("language is missing: what the language calls itself");

  for (std::size_t n = 0; n < std::size(kKeys); ++n) {
    const auto text = (*table)[kKeys[n]].value_exact<std::string>();
    if (!text || text->empty())
      trouble(fmt::format("{} is missing", kKeys[n]));
    else if (english != nullptr && placeholders(*text) != placeholders(english->texts[n]))
      trouble(fmt::format("{} has other placeholders ({}) than the English text ({})", kKeys[n],
                          fmt::join(placeholders(*text), " "),
                          fmt::join(placeholders(english->texts[n]), " ")));
    else
      made.texts[n] = *text;
  }
  for (const auto& [key, node] : *table)
    if (key.str() != "language" &&
        std::find(std::begin(kKeys), std::end(kKeys), key.str()) == std::end(kKeys))
      trouble(fmt::format("{} is not a key of words/en.toml", key.str()));
  return made;
}

const std::vector<Language>& languages() {
  static const std::vector<Language> all = read_all();
  return all;
}

const Language* language_of(std::string_view code) {
  for (const Language& one : languages())
    if (one.code == code) return &one;
  return nullptr;
}

std::string language_for(std::string_view lc_all, std::string_view lc_messages,
                         std::string_view lang) {
  const std::string_view first = !lc_all.empty()        ? lc_all
                                 : !lc_messages.empty() ? lc_messages
                                                        : lang;
  std::string code(first.substr(0, first.find_first_of("_.@")));
  std::transform(code.begin(), code.end(), code.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return language_of(code) != nullptr ? code : languages().front().code;
}

std::string language_of_environment() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::string_view(text != nullptr ? text : "");
  };
  return language_for(value("LC_ALL"), value("LC_MESSAGES"), value("LANG"));
}

void speak(std::string_view code) { now = language_of(code); }
const Language& spoken() {
  const Language* one = now;
  return one == nullptr ? languages().front() : *one;
}

const char* word(Word which) { return spoken().texts[static_cast<std::size_t>(which)].c_str(); }
std::string say_with(Word which, std::initializer_list<Value> values) {
  fmt::dynamic_format_arg_store<fmt::format_context> filled;
  for (const Value& value : values)
    std::visit([&filled](const auto& one) { filled.push_back(one); }, value);
  return fmt::vformat(word(which), filled);
}
const char* english(Word which) {
  return languages().front().texts[static_cast<std::size_t>(which)].c_str();
}

}  // namespace burr::words

// words/words.h - every text of window, page and report, in the language of the user.
//
//     speak("sv");
//     word(Word::undo)                          "Ångra"
//     say(Word::picture_left, "burr_001.png")   filled in, as fmt does
//
// The texts are in words/*.toml, one file per language, and are compiled in. The enumerators of
// Word are the keys of words/en.toml. Sentences of the library about files and options stay
// English, because they name fields of files. Thread: speak() main; the rest any. Text is UTF-8.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace burr::words {

enum class Word {
#define BURR_WORD(key) key,
#include "burr/words/word_keys.h"
#undef BURR_WORD
  count_,
};

struct Language {
  std::string code;                   // "sv": the name of its file
  std::string name;                   // "Svenska": its own name for itself
  std::vector<std::string> texts;     // indexed by Word; English where the file has no valid text
  std::vector<std::string> troubles;  // sentences: missing texts, unknown keys, wrong placeholders
};

// All languages that are compiled in, English first.
[[nodiscard]] const std::vector<Language>& languages();
[[nodiscard]] const Language* language_of(std::string_view code);  // none: nullptr

void speak(std::string_view code);  // an unknown language: English
// What a user's computer asks for: the first of these three that is not empty, as POSIX says
// ("sv_SE.UTF-8"). "en" where burr does not know that language.
[[nodiscard]] std::string language_for(std::string_view lc_all, std::string_view lc_messages,
                                       std::string_view lang);
// The same of LC_ALL, LC_MESSAGES and LANG of this process.
[[nodiscard]] std::string language_of_environment();
[[nodiscard]] const Language& spoken();

[[nodiscard]] const char* word(Word which);
[[nodiscard]] const char* english(Word which);

// A value that fills a place of a text: a number or a text, which outlives the call.
using Value = std::variant<char, long long, unsigned long long, float, double, std::string_view>;
template <class T>
[[nodiscard]] Value value_of(const T& given) {
  if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, char>)
    return given;
  else if constexpr (std::is_integral_v<T> && std::is_unsigned_v<T>)
    return static_cast<unsigned long long>(given);
  else if constexpr (std::is_integral_v<T>)
    return static_cast<long long>(given);
  else
    return std::string_view(given);
}
[[nodiscard]] std::string say_with(Word which, std::initializer_list<Value> values);
template <class... Values>
[[nodiscard]] std::string say(Word which, const Values&... values) {
  return say_with(which, {value_of(values)...});
}

// ---- reading the file of a language

struct WordFile {
  const char *code, *text;
};
[[nodiscard]] std::span<const WordFile> word_files();  // English first

// english: gives the texts that are missing; nullptr for English itself.
[[nodiscard]] Language read_language(const WordFile& file, const Language* english);

// The placeholders of a text, such as "{:.1f}" and "%d", each with the number of its value, sorted.
// Texts with the same placeholders take the same values.
[[nodiscard]] std::vector<std::string> placeholders(std::string_view text);

}  // namespace burr::words

// apps/burr/words/words.h - every text of the window, in the language of the user.
//
//     speak("sv");
//     word(Word::undo)                          "Ångra"
//     say(Word::picture_left, "burr_001.png")   filled in, as fmt does
//
// The texts are in words/*.toml, one file per language, and are compiled in. The enumerators of
// Word are the keys of words/en.toml. Sentences of the library about files and options stay
// English, because they name fields of files. Thread: speak() main; the rest any. Text is UTF-8.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burr::app {

enum class Word {
#define BURR_WORD(key) key,
#include "word_keys.h"
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
[[nodiscard]] const Language& spoken();

[[nodiscard]] const char* word(Word which);
[[nodiscard]] const char* english(Word which);
template <class... Values>
[[nodiscard]] std::string say(Word which, const Values&... values) {
  return fmt::format(fmt::runtime(word(which)), values...);
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

}  // namespace burr::app

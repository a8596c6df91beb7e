// apps/burr/window/shell/words.h - every text of the window, in the language of the user.
//
//     speak("sv");
//     word(Word::undo)                          "Ångra"
//     say(Word::picture_left, "burr_001.png")   filled in, as fmt does
//
// The texts are in words/*.toml, one file for each language, and are compiled in. The enumerators of
// Word are the keys of words/en.toml. Sentences of the library about files and options stay
// English: they name fields of files. Thread: main. Text is UTF-8.
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
  std::string name;                   // "Svenska": what the language calls itself
  std::vector<std::string> texts;     // by Word; English where the file has no text that fits
  std::vector<std::string> troubles;  // sentences: missing texts, unknown keys, other placeholders
};

// All that are compiled in, English first.
[[nodiscard]] const std::vector<Language>& languages();
[[nodiscard]] const Language* language_of(std::string_view code);  // none: nullptr

void speak(std::string_view code);  // of an unknown language: English
[[nodiscard]] const Language& spoken();

[[nodiscard]] const char* word(Word which);
[[nodiscard]] const char* english(Word which);
template <class... Values>
[[nodiscard]] std::string say(Word which, const Values&... values) {
  return fmt::format(fmt::runtime(word(which)), values...);
}

// ---- how a file becomes a language

struct WordFile {
  const char *code, *text;
};
[[nodiscard]] std::span<const WordFile> word_files();  // English first

// english: whose texts stand in for missing ones; nullptr for English itself.
[[nodiscard]] Language read_language(const WordFile& file, const Language* english);

// "{:.1f}" and "%d" of a text, each with the number of the value it shows, sorted. Texts with the
// same placeholders take the same values.
[[nodiscard]] std::vector<std::string> placeholders(std::string_view text);

}  // namespace burr::app

// apps/burr/shared/front_words.h - a sentence of the library as the user of the program reads it.
//
// The library serves programs, Python, pages and windows alike, so it names what can be given by its name in C++, in
// backticks, and never an option or a command: "no spacing; give `spacing_mm`". Here the name becomes what can be typed.
//
//     speak_for(command);                                  // main(), and each row of a batch
//     in_options("no spacing; give `spacing_mm`")          // -> "no spacing; give --spacing-mm"
//     in_options("damaged; `record::repair` saves it")     // -> "damaged; `burr repair` saves it"
//
// A field becomes an option only where the command that runs has this option; otherwise it stays as it is. What is no name
// of the library stays too, so a sentence may come here twice.
// Thread: speak_for() before others start; the rest any.
#pragma once

#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace CLI {
class App;
}

namespace burr::app {

// A name of the library and what the program has in its place.
struct FrontWord {
  std::string_view name, typed;
};
// Fields whose option is not "--" and their name with '-' for '_'.
[[nodiscard]] std::span<const FrontWord> other_options();
// Functions, and what does on the command line what they do.
[[nodiscard]] std::span<const FrontWord> other_ways();

// Its options, and those of the commands around it, are what can be typed from now on.
void speak_for(const CLI::App& command);

[[nodiscard]] std::string in_options(const std::string& sentence);
[[nodiscard]] Error in_options(const Error& problem);
[[nodiscard]] std::vector<std::string> in_options(const std::vector<std::string>& sentences);

// One line for each.
void print_notices(const std::vector<std::string>& notices, std::FILE* to = stderr);

// Each name in backticks becomes what `say` has for it; empty: it stays, with its backticks.
[[nodiscard]] std::string with_names_said(std::string_view sentence,
                                          const std::function<std::string(std::string_view)>& say);

}  // namespace burr::app

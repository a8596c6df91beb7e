// apps/burr/commands/complete.h - what may come next on a command line, for the completion of bash, zsh and fish
// (packaging/completion).
#pragma once

#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace burr::app {

// words: those after the program's name; the last one is being typed, and may be empty. Each line that comes back is
//
//     CANDIDATE[TAB WHAT IT IS]      a whole word; it begins with what was typed
//     :files [SUFFIX ...]            the shell offers files, of these endings if there are any, and folders
//
// Opens no file and no device.
[[nodiscard]] std::vector<std::string> completions(const CLI::App& program,
                                                   std::span<const std::string> words);

}  // namespace burr::app

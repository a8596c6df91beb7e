// apps/burr/school/store_command.h - what the commands about the store of learners have in common: how they find and open
// it, and their options --store and --json.
//
// Thread: main. Errors: one sentence.
#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/result.h"
#include "burr/school/store.h"
#include "shared/subcommand.h"

namespace burr::app {

// given: what --store says; empty: BURR_STORE, or the file in burr's data folder.
[[nodiscard]] Result<school::StorePlace> store_place(const std::string& given);

// Error, Trouble::usage: the file does not exist; burr makes no new store, since the name may be mistyped. Whether a server answers is
// found when the store is opened.
[[nodiscard]] Status check_store_is_there(const school::StorePlace& place);

// Opens it and makes none; says its notices on stderr.
[[nodiscard]] Result<std::unique_ptr<school::Store>> store_that_is_there(const std::string& given);

void add_store_option(CLI::App& command, std::string& store);

// {"...": ...} as the last line, where --json was given.
void print_json(bool wanted, const nlohmann::ordered_json& json);

// A sub-command with --store, which runs `run` with these options.
template <class Options>
CLI::App* store_command(CLI::App& parent, const char* name, const char* says,
                        const std::shared_ptr<Options>& options, Todo& todo,
                        Status (*run)(const Options&)) {
  auto* made = parent.add_subcommand(name, says);
  add_store_option(*made, options->store);
  made->callback([options, run, &todo] { todo.work = [options, run] { return run(*options); }; });
  return made;
}

}  // namespace burr::app

// apps/burr/shared/setting_options.h - the options that are settings of a session: the rows of
// tick/setting_table.h that persons give, each with its range and its meaning.
//
//     tick::TypedValues given;                     // it must outlive the parsing
//     add_setting_options(command, given);         // --burr-mm, --rpm, --torque-mnm ...
//     command.parse(...);                          // "--torque-mnm: must be a number from 0 to 1000 mN m, not -1"
//
// Thread: main.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "burr/tick/setting_table.h"

namespace burr::app {

// As it is typed: "--torque-mnm"
[[nodiscard]] std::string option_name(const tick::About& about);

// All of them. given: gets those that were typed, by their words.
void add_setting_options(CLI::App& command, tick::TypedValues& given);

// One of them, by its word, for a command that has few. `take` gets a good value in the person's unit.
// help: in place of the table's; "": that.
CLI::Option* add_setting_option(CLI::App& command, std::string_view word,
                                std::function<void(const base::Given&)> take,
                                const std::string& help = {});
// For one that is no whole number. `to` has what is usual; 0: the help does not say it.
CLI::Option* add_setting_option(CLI::App& command, std::string_view word, double& to,
                                const std::string& help = {});

}  // namespace burr::app

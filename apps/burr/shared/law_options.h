// apps/burr/shared/law_options.h - the options that put a custom law into a session
// (docs/develop/how_to_add_a_force_law.md).
#pragma once

#include <CLI/CLI.hpp>

#include "shared/law_choice.h"

namespace burr::app {

// --law, --law-settings; returns --law
CLI::Option* add_law_options(CLI::App& command, LawChoice& law);

}  // namespace burr::app

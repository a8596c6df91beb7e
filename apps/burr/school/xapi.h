// apps/burr/school/xapi.h - `burr learner xapi`: switches statements for a centre's learning record store on and off, and sends them.
#pragma once

#include <filesystem>

#include "burr/school/store.h"

namespace CLI {
class App;
}

namespace burr::app {

struct Todo;

// The subcommands below `learner`.
void add_xapi(CLI::App& learner, Todo& todo);

// After sessions came in: sends what is due where this computer has the key; says on stderr what went wrong. Cost: waits
// for the network.
void send_what_is_due(school::Store& store);

// Launches of learning management systems (cmi5) that could not be told how they ended wait in this folder; tried again,
// with a line on stderr for each result. Cost: waits for the network.
[[nodiscard]] std::filesystem::path launches_folder();
void tell_waiting_launches();

}  // namespace burr::app

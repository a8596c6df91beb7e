// apps/burr/school/xapi.h - `burr learner xapi`: switches statements for a centre's learning record store on and off, and sends them.
#pragma once

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

}  // namespace burr::app

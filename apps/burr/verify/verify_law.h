// apps/burr/verify/verify_law.h - `burr verify law FILE.so`: tries a compiled custom law, and remembers that it passed.
#pragma once

namespace CLI {
class App;
}

namespace burr::app {

struct Todo;

// The subcommand `law` of `verify`.
CLI::App* add_verify_law(CLI::App& verify, Todo& todo);

}  // namespace burr::app

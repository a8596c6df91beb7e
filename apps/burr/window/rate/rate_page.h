// apps/burr/window/rate/rate_page.h - a person marks products in the window: `burr rate --window`, and a button of the start
// page. The product turns in 3D and is seen in the same ten views as on the instructor's page; nothing on this page says
// whose it is, when it was made, or what the machine thinks of it.
//
//     RateState kept;
//     auto left = rate(*desk, kept, {});        // Closed::page or Closed::window
//
// What is marked goes into the store by school::mark(), as from the command line and the instructor's page. Thread: main.
// Errors: the store cannot be opened; troubles with one product are shown on the page.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "window/ui/closed.h"
#include "window/ui/desk.h"

namespace burr::app {

// What a rater finds again who leaves the page and comes back while burr runs. It is written into no file: it knows which
// session a product is.
struct RateState {
  struct Mark {
    std::string mark, reason;  // mark: "met", "unmet", "not assessable"; empty: none yet
  };
  std::string rater;
  std::uint64_t seed = 0;             // of the order; 0: none is drawn yet
  std::string session;                // of the product that is marked; empty: none
  std::map<std::string, Mark> marks;  // by item, not yet kept
  std::set<std::string> later;        // sessions that this rater put off
};

struct RateOptions {
  double seconds = 0;           // closes after this time; 0: never
  std::string screenshot = {};  // PNG of the last picture; empty: none
};

// Until the user leaves: Closed::page or Closed::window.
[[nodiscard]] Result<Closed> rate(Desk& desk, RateState& state, const RateOptions& options);

}  // namespace burr::app

// apps/burr/commands/second_options.h - the options of `burr mill` that let a second simulated hand take
// part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/sim/path_check.h"
#include "burr/sim/session.h"
#include "shared/tool_options.h"

namespace burr::app {

struct SecondOptions {
  std::string path_csv, motion;  // both empty: no second hand
  std::vector<double> at_mm, into;

  [[nodiscard]] bool wanted() const { return !path_csv.empty() || !motion.empty(); }
};

// --second-path, --second-motion, --second-at, --second-into
void add_second_options(CLI::App& command, SecondOptions& options);
// Call it before set_recorder(). rack: names the tool; none: a suction tube's ball. seconds: of a
// motion. followed: gets its path. Error: for the user.
[[nodiscard]] Status add_second_hand(const SecondOptions& options, const ToolOptions& rack,
                                     double seconds, sim::Session& session,
                                     std::optional<sim::FollowedPath>& followed);

}  // namespace burr::app

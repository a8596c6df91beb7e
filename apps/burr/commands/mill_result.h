// apps/burr/commands/mill_result.h - what `burr mill` has found: as text, as JSON, as a row of a batch.
//
// Thread: main.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch/row_command.h"
#include "burr/report/piece_words.h"
#include "burr/sim/session.h"
#include "burr/thermal/heat_grid.h"
#include "commands/mill_options.h"
#include "commands/mill_way.h"
#include "shared/recorded_session.h"

namespace burr::app {

struct Besides {
  std::vector<std::string> doubts;
  std::vector<report::MovedPiece> pieces;  // that were moved
  std::optional<CutLeft> left;             // of a cut along a plane
  thermal::HeatSummary heat = {};
};

[[nodiscard]] CommandResult result_of(const MillOptions& options, sim::Session& session,
                                      const Recording& recording, const Besides& besides);

// given: takes the findings; nullptr: it is printed.
void tell(const MillOptions& options, sim::Session& session, const Besides& besides,
          CommandResult findings, CommandResult* given);

}  // namespace burr::app

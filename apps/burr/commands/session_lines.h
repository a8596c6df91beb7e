// apps/burr/commands/session_lines.h - what `burr info` says of a session: which it was, what the
// user saw and did, how it ended.
//
// Thread: as the player's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "burr/record/player.h"

namespace burr::app {

// Lines for a terminal, each ends with a line break.
[[nodiscard]] std::string session_text(record::Player& player);

// "identity", "shaft", "ending", "views", "course", "lacks"; null where the recording lacks it.
[[nodiscard]] nlohmann::json session_json(record::Player& player);

}  // namespace burr::app

// commands/piece_words.h - pieces of bone that were moved: the options of `burr mill`, and how a moved
// piece was moved and how it fits, as sentences and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/scenario/lesson.h"
#include "burr/sim/move_pieces.h"

namespace burr::app {

// "X,Y,Z:DX,DY,DZ" or "X,Y,Z:DX,DY,DZ:AX,AY,AZ"  [mm, mm, degrees].
[[nodiscard]] Result<sim::PieceOrder> piece_order(const std::string& text);

// Every piece that was moved, as it lies in `bone`: how far, how it is turned, how it fits, and how far
// it is from the plan of the lesson (nullptr: there is none).
[[nodiscard]] nlohmann::ordered_json pieces_json(const edit::PieceStore& store,
                                                 const volume::Bone& bone,
                                                 const scenario::Lesson* lesson = nullptr);
// The same in lines of text.
[[nodiscard]] std::vector<std::string> pieces_text(const nlohmann::ordered_json& pieces);

}  // namespace burr::app

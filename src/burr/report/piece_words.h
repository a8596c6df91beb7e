// report/piece_words.h - pieces of bone that were moved: the options of `burr mill`, and how a moved
// piece was moved and how it fits, as sentences and as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/metrics/piece_fit.h"
#include "burr/record/player.h"
#include "burr/scenario/lesson.h"
#include "burr/sim/move_pieces.h"
#include "burr/workshop/piece_plan.h"

namespace burr::report {

// "X,Y,Z:DX,DY,DZ" or "X,Y,Z:DX,DY,DZ:AX,AY,AZ"  [mm, mm, degrees].
[[nodiscard]] Result<sim::PieceOrder> piece_order(const std::string& text);

// "X,Y,Z" [mm] as a point [m]. False: it is none.
[[nodiscard]] bool point_of(const std::string& text, math::Vec3& point);

// A piece that was moved, as it lies.
struct MovedPiece {
  std::uint32_t number = 0;                // 0: the first that was moved
  double volume = 0;                       // as it came free                 [m^3]
  math::Vec3 centre = math::Vec3::Zero();  // world                           [m]
  math::Vec3 by = math::Vec3::Zero();      // of it, from where it came free  [m]
  double turned = 0;                       // [rad]
  bool out = false;                        // of the bone: it is in a hand, and lies nowhere
  metrics::PieceFit fit;                   // to the other bone
  struct Plan {
    std::string title;                   // in English; may be empty
    math::Vec3 by = math::Vec3::Zero();  // [m]
    workshop::OffPlan off;
  };
  std::optional<Plan> plan;  // if the lesson has one for this piece
};
// All of them. lesson: nullptr without a case.
[[nodiscard]] std::vector<MovedPiece> moved_pieces(const edit::PieceStore& store,
                                                   const volume::Bone& bone,
                                                   const scenario::CaseLesson* lesson = nullptr);
// As one JSON array.
[[nodiscard]] std::string pieces_json(const std::vector<MovedPiece>& pieces);
// A line for each.
[[nodiscard]] std::vector<std::string> pieces_text(const std::vector<MovedPiece>& pieces);

// The moved pieces of a recording at a moment [s], without simulating it; below 0: at its end. bone:
// as it was opened; afterwards it is that of this moment. Error: as Player::bone_at().
struct MovedIn {
  edit::PieceStore store;
  std::vector<MovedPiece> pieces;
};
[[nodiscard]] Result<MovedIn> moved_pieces_of(record::Player& player, volume::Bone& bone,
                                              const scenario::CaseLesson* lesson, double at_s = -1);

}  // namespace burr::report

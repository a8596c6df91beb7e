// apps/burr/commands/mill_pieces.h - after its motion, `burr mill` moves free pieces, and carries one.
//
// Thread: main. Units: SI.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/device/hand_path.h"
#include "burr/edit/piece_store.h"
#include "burr/math/vec3.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/session.h"

namespace burr::app {

// One after the other, while the hand rests where the motion ended.
[[nodiscard]] Status move_pieces(const std::vector<sim::PieceOrder>& orders, sim::Session& session,
                                 edit::PieceStore& store);

// A path that carries a piece, from the place where the hand is when its motion is over.
struct Carry {
  math::Vec3 near = math::Vec3::Zero();  // of the piece
  std::string file;
  device::HandPath path;
};
// text: X,Y,Z:FILE.csv
[[nodiscard]] Result<Carry> read_carry(const std::string& text);
// The hand waits with an open grip while the piece is lifted, then goes as the path says.
void carry_on(device::HandPath& path, const Carry& carry);
// The bone keeps the piece, also where it cannot be put down.
[[nodiscard]] Status carry_piece(const Carry& way, sim::Session& session, edit::PieceStore& store);

}  // namespace burr::app

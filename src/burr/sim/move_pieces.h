// sim/move_pieces.h - puts a free piece of bone somewhere else, in a session that stands still.
//
//     edit::PieceStore store;
//     session.run(20, progress);                                   // cut it free
//     auto moved = sim::move_piece(session, store, {.near = p, .by = {5e-3, 0, 0}}, progress);
//
// The command is recorded like any other; a replay makes the same bits. For sessions in the
// background: sim/piece_mover.h. Thread: that of the session. Frame: world. Units: SI.
#pragma once

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/math/pose.h"
#include "burr/record/player.h"
#include "burr/sim/session.h"

namespace burr::sim {

struct PieceOrder {
  math::Vec3 near = math::Vec3::Zero();  // the free piece that is nearest to this point
  math::Vec3 by = math::Vec3::Zero();    // of its centre, from where it lies now [m]
  math::Vec3 turn =
      math::Vec3::Zero();  // about its centre, as it lies now: a rotation vector [rad]
};

// The whole move from where the piece came free, if it goes so much further from where it is now.
[[nodiscard]] edit::PieceMove further(const edit::PieceStore::Found& piece, const math::Vec3& by,
                                      const math::Quat& turn);

struct PieceMoved {
  edit::PieceMove move;
  double volume = 0;   // as it came free [m^3]
  double lost = 0;     // by the bone [m^3]; below 0: gained
  double overlap = 0;  // with other bone; part of lost [m^3]
};

// Lets the session run until the servo has put the piece down (tenths of a second). Error: no such
// piece, no way there, no room, or progress was cancelled.
[[nodiscard]] Result<PieceMoved> move_piece(Session& session, edit::PieceStore& store,
                                            const PieceOrder& order, Progress& progress);

// A piece that is out of the bone (tick/held_piece.h).
struct PieceLifted {
  edit::PieceMove move;                    // its number
  double volume = 0;                       // as it came free [m^3]
  math::Vec3 centre = math::Vec3::Zero();  // where it came free
};

// Lifts the free piece that is nearest to `near` out of the bone, so that a hand can hold it. Lets the
// session run until it is done. Errors as move_piece(), a piece too thin to be held,
// and a piece that is in the hand already.
[[nodiscard]] Result<PieceLifted> lift_piece(Session& session, edit::PieceStore& store,
                                             const math::Vec3& near, Progress& progress);
// Puts it down where it is now: where the bone stopped it. Errors as move_piece().
[[nodiscard]] Result<PieceMoved> put_down(Session& session, edit::PieceStore& store,
                                          const PieceLifted& lifted, Progress& progress);
// A piece that is out of the bone, or on its way out or in, goes back to where it lay; none: nothing
// happens. Lets the session run until it is there, also after an interrupt: the bone must not lose it.
// False: there was none, or it had just been put down. Error: it is still out, as where the servo does
// not answer.
[[nodiscard]] Result<bool> leave_piece(Session& session);
// The move that puts it down at this pose of its body.
[[nodiscard]] edit::PieceMove put_at(std::uint32_t piece, const math::Vec3& centre,
                                     const math::Pose& body);

// True: the recording has a command that moves or lifts a piece. Reads all commands.
[[nodiscard]] bool moves_pieces(record::Player& player);

// The pieces that were moved in a recording, without simulating it, up to `until` [s]; below 0: to
// its end, and the one that is out of the bone then, as where the session was killed. bone: as it was opened;
// afterwards it has a state of some moment. What the servo refused is left out. Error: as Player::bone_at().
[[nodiscard]] Result<edit::PieceStore> moved_in(record::Player& player, volume::Bone& bone,
                                                double until = -1);

}  // namespace burr::sim

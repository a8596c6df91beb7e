#include "burr/sim/move_pieces.h"

#include <Eigen/Geometry>
#include <utility>

#include "burr/math/turn.h"
#include "burr/rt/flags.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/servo.h"
#include "burr/volume/volume_of.h"

namespace burr::sim {

using math::Quat;
using math::Vec3;

edit::PieceMove further(const edit::PieceStore::Found& piece, const Vec3& by, const Quat& turn) {
  const Quat whole = math::normalized(math::product(turn, piece.now.q));
  const Vec3 shift = piece.now * piece.centre - piece.centre + by;
  edit::PieceMove move;
  move.piece = piece.number;
  move.specks = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    move.seed[axis] = piece.seed[static_cast<int>(axis)];
    move.by[axis] = shift[static_cast<int>(axis)];
  }
  move.turn = {whole.x(), whole.y(), whole.z(), whole.w()};
  return move;
}

namespace {

constexpr double kRest = 0.2;  // the recorder has written every brick by then  [s]

// Runs until the servo has written the bricks that it was sent.
Status wait_for_bricks(Session& session, Progress& progress) {
  constexpr double kStep = 0.05;  // [s]
  constexpr double kMost = 60;    // a piece of 10 million bricks' worth of ticks   [s]
  for (double waited = 0; waited < kMost; waited += kStep) {
    session.run(kStep, progress);
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped while a piece was moved");
    const tick::MoveState now = session.move_state();
    if (now == tick::MoveState::done) return fine();
    if (now != tick::MoveState::refused) continue;
    const std::uint32_t flags = session.outcome().flags;
    return error(Trouble::usage, (flags & rt::kFlagReserve) != 0
                                     ? "there is no room for the piece in its new place; raise "
                                       "reserve_bricks"
                                 : (flags & rt::kFlagUndoFull) != 0
                                     ? "the piece is too large to be undone; raise undo_bricks"
                                     : "the bone was changed while the piece was taken");
  }
  return error(Trouble::internal, "the piece was not put down in time");
}

// Sends a move that is whole but for what the bone says.
Result<PieceMoved> put(Session& session, edit::PieceStore& store, const edit::PieceMove& move,
                       double volume, Progress& progress) {
  const volume::Bone& bone = session.bone();
  PieceMoved done;
  done.move = move;
  done.volume = volume;
  done.move.writes = session.servo().writes_done();
  auto prepared = store.prepare(bone, done.move);
  if (!prepared) return prepared.error();
  done.move.bricks = prepared->bricks->hash;
  if (!session.move_piece(done.move, prepared->bricks))
    return error(Trouble::internal, "the command to move the piece did not reach the servo");
  if (const Status written = wait_for_bricks(session, progress); !written) return written.error();
  store.accept(*prepared);
  const double voxel = bone.grid().voxel,
               unit = voxel * voxel * voxel / static_cast<double>(volume::kVoxelUnits);
  done.lost = static_cast<double>(prepared->bricks->lost) * unit;
  done.overlap = static_cast<double>(prepared->bricks->overlap) * unit;
  return done;
}

}  // namespace

Result<PieceMoved> move_piece(Session& session, edit::PieceStore& store, const PieceOrder& order,
                              Progress& progress) {
  session.run(kRest, progress);
  const auto piece = store.find(session.bone(), order.near);
  if (!piece) return piece.error();
  const Quat turn = math::rotation_of(order.turn);
  return put(session, store, further(*piece, order.by, turn), piece->volume, progress);
}

Result<PieceLifted> lift_piece(Session& session, edit::PieceStore& store, const Vec3& near,
                               Progress& progress) {
  session.run(kRest, progress);
  if (session.servo().piece().lifted())
    return error(Trouble::usage, "a piece is in the hand already; put it down first");
  const auto piece = store.find(session.bone(), near);
  if (!piece) return piece.error();
  PieceLifted lifted;
  lifted.move = further(*piece, Vec3::Zero(), Quat::Identity());
  lifted.volume = piece->volume;
  lifted.centre = piece->centre;
  lifted.move.writes = session.servo().writes_done();
  const auto prepared = store.prepare_lift(session.bone(), lifted.move);
  if (!prepared) return prepared.error();
  lifted.move.bricks = prepared->bricks->hash;
  lifted.move.body = prepared->bricks->body.hash;
  if (!session.lift_piece(lifted.move, prepared->bricks))
    return error(Trouble::internal, "the command to lift the piece did not reach the servo");
  if (const Status written = wait_for_bricks(session, progress); !written) return written.error();
  store.accept(*prepared);
  return lifted;
}

edit::PieceMove put_at(std::uint32_t piece, const Vec3& centre, const math::Pose& body) {
  edit::PieceMove move;
  move.piece = piece;
  move.lifted = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    move.by[axis] = body.p[static_cast<int>(axis)] - centre[static_cast<int>(axis)];
  const Quat turn = math::normalized(body.q);
  move.turn = {turn.x(), turn.y(), turn.z(), turn.w()};
  return move;
}

Result<PieceMoved> put_down(Session& session, edit::PieceStore& store, const PieceLifted& lifted,
                            Progress& progress) {
  session.run(kRest, progress);
  if (!session.servo().piece().lifted()) return error(Trouble::usage, "no piece is in the hand");
  return put(session, store,
             put_at(lifted.move.piece, lifted.centre, session.servo().piece().pose()),
             lifted.volume, progress);
}

Result<bool> leave_piece(Session& session) {
  constexpr double kStep = 0.05, kMost = 60;  // [s]
  NoProgress quiet;
  bool left_it = false;
  for (double waited = 0; waited < kMost; waited += kStep) {
    const tick::Servo& servo = session.servo();
    const tick::MoveState now = servo.move_state();
    const bool moves = now == tick::MoveState::waiting || now == tick::MoveState::moving;
    if (!moves && !servo.restoring()) {
      if (!servo.piece().lifted()) break;
      if (left_it) return error(Trouble::internal, "the piece is still out of the bone");
      session.command({tick::CommandKind::leave_piece, 0});
      left_it = true;
    }
    session.run(kStep, quiet);
  }
  if (session.servo().piece().lifted() || session.servo().restoring())
    return error(Trouble::internal, "the piece did not go back into the bone in time");
  if (left_it) session.run(kRest, quiet);
  return left_it;
}

bool moves_pieces(record::Player& player) {
  record::StepCursor steps = player.steps();
  for (record::Step step; steps.next(step);)
    for (const tick::Command& command : step.commands)
      if (command.kind == tick::CommandKind::move_piece ||
          command.kind == tick::CommandKind::lift_piece)
        return true;
  return false;
}

Result<edit::PieceStore> moved_in(record::Player& player, volume::Bone& bone, double until) {
  edit::PieceStore store;
  record::StepCursor steps = player.steps();
  const double rate = player.info().rate_hz;
  bool out = false;
  for (record::Step step; steps.next(step);) {
    const double t = static_cast<double>(step.row.tick) / rate;
    if (until >= 0 && t > until) break;
    if (player.begins_part(step.row.tick)) store.none_is_out();
    // on its way out or in, too
    out = step.row.piece.state != tick::PieceRow::kNone ||
          (step.row.contact.flags & rt::kFlagRestoring) != 0;
    for (const tick::Command& command : step.commands) {
      const bool lifts = command.kind == tick::CommandKind::lift_piece;
      if ((command.kind != tick::CommandKind::move_piece && !lifts) || step.row.tick == 0) continue;
      const Status there = player.bone_at(static_cast<double>(step.row.tick - 1) / rate, bone);
      if (!there) return there.error();
      const auto prepared =
          lifts ? store.prepare_lift(bone, command.move) : store.prepare(bone, command.move);
      if (prepared && prepared->bricks->hash == command.move.bricks) store.accept(*prepared);
    }
  }
  if (!out) store.none_is_out();
  return store;
}

}  // namespace burr::sim

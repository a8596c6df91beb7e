#include "burr/workshop/out_piece.h"

#include <utility>

#include "burr/math/turn.h"
#include "burr/workshop/piece_look.h"

namespace burr::workshop {

using math::Quat;

void OutPieces::read_orders() {
  orders_.emplace();
  record::StepCursor steps = player_.steps();
  bool anew = false;  // the session was continued since the last order
  for (record::Step step; steps.next(step);) {
    anew = anew || player_.begins_part(step.row.tick);
    for (const tick::Command& command : step.commands) {
      const bool lifts = command.kind == tick::CommandKind::lift_piece;
      if (lifts || command.kind == tick::CommandKind::move_piece)
        orders_->push_back({step.row.tick, lifts, std::exchange(anew, false), command.move});
    }
  }
}

// Every order up to that tick, as the session's own store had it.
Status OutPieces::follow(std::uint64_t tick, volume::Bone& bone) {
  for (; followed_ < orders_->size() && (*orders_)[followed_].tick <= tick; ++followed_) {
    const Order& order = (*orders_)[followed_];
    if (order.tick == 0) continue;
    if (order.anew) store_.none_is_out();
    const double before = static_cast<double>(order.tick - 1) / player_.info().rate_hz;
    if (const Status there = player_.bone_at(before, bone); !there) return there;
    const auto prepared =
        order.lifts ? store_.prepare_lift(bone, order.move) : store_.prepare(bone, order.move);
    if (prepared && prepared->bricks->hash == order.move.bricks) store_.accept(*prepared);
  }
  return fine();
}

Result<OutPiece> OutPieces::at(const tick::TickRow& row, double t, volume::Bone& bone) {
  OutPiece out;
  if (row.piece.state == tick::PieceRow::kNone) return out;
  if (!orders_) read_orders();
  const Order* lifted = nullptr;
  for (const Order& order : *orders_)
    if (order.lifts && order.tick <= row.tick) lifted = &order;
  if (lifted == nullptr) return out;
  const std::uint32_t number = lifted->move.piece;
  auto shape = shapes_.find(number);
  if (shape == shapes_.end()) {
    const Status followed = follow(lifted->tick, bone);
    const Status back = player_.bone_at(t, bone);
    if (!followed) return followed.error();
    if (!back) return back.error();
    Shape made;
    if (const auto piece = store_.piece(number)) {
      made.mesh = mesh_of_piece(*piece->bone);
      made.centre = piece->centre;
    }
    shape = shapes_.emplace(number, std::move(made)).first;
  }
  const std::array<double, 4>& part = row.piece.turn;
  const Quat turn = math::normalized(Quat(part[3], part[0], part[1], part[2]));
  out.mesh = shape->second.mesh;
  out.by = {row.piece.p - turn * shape->second.centre, turn};
  return out;
}

}  // namespace burr::workshop

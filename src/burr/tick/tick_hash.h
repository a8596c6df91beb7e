// tick/tick_hash.h - one number for the inputs and results of a tick; a replay compares it.
//
// Chained: `before` is the hash of the previous tick, so the last hash covers the whole session.
// The times (took_us, late_us) are left out, because they differ from run to run. A torque of zero,
// sent or not, a turn of zero, a piece never moved, none lifted and no custom law are left out too, so that recordings from before these existed keep
// their hashes. For the same reason the undone volume
// is left out: it follows from the removed volume and the commands. No allocation.
#pragma once

#include <bit>
#include <cstdint>

#include "burr/base/hash.h"
#include "burr/rt/rt.h"
#include "burr/tick/rows.h"

namespace burr::tick {

[[nodiscard]] inline std::uint64_t tick_hash(const TickRow& row, std::uint64_t before) BURR_RT {
  std::uint64_t hash = before;
  const auto add = [&hash](double value) { hash = base::mix(hash, value); };
  const auto add3 = [&add](const math::Vec3& v) {
    add(v.x());
    add(v.y());
    add(v.z());
  };
  const auto bits = [&hash](std::uint64_t value) { hash = base::mix(hash, value); };

  bits(row.tick);
  add3(row.hand.world_from_tool.p);
  for (int i = 0; i < 4; ++i) add(row.hand.world_from_tool.q.coeffs()[i]);
  add3(row.hand.velocity);
  add(row.hand.pedal);
  bits(std::uint64_t{row.hand.buttons} << 1 | (row.hand.valid ? 1U : 0U));

  add3(row.contact.proxy);
  add3(row.contact.normal);
  add3(row.contact.force);
  if (row.contact.torque != math::Vec3::Zero()) add3(row.contact.torque);
  if (row.contact.unsent_torque != math::Vec3::Zero()) add3(row.contact.unsent_torque);
  if (row.contact.turn != math::Vec3::Zero()) add3(row.contact.turn);
  add(row.contact.depth);
  bits(static_cast<std::uint64_t>(row.contact.active));
  bits(static_cast<std::uint64_t>(row.contact.candidates));
  bits(std::uint64_t{row.contact.flags} << 1 | (row.contact.touching ? 1U : 0U));

  add(row.ledger.asked);
  add(row.ledger.removed);
  add(row.ledger.debt);
  add(row.ledger.not_cut);
  add(row.ledger.added);
  add(row.ledger.energy);
  if (row.ledger.moved != 0) add(row.ledger.moved);
  if (row.piece.state != PieceRow::kNone) {
    bits(static_cast<std::uint64_t>(row.piece.state));
    add3(row.piece.p);
    for (const double part : row.piece.turn) add(part);
  }
  if (row.law.state != LawRow::kNone) {
    bits(static_cast<std::uint64_t>(row.law.state));
    add3(row.law.force);
    add(row.law.energy);
    add(row.law.torque);
  }
  add(row.spindle_rad_s);
  add(row.cutting_nm);
  add(row.cutting_w);
  return hash;
}

}  // namespace burr::tick

// edit/ledger.h - the account of removed volume: what was asked for, removed and still owed.
//
//     asked = removed + debt + not_cut          at every tick, up to rounding of a double
//     removed - undone + moved                  what is missing from the bone now, apart from `added`
//
// Volumes are those of volume/volume_of.h.  [m^3]
#pragma once

namespace burr::edit {

struct Ledger {
  double asked = 0;    // by the removal law, since the start
  double removed = 0;  // actually removed from the field
  double debt = 0;     // asked for, not yet removed
  double not_cut = 0;  // asked, but written off: blocked longer than a debt may wait
  double added = 0;    // deposited
  double energy = 0;   // spent on cutting  [J]
  double undone = 0;   // of `removed`: brought back by undo and reset, and not redone
  // Lost where pieces were moved; below 0: gained. Resampling changes a little, and where a piece
  // overlaps other bone, that volume is there only once. Splinters that suction took count here, too; in the
  // second hand's own ledger those that its tube took, also after an undo. Undo takes it back.
  double moved = 0;
};

// Of two parts of one session.
[[nodiscard]] inline Ledger operator+(const Ledger& a, const Ledger& b) {
  return {a.asked + b.asked, a.removed + b.removed, a.debt + b.debt,     a.not_cut + b.not_cut,
          a.added + b.added, a.energy + b.energy,   a.undone + b.undone, a.moved + b.moved};
}

}  // namespace burr::edit

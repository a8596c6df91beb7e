// edit/account.h - running sums of what tools did to the bone, in the units of the field.
//
// Volumes that were removed or added are integers, so that their sums do not depend on the order;
// volumes that were only asked for are real numbers. ledger.h is the same account in m^3.
//
// Thread: servo. Units: those of volume/volume_of.h. Memory: none.
#pragma once

#include <array>
#include <cstdint>

#include "burr/edit/ledger.h"
#include "burr/rt/rt.h"

namespace burr::edit {

struct Account {
  double asked = 0, not_cut = 0;        // [units]
  std::array<double, 2> debts = {};     // of each carver: the first hand's, the second's [units]
  std::int64_t removed = 0, added = 0;  // [units]
  std::int64_t undone = 0;              // [units]
  std::int64_t moved = 0;               // [units]
  std::int64_t image_removed = 0, image_added = 0;  // of these, at the mirror's image
  double energy = 0;                                // [J]

  // Volumes that one tick of carving removed. The removal law asks only for the hand's side, so the
  // volume at the image is added to `asked` here.
  void took(std::int64_t hand, std::int64_t image) BURR_RT {
    removed += hand + image;
    image_removed += image;
    asked += static_cast<double>(image);
  }
  void put(std::int64_t hand, std::int64_t image) BURR_RT {
    added += hand + image;
    image_added += image;
  }

  [[nodiscard]] double debt() const BURR_RT { return debts[0] + debts[1]; }

  // unit_m3: volume of a unit [m^3]
  [[nodiscard]] Ledger ledger(double unit_m3) const BURR_RT {
    Ledger ledger;
    ledger.asked = asked * unit_m3;
    ledger.removed = static_cast<double>(removed) * unit_m3;
    ledger.debt = debt() * unit_m3;
    ledger.not_cut = not_cut * unit_m3;
    ledger.added = static_cast<double>(added) * unit_m3;
    ledger.undone = static_cast<double>(undone) * unit_m3;
    ledger.moved = static_cast<double>(moved) * unit_m3;
    ledger.energy = energy;
    return ledger;
  }
};

}  // namespace burr::edit

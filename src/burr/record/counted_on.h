// record/counted_on.h - the ticks of a later part of a session, as its recording says them.
//
// The servo of each part counts its ticks and its ledger from 0. In the recording they go on from the part
// before, and so does the chain of hashes: it is computed anew from the values that are written, so that
// whoever reads them (record/chain.h) finds one chain. What simulates a part again uses this, too.
//
//     CountedOn hand(part.hand);       // none: the first part, whose rows stay as they are
//     hand.change(row);
//
// Plain class. Thread: one.
#pragma once

#include <cstdint>
#include <optional>

#include "burr/edit/ledger.h"
#include "burr/tick/rows.h"
#include "burr/tick/tick_hash.h"

namespace burr::record {

// Where the parts before end, for one hand.
struct PartEnd {
  std::uint64_t ticks = 0;  // the first one of the new part
  edit::Ledger ledger;
  std::uint64_t hash = 0;  // of the last tick
};

class CountedOn {
 public:
  CountedOn() = default;
  explicit CountedOn(const PartEnd& before) : before_(before), last_(before.hash) {}

  // Row by row, in order.
  void change(tick::TickRow& row) {
    if (!before_) return;
    row.tick += before_->ticks;
    row.ledger = before_->ledger + row.ledger;
    row.hash = last_ = tick::tick_hash(row, last_);
  }

 private:
  std::optional<PartEnd> before_;
  std::uint64_t last_ = 0;
};

}  // namespace burr::record

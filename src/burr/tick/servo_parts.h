// tick/servo_parts.h - what the servo consists of, and the steps of a tick. For use of this room only:
// others have servo.h.
//
//     hand.h      read the hand
//     orders.h    obey commands
//     hand.h      touch, force law, energy guard      (restore.h: while an undo is in progress)
//     cutting.h   drag of the bone on the burr, vibration, the motor's torque
//     hand.h      limit, write the force
//     cutting.h   then cut the bone
//     servo_outbox.h    then give row and bricks to the others
//
// A second hand (second_hand.h), if there is one, takes each of these steps directly after the first.
//
// Thread: as servo.h says. Memory: taken at construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "burr/device/device.h"
#include "burr/edit/bone_writer.h"
#include "burr/edit/changed_queue.h"
#include "burr/edit/undo.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/rt.h"
#include "burr/surface/mesher.h"
#include "burr/thermal/heat_worker.h"
#include "burr/tick/controls.h"
#include "burr/tick/cutting.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/hand.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/law_call.h"
#include "burr/tick/orders.h"
#include "burr/tick/recorder_rings.h"
#include "burr/tick/restore.h"
#include "burr/tick/rows.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"
#include "burr/tick/servo_outbox.h"
#include "burr/tick/settings.h"
#include "burr/tick/shed.h"
#include "burr/tick/touch_methods.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

// What was found in the whole bone, which takes the longer the larger it is.
struct FoundInBone {
  edit::BoneWriter::Known bricks;
  std::unique_ptr<surface::Mesher> mesher;
};

class ServoParts {
 public:
  // found: take_found() of another servo of this bone that has ended; empty: none.
  ServoParts(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
             const ServoSettings& settings, FoundInBone found = {});

  // One tick. lost: ticks were lost just before this one, and the watchdog released the force.
  const TickRow& tick(bool lost) BURR_RT;

  // What to put off from the next tick on; recorded as a command when it changes. Between ticks, on
  // the servo's thread.
  void set_shed(Shed shed) BURR_RT { orders_.request(shed); }
  [[nodiscard]] Shed shed() const BURR_RT { return controls_.shed; }

  // ---- doors (docs/understand/realtime.md, "Doors")
  [[nodiscard]] rt::Ring<Command>& commands() BURR_RT { return orders_.commands(); }  // from main
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT { return outbox_.view(); }        // to main
  [[nodiscard]] rt::Latest<FaultReport>& faults() BURR_RT { return hand_.faults().reports(); }
  // of the burr's head as it is now: a command for a larger one is refused where it has no room [m]
  [[nodiscard]] double burr_radius() const BURR_RT { return outbox_.burr_radius(); }
  // The hand neither feels nor cuts, and will not until it was in free air once: a fault released
  // it in contact, or it came back inside bone. As of the last tick; any thread.
  [[nodiscard]] bool released() const BURR_RT { return outbox_.released(); }
  // before the session
  void set_recorder_rings(const RecorderRings& rings) { outbox_.set_recorder_rings(rings); }
  // The other hand, which takes part in every tick from the next one on; made with shared(). Before
  // the session. It must outlive the last tick.
  void set_second(SecondHand* second);
  [[nodiscard]] SharedByHands shared() {
    return {surface_, undo_, writer_, controls_, cutting_, piece_};
  }
  // Gives every row to one more reader, on a thread of its own; before the session. nullptr: none.
  void set_watch(rt::Latest<TickRow>* watch) { outbox_.set_watch(watch); }
  void set_heat(thermal::Worker* heat) { outbox_.set_heat(heat); }  // before the session
  // Gets every brick that is written (edit/crossed.h); between ticks. nullptr: none.
  void set_brick_watch(edit::ChangedQueue* watch) { writer_.set_watch(watch); }
  // For what puts the bone back to an earlier state, while this servo stands still (edit/bone_memory.h).
  [[nodiscard]] edit::BoneWriter& writer() { return writer_; }
  // For the next servo of the bone. This one must not tick any more.
  [[nodiscard]] FoundInBone take_found() { return {writer_.take_known(), touch_by_.take_mesher()}; }

  // How long the last tick took and how late it began, for the recorder and the view; not part of
  // the truth.
  void note_timing(double took_us, double late_us) BURR_RT;
  // Hands the finished row to the recorder and the view.
  void publish() BURR_RT;

  [[nodiscard]] Servo::Work work() const BURR_RT {
    return {row_.contact.candidates, cutting_.bricks_last(), surface_.rebuilt_last()};
  }

  [[nodiscard]] const ServoSettings& settings() const BURR_RT { return controls_.settings; }
  [[nodiscard]] const edit::UndoStore& undo_store() const BURR_RT { return undo_; }
  [[nodiscard]] std::size_t bricks_to_write() const BURR_RT { return changed_.size(); }
  [[nodiscard]] bool restoring() const BURR_RT { return restore_.active(); }
  // The piece that was lifted out of the bone, if one is; while the servo stands still.
  [[nodiscard]] const HeldPiece& piece() const { return piece_; }
  // ---- a piece that is put somewhere else (restore.h); from main
  [[nodiscard]] bool lay_ready(const edit::MovedBricks& bricks) {
    return restore_.lay_ready(bricks);
  }
  void take_back() { restore_.take_back(); }
  [[nodiscard]] MoveState move_state() const { return restore_.move_state(); }
  // bone_writer.h; any thread
  [[nodiscard]] std::uint64_t writes_begun() const { return writer_.writes_begun(); }
  [[nodiscard]] std::uint64_t writes_done() const { return writer_.writes_done(); }
  // Everything still owed to the recorder, regardless of budget; after the last tick.
  void flush_bricks() BURR_RT { outbox_.flush_bricks(row_.tick, tissue_changes()); }
  // Takes the memory that undo will need next; every few milliseconds while it ticks, from one
  // other thread.
  void commit_ahead() { undo_.commit_ahead(); }

 private:
  [[nodiscard]] bool tissue_changes() const BURR_RT {
    return cutting_.deposited() || restore_.has_moved();
  }
  [[nodiscard]] bool will_feel(bool usable) BURR_RT;
  [[nodiscard]] bool will_carry(bool usable) BURR_RT;
  void choose_touch() BURR_RT;
  void cut(const math::Vec3& touched) BURR_RT;
  void note_tool() BURR_RT;
  void finish_row(const Hand::Sent& sent) BURR_RT;

  // Members are destroyed in reverse order of declaration; each part uses only those above it.
  volume::IsoVertices& surface_;
  double dt_;
  Controls controls_;
  edit::ChangedQueue changed_;
  edit::UndoStore undo_;
  edit::BoneWriter writer_;
  TouchMethods touch_by_;
  Hand hand_;
  LawCall law_;
  Cutting cutting_;
  HeldPiece piece_;
  Restore restore_;
  Outbox outbox_;
  Orders orders_;
  SecondHand* second_ = nullptr;
  bool beside_piece_ = false;  // the second hand holds a piece, and the first its tool
  TickRow row_;
  std::uint64_t next_tick_ = 0, last_hash_ = 0;
};

}  // namespace burr::tick

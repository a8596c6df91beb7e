// tick/servo.h - the tick: the hand comes first, then the bone. What it consists of: servo_parts.h.
//
// A pure function of (bone, hand, buttons, commands, lost): no clock, no random number, so that a
// recording replays to the bit. Thread: tick() on one thread, the servo's, the only writer of the
// bone. Memory: taken at construction. Cost: docs/understand/realtime.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "burr/device/device.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/rt/rt.h"
#include "burr/tick/command.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/rows.h"
#include "burr/tick/settings.h"
#include "burr/tick/shed.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::edit {
class BoneWriter;
class ChangedQueue;
struct MovedBricks;
class UndoStore;
}  // namespace burr::edit
namespace burr::thermal {
class Worker;
}

namespace burr::tick {

struct FoundInBone;
class HeldPiece;
struct RecorderRings;
class SecondHand;
class ServoParts;
struct SharedByHands;

class Servo {
 public:
  // found: take_found() of another servo of this bone that has ended; nullptr: none.
  Servo(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
        const ServoSettings& settings, const std::shared_ptr<FoundInBone>& found = nullptr);
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  // One tick. lost: ticks were lost just before this one, and the watchdog released the force.
  const TickRow& tick(bool lost) BURR_RT;

  // What to put off from the next tick on; recorded as a command when it changes. Between ticks, on
  // the servo's thread.
  void set_shed(Shed shed) BURR_RT;
  [[nodiscard]] Shed shed() const BURR_RT;

  // ---- doors (docs/understand/realtime.md, "Doors")
  [[nodiscard]] rt::Ring<Command>& commands() BURR_RT;      // from main
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT;        // to main
  [[nodiscard]] rt::Latest<FaultReport>& faults() BURR_RT;  // to main
  // of the burr's head as it is now: a command for a larger one is refused where it has no room [m]
  [[nodiscard]] double burr_radius() const BURR_RT;
  // The hand neither feels nor cuts, and will not until it was in free air once: a fault released
  // it in contact, or it came back inside bone. As of the last tick; any thread.
  [[nodiscard]] bool released() const BURR_RT;
  // before the session
  void set_recorder_rings(const RecorderRings& rings);
  // The other hand, which takes part in every tick from the next one on; made with shared(). Before
  // the session. It must outlive the last tick.
  void set_second(SecondHand* second);
  [[nodiscard]] SharedByHands shared();
  // Gives every row to one more reader, on a thread of its own; before the session. nullptr: none.
  void set_watch(rt::Latest<TickRow>* watch);
  void set_heat(thermal::Worker* heat);  // before the session
  // Gets every brick that is written (edit/crossed.h); between ticks. nullptr: none.
  void set_brick_watch(edit::ChangedQueue* watch);
  // For what puts the bone back to an earlier state, while this servo stands still (edit/bone_memory.h).
  [[nodiscard]] edit::BoneWriter& writer();
  // What was found in the whole bone, which takes the longer the larger it is: for the next servo of the
  // bone. This one must not tick any more.
  [[nodiscard]] std::shared_ptr<FoundInBone> take_found();

  // How long the last tick took and how late it began, for the recorder and the view; not part of
  // the truth.
  void note_timing(double took_us, double late_us) BURR_RT;
  // Hands the finished row to the recorder and the view.
  void publish() BURR_RT;

  // What the last tick had to do, in counts that are the same on every machine.
  struct Work {
    int candidates = 0;  // contacts looked at
    int bricks = 0;      // that the burr stood in while cutting
    int rebuilt = 0;     // bricks whose surface was made again
  };
  [[nodiscard]] Work work() const BURR_RT;

  [[nodiscard]] const ServoSettings& settings() const BURR_RT;
  [[nodiscard]] const edit::UndoStore& undo_store() const BURR_RT;
  [[nodiscard]] std::size_t bricks_to_write() const BURR_RT;
  [[nodiscard]] bool restoring() const BURR_RT;
  // The piece that was lifted out of the bone, if one is; while the servo stands still.
  [[nodiscard]] const HeldPiece& piece() const;
  // ---- a piece that is put somewhere else (restore.h); from main
  [[nodiscard]] bool lay_ready(const edit::MovedBricks& bricks);
  void take_back();
  [[nodiscard]] MoveState move_state() const;
  // bone_writer.h; any thread
  [[nodiscard]] std::uint64_t writes_begun() const;
  [[nodiscard]] std::uint64_t writes_done() const;
  // Everything still owed to the recorder, regardless of budget; after the last tick.
  void flush_bricks() BURR_RT;
  // Takes the memory that undo will need next; every few milliseconds while it ticks, from one
  // other thread.
  void commit_ahead();

 private:
  std::unique_ptr<ServoParts> parts_;
};

}  // namespace burr::tick

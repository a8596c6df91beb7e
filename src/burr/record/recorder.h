// record/recorder.h - the diary's pen: takes rows from the servo through rings and brings them to
// disk on threads of its own.
//
//     Recorder recorder(rate_hz);
//     recorder.start("s.mcap", info, embed ? &bone : nullptr);
//       servo, each tick:  commands().push, bricks().push ..., then ticks().push     (wait-free)
//       not paced by a clock: between ticks, wait_for_room()
//     recorder.finish();
//
//     servo --rings, 4 s deep--> pen: a chunk every 40 ms, keyframe of the bone every 10 s
//                                 `--> syncer: fdatasync, so that a slow disk delays nobody
//
// A full ring drops the row and counts it; the count is written into the file. A process killed at
// any moment loses at most the last 100 ms of ticks: the pen hands each chunk to the kernel in one
// write. What it needs for that is a processor within 50 ms of asking; in a real-time session it
// comes right after the servo, where the machine permits.
//
// Trouble (disk full, file removed) ends the recording, not the session: it is told once, at once,
// and again by finish(); what was written until then stays and opens.
//
// Thread: start, finish, status on one thread; the rings on the servo's; safe_ticks any. Memory:
// rings (about 25 MiB at 1 kHz), a copy of the changed bricks, twice while a keyframe is written.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/record/session_info.h"
#include "burr/rt/ring.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::record {

// What was written, and what was not.
struct RecordingAccount {
  std::uint64_t ticks = 0, commands = 0, brick_rows = 0, keyframes = 0;
  std::uint64_t dropped_ticks = 0, dropped_commands = 0, dropped_bricks = 0;
  std::uint64_t safe_ticks = 0;  // of these, handed to the kernel: what the file holds
  std::uint64_t bytes = 0;       // of the file
  double longest_pause_s = 0;    // between two chunks handed to the kernel; what a kill may lose
  [[nodiscard]] bool whole() const {
    return dropped_ticks == 0 && dropped_commands == 0 && dropped_bricks == 0;
  }
};

class Recorder {
 public:
  // rate_hz: of ticks. brick_rows: how many changed bricks may wait; a burst of more in 40 ms is
  // refused by the ring, keep such a brick marked and push it at a later tick. realtime: the
  // session is paced by the clock, so the pen asks for a priority of its own.
  explicit Recorder(double rate_hz, std::size_t brick_rows = 8192, bool realtime = false);
  // Not finished: as finish(), but nobody hears of trouble.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Begins the file at `path` under its final name; a recording that was there is replaced only
  // once the new one has its beginning. embed: this bone goes into the file, as it is now.
  // Fills in burr_version, build and embedded of info.
  // on_trouble: called at most once, on a thread of the recorder, as soon as something goes wrong.
  [[nodiscard]] Status start(const std::string& path, const SessionInfo& info,
                             const volume::Bone* embed = nullptr,
                             std::function<void(const Error&)> on_trouble = {});

  // ---- the servo's side; within a tick: commands, bricks, then the tick
  [[nodiscard]] rt::Ring<tick::TickRow>& ticks() BURR_RT { return ticks_; }
  [[nodiscard]] rt::Ring<tick::CommandRow>& commands() BURR_RT { return commands_; }
  [[nodiscard]] rt::Ring<tick::BrickRow>& bricks() BURR_RT { return bricks_; }

  // For a session as fast as possible: call between ticks, on the servo's thread; waits (not
  // real-time!) until no ring is more than half full. Paced sessions never call it.
  void wait_for_room();

  // Trouble so far (disk full ...); the session goes on, the rows are counted as dropped.
  [[nodiscard]] Status status() const;

  // How many ticks lie in the file already, as far as a kill is concerned.
  [[nodiscard]] std::uint64_t safe_ticks() const;

  // Everything pushed before this call is written, then summary and footer. The file is then
  // complete, or the Error says what is missing.
  [[nodiscard]] Result<RecordingAccount> finish();
  // The same after finish(), whether it went well or not.
  [[nodiscard]] RecordingAccount account() const;

 private:
  class Pen;
  rt::Ring<tick::TickRow> ticks_;
  rt::Ring<tick::CommandRow> commands_;
  rt::Ring<tick::BrickRow> bricks_;
  double rate_hz_;
  bool realtime_;
  std::unique_ptr<Pen> pen_;
};

}  // namespace burr::record

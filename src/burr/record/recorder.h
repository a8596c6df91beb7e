// record/recorder.h - records a session: takes rows from the servo through rings and writes them to
// disk on threads of its own.
//
//     Recorder recorder(rate_hz);
//     recorder.start("s.mcap", info, embed ? &bone : nullptr);
//       servo, each tick:  commands().push, bricks().push ..., then ticks().push     (wait-free)
//       not paced by a clock: between ticks, wait_for_room()
//       main, now and then: note(view), note(event)                                  (locks)
//     recorder.finish();
//
//     servo --rings, 4 s deep--> pen: a chunk every 40 ms, keyframe of the bone every 10 s
//                                 `--> syncer: fdatasync, so that a slow disk delays no one
//
// If a ring is full, the row is dropped and counted; the count is written to the file. A process
// that is killed loses at most the last 100 ms of ticks: the pen gives each chunk to the kernel in
// one write. For this the pen must get a processor within 50 ms of asking for it; in a real-time
// session its priority comes directly after the servo's, where the machine permits.
//
// An error (disk full, file removed) ends the recording, not the session. It is reported once, at
// once, and again by finish(). What was written until then stays and can be opened.
//
// Thread: start, finish, status on one thread; the rings on the servo's; written_ticks and note any
// but the servo's. Memory:
// rings (about 25 MiB at 1 kHz), a copy of the changed bricks, twice while a keyframe is written.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/course.h"
#include "burr/record/recording_stats.h"
#include "burr/record/sealer.h"
#include "burr/record/session_info.h"
#include "burr/record/view.h"
#include "burr/rt/ring.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::record {

struct EarlierPart;

class Recorder {
 public:
  // rate_hz: of ticks. brick_rows: how many changed bricks may wait. A larger burst within 40 ms
  // does not fit into the ring; keep such a brick marked and push it at a later tick. realtime: the
  // session is paced by the clock, so the pen asks for a priority of its own.
  // second: a second hand takes part.
  explicit Recorder(double rate_hz, std::size_t brick_rows = 8192, bool realtime = false,
                    bool second = false);
  // Calls finish() if that was not done; errors are then not reported.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Call it before start(): who seals the recording. A session that goes on with an earlier recording is not
  // sealed: a seal is about one sitting.
  void set_sealer(std::shared_ptr<Sealer> sealer) { sealer_ = std::move(sealer); }

  // Begins the file at `path` under its final name; an existing recording is replaced only when the
  // new one has its beginning. embed: this bone goes into the file in its present state. Fills in
  // burr_version, build and embedded of info.
  // on_trouble: called at most once, on a thread of the recorder, as soon as there is an error.
  // earlier: the recording that this one goes on with, whose place `path` may be (earlier_part.h).
  // The servo counts its ticks from 0 all the same; so do views and events that are noted.
  [[nodiscard]] Status start(const std::string& path, const SessionInfo& info,
                             const volume::Bone* embed = nullptr,
                             std::function<void(const Error&)> on_trouble = {},
                             const EarlierPart* earlier = nullptr);

  // ---- for the servo; within a tick: commands, bricks, then the tick
  [[nodiscard]] rt::Ring<tick::TickRow>& ticks() BURR_RT { return ticks_; }
  [[nodiscard]] rt::Ring<tick::CommandRow>& commands() BURR_RT { return commands_; }
  [[nodiscard]] rt::Ring<tick::BrickRow>& bricks() BURR_RT { return bricks_; }
  // Of the second hand, before the tick; nullptr: none takes part.
  [[nodiscard]] rt::Ring<tick::TickRow>* second() BURR_RT { return second_ ? &*second_ : nullptr; }

  // ---- for everybody but the servo, after start(): what the user saw and did. Waits for a lock; a
  // disk error does not show here, but in status(). Error: it cannot be recorded (check() of
  // view.h, course.h). A tick later than the last one counts as the last one.
  [[nodiscard]] Status note(const View& view);
  [[nodiscard]] Status note(const CourseEvent& event);

  // For a session that runs as fast as possible: call it between ticks on the servo's thread. Waits
  // (not real-time!) until no ring is more than half full. Sessions in real time never call it.
  void wait_for_room();

  // After start(): what the user should know of the place that is recorded to, one sentence each.
  [[nodiscard]] std::vector<std::string> notices() const;

  // The error so far (disk full ...). The session goes on; its rows are counted as dropped.
  [[nodiscard]] Status status() const;

  // How many ticks the kernel already has: these survive a kill.
  [[nodiscard]] std::uint64_t written_ticks() const;

  // Writes everything pushed before this call, then summary and footer. The file is then complete,
  // or the Error says what is missing. stopped: the session was ended before its time, by a signal; the
  // file says so (Player::finished()).
  [[nodiscard]] Result<RecordingStats> finish(bool stopped = false);
  // The account after finish(), successful or not.
  [[nodiscard]] RecordingStats stats() const;

 private:
  class WriterThread;
  rt::Ring<tick::TickRow> ticks_;
  rt::Ring<tick::CommandRow> commands_;
  rt::Ring<tick::BrickRow> bricks_;
  std::optional<rt::Ring<tick::TickRow>> second_;
  double rate_hz_;
  bool realtime_;
  std::string path_;
  std::uint64_t first_tick_ = 0;  // of the servo's tick 0, in the file
  std::shared_ptr<Sealer> sealer_;
  std::unique_ptr<WriterThread> writer_thread_;
};

}  // namespace burr::record

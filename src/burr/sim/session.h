// sim/session.h - a session: a bone, a hand, the servo that brings them together, and the doors
// through which other threads see them.
//
//     Result<std::unique_ptr<Session>> session =
//         Session::make(std::move(bone), std::move(hand), settings, progress);
//     (*session)->run(20.0, progress);                        // headless: to the end, or
//     (*session)->start(); ... view().take(row) ...; stop();  // in the background, beside a window
//     (*session)->step(20, progress);                         // 20 ticks on this thread, or
//
// Thread: everything on the thread that made it, except where a door says otherwise. While the
// session runs, only the servo may touch the bone; others read it through copy_brick() and their
// own watcher.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/edit/piece_move.h"
#include "burr/math/aabb.h"
#include "burr/rt/latest.h"
#include "burr/rt/stats.h"
#include "burr/rt/thread.h"
#include "burr/thermal/heat_settings.h"
#include "burr/thermal/heat_summary.h"
#include "burr/tick/command.h"
#include "burr/tick/rows.h"
#include "burr/tick/settings.h"
#include "burr/tick/shed.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::device {
class Device;
}
namespace burr::edit {
class BoneMemory;
struct BoneState;
struct MovedBricks;
}  // namespace burr::edit
namespace burr::record {
class Recorder;
}
namespace burr::haptics {
class Watchdog;
}
namespace burr::thermal {
class Worker;
}
namespace burr::tick {
struct FaultReport;
class OwnLaw;
class SecondHand;
struct SecondHandSettings;
class Servo;
}  // namespace burr::tick

namespace burr::sim {

class RowLog;

// A request for the temperature of the bone. It is computed beside the session; no force depends on
// it.
struct HeatRequest {
  math::Aabb work;  // bone outside keeps its temperature; world [m]
  thermal::HeatSettings settings;
};

struct SessionSettings {
  tick::ServoSettings servo;
  volume::IsoSettings surface;
  tick::ShedSettings shed;  // what to leave out if this machine is too slow; real time only
  bool realtime = false;    // paced by the clock and watched by a watchdog; false: as fast as
                            // possible
  int threads = 2;          // for preparing the surface
  std::optional<HeatRequest> heat;
  // In place of burr's force law (servo.law is set from it). In real time only one that may be there. nullptr:
  // none. One session alone uses it.
  std::shared_ptr<tick::OwnLaw> law;
};

// Results so far.
struct Outcome {
  std::uint64_t ticks = 0;
  double seconds = 0;     // of simulated time
  double peak_force = 0;  // largest force that reached the hand [N]
  double mean_force = 0;  // while touching [N]
  edit::Ledger ledger;
  std::uint32_t flags = 0;           // all flags that were ever raised
  std::uint64_t heat_rows_lost = 0;  // rows lost because the machine was too slow; their heat is
                                     // missing
  rt::TickSummary timing;
  std::string scheduling;  // the scheduling that the servo thread got, one sentence
  std::array<std::uint64_t, tick::kShedSteps> shed_ticks = {};  // ticks at each step of tick/shed.h
  tick::Shed most_shed = tick::Shed::none;                      // the highest step ever taken
};

class Session {
 public:
  // Checks the settings: tick/setting_table.h, and against bone and device. An error names one.
  [[nodiscard]] static Result<std::unique_ptr<Session>> make(std::unique_ptr<volume::Bone> bone,
                                                             std::unique_ptr<device::Device> device,
                                                             const SessionSettings& settings,
                                                             Progress& progress);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Adds a device for the other hand (tick/second_hand.h). Opens the device. Call it once, before
  // set_recorder(), run() or start(). Error: as its open() says, or a tool with a part thinner than a
  // voxel.
  [[nodiscard]] Status add_second_hand(std::unique_ptr<device::Device> device,
                                       const tick::SecondHandSettings& settings);
  // nullptr: there is none. Its view() and faults() are doors.
  [[nodiscard]] tick::SecondHand* second_hand() { return second_.get(); }
  // Of a session with a second hand.
  [[nodiscard]] const device::Device& second_device() const { return *second_device_; }

  // Sends everything that happens to this recorder, which must be started; call it before run() or
  // start(). nullptr: no recorder.
  void set_recorder(record::Recorder* recorder);

  // Gives the newest row to one more reader, besides view(). Call it before run() or start();
  // `watch` must outlive the session's last tick. nullptr: none.
  void set_watch(rt::Latest<tick::TickRow>* watch);

  // Calls `what` before the first tick and then before every `every`-th one, on the thread of the
  // ticks, where it may read the bone and send commands. For scripted hands: it may take its time,
  // so a session in real time never calls it. Call it before run(); {}: nothing.
  void set_between_ticks(std::function<void()> what, std::uint64_t every) {
    between_ = std::move(what);
    between_every_ = every;
  }

  // Runs until the hand has finished, `seconds` of its time are over, or progress is cancelled;
  // returns when the servo has stopped.
  void run(double seconds, Progress& progress);

  // Makes so many ticks on this thread, as fast as possible, and returns how many it made: fewer if
  // the hand has finished, or progress was cancelled (it is asked every 64 ticks). The ticks are those
  // of run(), to the bit, however they are divided among calls. Between two calls nothing happens: no
  // force fades. The time that a tick takes is not measured. Not in real time, and not while the
  // session runs.
  std::uint64_t step(std::uint64_t ticks, Progress& progress);
  // After the last step() of a session with a recorder: gives it the bricks that still wait.
  void settle();

  // Keeps rows, and voxels that cross the surface, in memory, from the next tick on (row_log.h); not
  // in real time. Both false: keeps nothing any more. What was kept before is forgotten.
  void keep_in_memory(bool rows, bool voxels);
  // nullptr: nothing is kept
  [[nodiscard]] RowLog* log() { return log_.get(); }

  // The bone as it is now, for reset_to(). Only while the session stands still.
  [[nodiscard]] edit::BoneState bone_state();
  // Puts the bone back to a state of this session, {}: to the beginning, and starts over: tick 0, an
  // empty account, nothing to undo, the settings and the hand as at the beginning; outcome() and
  // bone_before() count from here. Takes milliseconds, or as long as what was changed is large. Not
  // while the session runs. Error (usage): a session in real time, with a recorder, a second hand or
  // heat, which keep an account of their own.
  [[nodiscard]] Status reset_to(const edit::BoneState& state);

  // Runs in the background, until stop(). May be repeated.
  void start();
  void stop();
  [[nodiscard]] bool running() const { return running_.load(std::memory_order_acquire); }

  // ---- doors
  void command(const tick::Command& command);
  // Sends the command `move_piece` with its bricks, which it keeps alive. False: another piece is
  // being moved, or too many commands wait. move_state() says what became of it.
  [[nodiscard]] bool move_piece(const edit::PieceMove& move,
                                std::shared_ptr<const edit::MovedBricks> bricks);
  // The same with `lift_piece`: the piece goes out of the bone, to be held (tick/held_piece.h).
  [[nodiscard]] bool lift_piece(const edit::PieceMove& move,
                                std::shared_ptr<const edit::MovedBricks> bricks);
  // The same with `take_splinter`. second: the tube of the second hand takes it.
  [[nodiscard]] bool take_splinter(const edit::PieceMove& move, bool second,
                                   std::shared_ptr<const edit::MovedBricks> bricks);
  [[nodiscard]] tick::MoveState move_state() const;
  // How often the bone was written (edit/bone_writer.h); any thread.
  [[nodiscard]] std::uint64_t writes() const;
  [[nodiscard]] std::uint64_t writes_begun() const;
  [[nodiscard]] bool view(tick::TickRow& newest);
  [[nodiscard]] bool fault(tick::FaultReport& report);
  // The temperature, ten times a second of the session's time; false: nothing new, or not
  // requested.
  [[nodiscard]] bool heat(thermal::HeatSummary& newest);
  // ticks so far; any thread
  [[nodiscard]] std::uint64_t ticks() const { return done_.load(std::memory_order_relaxed); }
  // present radius of the burr's head [m]; any thread
  [[nodiscard]] double burr_radius() const;
  // What this machine is too slow for at present: from Shed::picture and Shed::mesh on, the caller
  // must make pictures and surface less often. Any thread.
  [[nodiscard]] tick::Shed shed() const { return shed_.load(std::memory_order_relaxed); }

  [[nodiscard]] volume::Bone& bone() { return *bone_; }
  [[nodiscard]] const volume::TissueTable& bone_tissues() const { return bone_->tissues(); }
  [[nodiscard]] device::Device& hand() { return *device_; }
  [[nodiscard]] const SessionSettings& settings() const { return settings_; }
  [[nodiscard]] const volume::IsoVertices& surface() const { return *surface_; }
  // The servo itself; only while it is stopped.
  [[nodiscard]] tick::Servo& servo() { return *servo_; }
  // The bone as it was before the first cut; only while the servo is stopped.
  [[nodiscard]] std::unique_ptr<volume::Bone> bone_before() const;
  // Only while the servo is stopped.
  [[nodiscard]] Outcome outcome() const;
  // The scheduling that the servo's thread got last.
  [[nodiscard]] const rt::ThreadGrant& grant() const { return grant_; }

 private:
  [[nodiscard]] bool send(const tick::Command& command,
                          std::shared_ptr<const edit::MovedBricks> bricks);
  Session(std::unique_ptr<volume::Bone> bone, std::unique_ptr<device::Device> device,
          const SessionSettings& settings);
  void begin(std::uint64_t ticks);
  void one_step();
  void count(const tick::TickRow& row);
  void loop(std::uint64_t ticks);
  void guard();
  void commit_ahead();

  std::unique_ptr<volume::Bone> bone_;
  std::unique_ptr<device::Device> device_, second_device_;
  SessionSettings settings_;
  std::unique_ptr<volume::IsoVertices> surface_;
  std::unique_ptr<thermal::Worker> heat_;
  std::shared_ptr<const edit::MovedBricks> moving_;  // the servo reads it
  std::unique_ptr<tick::Servo> servo_;
  std::unique_ptr<tick::SecondHand> second_;
  std::unique_ptr<haptics::Watchdog> watchdog_;
  record::Recorder* recorder_ = nullptr;
  rt::Latest<tick::TickRow>* watch_ = nullptr;
  std::unique_ptr<RowLog> log_;
  std::unique_ptr<edit::BoneMemory> memory_;  // of what earlier servos changed, reset_to()
  std::function<void()> between_;
  std::uint64_t between_every_ = 1;

  std::unique_ptr<rt::Thread> thread_, guard_, ahead_;
  std::atomic<bool> running_ = false, stop_ = false;
  std::atomic<std::uint64_t> done_ = 0;
  std::atomic<tick::Shed> shed_ = tick::Shed::none;

  // used only by the servo
  rt::TickStats stats_;
  std::array<std::uint64_t, tick::kShedSteps> shed_ticks_ = {};
  double peak_force_ = 0, force_sum_ = 0;
  std::uint64_t touching_ = 0;
  std::uint32_t flags_ = 0;
  edit::Ledger ledger_;
  rt::ThreadGrant grant_;
};

}  // namespace burr::sim

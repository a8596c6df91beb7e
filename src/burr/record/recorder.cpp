#include "burr/record/recorder.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "burr/base/check.h"
#include "burr/base/inputs.h"
#include "burr/base/version.h"
#include "burr/record/bone_blob.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/rename_and_sync.h"
#include "burr/record/schema.h"
#include "burr/record/waiting_notes.h"
#include "burr/rt/thread.h"

namespace burr::record {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(40);      // between chunks; a kill loses this
constexpr auto kShortPause = std::chrono::milliseconds(4);  // while parts of a keyframe wait
constexpr double kKeyframeEvery = 10;                       // [s] of the session
constexpr double kRingDepth = 4;                            // [s]
constexpr double kBatch = 10e-3;                            // ticks in one message [s]
// small enough that writing one delays the ticks by only a few milliseconds
constexpr std::size_t kBricksPerMessage = 1024;
// of SCHED_FIFO: below servo and guard, above everything else that could delay the 40 ms
constexpr int kPenPriority = 10;

std::size_t ring_rows(double rate_hz) {
  BURR_CHECK(rate_hz > 0 && rate_hz <= 1e6);
  return static_cast<std::size_t>(std::ceil(rate_hz * kRingDepth));
}

template <class T>
bool half_full(const rt::Ring<T>& ring) {
  return 2 * ring.size() > ring.capacity();
}

}  // namespace

// ---- the pen: the work of the recorder's threads

class Recorder::WriterThread {
 public:
  WriterThread(Recorder& recorder, std::unique_ptr<McapWriter> writer,
               const std::array<std::uint16_t, kTopics.size()>& ids,
               std::function<void(const Error&)> on_trouble)
      : recorder_(recorder), writer_(std::move(writer)), on_trouble_(std::move(on_trouble)) {
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      const std::string_view name = kTopics[i].name;
      if (name == kTicks.name) tick_channel_ = ids[i];
      if (name == kCommands.name) command_channel_ = ids[i];
      if (name == kEvents.name) event_channel_ = ids[i];
      if (name == kChanges.name) change_channel_ = ids[i];
      if (name == kKeyframes.name) keyframe_channel_ = ids[i];
      if (name == kViews.name) view_channel_ = ids[i];
      if (name == kCourse.name) course_channel_ = ids[i];
      if (name == kSecond.name) second_channel_ = ids[i];
    }
    last_write_ = Clock::now();
    syncer_ = std::thread([this] { sync_run(); });
    thread_ = std::make_unique<rt::Thread>(
        rt::ThreadRequest{.name = "pen", .realtime = recorder.realtime_, .priority = kPenPriority},
        [this] { run(); });
  }
  ~WriterThread() { stop(); }
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  void stop(bool early = false) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      stopped_early_ = stopped_early_ || early;
    }
    wake_.notify_all();
    thread_->join();
    {
      const std::lock_guard lock(sync_mutex_);
      sync_stopping_ = true;
    }
    sync_wake_.notify_all();
    if (syncer_.joinable()) syncer_.join();
  }

  void wait_for_room() {
    std::unique_lock lock(mutex_);
    while (crowded() && !stopping_) {
      hurry_ = true;
      wake_.notify_all();
      room_.wait_for(lock, kPause);
    }
  }

  [[nodiscard]] bool crowded() const {
    return half_full(recorder_.ticks_) || half_full(recorder_.commands_) ||
           half_full(recorder_.bricks_) || (recorder_.second_ && half_full(*recorder_.second_));
  }

  [[nodiscard]] Status status() const {
    const std::lock_guard lock(mutex_);
    return trouble_ ? Status(*trouble_) : fine();
  }

  [[nodiscard]] std::uint64_t written_ticks() const { return written_ticks_.load(); }

  [[nodiscard]] WaitingNotes& notes() { return notes_; }

  // after stop()
  [[nodiscard]] RecordingStats stats() const {
    RecordingStats account = account_;
    account.written_ticks = written_ticks_.load();
    account.bytes = writer_->size();
    return account;
  }

 private:
  void run() {
    for (;;) {
      bool last = false;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, keyframe_.empty() ? kPause : kShortPause,
                       [&] { return stopping_ || hurry_; });
        hurry_ = false;
        last = stopping_;
      }
      work(last);
      room_.notify_all();
      if (last) return;
    }
  }

  void work(bool last) {
    // running out of memory is the only exception possible here; the session goes on unrecorded
    try {
      Status done = failed_ ? fine() : drain(last);
      if (failed_) discard();
      if (!done.ok()) fail(done.error());
    } catch (const std::bad_alloc&) {
      fail(error(Trouble::io, "recording: there is not enough memory; the recording ends here"));
    }
  }

  void fail(const Error& problem) {
    failed_ = true;
    // taken from the ring but not written
    account_.dropped_ticks += account_.ticks - written_ticks_;
    account_.ticks = written_ticks_;
    tell(problem);
  }

  // pen or syncer
  void tell(const Error& problem) {
    {
      const std::lock_guard lock(mutex_);
      if (trouble_) return;
      trouble_ = problem;
    }
    if (on_trouble_) on_trouble_(problem);
  }

  // after a failure: empties the rings, because wait_for_room() would never return from full ones
  void discard() {
    tick::TickRow tick;
    tick::CommandRow command;
    tick::BrickRow brick;
    while (recorder_.ticks_.pop(tick)) ++account_.dropped_ticks;
    while (recorder_.commands_.pop(command)) ++account_.dropped_commands;
    while (recorder_.bricks_.pop(brick)) ++account_.dropped_bricks;
    while (recorder_.second_ && recorder_.second_->pop(tick)) ++account_.dropped_ticks;
    notes_.drop_all();
    account_.dropped_notes = notes_.dropped();
  }

  Status drain(bool last) {
    // Ticks first: everything that belongs to a tick was pushed before it, so it is in the rings by
    // now. Rows of a newer tick wait for it, so that chunks are in order of time.
    const std::uint64_t first = end_tick_;
    take_ticks();
    const std::uint64_t until = last ? std::numeric_limits<std::uint64_t>::max() : end_tick_;
    take_second(until);
    take_commands(until);
    take_bricks(until);
    take_notes(first, until);
    note_dropped();
    Status written = write_chunk();
    if (!written.ok()) return written;

    if (keyframe_due()) begin_keyframe();
    do {
      if (keyframe_.empty()) break;
      put_keyframe_part();
      written = write_chunk();
    } while (last && written.ok());
    if (!written.ok() || !last) return written;

    put_event(stopped_early_ ? "stopped" : "finished");
    const auto number = [](std::uint64_t value) { return fmt::format("{}", value); };
    if (Status added = writer_->add_metadata("burr.account",
                                             {{"ticks", number(account_.ticks)},
                                              {"wishes", number(account_.commands)},
                                              {"brick_rows", number(account_.brick_rows)},
                                              {"keyframes", number(account_.keyframes)},
                                              {"views", number(account_.views)},
                                              {"events", number(account_.events)},
                                              {"dropped_ticks", number(account_.dropped_ticks)},
                                              {"dropped_wishes", number(account_.dropped_commands)},
                                              {"dropped_bricks", number(account_.dropped_bricks)},
                                              {"dropped_notes", number(account_.dropped_notes)}});
        !added.ok())
      return added;
    stop_syncing();
    Status whole = writer_->still_there();
    return whole.ok() ? writer_->finish() : whole;
  }

  Status write_chunk() {
    const bool something = writer_->chunk_open();
    Status written = writer_->close_chunk();
    // bytes in a file that has been removed are lost, whatever the kernel says
    if (something && written.ok()) written = writer_->still_there();
    if (!written.ok()) return written;
    written_ticks_.store(account_.ticks);
    const Clock::time_point now = Clock::now();
    if (!something) {
      last_write_ = now;  // nothing waits, so nothing could be lost
      return written;
    }
    account_.longest_pause_s = std::max(account_.longest_pause_s,
                                        std::chrono::duration<double>(now - last_write_).count());
    last_write_ = now;
    {
      const std::lock_guard lock(sync_mutex_);
      sync_wanted_ = true;
    }
    sync_wake_.notify_all();
    return written;
  }

  [[nodiscard]] std::uint64_t time_ns(std::uint64_t tick) const {
    return static_cast<std::uint64_t>(
        std::llround(static_cast<double>(tick) * 1e9 / recorder_.rate_hz_));
  }

  void put(std::uint16_t channel, std::uint64_t tick, ByteSpan message) {
    writer_->add_message(channel, ++sequence_[channel], time_ns(tick), message);
  }

  void take_ticks() {
    const std::size_t per_message = rows_per_message();
    std::vector<tick::TickRow> rows;
    tick::TickRow row;
    // at most as many as there are now: a servo as fast as this thread would keep it here for ever
    for (std::size_t left = recorder_.ticks_.size(); left > 0 && recorder_.ticks_.pop(row);
         --left) {
      rows.push_back(row);
      if (rows.size() < per_message && left > 1) continue;
      message_.clear();
      encode_ticks(rows, message_);
      put(tick_channel_, rows.front().tick, message_.span());
      account_.ticks += rows.size();
      end_tick_ = rows.back().tick + 1;
      rows.clear();
    }
  }

  [[nodiscard]] std::size_t rows_per_message() const {
    return static_cast<std::size_t>(std::max(1.0, std::round(recorder_.rate_hz_ * kBatch)));
  }

  // The next row of a tick before `until`; a newer one is kept for the next call.
  template <class Row>
  static bool next_until(rt::Ring<Row>& ring, std::optional<Row>& waiting, std::uint64_t until,
                         Row& row) {
    if (!waiting) {
      if (!ring.pop(row)) return false;
      waiting = row;
    }
    if (waiting->tick >= until) return false;
    row = *waiting;
    waiting.reset();
    return true;
  }

  void take_second(std::uint64_t until) {
    if (!recorder_.second_ || second_channel_ == 0) return;
    std::vector<tick::TickRow> rows;
    tick::TickRow row;
    const auto put_rows = [&] {
      if (rows.empty()) return;
      message_.clear();
      encode_ticks(rows, message_);
      put(second_channel_, rows.front().tick, message_.span());
      rows.clear();
    };
    while (next_until(*recorder_.second_, waiting_second_, until, row)) {
      rows.push_back(row);
      if (rows.size() >= rows_per_message()) put_rows();
    }
    put_rows();
  }

  void take_commands(std::uint64_t until) {
    tick::CommandRow row;
    while (next_until(recorder_.commands_, waiting_command_, until, row)) {
      put(command_channel_, row.tick, as_bytes(to_json(row)));
      ++account_.commands;
    }
  }

  void take_bricks(std::uint64_t until) {
    Bricks bricks;
    tick::BrickRow row;
    while (next_until(recorder_.bricks_, waiting_brick_, until, row)) {
      // the new content goes to the mirror, the difference to the file
      BrickContent& mirror = mirror_[row.brick];
      BrickContent change;
      change.field = row.field;
      change.tissue = row.tissue;
      change.has_tissue = row.has_tissue;
      apply_xor(change, mirror);
      change.has_tissue = row.has_tissue;  // the mirror may have tissue where the row has none
      apply_xor(mirror, change);
      bricks.tick.push_back(row.tick);
      bricks.brick.push_back(row.brick);
      bricks.crc.push_back(mirror.crc());
      bricks.content.push_back(change);
      if (bricks.tick.size() == kBricksPerMessage) put_changes(bricks);
    }
    put_changes(bricks);
  }

  // first: of this chunk; an earlier time would put the chunk out of order
  void take_notes(std::uint64_t first, std::uint64_t until) {
    for (const WaitingNote& note : notes_.take(until)) {
      put(note.view ? view_channel_ : course_channel_,
          std::min(std::max(note.tick, first), last_tick()), as_bytes(note.json));
      ++(note.view ? account_.views : account_.events);
    }
  }

  void put_changes(Bricks& bricks) {
    if (bricks.tick.empty()) return;
    bricks.batch = ++batch_;
    message_.clear();
    encode_bricks(bricks, message_);
    put(change_channel_, bricks.tick.front(), message_.span());
    account_.brick_rows += bricks.tick.size();
    changed_since_keyframe_ = true;
    bricks = {};
  }

  [[nodiscard]] std::uint64_t last_tick() const { return end_tick_ == 0 ? 0 : end_tick_ - 1; }

  [[nodiscard]] bool keyframe_due() const {
    return keyframe_.empty() && changed_since_keyframe_ &&
           static_cast<double>(end_tick_ - keyframe_tick_) >= kKeyframeEvery * recorder_.rate_hz_;
  }

  // Copies the present bone, then writes it part by part between the ticks.
  void begin_keyframe() {
    std::vector<volume::BrickIndex> order;
    order.reserve(mirror_.size());
    for (const auto& [brick, content] : mirror_) order.push_back(brick);
    std::sort(order.begin(), order.end());  // so that the same session gives the same file
    keyframe_.reserve(order.size());
    for (const volume::BrickIndex brick : order) keyframe_.emplace_back(brick, mirror_[brick]);
    keyframe_tick_ = last_tick();
    keyframe_batch_ = batch_;
    keyframe_done_ = 0;
    changed_since_keyframe_ = false;
  }

  void put_keyframe_part() {
    const std::size_t n = std::min(kBricksPerMessage, keyframe_.size() - keyframe_done_);
    Bricks part;
    part.batch = keyframe_batch_;
    part.part = static_cast<std::uint32_t>(keyframe_done_ / kBricksPerMessage);
    part.parts =
        static_cast<std::uint32_t>((keyframe_.size() + kBricksPerMessage - 1) / kBricksPerMessage);
    for (std::size_t i = keyframe_done_; i < keyframe_done_ + n; ++i) {
      part.tick.push_back(keyframe_tick_);
      part.brick.push_back(keyframe_[i].first);
      part.crc.push_back(keyframe_[i].second.crc());
      part.content.push_back(keyframe_[i].second);
    }
    message_.clear();
    encode_bricks(part, message_);
    put(keyframe_channel_, keyframe_tick_, message_.span());
    keyframe_done_ += n;
    if (keyframe_done_ < keyframe_.size()) return;
    keyframe_.clear();
    keyframe_.shrink_to_fit();
    ++account_.keyframes;
  }

  void note_dropped() {
    const auto lost = [this] {
      return std::tuple(account_.dropped_ticks, account_.dropped_commands, account_.dropped_bricks,
                        account_.dropped_notes);
    };
    const auto before = lost();
    account_.dropped_ticks =
        recorder_.ticks_.dropped() + (recorder_.second_ ? recorder_.second_->dropped() : 0);
    account_.dropped_commands = recorder_.commands_.dropped();
    account_.dropped_bricks = recorder_.bricks_.dropped();
    account_.dropped_notes = notes_.dropped();
    if (before != lost()) put_event("dropped");
  }

  void put_event(const char* event) {
    const std::string text = fmt::format(
        R"({{"event":"{}","tick":{},"dropped_ticks":{},"dropped_wishes":{},"dropped_bricks":{},"dropped_notes":{}}})",
        event, last_tick(), account_.dropped_ticks, account_.dropped_commands,
        account_.dropped_bricks, account_.dropped_notes);
    put(event_channel_, last_tick(), as_bytes(text));
  }

  // ---- the other thread: bringing data to the disk may take as long as the disk needs

  void sync_run() {
    std::unique_lock lock(sync_mutex_);
    for (;;) {
      sync_wake_.wait(lock, [&] { return sync_wanted_ || sync_stopping_; });
      if (sync_stopping_) return;
      sync_wanted_ = false;
      lock.unlock();
      if (Status synced = writer_->sync(); !synced.ok()) tell(synced.error());
      lock.lock();
    }
  }

  void stop_syncing() {
    {
      const std::lock_guard lock(sync_mutex_);
      sync_stopping_ = true;
    }
    sync_wake_.notify_all();
    syncer_.join();
  }

  Recorder& recorder_;
  std::unique_ptr<McapWriter> writer_;
  std::function<void(const Error&)> on_trouble_;
  std::uint16_t tick_channel_ = 0, command_channel_ = 0, event_channel_ = 0, change_channel_ = 0,
                keyframe_channel_ = 0, view_channel_ = 0, course_channel_ = 0,
                second_channel_ = 0;  // 0: no second hand
  WaitingNotes notes_;
  std::map<std::uint16_t, std::uint32_t> sequence_;

  // used only by the pen
  BytesOut message_;
  RecordingStats account_;
  bool failed_ = false;
  Clock::time_point last_write_;
  std::uint64_t end_tick_ = 0;  // ticks before this one have been taken
  std::optional<tick::CommandRow> waiting_command_;
  std::optional<tick::BrickRow> waiting_brick_;
  std::optional<tick::TickRow> waiting_second_;
  std::unordered_map<volume::BrickIndex, BrickContent> mirror_;  // state of the bone according to
                                                                 // the file
  std::uint64_t batch_ = 0;
  std::vector<std::pair<volume::BrickIndex, BrickContent>> keyframe_;  // being written
  std::uint64_t keyframe_tick_ = 0, keyframe_batch_ = 0;
  std::size_t keyframe_done_ = 0;
  bool changed_since_keyframe_ = false;

  // shared between threads
  mutable std::mutex mutex_;
  std::condition_variable wake_, room_;
  bool stopping_ = false, hurry_ = false;
  bool stopped_early_ = false;  // written before stopping_, read after it
  std::atomic<std::uint64_t> written_ticks_ = 0;
  std::optional<Error> trouble_;
  std::mutex sync_mutex_;
  std::condition_variable sync_wake_;
  bool sync_wanted_ = false, sync_stopping_ = false;
  std::thread syncer_;
  std::unique_ptr<rt::Thread> thread_;
};

// ---- the recorder

Recorder::Recorder(double rate_hz, std::size_t brick_rows, bool realtime, bool second)
    : ticks_(ring_rows(rate_hz)),
      commands_(1024),
      bricks_(brick_rows),
      rate_hz_(rate_hz),
      realtime_(realtime) {
  if (second) second_.emplace(ring_rows(rate_hz));
}

Recorder::~Recorder() = default;

Status Recorder::start(const std::string& path, const SessionInfo& asked, const volume::Bone* embed,
                       std::function<void(const Error&)> on_trouble) {
  BURR_CHECK(writer_thread_ == nullptr);
  SessionInfo info = asked;
  info.burr_version = base::version();
  info.build = base::build();
  info.rate_hz = rate_hz_;
  info.embedded = embed != nullptr;
  if (Status good = check(info); !good.ok()) return good;

  if (const Status allowed = base::check_not_input(path); !allowed) return allowed;
  if (being_written(path))
    return error(Trouble::io,
                 path + ": another burr is recording to this file; choose another name");

  // under another name until it has its beginning; until then an older recording is safe
  const std::string beside = path + ".part";
  const auto give_up = [&](const Error& problem) {
    ::unlink(beside.c_str());
    return problem;
  };
  auto writer = std::make_unique<McapWriter>();
  // A file there that another user's burr left when it was killed, and that this user may not
  // write, is rubbish. It must be readable, so that a lock on it can be seen.
  if (::access(beside.c_str(), R_OK) == 0 && ::access(beside.c_str(), W_OK) != 0 &&
      !being_written(beside))
    ::unlink(beside.c_str());
  if (Status opened = writer->open(beside, path); !opened.ok()) return opened;
  if (Status added = writer->add_metadata(
          "burr.format", {{"version", fmt::format("{}", kFormatVersion)},
                          {"time",
                           "log_time is tick / rate_hz since the start, in nanoseconds; "
                           "recordings hold no dates"},
                          {"described_in", "docs/recording.md of burr"}});
      !added.ok())
    return give_up(added.error());

  std::array<std::uint16_t, kTopics.size()> ids{};
  std::map<std::string, std::uint16_t> schemas;
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    const Topic& topic = kTopics[i];
    if (topic.name == std::string_view(kSecond.name) && !second_) continue;
    if (!schemas.contains(topic.schema_name)) {
      const auto schema = writer->add_schema(topic.schema_name, topic.schema_encoding,
                                             schema_data(topic.schema_name));
      if (!schema) return give_up(schema.error());
      schemas[topic.schema_name] = *schema;
    }
    const auto id = writer->add_channel(topic.name, topic.encoding, schemas[topic.schema_name]);
    if (!id) return give_up(id.error());
    ids[i] = *id;
  }
  if (embed != nullptr)
    if (Status added =
            writer->add_attachment(kBoneAttachment, kBoneMediaType, bone_to_blob(*embed));
        !added.ok())
      return give_up(added.error());
  writer->add_message(ids[0], 1, 0, as_bytes(to_json(info)));
  if (Status written = writer->close_chunk(); !written.ok()) return give_up(written.error());
  if (Status synced = writer->sync(); !synced.ok()) return give_up(synced.error());
  if (Status placed = rename_and_sync(beside, path); !placed.ok()) return give_up(placed.error());

  writer_thread_ =
      std::make_unique<WriterThread>(*this, std::move(writer), ids, std::move(on_trouble));
  return fine();
}

Status Recorder::note(const View& view) {
  BURR_CHECK(writer_thread_ != nullptr);
  if (Status good = check(view); !good.ok()) return good;
  writer_thread_->notes().put({true, view.tick, to_json(view)});
  return fine();
}

Status Recorder::note(const CourseEvent& event) {
  BURR_CHECK(writer_thread_ != nullptr);
  if (Status good = check(event); !good.ok()) return good;
  writer_thread_->notes().put({false, event.tick, to_json(event)});
  return fine();
}

void Recorder::wait_for_room() {
  if (writer_thread_ && writer_thread_->crowded()) writer_thread_->wait_for_room();
}

Status Recorder::status() const { return writer_thread_ ? writer_thread_->status() : fine(); }

Result<RecordingStats> Recorder::finish(bool stopped) {
  BURR_CHECK(writer_thread_ != nullptr);
  writer_thread_->stop(stopped);
  if (Status done = writer_thread_->status(); !done.ok()) return done.error();
  return writer_thread_->stats();
}

std::uint64_t Recorder::written_ticks() const {
  return writer_thread_ ? writer_thread_->written_ticks() : 0;
}

RecordingStats Recorder::stats() const {
  return writer_thread_ ? writer_thread_->stats() : RecordingStats{};
}

}  // namespace burr::record

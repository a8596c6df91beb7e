#include "burr/record/recorder.h"

#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include "burr/base/check.h"
#include "burr/base/inputs.h"
#include "burr/record/earlier_part.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/pen.h"
#include "burr/record/rename_and_sync.h"
#include "burr/record/schema.h"
#include "burr/rt/thread.h"

namespace burr::record {
namespace {

constexpr auto kPause = std::chrono::milliseconds(40);      // between chunks; a kill loses this
constexpr auto kShortPause = std::chrono::milliseconds(4);  // while parts of a keyframe wait
constexpr double kRingDepth = 4;                            // [s]
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
  WriterThread(Recorder& recorder, std::unique_ptr<Pen> pen,
               std::function<void(const Error&)> on_trouble)
      : recorder_(recorder),
        pen_(std::move(pen)),
        on_trouble_(std::move(on_trouble)),
        locked_(pen_->writer().locked()) {
    pen_->set_on_chunk([this] {
      {
        const std::lock_guard lock(sync_mutex_);
        sync_wanted_ = true;
      }
      sync_wake_.notify_all();
    });
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

  [[nodiscard]] std::uint64_t written_ticks() const { return pen_->written_ticks(); }
  [[nodiscard]] bool locked() const { return locked_; }

  [[nodiscard]] WaitingNotes& notes() { return pen_->notes(); }

  // after stop()
  [[nodiscard]] RecordingStats stats() const { return pen_->stats(); }

 private:
  void run() {
    for (;;) {
      bool last = false;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, pen_->keyframe_waits() ? kShortPause : kPause,
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
      Status done = failed_ ? fine() : last ? write_end() : pen_->drain();
      if (failed_) pen_->discard();
      if (!done.ok()) fail(done.error());
    } catch (const std::bad_alloc&) {
      fail(error(Trouble::io, "recording: there is not enough memory; the recording ends here"));
    }
  }

  Status write_end() {
    if (Status drained = pen_->drain_last(stopped_early_); !drained.ok()) return drained;
    stop_syncing();
    const Status finished = pen_->finish();
    const std::lock_guard lock(sync_mutex_);
    return finished.ok() && unsynced_ ? Status(*unsynced_) : finished;
  }

  void fail(const Error& problem) {
    failed_ = true;
    pen_->lose_unwritten();
    tell(problem);
  }

  void tell(const Error& problem) {
    {
      const std::lock_guard lock(mutex_);
      if (trouble_) return;
      trouble_ = problem;
    }
    if (on_trouble_) on_trouble_(problem);
  }

  // ---- the other thread: bringing data to the disk may take as long as the disk needs

  void sync_run() {
    std::unique_lock lock(sync_mutex_);
    for (;;) {
      sync_wake_.wait(lock, [&] { return sync_wanted_ || sync_stopping_; });
      if (sync_stopping_) return;
      sync_wanted_ = false;
      lock.unlock();
      const Status synced = pen_->writer().sync();
      lock.lock();
      // what is written goes on to be read, so the recording goes on; finish() reports it. The system says
      // it once, so it is kept
      if (!synced.ok() && !unsynced_) unsynced_ = synced.error();
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
  std::unique_ptr<Pen> pen_;
  std::function<void(const Error&)> on_trouble_;
  bool failed_ = false;  // used only by the pen's thread
  const bool locked_;

  // shared between threads
  mutable std::mutex mutex_;
  std::condition_variable wake_, room_;
  bool stopping_ = false, hurry_ = false;
  bool stopped_early_ = false;  // written before stopping_, read after it
  std::optional<Error> trouble_;
  std::mutex sync_mutex_;
  std::condition_variable sync_wake_;
  bool sync_wanted_ = false, sync_stopping_ = false;
  std::optional<Error> unsynced_;
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
                       std::function<void(const Error&)> on_trouble, const EarlierPart* earlier) {
  BURR_CHECK(writer_thread_ == nullptr);
  SessionInfo info = Pen::completed(asked, rate_hz_, embed != nullptr);
  if (Status good = check(info); !good.ok()) return good;

  if (earlier != nullptr)
    if (const Status same = goes_on(earlier->info, info); !same)
      return error(Trouble::usage,
                   fmt::format("{}: this session cannot be continued in its own recording, because "
                               "{}",
                               path, same.error().text));
  if (earlier == nullptr)  // otherwise it may be the file that was read, which goes on
    if (const Status allowed = base::check_not_input(path); !allowed) return allowed;
  if (being_written(path))
    return error(Trouble::io,
                 path + ": another burr is recording to this file; choose another name");

  if (sealer_ != nullptr && earlier == nullptr) info.seal = sealer_->begin(info);

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
  const Pen::Rings rings{ticks_, commands_, bricks_, second_ ? &*second_ : nullptr};
  auto pen = earlier != nullptr ? Pen::go_on(writer, info, rings, *earlier)
                                : Pen::begin(writer, info, embed, rings);
  if (!pen) return give_up(pen.error());
  if (Status synced = (*pen)->writer().sync(); !synced.ok()) return give_up(synced.error());
  if (Status placed = rename_and_sync(beside, path); !placed.ok()) return give_up(placed.error());

  path_ = path;
  first_tick_ = earlier != nullptr ? earlier->ticks : 0;
  if (info.seal) (*pen)->set_sealer(sealer_, path);
  (*pen)->session_begins();
  writer_thread_ = std::make_unique<WriterThread>(*this, std::move(*pen), std::move(on_trouble));
  return fine();
}

Status Recorder::note(const View& view) {
  BURR_CHECK(writer_thread_ != nullptr);
  if (Status good = check(view); !good.ok()) return good;
  View later = view;
  later.tick += first_tick_;
  writer_thread_->notes().put({true, later.tick, to_json(later)});
  return fine();
}

Status Recorder::note(const CourseEvent& event) {
  BURR_CHECK(writer_thread_ != nullptr);
  if (Status good = check(event); !good.ok()) return good;
  CourseEvent later = event;
  later.tick += first_tick_;
  writer_thread_->notes().put({false, later.tick, to_json(later)});
  return fine();
}

std::vector<std::string> Recorder::notices() const {
  if (!writer_thread_ || writer_thread_->locked()) return {};
  return {
      path_ +
      ": its file system has no locks, so another burr could write the same file, and nobody can "
      "see that it is still being recorded; give each session a name of its own"};
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

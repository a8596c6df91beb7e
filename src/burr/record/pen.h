// record/pen.h - writes a recording: takes what waits in the rings, and puts it into the file, chunk
// by chunk.
//
//     auto pen = Pen::begin(writer, info, embed, rings);    // format, topics, bone, session
//     now and then:  (*pen)->drain();
//     at the end:    (*pen)->drain_last(stopped); (*pen)->finish();
//
// It starts no thread and waits for nobody: the Recorder gives it a thread of its own, a page in a
// browser calls it between ticks. Thread: one; notes() and written_ticks() any. Memory: a copy of the
// changed bricks, twice while a keyframe is written. Errors: as McapWriter.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/counted_on.h"
#include "burr/record/earlier_part.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/recording_stats.h"
#include "burr/record/schema.h"
#include "burr/record/sealer.h"
#include "burr/record/session_info.h"
#include "burr/record/text_sums.h"
#include "burr/record/waiting_notes.h"
#include "burr/rt/ring.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::record {

class Pen {
 public:
  // Where the rows come from; they outlive the pen.
  struct Rings {
    rt::Ring<tick::TickRow>& ticks;
    rt::Ring<tick::CommandRow>& commands;
    rt::Ring<tick::BrickRow>& bricks;
    rt::Ring<tick::TickRow>* second;  // of the second hand; nullptr: none takes part
  };

  // What is to be written of a session: with version, build, rate, and whether the bone comes along.
  [[nodiscard]] static SessionInfo completed(const SessionInfo& asked, double rate_hz, bool embed);

  // Writes the beginning, down to the description of the session. The writer's file is open. info:
  // completed(). embed: nullptr: without the bone.
  [[nodiscard]] static Result<std::unique_ptr<Pen>> begin(std::unique_ptr<McapWriter>& writer,
                                                          const SessionInfo& info,
                                                          const volume::Bone* embed,
                                                          const Rings& rings);
  // The same for a session that is continued: writes the recording that it goes on with, then its
  // description (pen_goes_on.cpp, which a page in a browser leaves out).
  [[nodiscard]] static Result<std::unique_ptr<Pen>> go_on(std::unique_ptr<McapWriter>& writer,
                                                          const SessionInfo& info,
                                                          const Rings& rings,
                                                          const EarlierPart& earlier);

  // Called after each chunk that was given to the kernel.
  void set_on_chunk(std::function<void()> what) { on_chunk_ = std::move(what); }

  // file: the place of the recording. Its seal comes after the account.
  void set_sealer(std::shared_ptr<Sealer> sealer, std::string file) {
    sealer_ = std::move(sealer);
    sealed_file_ = std::move(file);
  }

  // The session begins now: pauses are counted from here.
  void session_begins() { last_write_ = std::chrono::steady_clock::now(); }
  // Writes what waits: one chunk, and a part of a keyframe.
  [[nodiscard]] Status drain() { return drain(false); }
  // Everything that waits, the keyframe, the account and the seal. stopped: the session ended before its time.
  [[nodiscard]] Status drain_last(bool stopped);
  // Summary and footer.
  [[nodiscard]] Status finish();
  // After a failure: empties the rings, and counts their rows as dropped.
  void discard();
  // Rows that were taken but not written are lost.
  void lose_unwritten();

  [[nodiscard]] bool keyframe_waits() const { return !keyframe_.empty(); }
  [[nodiscard]] WaitingNotes& notes() { return notes_; }
  [[nodiscard]] McapWriter& writer() { return *writer_; }
  [[nodiscard]] std::uint64_t written_ticks() const { return written_ticks_.load(); }
  [[nodiscard]] RecordingStats stats() const;

 private:
  using ChannelIds = std::array<std::uint16_t, kTopics.size()>;
  struct Topics {  // of the recording that goes on, by name
    std::map<std::string, std::uint16_t> schemas, channels;
  };
  Pen(std::unique_ptr<McapWriter> writer, const Rings& rings, double rate_hz);
  [[nodiscard]] Status drain(bool last);
  [[nodiscard]] Status write_chunk();
  [[nodiscard]] Status write_beginning(const SessionInfo& info, const volume::Bone* embed);
  [[nodiscard]] Status copy_earlier(const EarlierPart& earlier);
  void take_up(const SessionInfo& info, const EarlierPart& earlier);
  [[nodiscard]] Result<ChannelIds> add_topics(const Topics& had);
  void name_channels(const ChannelIds& ids);
  [[nodiscard]] std::uint64_t time_ns(std::uint64_t tick) const;
  void put(std::uint16_t channel, std::uint64_t tick, ByteSpan message);
  [[nodiscard]] Status put_account();
  [[nodiscard]] Status put_seal();
  void take_ticks();
  [[nodiscard]] std::size_t rows_per_message() const;
  void take_second(std::uint64_t until);
  void take_commands(std::uint64_t until);
  void take_bricks(std::uint64_t until);
  void take_notes(std::uint64_t first, std::uint64_t until);
  void put_changes(Bricks& bricks);
  [[nodiscard]] std::uint64_t last_tick() const;
  [[nodiscard]] bool keyframe_due() const;
  void begin_keyframe();
  void put_keyframe_part();
  void note_dropped();
  void put_event(const char* event);

  Rings rings_;
  std::unique_ptr<McapWriter> writer_;
  double rate_hz_;
  std::function<void()> on_chunk_;
  std::uint16_t session_channel_ = 0, tick_channel_ = 0, command_channel_ = 0, event_channel_ = 0,
                change_channel_ = 0, keyframe_channel_ = 0, view_channel_ = 0, course_channel_ = 0,
                second_channel_ = 0;  // 0: no second hand
  WaitingNotes notes_;
  std::map<std::uint16_t, std::uint32_t> sequence_;
  std::map<std::uint16_t, const char*> summed_;  // channels of texts, with their topics
  TextSums sums_;                                // of the texts so far
  std::shared_ptr<Sealer> sealer_;
  std::string sealed_file_;

  BytesOut message_;
  RecordingStats account_;
  std::chrono::steady_clock::time_point last_write_;
  // Of the part of the session that is recorded now; the servo counts from 0.
  std::uint64_t first_tick_ = 0;
  CountedOn hand_, second_hand_;
  RecordingStats before_;       // the account of the earlier parts
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
  std::atomic<std::uint64_t> written_ticks_ = 0;
};

}  // namespace burr::record

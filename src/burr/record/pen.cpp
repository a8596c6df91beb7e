#include "burr/record/pen.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>

#include "burr/base/version.h"
#include "burr/record/bone_blob.h"

namespace burr::record {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kKeyframeEvery = 10;  // [s] of the session
constexpr double kBatch = 10e-3;       // ticks in one message [s]
// small enough that writing one delays the ticks by only a few milliseconds
constexpr std::size_t kBricksPerMessage = 1024;

// The next row of a tick before `until`; a newer one is kept for the next call. change: makes of a row of
// the servo one of the file.
template <class Row, class Change>
bool next_until(rt::Ring<Row>& ring, std::optional<Row>& waiting, const Change& change,
                std::uint64_t until, Row& row) {
  if (!waiting) {
    if (!ring.pop(row)) return false;
    change(row);
    waiting = row;
  }
  if (waiting->tick >= until) return false;
  row = *waiting;
  waiting.reset();
  return true;
}

}  // namespace

// ---- the beginning

SessionInfo Pen::completed(const SessionInfo& asked, double rate_hz, bool embed) {
  SessionInfo info = asked;
  info.burr_version = base::version();
  info.build = base::build();
  info.rate_hz = rate_hz;
  info.embedded = embed;
  return info;
}

Pen::Pen(std::unique_ptr<McapWriter> writer, const Rings& rings, double rate_hz)
    : rings_(rings), writer_(std::move(writer)), rate_hz_(rate_hz), last_write_(Clock::now()) {}

Result<std::unique_ptr<Pen>> Pen::begin(std::unique_ptr<McapWriter>& writer,
                                        const SessionInfo& info, const volume::Bone* embed,
                                        const Rings& rings) {
  std::unique_ptr<Pen> pen(new Pen(std::move(writer), rings, info.rate_hz));
  if (Status begun = pen->write_beginning(info, embed); !begun.ok()) {
    writer = std::move(pen->writer_);  // with its lock, until the caller has removed the file
    return begun.error();
  }
  return pen;
}

Status Pen::write_beginning(const SessionInfo& info, const volume::Bone* embed) {
  if (Status added = writer_->add_metadata(
          "burr.format", {{"version", fmt::format("{}", kFormatVersion)},
                          {"time",
                           "log_time is tick / rate_hz since the start, in nanoseconds; "
                           "recordings hold no dates"},
                          {"described_in", "docs/use/recording.md of burr"}});
      !added.ok())
    return added;

  const auto ids = add_topics({});
  if (!ids) return ids.error();
  if (embed != nullptr)
    if (Status added =
            writer_->add_attachment(kBoneAttachment, kBoneMediaType, bone_to_blob(*embed));
        !added.ok())
      return added;
  name_channels(*ids);
  const std::string session = to_json(info);
  add_to(sums_, kSession.name, as_bytes(session));
  writer_->add_message(session_channel_, 1, 0, as_bytes(session));
  return writer_->close_chunk();
}

// The channels of a recording; those of the earlier one keep their numbers.
Result<Pen::ChannelIds> Pen::add_topics(const Topics& had) {
  ChannelIds ids{};
  std::map<std::string, std::uint16_t> schemas = had.schemas;
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    const Topic& topic = kTopics[i];
    if (topic.name == std::string_view(kSecond.name) && rings_.second == nullptr) continue;
    if (const auto earlier = had.channels.find(topic.name); earlier != had.channels.end()) {
      ids[i] = earlier->second;
      continue;
    }
    if (!schemas.contains(topic.schema_name)) {
      const auto schema = writer_->add_schema(topic.schema_name, topic.schema_encoding,
                                              schema_data(topic.schema_name));
      if (!schema) return schema.error();
      schemas[topic.schema_name] = *schema;
    }
    const auto id = writer_->add_channel(topic.name, topic.encoding, schemas[topic.schema_name]);
    if (!id) return id.error();
    ids[i] = *id;
  }
  return ids;
}

void Pen::name_channels(const ChannelIds& ids) {
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    const std::string_view name = kTopics[i].name;
    if (name == kSession.name) session_channel_ = ids[i];
    if (name == kTicks.name) tick_channel_ = ids[i];
    if (name == kCommands.name) command_channel_ = ids[i];
    if (name == kEvents.name) event_channel_ = ids[i];
    if (name == kChanges.name) change_channel_ = ids[i];
    if (name == kKeyframes.name) keyframe_channel_ = ids[i];
    if (name == kViews.name) view_channel_ = ids[i];
    if (name == kCourse.name) course_channel_ = ids[i];
    if (name == kSecond.name) second_channel_ = ids[i];
    if (is_summed(name)) summed_[ids[i]] = kTopics[i].name;
  }
}

// ---- what waits

Status Pen::drain(bool last) {
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
  return written;
}

Status Pen::drain_last(bool stopped) {
  if (Status drained = drain(true); !drained.ok()) return drained;
  put_event(stopped ? "stopped" : "finished");
  // the event must be in the file before the account says what is in the file, and the seal that this is all
  if (Status written = write_chunk(); !written.ok()) return written;
  if (Status put = put_account(); !put.ok()) return put;
  return sealer_ ? put_seal() : fine();
}

Status Pen::put_account() {
  const auto number = [](std::uint64_t value) { return fmt::format("{}", value); };
  mcap::Pairs account = {{"ticks", number(account_.ticks)},
                         {"wishes", number(account_.commands)},
                         {"brick_rows", number(account_.brick_rows)},
                         {"keyframes", number(account_.keyframes)},
                         {"views", number(account_.views)},
                         {"events", number(account_.events)},
                         {"dropped_ticks", number(account_.dropped_ticks)},
                         {"dropped_wishes", number(account_.dropped_commands)},
                         {"dropped_bricks", number(account_.dropped_bricks)},
                         {"dropped_notes", number(account_.dropped_notes)}};
  for (const auto& [topic, sum] : sums_) account[kSumOf + topic] = hex(sum);
  return writer_->add_metadata(kAccountName, account);
}

Status Pen::put_seal() {
  const auto seal = sealer_->end(sealed_file_, writer_->size());
  return seal ? writer_->add_metadata(kSealName, *seal) : fine();
}

Status Pen::finish() {
  Status whole = writer_->still_there();
  return whole.ok() ? writer_->finish() : whole;
}

Status Pen::write_chunk() {
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
  account_.longest_pause_s =
      std::max(account_.longest_pause_s, std::chrono::duration<double>(now - last_write_).count());
  last_write_ = now;
  if (on_chunk_) on_chunk_();
  return written;
}

void Pen::discard() {
  tick::TickRow tick;
  tick::CommandRow command;
  tick::BrickRow brick;
  while (rings_.ticks.pop(tick)) ++account_.dropped_ticks;
  while (rings_.commands.pop(command)) ++account_.dropped_commands;
  while (rings_.bricks.pop(brick)) ++account_.dropped_bricks;
  while (rings_.second && rings_.second->pop(tick)) ++account_.dropped_ticks;
  notes_.drop_all();
  account_.dropped_notes = before_.dropped_notes + notes_.dropped();
}

void Pen::lose_unwritten() {
  account_.dropped_ticks += account_.ticks - written_ticks_;
  account_.ticks = written_ticks_;
}

RecordingStats Pen::stats() const {
  RecordingStats account = account_;
  account.written_ticks = written_ticks_.load();
  account.bytes = writer_->size();
  return account;
}

std::uint64_t Pen::time_ns(std::uint64_t tick) const {
  return static_cast<std::uint64_t>(std::llround(static_cast<double>(tick) * 1e9 / rate_hz_));
}

void Pen::put(std::uint16_t channel, std::uint64_t tick, ByteSpan message) {
  if (const auto text = summed_.find(channel); text != summed_.end())
    add_to(sums_, text->second, message);
  writer_->add_message(channel, ++sequence_[channel], time_ns(tick), message);
}

void Pen::take_ticks() {
  const std::size_t per_message = rows_per_message();
  std::vector<tick::TickRow> rows;
  tick::TickRow row;
  // at most as many as there are now: a servo as fast as this thread would keep it here for ever
  for (std::size_t left = rings_.ticks.size(); left > 0 && rings_.ticks.pop(row); --left) {
    hand_.change(row);
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

std::size_t Pen::rows_per_message() const {
  return static_cast<std::size_t>(std::max(1.0, std::round(rate_hz_ * kBatch)));
}

void Pen::take_second(std::uint64_t until) {
  if (!rings_.second || second_channel_ == 0) return;
  std::vector<tick::TickRow> rows;
  tick::TickRow row;
  const auto put_rows = [&] {
    if (rows.empty()) return;
    message_.clear();
    encode_ticks(rows, message_);
    put(second_channel_, rows.front().tick, message_.span());
    rows.clear();
  };
  const auto count_on = [this](tick::TickRow& one) { second_hand_.change(one); };
  while (next_until(*rings_.second, waiting_second_, count_on, until, row)) {
    rows.push_back(row);
    if (rows.size() >= rows_per_message()) put_rows();
  }
  put_rows();
}

void Pen::take_commands(std::uint64_t until) {
  tick::CommandRow row;
  const auto count_on = [this](tick::CommandRow& one) { one.tick += first_tick_; };
  while (next_until(rings_.commands, waiting_command_, count_on, until, row)) {
    put(command_channel_, row.tick, as_bytes(to_json(row)));
    ++account_.commands;
  }
}

void Pen::take_bricks(std::uint64_t until) {
  Bricks bricks;
  tick::BrickRow row;
  const auto count_on = [this](tick::BrickRow& one) { one.tick += first_tick_; };
  while (next_until(rings_.bricks, waiting_brick_, count_on, until, row)) {
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
void Pen::take_notes(std::uint64_t first, std::uint64_t until) {
  for (const WaitingNote& note : notes_.take(until)) {
    put(note.view ? view_channel_ : course_channel_,
        std::min(std::max(note.tick, first), last_tick()), as_bytes(note.json));
    ++(note.view ? account_.views : account_.events);
  }
}

void Pen::put_changes(Bricks& bricks) {
  if (bricks.tick.empty()) return;
  bricks.batch = ++batch_;
  message_.clear();
  encode_bricks(bricks, message_);
  put(change_channel_, bricks.tick.front(), message_.span());
  account_.brick_rows += bricks.tick.size();
  changed_since_keyframe_ = true;
  bricks = {};
}

std::uint64_t Pen::last_tick() const { return end_tick_ == 0 ? 0 : end_tick_ - 1; }

bool Pen::keyframe_due() const {
  return keyframe_.empty() && changed_since_keyframe_ &&
         static_cast<double>(end_tick_ - keyframe_tick_) >= kKeyframeEvery * rate_hz_;
}

// Copies the present bone, then writes it part by part between the ticks.
void Pen::begin_keyframe() {
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

void Pen::put_keyframe_part() {
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

void Pen::note_dropped() {
  const auto lost = [this] {
    return std::tuple(account_.dropped_ticks, account_.dropped_commands, account_.dropped_bricks,
                      account_.dropped_notes);
  };
  const auto before = lost();
  account_.dropped_ticks = before_.dropped_ticks + rings_.ticks.dropped() +
                           (rings_.second ? rings_.second->dropped() : 0);
  account_.dropped_commands = before_.dropped_commands + rings_.commands.dropped();
  account_.dropped_bricks = before_.dropped_bricks + rings_.bricks.dropped();
  account_.dropped_notes = before_.dropped_notes + notes_.dropped();
  if (before != lost()) put_event("dropped");
}

void Pen::put_event(const char* event) {
  const std::string text = fmt::format(
      R"({{"event":"{}","tick":{},"dropped_ticks":{},"dropped_wishes":{},"dropped_bricks":{},"dropped_notes":{}}})",
      event, last_tick(), account_.dropped_ticks, account_.dropped_commands,
      account_.dropped_bricks, account_.dropped_notes);
  put(event_channel_, last_tick(), as_bytes(text));
}

}  // namespace burr::record

#include "burr/record/player.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "burr/record/assumed_tool.h"
#include "burr/record/mcap/whole_chunks.h"
#include "burr/scenario/case.h"

namespace burr::record {
namespace {

using volume::BrickIndex;

tick::BrickRow row_of(std::uint64_t tick, BrickIndex brick, const BrickContent& content,
                      bool with_tissue) {
  tick::BrickRow row;
  row.tick = tick;
  row.brick = brick;
  row.field = content.field;
  row.has_tissue = with_tissue;
  if (with_tissue) row.tissue = content.tissue;
  return row;
}

}  // namespace

// ---- opening

Result<std::unique_ptr<Player>> Player::open(const std::string& path) {
  auto reader = McapReader::open(path);
  if (!reader) return reader.error();
  std::unique_ptr<Player> player(new Player);
  player->path_ = path;
  player->reader_ = std::move(*reader);
  player->notices_ = player->reader_->notices();
  const McapReader& file = *player->reader_;
  player->tick_channel_ = file.channel_of(kTicks.name);
  player->command_channel_ = file.channel_of(kCommands.name);
  player->event_channel_ = file.channel_of(kEvents.name);
  player->change_channel_ = file.channel_of(kChanges.name);
  player->keyframe_channel_ = file.channel_of(kKeyframes.name);
  player->view_channel_ = file.channel_of(kViews.name);
  player->course_channel_ = file.channel_of(kCourse.name);
  player->second_channel_ = file.channel_of(kSecond.name);
  if (Status read = player->read_session(); !read.ok()) return read.error();
  player->step_chunks_ = player->chunks_with(player->tick_channel_, player->command_channel_);
  player->change_chunks_ = player->chunks_with(player->change_channel_);
  player->keyframe_chunks_ = player->chunks_with(player->keyframe_channel_);
  player->read_events();
  player->read_course();
  player->find_ends();
  player->find_holes();
  return player;
}

std::vector<std::size_t> Player::chunks_with(std::uint16_t channel,
                                             std::uint16_t or_channel) const {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < reader_->chunks().size(); ++c) {
    const auto& has = reader_->chunks()[c].index_offsets;
    if ((channel != 0 && has.contains(channel)) || (or_channel != 0 && has.contains(or_channel)))
      found.push_back(c);
  }
  return found;
}

void Player::notice(const std::string& sentence) {
  if (std::find(notices_.begin(), notices_.end(), sentence) == notices_.end())
    notices_.push_back(sentence);
}

Status Player::read_session() {
  const std::uint16_t channel = reader_->channel_of(kSession.name);
  bool first = true;
  for (const std::size_t c : chunks_with(channel)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk && first) return chunk.error();
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) {
      if (message.channel != channel) continue;
      auto info = session_from_json(as_text(message.data), path_);
      if (!info) return info.error();
      if (std::exchange(first, false))
        info_ = std::move(*info);
      else if (info->first_tick > (continued_.empty() ? 0 : continued_.back().first_tick))
        continued_.push_back(std::move(*info));
    }
  }
  if (first)
    return error(path_ +
                 ": the description of the session is missing; this is not a recording of burr, or "
                 "its beginning is damaged");
  if (info_.work_case && !info_.work_case->unchanged())
    notice(path_ +
           ": the case in this recording was changed after it was recorded; a score computed "
           "from it is not the score of the session");
  return fine();
}

void Player::read_events() {
  for (const std::size_t c : chunks_with(event_channel_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) {
      if (message.channel != event_channel_) continue;
      const auto event = nlohmann::json::parse(as_text(message.data), nullptr, false);
      if (!event.is_object()) continue;
      const nlohmann::json what = event.value("event", nlohmann::json());
      stopped_ = what != "continued" && (stopped_ || what == "stopped");
      const auto count = [&](const char* name, std::uint64_t& to) {
        const auto at = event.find(name);
        if (at != event.end() && at->is_number_unsigned())
          to = std::max(to, at->get<std::uint64_t>());
      };
      count("dropped_ticks", dropped_ticks_);
      count("dropped_wishes", dropped_commands_);
      count("dropped_bricks", dropped_bricks_);
      count("dropped_notes", dropped_notes_);
    }
  }
  if (stopped_) notice(path_ + ": the session was stopped before its end, by Ctrl-C or a signal");
  if (dropped_notes_ > 0)
    notice(
        fmt::format("{}: the disk was too slow while recording; {} notes on the view and the "
                    "course are missing",
                    path_, dropped_notes_));
  if (dropped_ticks_ + dropped_commands_ + dropped_bricks_ > 0)
    notice(
        fmt::format("{}: the disk was too slow while recording; {} ticks, {} commands and {} "
                    "changed bricks are missing",
                    path_, dropped_ticks_, dropped_commands_, dropped_bricks_));
}

void Player::find_ends() {
  Step step;
  StepCursor first = steps();
  if (!first.next(step)) return;
  first_tick_ = step.row.tick;
  tool_is_recorded_ = first.rows_.front().tool.radius > 0;
  // each chunk is read once: there may be many with commands alone
  std::vector<tick::TickRow> rows;
  for (std::size_t c = step_chunks_.size(); c-- > 0 && rows.empty();) {
    const auto chunk = reader_->read_chunk(step_chunks_[c]);
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages)
      if (message.channel == tick_channel_) static_cast<void>(decode_ticks(message.data, rows));
  }
  // a damaged number may be the largest there is, or smaller than the first
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max() - 1;
  first_tick_ = std::min(first_tick_, kLargest);
  end_tick_ = std::max(first_tick_, rows.empty() ? 0 : std::min(rows.back().tick, kLargest)) + 1;
}

void Player::find_holes() {
  std::optional<Hole> hole;
  const auto close = [&](std::uint64_t end) {
    if (!hole) return;
    hole->end = std::max(hole->first, std::min(end, end_tick_));
    holes_.push_back(*hole);
    hole.reset();
  };
  const std::vector<std::uint8_t> whole = whole_chunks(*reader_, step_chunks_);
  for (std::size_t n = 0; n < step_chunks_.size(); ++n) {
    const std::uint64_t start = std::clamp(start_tick(step_chunks_[n]), first_tick_, end_tick_);
    if (whole[n] != 0) {
      close(start);
    } else if (!hole) {
      hole = Hole{start, start};
    }
  }
  close(end_tick_);
  const auto seconds = [this](std::uint64_t tick) {
    return static_cast<double>(tick) / info_.rate_hz;
  };
  for (const Hole& one : holes_)
    notice(
        fmt::format("{}: is damaged from {:.3f} s to {:.3f} s: {} ticks are lost; `record::repair` "
                    "keeps the rest",
                    path_, seconds(one.first), seconds(one.end), one.end - one.first));
}

// ---- the tool of recordings that do not say it

void Player::read_assumed_tools() {
  std::vector<tick::CommandRow> commands;
  for (const std::size_t c : chunks_with(command_channel_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) continue;  // the cursors say so
    tick::CommandRow row;
    for (const McapMessage& message : chunk->messages)
      if (message.channel == command_channel_ && command_from_json(as_text(message.data), row))
        commands.push_back(row);
  }
  std::stable_sort(commands.begin(), commands.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  AssumedTool tool(info_);
  assumed_tools_.emplace_back(0, tool.now());
  for (const tick::CommandRow& row : commands) {
    tool.obey(row.command);
    if (tool.now() != assumed_tools_.back().second)
      assumed_tools_.emplace_back(row.tick, tool.now());
  }
}

tool::ToolState Player::assumed_tool(std::uint64_t tick) {
  if (assumed_tools_.empty()) read_assumed_tools();
  const auto after = std::partition_point(assumed_tools_.begin(), assumed_tools_.end(),
                                          [tick](const auto& one) { return one.first <= tick; });
  return std::prev(after)->second;
}

// ---- in order

bool StepCursor::take_second(ByteSpan message) {
  std::vector<tick::TickRow> rows;
  if (!decode_ticks(message, rows)) return false;
  second_.insert(second_.end(), rows.begin(), rows.end());
  return true;
}

bool StepCursor::fill() {
  rows_.clear();
  row_ = 0;
  const Player& player = *player_;
  while (chunk_ < player.step_chunks_.size()) {
    const auto chunk = player.reader_->read_chunk(player.step_chunks_[chunk_++]);
    if (!chunk) {
      player_->notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) {
      tick::CommandRow command;
      if (message.channel == player.tick_channel_ && !decode_ticks(message.data, rows_))
        player_->notice(
            fmt::format("{}: a message of ticks near {:.3f} s is not valid and was ignored",
                        player.path_, static_cast<double>(message.time_ns) * 1e-9));
      if (message.channel == player.second_channel_ && player.second_channel_ != 0 &&
          !take_second(message.data))
        player_->notice(
            fmt::format("{}: a message of the second hand near {:.3f} s is not valid and was "
                        "ignored",
                        player.path_, static_cast<double>(message.time_ns) * 1e-9));
      if (message.channel == player.command_channel_) {
        if (command_from_json(as_text(message.data), command))
          commands_.push_back(command);
        else
          player_->notice(
              fmt::format("{}: a command near {:.3f} s is unknown and was ignored; it was perhaps "
                          "recorded by a newer burr",
                          player.path_, static_cast<double>(message.time_ns) * 1e-9));
      }
    }
    if (!rows_.empty()) return true;
  }
  return false;
}

bool StepCursor::next(Step& step) {
  for (;;) {
    if (row_ == rows_.size() && !fill()) return false;
    const tick::TickRow& row = rows_[row_++];
    if (row.tick < first_tick_ || (last_tick_ && row.tick <= *last_tick_)) continue;
    step.row = row;
    if (!(row.tool.radius > 0)) step.row.tool = player_->assumed_tool(row.tick);
    step.gap =
        row.tick != (last_tick_ ? *last_tick_ + 1 : first_tick_) || player_->begins_part(row.tick);
    last_tick_ = row.tick;
    step.commands.clear();
    for (; !commands_.empty() && commands_.front().tick <= row.tick; commands_.pop_front())
      if (commands_.front().tick == row.tick) step.commands.push_back(commands_.front().command);
    step.second.reset();
    for (; !second_.empty() && second_.front().tick <= row.tick; second_.pop_front())
      if (second_.front().tick == row.tick) step.second = second_.front();
    return true;
  }
}

StepCursor Player::steps(std::uint64_t first_tick) {
  return {*this, first_tick == 0 ? 0 : step_chunk_before(first_tick), first_tick};
}

BrickCursor Player::bricks() { return BrickCursor(*this); }

bool BrickCursor::next(tick::BrickRow& row) {
  while (row_ == rows_.size()) {
    rows_.clear();
    row_ = 0;
    if (chunk_ >= player_->change_chunks_.size()) return false;
    const auto chunk = player_->reader_->read_chunk(player_->change_chunks_[chunk_++]);
    if (!chunk) {
      player_->notice(chunk.error().text);
      continue;
    }
    Bricks bricks;
    for (const McapMessage& message : chunk->messages) {
      if (message.channel != player_->change_channel_) continue;
      if (!decode_bricks(message.data, bricks)) {
        player_->notice(player_->path_ +
                        ": a message of changed bricks is not valid and was ignored");
        continue;
      }
      for (std::size_t i = 0; i < bricks.tick.size(); ++i) {
        BrickContent& content = state_[bricks.brick[i]];
        apply_xor(content, bricks.content[i]);
        if (content.crc() == bricks.crc[i])
          rows_.push_back(
              row_of(bricks.tick[i], bricks.brick[i], content, bricks.content[i].has_tissue));
        else
          player_->notice(player_->broken_before(bricks.tick[i]).text);
      }
    }
  }
  row = rows_[row_++];
  return true;
}

// ---- at a moment

std::uint64_t Player::tick_of(double t_s) const {
  const double tick = std::floor(t_s * info_.rate_hz + 1e-6);
  if (!(tick > 0)) return 0;
  return tick >= static_cast<double>(end_tick_) ? (end_tick_ == 0 ? 0 : end_tick_ - 1)
                                                : static_cast<std::uint64_t>(tick);
}

std::uint64_t Player::tick_of_ns(std::uint64_t time_ns) const {
  return static_cast<std::uint64_t>(
      std::llround(std::min(static_cast<double>(time_ns) * 1e-9 * info_.rate_hz, 9e18)));
}

std::uint64_t Player::start_tick(std::size_t chunk) const {
  return tick_of_ns(reader_->chunks()[chunk].start_ns);
}

// The index in step_chunks_ of the chunk that holds the tick, or of the one before.
std::size_t Player::step_chunk_before(std::uint64_t tick) const {
  const auto after =
      std::partition_point(step_chunks_.begin(), step_chunks_.end(),
                           [&](std::size_t chunk) { return start_tick(chunk) <= tick; });
  const auto count = static_cast<std::size_t>(after - step_chunks_.begin());
  return count == 0 ? 0 : count - 1;
}

Result<tick::TickRow> Player::tick_at(double t_s) {
  auto step = step_at(t_s);
  if (!step) return step.error();
  return step->row;
}

Result<Step> Player::step_at(double t_s) {
  const std::uint64_t tick = tick_of(t_s);
  std::optional<Step> found;
  for (std::size_t start = step_chunk_before(tick), back = 16;; back *= 2) {
    StepCursor cursor(*this, start, 0);
    Step step;
    while (cursor.next(step) && step.row.tick <= tick) found = step;
    if (found) return std::move(*found);
    // a damaged part lies before it: search for the last good tick
    if (start == 0) break;
    start = start > back ? start - back : 0;  // further each time, so that no chunk is read often
  }
  return error(
      fmt::format("{}: holds no tick at or before {} s; choose a later moment", path_, t_s));
}

}  // namespace burr::record

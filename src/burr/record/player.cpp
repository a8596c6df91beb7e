#include "burr/record/player.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
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

// A command, and the number of its message: other writers may put those of one tick into any chunks.
using NumberedCommand = std::pair<std::uint32_t, tick::CommandRow>;

void put_in_order_recorded(auto& commands) {
  const auto earlier = [](const NumberedCommand& a, const NumberedCommand& b) {
    return std::pair(a.second.tick, a.first) < std::pair(b.second.tick, b.first);
  };
  if (!std::is_sorted(commands.begin(), commands.end(), earlier))
    std::stable_sort(commands.begin(), commands.end(), earlier);
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
  player->tick_channels_ = file.channels_of(kTicks.name);
  player->command_channels_ = file.channels_of(kCommands.name);
  player->event_channels_ = file.channels_of(kEvents.name);
  player->change_channels_ = file.channels_of(kChanges.name);
  player->keyframe_channels_ = file.channels_of(kKeyframes.name);
  player->view_channels_ = file.channels_of(kViews.name);
  player->course_channels_ = file.channels_of(kCourse.name);
  player->second_channels_ = file.channels_of(kSecond.name);
  if (Status read = player->read_session(); !read.ok()) return read.error();
  Channels steps = player->tick_channels_;
  steps.insert(player->command_channels_.begin(), player->command_channels_.end());
  steps.insert(player->second_channels_.begin(), player->second_channels_.end());
  player->step_chunks_ = player->chunks_with(steps);
  player->change_chunks_ = player->chunks_with(player->change_channels_);
  for (const std::size_t c : player->step_chunks_) {
    const std::uint64_t before = player->step_ends_.empty() ? 0 : player->step_ends_.back();
    player->step_ends_.push_back(
        std::max(before, player->tick_of_ns(player->reader_->chunks()[c].end_ns)));
  }
  player->find_keyframes();
  player->read_events();
  player->read_course();
  player->find_ends();
  player->find_holes();
  return player;
}

std::vector<std::size_t> Player::chunks_with(const Channels& channels) const {
  const auto& chunks = reader_->chunks();
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < chunks.size(); ++c)
    if (std::any_of(channels.begin(), channels.end(), [&](std::uint16_t channel) {
          return chunks[c].index_offsets.contains(channel);
        }))
      found.push_back(c);
  std::stable_sort(found.begin(), found.end(), [&chunks](std::size_t a, std::size_t b) {
    return chunks[a].start_ns < chunks[b].start_ns;
  });
  return found;
}

void Player::notice(const std::string& sentence) {
  if (std::find(notices_.begin(), notices_.end(), sentence) == notices_.end())
    notices_.push_back(sentence);
}

Status Player::read_session() {
  const Channels channels = reader_->channels_of(kSession.name);
  bool first = true;
  for (const std::size_t c : chunks_with(channels)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk && first) return chunk.error();
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) {
      if (!channels.contains(message.channel)) continue;
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
  for (const std::size_t c : chunks_with(event_channels_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) {
      if (!event_channels_.contains(message.channel)) continue;
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
  std::optional<std::uint64_t> last;
  for (std::size_t c = step_chunks_.size(); c-- > 0 && !(last && step_ends_[c] <= *last);) {
    const auto chunk = reader_->read_chunk(step_chunks_[c]);
    if (!chunk) {
      notice(chunk.error().text);
      continue;
    }
    std::uint64_t newest = 0;
    std::vector<tick::TickRow> rows;
    for (const McapMessage& message : chunk->messages) {
      if (!tick_channels_.contains(message.channel) || message.time_ns < newest) continue;
      newest = message.time_ns;
      static_cast<void>(decode_ticks(message.data, rows));
    }
    if (!rows.empty()) last = std::max(last.value_or(0), rows.back().tick);
  }
  // a damaged number may be the largest there is, or smaller than the first
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max() - 1;
  first_tick_ = std::min(first_tick_, kLargest);
  end_tick_ = std::max(first_tick_, std::min(last.value_or(0), kLargest)) + 1;
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
  std::vector<NumberedCommand> commands;
  for (const std::size_t c : chunks_with(command_channels_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) continue;  // the cursors say so
    tick::CommandRow row;
    for (const McapMessage& message : chunk->messages)
      if (command_channels_.contains(message.channel) &&
          command_from_json(as_text(message.data), row))
        commands.emplace_back(message.sequence, row);
  }
  put_in_order_recorded(commands);
  AssumedTool tool(info_);
  assumed_tools_.emplace_back(0, tool.now());
  for (const auto& [number, row] : commands) {
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

// reach: up to which tick the rows go
void StepCursor::take(const McapMessage& message, std::uint64_t& reach) {
  const Player& player = *player_;
  const auto is_wrong = [&](const char* what) {
    player_->notice(fmt::format("{}: a {} near {:.3f} s is not valid and was ignored", player.path_,
                                what, static_cast<double>(message.time_ns) * 1e-9));
  };
  if (player.tick_channels_.contains(message.channel)) {
    if (!decode_ticks(message.data, rows_)) is_wrong("message of ticks");
    // one damaged number must not make this cursor read the whole file
    const auto second = static_cast<std::uint64_t>(player.info_.rate_hz);
    if (!rows_.empty())
      reach =
          std::max(reach, std::min(rows_.back().tick, player.tick_of_ns(message.time_ns) + second));
  }
  if (player.second_channels_.contains(message.channel) && !take_second(message.data))
    is_wrong("message of the second hand");
  if (!player.command_channels_.contains(message.channel)) return;
  tick::CommandRow command;
  if (command_from_json(as_text(message.data), command))
    commands_.emplace_back(message.sequence, command);
  else
    player_->notice(
        fmt::format("{}: a command near {:.3f} s is unknown and was ignored; it was perhaps "
                    "recorded by a newer burr",
                    player.path_, static_cast<double>(message.time_ns) * 1e-9));
}

bool StepCursor::fill() {
  rows_.clear();
  row_ = 0;
  const Player& player = *player_;
  // other writers put what belongs to one tick into several chunks: all that begin before the rows end
  std::uint64_t reach = 0;
  while (chunk_ < player.step_chunks_.size() &&
         (rows_.empty() || player.start_tick(player.step_chunks_[chunk_]) <= reach)) {
    const auto chunk = player.reader_->read_chunk(player.step_chunks_[chunk_++]);
    if (!chunk) {
      player_->notice(chunk.error().text);
      continue;
    }
    for (const McapMessage& message : chunk->messages) take(message, reach);
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.tick < b.tick; };
  const auto put_in_order = [&earlier](auto& rows) {
    if (!std::is_sorted(rows.begin(), rows.end(), earlier))
      std::stable_sort(rows.begin(), rows.end(), earlier);
  };
  put_in_order(rows_);
  put_in_order_recorded(commands_);
  put_in_order(second_);
  return !rows_.empty();
}

bool StepCursor::next(Step& step) {
  for (;;) {
    if (row_ == rows_.size() && !fill()) return false;
    const tick::TickRow& row = rows_[row_++];
    if (row.tick < first_tick_ || (last_tick_ && row.tick <= *last_tick_)) continue;
    step.row = row;
    if (!(row.tool.radius > 0)) step.row.tool = player_->assumed_tool(row.tick);
    step.missing = row.tick != (last_tick_ ? *last_tick_ + 1 : first_tick_);
    step.gap = step.missing || player_->begins_part(row.tick);
    last_tick_ = row.tick;
    step.commands.clear();
    for (; !commands_.empty() && commands_.front().second.tick <= row.tick; commands_.pop_front())
      if (commands_.front().second.tick == row.tick)
        step.commands.push_back(commands_.front().second.command);
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
      if (!player_->change_channels_.contains(message.channel)) continue;
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

// The index in step_chunks_ of a chunk from which on a cursor meets the tick.
std::size_t Player::step_chunk_before(std::uint64_t tick) const {
  const auto reaches = std::lower_bound(step_ends_.begin(), step_ends_.end(), tick);
  const auto count = static_cast<std::size_t>(reaches - step_ends_.begin());
  return count == 0 ? 0 : count - 1;  // the rows of a message go on after its time
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

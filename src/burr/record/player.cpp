#include "burr/record/player.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "burr/record/assumed_tool.h"
#include "burr/record/bone_blob.h"
#include "burr/record/mcap/whole_chunks.h"

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
  for (const std::size_t c : chunks_with(channel)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) return chunk.error();
    for (const McapMessage& message : chunk->messages) {
      if (message.channel != channel) continue;
      auto info = session_from_json(as_text(message.data), path_);
      if (!info) return info.error();
      info_ = std::move(*info);
      if (info_.work_case && !info_.work_case->unchanged())
        notice(path_ +
               ": the case in this recording was changed after it was recorded; a score computed "
               "from it is not the score of the session");
      return fine();
    }
  }
  return error(path_ +
               ": the description of the session is missing; this is not a recording of burr, or "
               "its beginning is damaged");
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
      stopped_ = stopped_ || event.value("event", nlohmann::json()) == "stopped";
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
        fmt::format("{}: is damaged from {:.3f} s to {:.3f} s: {} ticks are lost; `burr repair` "
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
    step.gap = row.tick != (last_tick_ ? *last_tick_ + 1 : first_tick_);
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

Error Player::broken_before(std::uint64_t tick) const {
  std::string again = "and there is no later keyframe";
  for (const std::size_t c : keyframe_chunks_) {
    if (start_tick(c) <= tick) continue;
    again = fmt::format("and the next keyframe is at {:.3f} s",
                        static_cast<double>(start_tick(c)) / info_.rate_hz);
    break;
  }
  return error(
      fmt::format("{}: the bone at {:.3f} s cannot be shown, because earlier changes are damaged "
                  "{}; choose another moment, or replay the session",
                  path_, static_cast<double>(tick) / info_.rate_hz, again));
}

// Loads the newest complete keyframe at or before the tick. False: there is none.
bool Player::load_keyframe(std::uint64_t tick) {
  const auto& chunks = reader_->chunks();
  std::optional<std::uint64_t> not_after;  // keyframes found incomplete, and all later ones
  for (;;) {
    // its chunks all have the same time
    std::vector<std::size_t> parts;
    std::optional<std::uint64_t> time;
    for (auto c = keyframe_chunks_.rbegin(); c != keyframe_chunks_.rend(); ++c) {
      const std::uint64_t start = chunks[*c].start_ns;
      if (start_tick(*c) > tick || (not_after && start >= *not_after)) continue;
      if (time && start != *time) break;
      time = start;
      parts.push_back(*c);
    }
    if (!time) return false;

    State state;
    std::uint32_t wanted = 1, seen = 0;
    std::uint64_t batch = 0;
    bool good = true;
    for (const std::size_t c : parts) {
      const auto chunk = reader_->read_chunk(c);
      if (!chunk) {
        notice(chunk.error().text);
        good = false;
        break;
      }
      Bricks bricks;
      for (const McapMessage& message : chunk->messages) {
        if (message.channel != keyframe_channel_ || message.time_ns != *time) continue;
        good = good && decode_bricks(message.data, bricks);
        if (!good) break;
        wanted = bricks.parts;
        batch = bricks.batch;
        ++seen;
        for (std::size_t i = 0; i < bricks.brick.size(); ++i) {
          good = good && bricks.content[i].crc() == bricks.crc[i];
          state[bricks.brick[i]] = bricks.content[i];
        }
      }
    }
    if (good && seen == wanted) {
      state_ = std::move(state);
      state_tick_ = tick_of_ns(*time);
      place_ = {};
      place_.next_batch = batch + 1;
      const auto from =
          std::partition_point(change_chunks_.begin(), change_chunks_.end(),
                               [&](std::size_t c) { return chunks[c].end_ns < *time; });
      place_.chunk = static_cast<std::size_t>(from - change_chunks_.begin());
      state_good_ = true;
      return true;
    }
    not_after = *time;
  }
}

// Applies the changes up to and including the tick.
Status Player::advance(std::uint64_t tick) {
  for (; place_.chunk < change_chunks_.size(); ++place_.chunk, place_.message = 0) {
    const auto chunk = reader_->read_chunk(change_chunks_[place_.chunk]);
    if (!chunk) {  // its content up to this tick is unknown; if it begins later, it is not needed
      notice(chunk.error().text);
      if (start_tick(change_chunks_[place_.chunk]) <= tick) return broken_before(tick);
      break;
    }
    for (; place_.message < chunk->messages.size(); ++place_.message, place_.row = 0) {
      const McapMessage& message = chunk->messages[place_.message];
      if (message.channel != change_channel_) continue;
      Bricks bricks;
      if (!decode_bricks(message.data, bricks)) {
        notice(path_ + ": a message of changed bricks is not valid");
        return broken_before(tick);
      }
      if (bricks.batch < place_.next_batch) continue;  // already in the keyframe
      if (bricks.batch > place_.next_batch) return broken_before(tick);
      for (; place_.row < bricks.tick.size(); ++place_.row) {
        if (bricks.tick[place_.row] > tick) {
          state_tick_ = tick;
          return fine();
        }
        BrickContent& content = state_[bricks.brick[place_.row]];
        apply_xor(content, bricks.content[place_.row]);
        if (content.crc() != bricks.crc[place_.row]) return broken_before(tick);
      }
      ++place_.next_batch;
    }
  }
  state_tick_ = tick;
  return fine();
}

Status Player::show(volume::Bone& bone) {
  const auto original = [&](BrickIndex brick) -> const BrickContent& {
    const auto [at, fresh] = originals_.try_emplace(brick);
    if (fresh) {
      BrickContent& content = at->second;
      if (const volume::Field* field = bone.brick_field(brick); field != nullptr) {
        std::memcpy(content.field.voxel, field, sizeof content.field.voxel);
        std::memcpy(content.tissue.data(), bone.brick_tissue(brick), content.tissue.size());
      }
      content.has_tissue = true;
    }
    return at->second;
  };
  const auto write = [&](BrickIndex brick, const BrickContent& content, const BrickContent& base) {
    if (bone.ensure_slot(brick) == volume::kNoSlot) return false;
    if (std::memcmp(bone.brick_field(brick), content.field.voxel, sizeof content.field.voxel) != 0)
      bone.write_brick(brick, content.field);
    // where the recording has no tissue, that of the bone as it was opened counts
    const auto& tissue = content.has_tissue ? content.tissue : base.tissue;
    const math::Ijk first = bone.brick_ijk(brick);
    if (std::memcmp(bone.brick_tissue(brick), tissue.data(), tissue.size()) == 0) return true;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const math::Ijk ijk = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (bone.grid().contains(ijk))
        bone.set_tissue(ijk.x(), ijk.y(), ijk.z(), tissue[static_cast<std::size_t>(v)]);
    }
    return true;
  };
  for (const auto& [brick, content] : state_) {
    if (brick < 0 || brick >= bone.brick_count())
      return error(fmt::format(
          "{}: changes brick {}, which this bone does not have; give the right bone with --volume",
          path_, brick));
    if (!write(brick, content, original(brick)))
      return error(fmt::format(
          "{}: the bone has no space for deposited material; open it with reserve_bricks {}", path_,
          std::max<std::uint64_t>(info_.volume.recipe.reserve_bricks, 1)));
  }
  // bricks that an earlier call changed and that are unchanged at this moment
  for (const auto& [brick, content] : originals_)
    if (!state_.contains(brick) && !write(brick, content, content)) break;
  return fine();
}

Status Player::bone_at(double t_s, volume::Bone& bone) {
  if (bone.grid().size != info_.volume.grid.size)
    return error(fmt::format(
        "{}: the bone of the recording has {} x {} x {} voxels, but this one has {} x {} x {}; "
        "give the right bone with --volume",
        path_, info_.volume.grid.size.x(), info_.volume.grid.size.y(), info_.volume.grid.size.z(),
        bone.grid().size.x(), bone.grid().size.y(), bone.grid().size.z()));
  const std::uint64_t tick = tick_of(t_s);

  // forward from the present state, unless a keyframe is nearer
  bool restart = !state_good_ || tick < state_tick_;
  if (!restart)
    for (const std::size_t c : keyframe_chunks_)
      restart = restart || (start_tick(c) <= tick && start_tick(c) > state_tick_);
  if (restart) {
    state_good_ = false;
    if (!load_keyframe(tick)) {
      state_.clear();
      place_ = {};
    }
  }
  Status reached = advance(tick);
  state_good_ = reached.ok();
  if (!reached.ok()) return reached;
  return show(bone);
}

Result<std::unique_ptr<volume::Bone>> Player::embedded_bone(std::size_t reserve_bricks) const {
  const auto& attachments = reader_->attachments();
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (attachments[i].name != kBoneAttachment) continue;
    const auto blob = reader_->read_attachment(i);
    if (!blob) return blob.error();
    return bone_from_blob(*blob, reserve_bricks, path_);
  }
  return error(path_ + ": holds no bone; give the scan of the bone with --volume");
}

}  // namespace burr::record

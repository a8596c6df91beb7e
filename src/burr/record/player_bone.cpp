// The bone at a moment: from the newest keyframe before it, by the changes since then. Reading in order is player.cpp's.
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "burr/record/bone_blob.h"
#include "burr/record/earlier_part.h"
#include "burr/record/player.h"

namespace burr::record {

using volume::BrickIndex;

Error Player::broken_before(std::uint64_t tick) const {
  std::string again = "and there is no later keyframe";
  for (const Keyframe& keyframe : keyframes_) {
    const std::uint64_t at = tick_of_ns(keyframe.time_ns);
    if (at <= tick) continue;
    again = fmt::format("and the next keyframe is at {:.3f} s",
                        static_cast<double>(at) / info_.rate_hz);
    break;
  }
  return error(
      fmt::format("{}: the bone at {:.3f} s cannot be shown, because earlier changes are damaged "
                  "{}; choose another moment, or replay the session",
                  path_, static_cast<double>(tick) / info_.rate_hz, again));
}

// burr gives each part a chunk of its own; other writers put it among other messages.
void Player::find_keyframes() {
  for (const std::size_t c : chunks_with(keyframe_channels_)) {
    const mcap::ChunkAt& at = reader_->chunks()[c];
    if (at.start_ns == at.end_ns) {
      keyframes_.push_back({c, at.start_ns});
      continue;
    }
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) continue;  // whoever needs what is in it says so
    std::set<std::uint64_t> times;
    for (const McapMessage& message : chunk->messages)
      if (keyframe_channels_.contains(message.channel)) times.insert(message.time_ns);
    for (const std::uint64_t time : times) keyframes_.push_back({c, time});
  }
  std::stable_sort(keyframes_.begin(), keyframes_.end(),
                   [](const Keyframe& a, const Keyframe& b) { return a.time_ns < b.time_ns; });
}

// Loads the newest complete keyframe at or before the tick. False: there is none.
bool Player::load_keyframe(std::uint64_t tick) {
  const auto& chunks = reader_->chunks();
  std::optional<std::uint64_t> not_after;  // keyframes found incomplete, and all later ones
  for (;;) {
    // its parts all have the same time
    std::vector<std::size_t> parts;
    std::optional<std::uint64_t> time;
    for (auto k = keyframes_.rbegin(); k != keyframes_.rend(); ++k) {
      if (tick_of_ns(k->time_ns) > tick || (not_after && k->time_ns >= *not_after)) continue;
      if (time && k->time_ns != *time) break;
      time = k->time_ns;
      parts.push_back(k->chunk);
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
        if (!keyframe_channels_.contains(message.channel) || message.time_ns != *time) continue;
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
      if (!change_channels_.contains(message.channel)) continue;
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
          "{}: changes brick {}, which this bone does not have; give the right bone with `volume`",
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
        "give the right bone with `volume`",
        path_, info_.volume.grid.size.x(), info_.volume.grid.size.y(), info_.volume.grid.size.z(),
        bone.grid().size.x(), bone.grid().size.y(), bone.grid().size.z()));
  const std::uint64_t tick = tick_of(t_s);

  // forward from the present state, unless a keyframe is nearer
  bool restart = !state_good_ || tick < state_tick_;
  if (!restart)
    for (const Keyframe& keyframe : keyframes_) {
      const std::uint64_t at = tick_of_ns(keyframe.time_ns);
      restart = restart || (at <= tick && at > state_tick_);
    }
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

Result<EarlierPart> Player::earlier_part() {
  if (end_tick_ == first_tick_) return error(path_ + ": this recording holds no tick");
  const std::uint64_t last = end_tick_ - 1;
  state_good_ = false;
  if (!load_keyframe(last)) {
    state_.clear();
    place_ = {};
  }
  if (Status reached = advance(last); !reached.ok()) return reached.error();
  state_good_ = true;
  EarlierPart part;
  part.file = path_;
  part.info = info_;
  part.ticks = end_tick_;
  part.bricks = state_;
  part.batch = place_.next_batch - 1;
  const auto step = step_at(static_cast<double>(last) / info_.rate_hz);
  if (!step) return step.error();
  part.hand = {end_tick_, step->row.ledger, step->row.hash};
  part.second.ticks = end_tick_;
  if (step->second) part.second = {end_tick_, step->second->ledger, step->second->hash};
  part.sums = text_sums().sums;
  RecordingStats& account = part.account;
  for (std::size_t i = 0; i < reader_->metadata().size(); ++i) {
    if (reader_->metadata()[i].name != kAccountName) continue;
    const auto pairs = reader_->read_metadata(i);
    if (!pairs) continue;
    const auto count = [&pairs](const char* name, std::uint64_t& to) {
      for (const auto& [key, value] : *pairs)
        if (key == name) to = std::strtoull(value.c_str(), nullptr, 10);
    };
    count("wishes", account.commands);
    count("brick_rows", account.brick_rows);
    count("keyframes", account.keyframes);
    count("views", account.views);
    count("events", account.events);
  }
  account.ticks = account.written_ticks = end_tick_ - first_tick_;
  account.dropped_ticks = dropped_ticks_;
  account.dropped_commands = dropped_commands_;
  account.dropped_bricks = dropped_bricks_;
  account.dropped_notes = dropped_notes_;
  return part;
}

Result<std::unique_ptr<volume::Bone>> Player::embedded_bone(std::size_t reserve_bricks) const {
  const auto& attachments = reader_->attachments();
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (attachments[i].name != kBoneAttachment) continue;
    const auto blob = reader_->read_attachment(i);
    if (!blob) return blob.error();
    return bone_from_blob(*blob, reserve_bricks, path_);
  }
  return error(path_ + ": holds no bone; give the scan of the bone with `volume`");
}

}  // namespace burr::record

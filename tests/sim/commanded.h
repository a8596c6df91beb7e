// tests/sim/commanded.h - a recorded session that gets commands at given ticks, and the same
// recording as a burr wrote it that did not record the tool.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/recorder.h"
#include "burr/record/schema.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"

namespace burr::sim::test {

struct Commanded {
  std::string motion = "plunge";
  double seconds = 3, burr_mm = 4;
  tool::BurrKind kind = tool::BurrKind::cutting;
  tick::ToolMode mode = tick::ToolMode::cut;
  bool irrigated = false;
  double stopped_after = 60;                                           // [s]
  std::vector<std::pair<std::uint64_t, tick::Command>> commands = {};  // tick that takes it
};

// A 4 mm burr in the hole that it makes for itself, and a command for 7 mm in there.
inline constexpr std::uint64_t kAsked = 2000;  // [tick]
inline Commanded in_its_own_hole() {
  return {.commands = {{kAsked, {tick::CommandKind::burr_radius, 3.5e-3}}}};
}

// Records it with its bone; returns the radius that the servo has at the end [m].
inline double record_commanded(const std::string& path, const Commanded& plan) {
  NoProgress quiet;
  using math::Vec3;
  auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), {}, phantom::slab(),
      256);
  SessionSettings settings;
  settings.servo.burr.radius = 0.5e-3 * plan.burr_mm;
  settings.servo.burr.kind = plan.kind;
  settings.servo.mode = plan.mode;
  settings.servo.irrigated = plan.irrigated;
  settings.servo.undo_bricks = 2048;
  settings.surface.reserve_blocks = 1 << 13;
  auto hand = surgeon::motion(plan.motion, {}, 2e-3, plan.seconds);
  EXPECT_TRUE(hand.ok());
  auto session = Session::make(
      std::move(bone), std::make_unique<device::SimulatedHand>(*hand, device::ArmSettings{}),
      settings, quiet);
  EXPECT_TRUE(session.ok()) << session.error().text;
  record::SessionInfo info;
  describe((*session)->settings(), (*session)->hand().spec(), info);
  info.volume.content_hash = (*session)->bone().content_hash();
  info.volume.grid = (*session)->bone().grid();
  info.volume.tissues = (*session)->bone().tissues();
  info.volume.recipe.reserve_bricks = 256;
  record::Recorder recorder(info.rate_hz, 8192);
  const Status started = recorder.start(path, info, &(*session)->bone());
  EXPECT_TRUE(started.ok()) << started.error().text;
  (*session)->set_recorder(&recorder);
  std::uint64_t done = 0;
  for (const auto& [tick, command] : plan.commands) {
    if (tick > done) (*session)->run(1e-3 * static_cast<double>(tick - done), quiet);
    done = tick;
    (*session)->command(command);
  }
  (*session)->run(std::min(plan.seconds, plan.stopped_after) - 1e-3 * static_cast<double>(done),
                  quiet);
  (*session)->set_recorder(nullptr);
  const auto account = recorder.finish();
  EXPECT_TRUE(account.ok() && account->whole());
  return (*session)->burr_radius();
}

// The columns of the tool taken out of every message, as if they had never been there.
inline void forget_tool(const std::string& from, const std::string& to) {
  constexpr std::uint64_t kFirst = 44, kLast = 50;
  auto reader = record::McapReader::open(from);
  ASSERT_TRUE(reader.ok()) << reader.error().text;
  record::McapWriter writer;
  ASSERT_TRUE(writer.open(to, to).ok());
  for (const auto& schema : (*reader)->schemas()) ASSERT_TRUE(writer.add(schema).ok());
  for (const auto& channel : (*reader)->channels()) ASSERT_TRUE(writer.add(channel).ok());
  for (std::size_t n = 0; n < (*reader)->attachments().size(); ++n) {
    const auto bone = (*reader)->read_attachment(n);
    ASSERT_TRUE(bone.ok());
    ASSERT_TRUE(writer.add_attachment(record::kBoneAttachment, record::kBoneMediaType, *bone).ok());
  }
  const std::uint16_t ticks = *(*reader)->channels_of(record::kTicks.name).begin();
  for (std::size_t c = 0; c < (*reader)->chunks().size(); ++c) {
    const auto chunk = (*reader)->read_chunk(c);
    ASSERT_TRUE(chunk.ok());
    for (const record::McapMessage& message : chunk->messages) {
      record::BytesOut kept;
      record::BytesIn in(message.data);
      const auto varint = [&in] {
        std::uint64_t value = 0;
        for (unsigned shift = 0;; shift += 7) {
          const auto byte = in.get<std::uint8_t>();
          value |= std::uint64_t{byte & 0x7FU} << shift;
          if ((byte & 0x80U) == 0) return value;
        }
      };
      while (message.channel == ticks && !in.empty()) {  // columns are blocks only
        const std::uint8_t* begin = message.data.data() + (message.data.size() - in.left());
        const std::uint64_t field = varint() >> 3;
        in.take(varint());
        const std::uint8_t* end = message.data.data() + (message.data.size() - in.left());
        if (field < kFirst || field > kLast)
          kept.raw(record::ByteSpan(begin, static_cast<std::size_t>(end - begin)));
      }
      writer.add_message(message.channel, message.sequence, message.time_ns,
                         message.channel == ticks ? kept.span() : message.data);
    }
    ASSERT_TRUE(writer.close_chunk().ok());
  }
  ASSERT_TRUE(writer.finish().ok());
}

}  // namespace burr::sim::test

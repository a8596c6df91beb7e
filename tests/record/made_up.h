// tests/record/made_up.h - random rows, bones and sessions.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>

#include "burr/record/recorder.h"
#include "burr/record/session_info.h"
#include "burr/tick/rows.h"
#include "support/folder.h"

namespace burr::record::test {

using Random = std::mt19937_64;
using burr::test::Folder;

inline std::vector<std::uint8_t> bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

inline double any(Random& random) {
  // now and then values that break careless formats
  switch (random() % 64) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return -std::numeric_limits<double>::infinity();
    case 2:
      return -0.0;
    case 3:
      return std::numeric_limits<double>::denorm_min();
    default:
      return std::normal_distribution<double>(0, 1)(random);
  }
}

inline math::Vec3 any_vec3(Random& random) {
  const double x = any(random), y = any(random), z = any(random);
  return {x, y, z};
}

inline tick::TickRow any_tick(std::uint64_t tick, Random& random) {
  tick::TickRow row;
  row.tick = tick;
  row.hand.world_from_tool.p = any_vec3(random);
  row.hand.world_from_tool.q.coeffs() << any_vec3(random), any(random);
  row.hand.velocity = any_vec3(random);
  row.hand.pedal = any(random);
  row.hand.buttons = static_cast<std::uint32_t>(random());
  row.hand.valid = random() % 2 == 0;
  row.contact.proxy = any_vec3(random);
  row.contact.normal = any_vec3(random);
  row.contact.force = any_vec3(random);
  row.contact.torque = any_vec3(random);
  row.contact.unsent_torque = any_vec3(random);
  row.contact.turn = any_vec3(random);
  row.contact.depth = any(random);
  row.contact.active = static_cast<int>(random() % 4);
  row.contact.candidates = static_cast<int>(random() % 1000) - 1;
  row.contact.touching = random() % 2 == 0;
  row.contact.flags = static_cast<std::uint32_t>(random());
  row.ledger = {any(random), any(random), any(random), any(random),
                any(random), any(random), any(random), any(random)};
  row.piece.state = static_cast<int>(2 + random() % 100);
  row.piece.p = any_vec3(random);
  row.piece.turn = {any(random), any(random), any(random), any(random)};
  row.law.state = static_cast<std::int64_t>(2 + random() % 100);
  row.law.force = any_vec3(random);
  row.law.energy = any(random);
  row.law.torque = any(random);
  row.spindle_rad_s = any(random);
  row.cutting_nm = any(random);
  row.cutting_w = any(random);
  // the same for some ticks, as a tool is, then another
  Random tools(tick / 64);
  row.tool.radius = 1e-6 * static_cast<double>(1 + tools() % 3500);
  row.tool.full_speed = std::normal_distribution<double>(0, 1e3)(tools);
  row.tool.kind = static_cast<tool::BurrKind>(tools() % 2);
  row.tool.mode = static_cast<tool::Mode>(tools() % tool::kModes);
  row.tool.mirror_axis = static_cast<int>(tools() % 4) - 1;
  row.tool.mirror_twice = static_cast<int>(tools() % 1000);
  row.tool.irrigated = tools() % 2 == 0;
  row.tool.number = static_cast<int>(tools() % 5) - 1;
  row.took_us = static_cast<float>(any(random));
  row.late_us = static_cast<float>(any(random));
  row.hash = random();
  return row;
}

// equal to the bit, NaN included, whatever the padding
inline void expect_same(const tick::TickRow& a, const tick::TickRow& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  const auto same3 = [&](const math::Vec3& x, const math::Vec3& y) {
    return same(x.x(), y.x()) && same(x.y(), y.y()) && same(x.z(), y.z());
  };
  EXPECT_EQ(a.tick, b.tick);
  EXPECT_TRUE(same3(a.hand.world_from_tool.p, b.hand.world_from_tool.p)) << a.tick;
  for (int i = 0; i < 4; ++i)
    EXPECT_TRUE(same(a.hand.world_from_tool.q.coeffs()[i], b.hand.world_from_tool.q.coeffs()[i]));
  EXPECT_TRUE(same3(a.hand.velocity, b.hand.velocity)) << a.tick;
  EXPECT_TRUE(same(a.hand.pedal, b.hand.pedal)) << a.tick;
  EXPECT_EQ(a.hand.buttons, b.hand.buttons);
  EXPECT_EQ(a.hand.valid, b.hand.valid);
  EXPECT_TRUE(same3(a.contact.proxy, b.contact.proxy)) << a.tick;
  EXPECT_TRUE(same3(a.contact.normal, b.contact.normal)) << a.tick;
  EXPECT_TRUE(same3(a.contact.force, b.contact.force)) << a.tick;
  EXPECT_TRUE(same3(a.contact.torque, b.contact.torque)) << a.tick;
  EXPECT_TRUE(same3(a.contact.unsent_torque, b.contact.unsent_torque)) << a.tick;
  EXPECT_TRUE(same3(a.contact.turn, b.contact.turn)) << a.tick;
  EXPECT_TRUE(same(a.contact.depth, b.contact.depth)) << a.tick;
  EXPECT_EQ(a.contact.active, b.contact.active);
  EXPECT_EQ(a.contact.candidates, b.contact.candidates);
  EXPECT_EQ(a.contact.touching, b.contact.touching);
  EXPECT_EQ(a.contact.flags, b.contact.flags);
  EXPECT_TRUE(same(a.ledger.asked, b.ledger.asked) && same(a.ledger.removed, b.ledger.removed) &&
              same(a.ledger.debt, b.ledger.debt) && same(a.ledger.not_cut, b.ledger.not_cut) &&
              same(a.ledger.added, b.ledger.added) && same(a.ledger.energy, b.ledger.energy) &&
              same(a.ledger.undone, b.ledger.undone) && same(a.ledger.moved, b.ledger.moved))
      << a.tick;
  EXPECT_TRUE(same(a.spindle_rad_s, b.spindle_rad_s)) << a.tick;
  EXPECT_TRUE(same(a.cutting_nm, b.cutting_nm) && same(a.cutting_w, b.cutting_w)) << a.tick;
  EXPECT_EQ(a.piece.state, b.piece.state);
  EXPECT_TRUE(same3(a.piece.p, b.piece.p)) << a.tick;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(same(a.piece.turn[i], b.piece.turn[i])) << a.tick;
  EXPECT_EQ(a.tool, b.tool) << a.tick;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a.took_us), std::bit_cast<std::uint32_t>(b.took_us));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a.late_us), std::bit_cast<std::uint32_t>(b.late_us));
  EXPECT_EQ(a.hash, b.hash);
}

// A slab with a soft edge and two tissues; bricks above it are air, for deposits.
inline std::unique_ptr<volume::Bone> any_bone(Random& random, std::size_t reserve = 64,
                                              bool with_intensity = false) {
  volume::Grid grid;
  grid.size = {45, 33, 30};
  grid.voxel = 0.37e-3;
  grid.frame.p = {0.01234567890123, -0.2, 1.0 / 3.0};
  grid.frame.q = math::Quat(0.5, -0.5, 0.5, 0.5);
  volume::TissueTable tissues;
  tissues.tissues.push_back({.name = "facial nerve", .colour = {1, 0.85F, 0.1F}, .spare = true});
  const auto n = static_cast<std::size_t>(grid.size.prod());
  std::vector<volume::Field> field(n);
  std::vector<volume::TissueId> tissue(n);
  std::vector<std::int16_t> intensity(with_intensity ? n : 0);
  for (std::size_t v = 0; v < n; ++v) {
    const auto k = static_cast<int>(v / (45 * 33));
    field[v] = volume::field_from_depth(14.0 - k + 0.001 * static_cast<double>(random() % 500));
    tissue[v] = k < 18 ? static_cast<volume::TissueId>(1 + random() % 2) : volume::TissueId{0};
    if (with_intensity) intensity[v] = static_cast<std::int16_t>(random());
  }
  return volume::bone_from_arrays(grid, tissues, field, tissue, intensity, reserve);
}

inline SessionInfo info_of(const volume::Bone& bone, Random& random) {
  SessionInfo info;
  info.seed = random();
  info.numbers = {{"burr_radius_m", 2.5e-3}, {"stiffness_n_per_m", 1.0 / 3.0}, {"odd", -1e-300}};
  info.words = {{"device", "simulated hand"}, {"motion", "pocket"}};
  info.volume.content_hash = bone.content_hash();
  info.volume.source_fingerprint = random();
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.has_intensity = bone.has_intensity();
  info.volume.recipe.reserve_bricks = bone.free_slots();
  info.volume.format = "DICOM";
  info.volume.recipe.voxel_mm = 0.37;
  info.volume.recipe.iso = 300;
  info.volume.recipe.series = "#2";
  return info;
}

// Changes a bone as the servo may in one tick: removes some of some bricks, sometimes deposits.
inline std::vector<tick::BrickRow> nibble(volume::Bone& bone, std::uint64_t tick, Random& random) {
  std::vector<tick::BrickRow> rows;
  for (std::uint64_t i = random() % 3; i > 0; --i) {
    const auto brick =
        static_cast<volume::BrickIndex>(random() % static_cast<std::uint64_t>(bone.brick_count()));
    const bool deposit = random() % 8 == 0;
    if (bone.brick_field(brick) == nullptr && !deposit) continue;
    if (bone.ensure_slot(brick) == volume::kNoSlot) continue;
    tick::BrickRow row;
    row.tick = tick;
    row.brick = brick;
    std::copy_n(bone.brick_field(brick), volume::kBrickVoxels, row.field.voxel);
    const math::Ijk first = bone.brick_ijk(brick);
    for (int v = static_cast<int>(random() % 64); v < volume::kBrickVoxels;
         v += 1 + static_cast<int>(random() % 64)) {
      const math::Ijk ijk = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (!bone.grid().contains(ijk)) continue;
      row.field.voxel[v] = static_cast<volume::Field>(random());
      if (deposit) bone.set_tissue(ijk.x(), ijk.y(), ijk.z(), 2);
    }
    bone.write_brick(brick, row.field);
    row.has_tissue = deposit;
    if (deposit) std::copy_n(bone.brick_tissue(brick), row.tissue.size(), row.tissue.begin());
    rows.push_back(row);
  }
  return rows;
}

// Everything that happened in a random session, to compare with.
struct Truth {
  SessionInfo info;
  std::vector<tick::TickRow> ticks;
  std::vector<tick::CommandRow> commands;
  std::vector<tick::BrickRow> bricks;
  RecordingStats account;
};

// Records `count` ticks as fast as possible.
inline Truth record_any(const std::string& path, std::uint64_t count, double rate_hz,
                        volume::Bone& bone, Random& random, bool embed = false) {
  Truth truth;
  truth.info = info_of(bone, random);
  truth.info.rate_hz = rate_hz;
  Recorder recorder(rate_hz);
  const Status started = recorder.start(path, truth.info, embed ? &bone : nullptr);
  EXPECT_TRUE(started.ok()) << started.error().text;
  for (std::uint64_t tick = 0; tick < count; ++tick) {
    recorder.wait_for_room();
    if (random() % 50 == 0)
      for (std::uint64_t i = random() % 3; i > 0; --i) {
        truth.commands.push_back(
            {tick, {static_cast<tick::CommandKind>(random() % 9), any(random)}});
        EXPECT_TRUE(recorder.commands().push(truth.commands.back()));
      }
    for (const tick::BrickRow& row : nibble(bone, tick, random)) {
      truth.bricks.push_back(row);
      EXPECT_TRUE(recorder.bricks().push(row));
    }
    truth.ticks.push_back(any_tick(tick, random));
    EXPECT_TRUE(recorder.ticks().push(truth.ticks.back()));
  }
  const auto account = recorder.finish();
  EXPECT_TRUE(account.ok()) << account.error().text;
  truth.account = *account;
  return truth;
}

inline Random seeded(std::uint64_t seed) { return Random(seed); }

}  // namespace burr::record::test

// a random test prints its seed
#define BURR_SEEDED(name, seed)                 \
  SCOPED_TRACE("seed " + std::to_string(seed)); \
  auto name = ::burr::record::test::seeded(seed)

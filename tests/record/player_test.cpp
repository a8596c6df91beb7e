// Any moment of a recording, compared with the true bone and rows.
#include "burr/record/player.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "burr/record/bone_blob.h"
#include "burr/record/find_volume.h"
#include "burr/record/grid_json.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/mcap/packed.h"
#include "burr/record/schema.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

using namespace test;

// The bone after a tick, from the truth.
std::uint64_t hash_after(const Truth& truth, std::uint64_t tick, volume::Bone& bone) {
  for (const tick::BrickRow& row : truth.bricks) {
    if (row.tick > tick) break;
    EXPECT_NE(bone.ensure_slot(row.brick), volume::kNoSlot);
    bone.write_brick(row.brick, row.field);
    if (row.has_tissue)
      std::copy(row.tissue.begin(), row.tissue.end(), bone.build_tissue(row.brick));
  }
  return bone.content_hash();
}

TEST(Player, ShowsTheBoneOfAnyMomentInAnyOrder) {
  const std::uint64_t seed = 41;
  BURR_SEEDED(random, seed);
  const Folder folder;
  const auto cut = any_bone(random, 500);
  // 31 s at 500 Hz: three keyframes
  const Truth truth = record_any(folder / "s.mcap", 15'500, 500, *cut, random);
  EXPECT_GE(truth.account.keyframes, 2U);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok()) << player.error().text;

  const auto fresh = [&] {
    Random same = seeded(seed);
    return any_bone(same, 500);
  };
  const auto shown = fresh();
  EXPECT_EQ(shown->content_hash(), truth.info.volume.content_hash);
  std::vector<std::uint64_t> ticks = {0, 1, 4999, 5000, 5001, 15'499, 10'001, 300};
  for (int i = 0; i < 25; ++i) ticks.push_back(random() % 15'500);
  for (std::uint64_t tick = 7000; tick < 7400; tick += 20) ticks.push_back(tick);  // a film
  for (const std::uint64_t tick : ticks) {
    const auto want = fresh();
    const std::uint64_t hash = hash_after(truth, tick, *want);
    const Status done = (*player)->bone_at(static_cast<double>(tick) / 500, *shown);
    ASSERT_TRUE(done.ok()) << done.error().text;
    ASSERT_EQ(shown->content_hash(), hash) << "tick " << tick;
    const auto row = (*player)->tick_at(static_cast<double>(tick) / 500);
    ASSERT_TRUE(row.ok()) << row.error().text;
    expect_same(*row, truth.ticks[tick]);
  }
  ASSERT_TRUE((*player)->bone_at(1e6, *shown).ok());
  EXPECT_EQ(shown->content_hash(), cut->content_hash()) << "later than the end is the end";

  // a cursor that starts in the middle gives the same rows
  for (const std::uint64_t from : {1UL, 777UL, 12'345UL, 15'499UL}) {
    StepCursor steps = (*player)->steps(from);
    Step step;
    ASSERT_TRUE(steps.next(step));
    EXPECT_EQ(step.row.tick, from);
    EXPECT_FALSE(step.gap);
    expect_same(step.row, truth.ticks[from]);
  }
  EXPECT_FALSE([&] {
    Step step;
    StepCursor steps = (*player)->steps(15'500);
    return steps.next(step);
  }());
}

TEST(Player, AnotherBoneOrOneWithoutRoomIsRefused) {
  BURR_SEEDED(random, 42);
  const Folder folder;
  const auto cut = any_bone(random, 500);
  record_any(folder / "s.mcap", 4000, 1000, *cut, random);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok());
  volume::Grid other;
  other.size = {8, 8, 8};
  volume::Bone small(other, {}, 1, 0, false);
  const Status wrong = (*player)->bone_at(1, small);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().text.find("`volume`"), std::string::npos);
  const auto narrow = any_bone(random, 0);
  const Status no_room = (*player)->bone_at(4, *narrow);
  ASSERT_FALSE(no_room.ok());
  EXPECT_NE(no_room.error().text.find("reserve_bricks"), std::string::npos);
}

// A chunk of changes is damaged: moments after it are refused until a keyframe, never shown wrong.
TEST(Player, NeverShowsABoneThatDamageMadeWrong) {
  const std::uint64_t seed = 43;
  BURR_SEEDED(random, seed);
  const Folder folder;
  const auto cut = any_bone(random, 500);
  const Truth truth = record_any(folder / "s.mcap", 15'500, 500, *cut, random);
  auto whole = McapReader::open(folder / "s.mcap");
  ASSERT_TRUE(whole.ok());
  const std::uint16_t changes = *(*whole)->channels_of(kChanges.name).begin();
  std::vector<std::uint64_t> offsets;
  for (const auto& chunk : (*whole)->chunks())
    if (chunk.index_offsets.contains(changes)) offsets.push_back(chunk.offset + chunk.length / 2);
  ASSERT_GE(offsets.size(), 4U);

  std::map<std::uint64_t, std::uint64_t> right;  // the hash of the bone after a tick
  const auto right_hash = [&](std::uint64_t tick) {
    const auto [at, is_new] = right.try_emplace(tick);
    if (is_new) {
      Random same = seeded(seed);
      at->second = hash_after(truth, tick, *any_bone(same, 500));
    }
    return at->second;
  };
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    auto bytes = bytes_of_file(folder / "s.mcap");
    bytes[offsets[i]] ^= 0x10;
    write_file(folder / "damaged.mcap", bytes);
    auto player = Player::open(folder / "damaged.mcap");
    ASSERT_TRUE(player.ok()) << player.error().text;
    int shown_right = 0, refused = 0;
    for (std::uint64_t tick = 0; tick < 15'500; tick += 1500) {
      Random same = seeded(seed);
      const auto shown = any_bone(same, 500);
      auto fresh = Player::open(folder / "damaged.mcap");
      const Status done = (*fresh)->bone_at(static_cast<double>(tick) / 500, *shown);
      if (!done.ok()) {
        EXPECT_NE(done.error().text.find("cannot be shown"), std::string::npos)
            << done.error().text;
        ++refused;
        continue;
      }
      ++shown_right;
      // if the last chunk is the damaged one, the recording ends before it and says so
      const std::uint64_t end = (*fresh)->end_tick();
      if (end < 15'500) {
        EXPECT_FALSE((*fresh)->notices().empty());
      }
      EXPECT_EQ(shown->content_hash(), right_hash(std::min(tick, end - 1))) << tick;
    }
    EXPECT_GT(shown_right, 0);
    if (i + 1 < offsets.size()) {
      EXPECT_LT(refused, 11);
    }
  }
}

TEST(Player, OpensAnyMomentOfTenMinutesAtOnce) {
  BURR_SEEDED(random, 44);
  const Folder folder;
  const auto cut = any_bone(random, 500);
  const std::string path = folder / "long.mcap";
  {
    const tick::TickRow row = any_tick(0, random);
    Recorder recorder(1000);
    ASSERT_TRUE(recorder.start(path, info_of(*cut, random)).ok());
    for (std::uint64_t tick = 0; tick < 600'000; ++tick) {
      recorder.wait_for_room();
      if (tick % 20 == 0)
        for (const tick::BrickRow& brick : nibble(*cut, tick, random))
          recorder.bricks().push(brick);
      tick::TickRow mine = row;
      mine.tick = tick;
      mine.hash = tick;
      recorder.ticks().push(mine);
    }
    ASSERT_TRUE(recorder.finish().ok());
  }
  auto bytes = bytes_of_file(path);
  double worst = 0;
  for (const bool torn : {false, true}) {
    if (torn) {
      bytes.resize(bytes.size() - 100);
      write_file(path, bytes);
    }
    for (const double t_s : {599.9, 9.99, 305.0, 0.001, 119.98}) {
      Random same = seeded(44);
      const auto bone = any_bone(same, 500);
      const auto start = std::chrono::steady_clock::now();
      auto player = Player::open(path);
      ASSERT_TRUE(player.ok());
      const Status shown = (*player)->bone_at(t_s, *bone);
      ASSERT_TRUE(shown.ok()) << shown.error().text;
      const auto row = (*player)->tick_at(t_s);
      ASSERT_TRUE(row.ok());
      EXPECT_EQ(row->hash, static_cast<std::uint64_t>(t_s * 1000 + 1e-6));
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      worst = std::max(worst, took.count());
    }
  }
  std::printf("a moment of 10 minutes (%zu MiB) opens in at most %.3f s\n", bytes.size() >> 20,
              worst);
  // no timing decides here; but ten times the promise means that it reads what it should skip
  EXPECT_LT(worst, 10.0);
}

// ---- an embedded bone

TEST(BoneBlob, ComesBackToTheBit) {
  BURR_SEEDED(random, 51);
  for (const bool with_intensity : {false, true}) {
    const auto bone = any_bone(random, 10, with_intensity);
    const auto blob = bone_to_blob(*bone);
    auto back = bone_from_blob(blob, 33, "x.mcap");
    ASSERT_TRUE(back.ok()) << back.error().text;
    EXPECT_EQ((*back)->content_hash(), bone->content_hash());
    EXPECT_EQ((*back)->has_intensity(), with_intensity);
    EXPECT_EQ((*back)->used_slots(), bone->used_slots());
    EXPECT_EQ((*back)->free_slots(),
              std::min<std::size_t>(
                  33, static_cast<std::size_t>(bone->brick_count()) - bone->used_slots()));
    EXPECT_EQ((*back)->grid().frame.p, bone->grid().frame.p);
    EXPECT_EQ((*back)->grid().frame.q.coeffs(), bone->grid().frame.q.coeffs());
    EXPECT_EQ((*back)->tissues()[2].name, "facial nerve");
    for (int i = 0; i < 2000; ++i) {
      const int x = static_cast<int>(random() % 45), y = static_cast<int>(random() % 33),
                z = static_cast<int>(random() % 30);
      ASSERT_EQ((*back)->intensity(x, y, z), bone->intensity(x, y, z));
      ASSERT_EQ((*back)->tissue(x, y, z), bone->tissue(x, y, z));
    }
  }
}

TEST(BoneBlob, DamageIsFoundNotShown) {
  BURR_SEEDED(random, 52);
  const auto bone = any_bone(random);
  const auto blob = bone_to_blob(*bone);
  for (int round = 0; round < 300; ++round) {
    auto bytes = blob;
    if (round % 3 == 0)
      bytes.resize(random() % bytes.size());
    else
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    const auto back = bone_from_blob(bytes, 10, "x.mcap");
    if (back.ok()) {
      EXPECT_EQ((*back)->content_hash(), bone->content_hash()) << "only harmless bits may pass";
    }
  }
}

TEST(BoneBlob, PromisesOfMoreBricksThanThereAreCostNothing) {
  volume::Grid grid;
  grid.size = {2048, 2048, 2048};
  const std::string head = nlohmann::json{
      {"grid", json_from_grid(grid)},
      {"tissues", json_from_tissues({})},
      {"has_intensity", false}}.dump();
  BytesOut blob, block;
  blob.raw(as_bytes("BURRBON1"));
  blob.text(head);
  blob.put(crc32(as_bytes(head)));
  // bricks 0 to 4095, all air, compress to almost nothing; here they come 200 times
  constexpr std::uint32_t kBricks = 4096;
  for (std::uint32_t b = 0; b < kBricks; ++b) block.put(b);
  block.bytes().resize(block.size() + std::size_t{kBricks} * 512 * 3);
  std::vector<std::uint8_t> packed;
  Packer().pack(block.span(), packed);
  for (int n = 0; n < 200; ++n) {
    blob.put(kBricks);
    blob.put(std::uint64_t{packed.size()});
    blob.raw(packed);
    blob.put(crc32(block.span()));
  }
  blob.put(std::uint32_t{0});
  rusage before{};
  ::getrusage(RUSAGE_SELF, &before);
  EXPECT_FALSE(bone_from_blob(blob.span(), 10, "x.mcap").ok());

  // nor the room for deposits that the description of a session claims
  blob.bytes().resize(8 + 4 + head.size() + 4);
  blob.put(std::uint32_t{0});
  EXPECT_TRUE(bone_from_blob(blob.span(), ~std::size_t{0}, "x.mcap").ok());
  rusage after{};
  ::getrusage(RUSAGE_SELF, &after);
#if !defined(BURR_SANITIZED)
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 500'000) << "KiB";
#endif
}

TEST(Player, OpensARecordingOfNothingButCommandsAtOnce) {
  // invented: a session, one tick, and then commands, each in a chunk of its own
  BURR_SEEDED(random, 55);
  const Folder folder;
  const std::string path = folder / "s.mcap";
  McapWriter writer;
  ASSERT_TRUE(writer.open(path, path).ok());
  const auto session = writer.add_channel(kSession.name, "json", 0);
  const auto ticks = writer.add_channel(kTicks.name, "protobuf", 0);
  const auto commands = writer.add_channel(kCommands.name, "json", 0);
  writer.add_message(*session, 0, 0, as_bytes(to_json(info_of(*any_bone(random), random))));
  BytesOut rows;
  const tick::TickRow row = any_tick(3, random);
  encode_ticks({&row, 1}, rows);
  writer.add_message(*ticks, 0, 0, rows.span());
  ASSERT_TRUE(writer.close_chunk().ok());
  constexpr std::uint64_t kCommandChunks = 15'000;
  for (std::uint64_t n = 0; n < kCommandChunks; ++n) {
    const std::string command = to_json(tick::CommandRow{n, {tick::CommandKind::undo, 0}});
    writer.add_message(*commands, 0, 1'000'000 * n, as_bytes(command));
    ASSERT_TRUE(writer.close_chunk().ok());
  }
  ASSERT_TRUE(writer.finish().ok());

  // to read all later chunks again for each would be a hundred million chunks
  const auto start = std::chrono::steady_clock::now();
  const auto player = Player::open(path);
  ASSERT_TRUE(player.ok()) << player.error().text;
  EXPECT_EQ((*player)->end_tick(), 4U);
  expect_same(*(*player)->tick_at(1e6), row);
  EXPECT_FALSE((*player)->tick_at(0).ok()) << "before the first tick there is none";
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::minutes(2));
}

TEST(Player, FindsTheEmbeddedBone) {
  BURR_SEEDED(random, 53);
  const Folder folder;
  const auto bone = any_bone(random, 64, true);
  const std::uint64_t before = bone->content_hash();
  const Truth truth = record_any(folder / "s.mcap", 3000, 1000, *bone, random, true);
  auto player = Player::open(folder / "s.mcap");
  ASSERT_TRUE(player.ok());
  EXPECT_TRUE((*player)->info().embedded);
  auto inside = (*player)->embedded_bone((*player)->info().volume.recipe.reserve_bricks);
  ASSERT_TRUE(inside.ok()) << inside.error().text;
  EXPECT_EQ((*inside)->content_hash(), before);
  EXPECT_TRUE(check_volume((*player)->info().volume, **inside, "inside").ok());
  ASSERT_TRUE((*player)->bone_at(3, **inside).ok());
  EXPECT_EQ((*inside)->content_hash(), bone->content_hash());
  EXPECT_FALSE(check_volume((*player)->info().volume, **inside, "inside").ok());

  record_any(folder / "without.mcap", 10, 1000, *bone, random);
  auto without = Player::open(folder / "without.mcap");
  ASSERT_TRUE(without.ok());
  EXPECT_FALSE((*without)->embedded_bone(0).ok());
}

// ---- a bone in another file

TEST(FindVolume, ByFingerprintWhateverItIsCalled) {
  BURR_SEEDED(random, 61);
  const Folder folder;
  const auto bone = any_bone(random);
  const auto put = [&](const std::string& name, std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    std::filesystem::create_directories(std::filesystem::path(folder / name).parent_path());
    write_file(folder / name, bytes);
  };
  put("scans/a/one.nii.gz", 100'000);
  put("scans/b/two.nrrd", 50);
  put("scans/series/IM1", 40'000);
  put("scans/series/IM2", 40'000);
  put("recordings/s.mcap", 100);

  VolumeInfo wanted;
  wanted.grid = bone->grid();
  wanted.content_hash = bone->content_hash();
  VolumeHints hints;
  hints.search_path = (folder / "nowhere") + ":" + (folder / "scans");
  hints.recording = folder / "recordings/s.mcap";
  const auto search = [&] { return find_volume(wanted, hints); };

  wanted.source_fingerprint = *fingerprint(folder / "scans/a/one.nii.gz");
  ASSERT_TRUE(search().ok());
  EXPECT_EQ(*search(), folder / "scans/a/one.nii.gz");
  // renamed and moved beside the recording
  std::filesystem::rename(folder / "scans/a/one.nii.gz", folder / "recordings/x.nii.gz");
  ASSERT_TRUE(search().ok());
  EXPECT_EQ(*search(), folder / "recordings/x.nii.gz");

  // a series is made of its files, whatever their names; files that burr wrote there do not count
  wanted.source_fingerprint = *fingerprint(folder / "scans/series");
  std::filesystem::rename(folder / "scans/series/IM1", folder / "scans/series/z.dcm");
  put("scans/series/after.png", 10);
  put("scans/series/s.mcap", 10);
  ASSERT_TRUE(search().ok()) << search().error().text;
  EXPECT_EQ(*search(), folder / "scans/series");

  // one byte more makes it another scan
  put("scans/series/IM3", 1);
  ASSERT_FALSE(search().ok());
  EXPECT_EQ(search().error().trouble, Trouble::io);
  EXPECT_NE(search().error().text.find("`volume`"), std::string::npos);
  hints.given = folder / "scans/b/two.nrrd";
  EXPECT_EQ(*search(), hints.given) << "the user's word";
  hints.given = folder / "gone.nrrd";
  EXPECT_FALSE(search().ok());
}

}  // namespace
}  // namespace burr::record

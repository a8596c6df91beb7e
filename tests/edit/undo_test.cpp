// Undo, redo and reset against a plain model that keeps every state of the whole bone.
#include "burr/edit/undo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "burr/base/progress.h"
#include "burr/edit/bone_writer.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::edit {
namespace {

using math::Vec3;
using volume::BrickIndex;
constexpr double kMm = 1e-3;

struct Work {
  explicit Work(std::size_t stroke_bricks)
      : bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3::Constant(-4 * kMm), Vec3::Constant(4 * kMm), 0.25 * kMm), {},
            phantom::slab(), 64)),
        surface(*bone, {}, 1, quiet),
        undo(*bone, stroke_bricks),
        writer(*bone, surface, undo, nullptr) {}

  [[nodiscard]] std::uint64_t hash() const { return bone->content_hash(); }
  // Writes something else into any brick. False: with a flag.
  bool write(std::mt19937& random) {
    const auto brick =
        static_cast<BrickIndex>(random() % static_cast<unsigned>(bone->brick_count()));
    KeptBrick now;
    now.brick = brick;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      now.field.voxel[v] = static_cast<volume::Field>(random());
      now.tissue[v] = static_cast<volume::TissueId>(1 + random() % 3);
    }
    std::uint32_t flags = 0;
    writer.rewrite(now, flags);
    return flags == 0;
  }
  void swap(const UndoStore::Range& range) {
    for (std::uint64_t n = 0; n < range.count; ++n) writer.swap(undo.entry(range.first + n));
  }

  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  UndoStore undo;
  BoneWriter writer;
};

TEST(Undo, AnyWayBackAndForthIsWhatAModelOfWholeBonesSays) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  Work work(4096);
  const std::uint64_t start = work.hash();
  std::vector<std::uint64_t> states = {start};  // states[at] is what there is
  std::size_t at = 0;
  int undone = 0, redone = 0;
  for (int round = 0; round < 300; ++round) {
    ASSERT_EQ(work.undo.can_undo(), at > 0);
    ASSERT_EQ(work.undo.can_redo(), at + 1 < states.size());
    const unsigned what = static_cast<unsigned>(random()) % 3;
    if (what == 0) {
      work.undo.begin_stroke(static_cast<std::uint64_t>(round));
      EXPECT_FALSE(work.undo.can_undo()) << "not while a stroke is open";
      for (unsigned n = static_cast<unsigned>(random()) % 6; n > 0; --n)
        ASSERT_TRUE(work.write(random));
      work.undo.end_stroke();
      states.resize(++at);  // what could have been redone is gone
      states.push_back(work.hash());
    } else if (what == 1 && at > 0) {
      work.swap(work.undo.undo());
      --at;
      ++undone;
    } else if (what == 2 && at + 1 < states.size()) {
      work.swap(work.undo.redo());
      ++at;
      ++redone;
    }
    ASSERT_EQ(work.hash(), states[at]) << "round " << round;
  }
  EXPECT_GT(undone, 20);
  EXPECT_GT(redone, 5);

  // the start of each brick that was ever written is kept, whatever was undone
  for (std::size_t n = 0; n < work.undo.touched(); ++n) {
    const KeptBrick& kept = work.undo.original(n);
    EXPECT_EQ(work.undo.original_of(kept.brick), &kept);
    work.writer.restore(kept);
  }
  EXPECT_EQ(work.hash(), start) << "reset";
  work.undo.forget_strokes();
  EXPECT_FALSE(work.undo.can_undo());
  EXPECT_FALSE(work.undo.can_redo());
}

TEST(Undo, AFullStoreForgetsOldStrokesOnlyAndTellsWhen) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  Work work(64);
  std::vector<std::uint64_t> states = {work.hash()};
  bool told = false;
  for (int stroke = 0; stroke < 30; ++stroke) {
    work.undo.begin_stroke(0);
    for (int n = 0; n < 8; ++n) told |= !work.write(random);
    work.undo.end_stroke();
    states.push_back(work.hash());
  }
  EXPECT_TRUE(told);
  std::uint64_t room = 64;
  std::size_t at = states.size() - 1;
  while (work.undo.can_undo()) {
    const UndoStore::Range range = work.undo.undo();
    ASSERT_LE(range.count, room);
    room -= range.count;
    work.swap(range);
    ASSERT_EQ(work.hash(), states[--at]);
  }
  EXPECT_LT(room, 16U) << "it forgets no more than it has to";
  EXPECT_GT(at, 0U);
}

}  // namespace
}  // namespace burr::edit

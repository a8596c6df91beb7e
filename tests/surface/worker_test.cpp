#include "burr/surface/worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <random>
#include <thread>

#include "surface/surface_bones.h"

namespace burr::surface {
namespace {

using test::askew;
using test::bone_of;
using volume::Field;

std::unique_ptr<volume::Bone> lumps() {
  return bone_of(
      askew({60, 41, 49}),
      [](const math::Vec3& p) {
        return 4 * (std::sin(p.x() / 3) + std::sin(p.y() / 4) + std::sin(p.z() / 5));
      },
      100);
}

// What the main thread would show on the screen.
struct Screen {
  std::map<int, Patch> patches;
  void show(const Skin& skin) {
    if (skin.mesh->triangles.empty())
      patches.erase(skin.patch);
    else
      patches[skin.patch] = *skin.mesh;
  }
};

void expect_equals_full_extraction(const Screen& screen, const volume::Bone& bone) {
  Mesher mesher(bone);
  Patch patch;
  for (int i = 0; i < mesher.patch_count(); ++i) {
    ASSERT_TRUE(mesher.mesh_patch(i, patch));
    const auto seen = screen.patches.find(i);
    if (patch.triangles.empty()) {
      EXPECT_EQ(seen, screen.patches.end()) << "patch " << i << " is gone but still shown";
      continue;
    }
    ASSERT_NE(seen, screen.patches.end()) << "patch " << i << " is missing";
    EXPECT_EQ(seen->second.triangles, patch.triangles) << "patch " << i;
    ASSERT_EQ(seen->second.vertices.size(), patch.vertices.size()) << "patch " << i;
    for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
      ASSERT_EQ(seen->second.vertices[v].p, patch.vertices[v].p);
      ASSERT_EQ(seen->second.vertices[v].n, patch.vertices[v].n);
    }
  }
}

// One random cut, deposit or erasure of a whole brick.
void edit(volume::Bone& bone, std::mt19937& random) {
  const auto brick =
      static_cast<volume::BrickIndex>(random() % static_cast<unsigned>(bone.brick_count()));
  if (bone.ensure_slot(brick) == volume::kNoSlot) return;
  volume::BrickField content{};
  const auto kind = random() % 3;
  for (Field& voxel : content.voxel)
    voxel = kind == 0 ? Field{0} : kind == 1 ? volume::kSolid : static_cast<Field>(random());
  bone.write_brick(brick, content);
}

TEST(Worker, ShowsTheWholeSurfaceFirst) {
  for (const int threads : {1, 3}) {
    const auto bone = lumps();
    Worker worker(*bone, threads);
    Screen screen;
    NoProgress progress;
    ASSERT_TRUE(worker.first(progress, [&](const Skin& skin) { screen.show(skin); }).ok());
    EXPECT_EQ(worker.waiting(), 0);
    EXPECT_GT(screen.patches.size(), 10U);
    expect_equals_full_extraction(screen, *bone);
  }
}

TEST(Worker, AfterRandomEditsIncrementalEqualsFull) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto bone = lumps();
    Worker worker(*bone, 2);
    Screen screen;
    const auto show = [&](const Skin& skin) { screen.show(skin); };
    worker.settle(show);
    for (int round = 0; round < 10; ++round) {
      for (auto n = 1 + random() % 6; n > 0; --n) edit(*bone, random);
      worker.settle(show);
    }
    expect_equals_full_extraction(screen, *bone);
  }
}

TEST(Worker, WhatIsCutAwayWholeDisappears) {
  const auto bone = lumps();
  Worker worker(*bone, 2);
  Screen screen;
  const auto show = [&](const Skin& skin) { screen.show(skin); };
  worker.settle(show);
  EXPECT_FALSE(screen.patches.empty());
  for (volume::BrickIndex brick = 0; brick < bone->brick_count(); ++brick)
    if (bone->brick_field(brick) != nullptr) bone->write_brick(brick, {});
  worker.settle(show);
  EXPECT_TRUE(screen.patches.empty());
}

TEST(Worker, KeepsUpWithAServoThatCutsAllTheTime) {
  const auto bone = lumps();
  Worker worker(*bone, 2);
  std::atomic<bool> stop = false;
  std::atomic<int> taken = 0;
  std::thread servo([&] {
    std::mt19937 random(17);
    // until something was seen meanwhile, however slow the machine or the build; at most a minute
    const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    for (int tick = 0; tick < 3000 || (taken <= 10 && std::chrono::steady_clock::now() < late);
         ++tick) {
      edit(*bone, random);
      if (tick % 16 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    stop = true;
  });
  Screen screen;
  const auto show = [&](const Skin& skin) { screen.show(skin); };
  while (!stop) {
    for (Skin skin; worker.take(skin); worker.give_back(skin), ++taken) show(skin);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  servo.join();
  worker.settle(show);
  EXPECT_GT(taken, 10);
  expect_equals_full_extraction(screen, *bone);
}

TEST(Worker, WaitsForALazyMainAndLosesNothing) {
  // more patches with surface than may be lent at the same time
  const auto bone = bone_of(askew({150, 150, 150}), [](const math::Vec3& p) {
    return 3 * (std::sin(p.x() / 2) + std::sin(p.y() / 2) + std::sin(p.z() / 2));
  });
  Worker worker(*bone, 1);
  std::vector<Skin> kept;
  for (int i = 0; i < 60000 && kept.size() < kLent; ++i) {  // at most a minute
    for (Skin skin; worker.take(skin);) kept.push_back(skin);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(kept.size(), static_cast<std::size_t>(kLent));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  Skin none;
  EXPECT_FALSE(worker.take(none));
  Screen screen;
  for (const Skin& skin : kept) {
    screen.show(skin);
    worker.give_back(skin);
  }
  worker.settle([&](const Skin& skin) { screen.show(skin); });
  expect_equals_full_extraction(screen, *bone);
}

TEST(Worker, FirstStopsWhenAsked) {
  struct Impatient final : Progress {
    void report(double, std::string_view) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } progress;
  const auto bone = lumps();
  Worker worker(*bone, 1);
  const Status status = worker.first(progress, [](const Skin&) {});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().trouble, Trouble::interrupted);
}

}  // namespace
}  // namespace burr::surface

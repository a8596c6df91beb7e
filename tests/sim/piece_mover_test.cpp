// A piece that a hand cuts free while the session runs beside the main thread: it is told once, listed,
// and put down.
#include "burr/sim/piece_mover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"

namespace burr::sim {
namespace {

using math::Quat;
using math::Vec3;
constexpr double kMm = 1e-3, kVoxel = 0.25 * kMm;

// Two blocks with a bridge 1 mm wide at x = 2, and a hand that cuts through it and then rests. island: a
// third block lies free beside them.
std::unique_ptr<Session> bridged(bool island = false) {
  NoProgress quiet;
  const phantom::Depth whole = phantom::box({8 * kMm, 2 * kMm, 2 * kMm});
  auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-10, -6, -6) * kMm, Vec3(14, 6, 6) * kMm, kVoxel), {},
      [whole, island](const Vec3& p) {
        const phantom::Depth block = phantom::box({1.5 * kMm, 2 * kMm, 2 * kMm});
        if (island && p.x() > 9 * kMm) return block(p - Vec3(11, 0, 0) * kMm);
        const double kerf = std::abs(p.x() - 2 * kMm) - 1.2 * kMm;
        const double bridge = 0.5 * kMm - std::max(std::abs(p.y()), std::abs(p.z()));
        return std::min(whole(p), std::max(kerf, bridge));
      },
      1024);
  device::HandPath path;
  const auto at = [&path](double t, double y) {
    path.points.push_back({t, {Vec3(2, y, 0) * kMm, Quat::Identity()}, 1});
  };
  at(0, -5);
  at(0.5, -5);
  at(3, 5);
  at(1e6, 5);
  SessionSettings settings;
  settings.servo.burr.radius = 1 * kMm;
  settings.surface.reserve_blocks = 1 << 13;
  auto made = Session::make(std::move(bone),
                            std::make_unique<device::SimulatedHand>(
                                std::move(path), device::ArmSettings{.stiffness = INFINITY}),
                            settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return std::move(*made);
}

bool waited_for(const std::function<bool()>& what) {
  for (int n = 0; n < 6000; ++n) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(PieceMover, TellsOnceListsAndPutsDown) {
  const std::unique_ptr<Session> session = bridged();
  const std::uint64_t at_start = session->bone().content_hash();
  PieceMover mover(*session);
  EXPECT_TRUE(mover.look().empty()) << "the bridge holds";
  session->start();
  std::vector<PieceMover::News> news;
  const auto more = [&] {
    for (const PieceMover::News& one : mover.look())
      if (!one.dust) news.push_back(one);
    return !news.empty();
  };
  ASSERT_TRUE(waited_for(more));
  ASSERT_EQ(news.size(), 1U);
  EXPECT_NEAR(1e9 * news[0].volume, 4.8 * 16, 0.1 * 4.8 * 16);
  mover.take();
  ASSERT_TRUE(waited_for([&] { return mover.list() != nullptr; }));
  const auto list = mover.list();
  ASSERT_GE(list->size(), 1U);
  ASSERT_TRUE(mover.put(list->front(), Vec3(3, 0, 0) * kMm, Quat::Identity()));
  EXPECT_FALSE(mover.put(list->front(), Vec3(3, 0, 0) * kMm, Quat::Identity()));
  ASSERT_TRUE(waited_for([&] {
    static_cast<void>(more());
    return mover.state() == PieceMover::State::put || mover.state() == PieceMover::State::refused;
  }));
  EXPECT_EQ(mover.state(), PieceMover::State::put) << mover.why();
  // it is no news that it is free
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  static_cast<void>(more());
  EXPECT_EQ(news.size(), 1U);
  session->stop();
  const auto moved = mover.store().moved(session->bone());
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_LT((moved[0].now * moved[0].centre - moved[0].centre - Vec3(3, 0, 0) * kMm).norm(), 1e-9);
  EXPECT_NE(session->bone().content_hash(), at_start);
}

TEST(PieceMover, WhatWasFreeBeforeIsNoNews) {
  const std::unique_ptr<Session> session = bridged(true);
  PieceMover mover(*session);
  session->start();
  std::vector<PieceMover::News> news;
  ASSERT_TRUE(waited_for([&] {
    for (const PieceMover::News& one : mover.look())
      if (!one.dust) news.push_back(one);
    return !news.empty();
  }));
  session->stop();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_NEAR(1e9 * news[0].volume, 4.8 * 16, 0.1 * 4.8 * 16) << "the island has 48";
}

}  // namespace
}  // namespace burr::sim

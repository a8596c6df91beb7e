// A free piece of bone at the window: taken from the list, moved by keys, put down, undone.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "burr/rt/flags.h"
#include "burr/tick/held_piece.h"
#include "burr/volume/pieces.h"
#include "burr/volume/sample.h"
#include "two_blocks.h"
#include "user.h"
#include "window/mill/piece_mode.h"
#include "window/mill/side_panel.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kMm = 1e-3;

class PiecesWindow : public Window {
 protected:
  void click_take() const {
    const float u = desk_->ui().unit();
    click(static_cast<int>((kSideLeft + kSideWide - 50) * u),
          static_cast<int>((kSideTop + 48 + 16) * u));
  }
};

TEST_F(PiecesWindow, AFreePieceIsTakenMovedPutDownAndBroughtBack) {
  auto made = ready_two_blocks();
  ASSERT_TRUE(made) << made.error().text;
  WindowSession& ready = *made;
  const std::uint64_t at_start = ready.session->bone().content_hash();
  const std::size_t softs = ready.scene.soft.size();
  const auto told = [this](Word says) {
    return [this, says] { return desk_->status_text.find(word(says)) != std::string::npos; };
  };
  int framed = 0;
  const auto has_ghost = [&] { return ready.scene.soft.size() > softs; };
  mill_by(ready, {{"a picture", looks(3), [] { press(SDLK_m, KMOD_CTRL); }},
                  {"the frame of the piece", [&] { return ready.scene.rods.size() >= 12; },
                   [&] {
                     // a frame that lies in the bone is not seen
                     for (const render::Rod& rod : ready.scene.rods) {
                       if (rod.on_top || rod.arrow) continue;
                       ++framed;
                       EXPECT_LT(volume::depth_at(ready.session->bone(), rod.a), 0);
                       EXPECT_LT(volume::depth_at(ready.session->bone(), rod.b), 0);
                     }
                     click_take();
                   }},
                  {"the ghost", asking_until(has_ghost, [&] { click_take(); }),
                   [] {
                     for (int n = 0; n < 6; ++n) press(SDLK_RIGHT);
                     for (int n = 0; n < 5; ++n) press(SDLK_RIGHT, KMOD_SHIFT);
                   }},
                  {"the ghost has moved", looks(5), [] { press(SDLK_RETURN); }},
                  {"it lies there", told(Word::piece_lies), [] { press(SDLK_u); }},
                  {"it is back", looks(30), [] { close_window(); }}});
  EXPECT_GE(framed, 12);
  EXPECT_EQ(ready.session->bone().content_hash(), at_start) << "undone";
  EXPECT_EQ(ready.scene.soft.size(), softs) << "the ghost is gone";
  EXPECT_GT(ready.session->writes(), 0U);
}

TEST_F(PiecesWindow, WhatIsPutDownLiesWhereItWasShown) {
  auto made = ready_two_blocks();
  ASSERT_TRUE(made) << made.error().text;
  WindowSession& ready = *made;
  const std::size_t softs = ready.scene.soft.size();
  const auto boxed = [](const volume::Bone& bone) {
    const volume::PieceFinder finder(std::as_const(bone));
    EXPECT_EQ(finder.pieces().size(), 2U);
    const volume::Piece& piece = finder.pieces().back();
    return Vec3(bone.grid().world_from_grid(0.5 * (piece.low + piece.high).cast<double>()));
  };
  const Vec3 before = boxed(ready.session->bone());
  Vec3 right = Vec3::Zero();
  const auto told = [this](Word says) {
    return [this, says] { return desk_->status_text.find(word(says)) != std::string::npos; };
  };
  mill_by(ready,
          {{"a picture", looks(3), [] { press(SDLK_m, KMOD_CTRL); }},
           {"the frame of the piece", [&] { return ready.scene.rods.size() >= 12; },
            [&] { click_take(); }},
           {"the ghost",
            asking_until([&] { return ready.scene.soft.size() > softs; }, [&] { click_take(); }),
            [&] {
              right = ready.scene.camera.right();
              for (int n = 0; n < 6; ++n) press(SDLK_RIGHT);
              for (int n = 0; n < 5; ++n) press(SDLK_RIGHT, KMOD_SHIFT);
            }},
           {"the ghost has moved", looks(5), [] { press(SDLK_RETURN); }},
           {"it lies there", told(Word::piece_lies), [] { close_window(); }}});
  const Vec3 by = boxed(ready.session->bone()) - before;
  EXPECT_LT((by - 3.5 * kMm * right).norm(), kBlockVoxel) << (1e3 * by).transpose();
}

// The piece without the page: looked at as often as a picture would.
class LiftedPiece : public testing::Test {
 protected:
  void SetUp() override {
    auto made = ready_two_blocks();
    ASSERT_TRUE(made) << made.error().text;
    ready_.emplace(std::move(*made));
    at_start_ = session().bone().content_hash();
    mode_.emplace(session(), nullptr);
    session().start();
  }
  void TearDown() override {
    mode_.reset();
    ready_.reset();
  }
  sim::Session& session() { return *ready_->session; }
  bool until(const std::function<bool()>& done) {
    for (int n = 0; n < 3000; ++n) {
      static_cast<void>(session().view(row_));
      if (const std::string told = mode_->look(true, row_); !told.empty()) told_ = told;
      if (done()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  [[nodiscard]] bool out() const { return row_.piece.state != tick::PieceRow::kNone; }
  // Also where the list is older than what came back.
  bool taken_out() {
    return until([&] {
      const PiecesState state = mode_->state();
      if (!state.taken && !state.putting && !state.rows.empty()) mode_->take(0);
      return mode_->taken() && mode_->state().felt && out();
    });
  }
  [[nodiscard]] bool at_rest() const { return (row_.contact.flags & rt::kFlagRestoring) == 0; }
  std::uint64_t hash_at_end() {
    mode_->end();
    mode_.reset();
    session().stop();
    EXPECT_FALSE(session().servo().restoring());
    EXPECT_FALSE(session().servo().piece().lifted());
    return session().bone().content_hash();
  }

  std::optional<WindowSession> ready_;
  std::optional<PieceMode> mode_;
  tick::TickRow row_;
  std::string told_;
  std::uint64_t at_start_ = 0;
};

TEST_F(LiftedPiece, GoesBackWhenTheSessionEnds) {
  ASSERT_TRUE(taken_out());
  mode_->shift({5 * kMm, 2 * kMm, 0});
  ASSERT_TRUE(until([&] { return row_.piece.p.y() > 1.5 * kMm; }));
  EXPECT_EQ(hash_at_end(), at_start_);
}

// On its way out, and never out.
TEST_F(LiftedPiece, GoesBackWhenTheSessionEndsAtOnce) {
  ASSERT_TRUE(until([&] { return !mode_->state().rows.empty(); }));
  mode_->take(0);
  EXPECT_EQ(hash_at_end(), at_start_);
}

TEST_F(LiftedPiece, IsPutDownWholeWhenTheSessionEndsMeanwhile) {
  ASSERT_TRUE(taken_out());
  mode_->shift({0, 4 * kMm, 0});
  ASSERT_TRUE(until([&] { return row_.piece.p.y() > 3.5 * kMm; }));
  mode_->put_down();
  EXPECT_NE(hash_at_end(), at_start_);
  const volume::PieceFinder finder(std::as_const(session().bone()));
  ASSERT_EQ(finder.pieces().size(), 2U);
  EXPECT_NEAR(session().outcome().ledger.moved, 0, 1e-13) << "whole voxels: nothing is lost";
}

// Where it cannot be put down it stays in the hand, or goes back at the end.
TEST_F(LiftedPiece, IsNotLostWhereItIsRefused) {
  ASSERT_TRUE(taken_out());
  mode_->shift({0, 0, 9 * kMm});
  ASSERT_TRUE(until([&] { return row_.piece.p.z() > 8.5 * kMm; }));
  mode_->put_down();
  ASSERT_TRUE(until([&] { return !told_.empty(); }));
  EXPECT_NE(told_.find("volume"), std::string::npos) << told_;
  EXPECT_TRUE(mode_->taken());
  EXPECT_TRUE(out());
  mode_->put_down();
  EXPECT_EQ(hash_at_end(), at_start_);
}

// One after another: left, undone while it was being put down, and taken once more.
TEST_F(LiftedPiece, IsTakenAgainAfterItWasLeftAndUndone) {
  ASSERT_TRUE(taken_out());
  mode_->leave();
  EXPECT_FALSE(mode_->taken());
  mode_->take(0);
  EXPECT_FALSE(mode_->taken()) << "it is on its way back";
  ASSERT_TRUE(until([&] { return !out() && at_rest(); }));
  EXPECT_EQ(session().bone().content_hash(), at_start_);
  ASSERT_TRUE(taken_out());
  mode_->take(0);
  EXPECT_TRUE(mode_->state().felt) << "it is in the hand already";
  mode_->put_down();
  session().command({tick::CommandKind::undo, 0});
  ASSERT_TRUE(until([&] { return !mode_->taken() && !mode_->state().putting && at_rest(); }));
  EXPECT_EQ(session().bone().content_hash(), at_start_);
  ASSERT_TRUE(taken_out());
  session().command({tick::CommandKind::reset, 0});
  ASSERT_TRUE(until([&] { return !mode_->taken() && at_rest(); }));
  EXPECT_EQ(session().bone().content_hash(), at_start_);
  EXPECT_EQ(hash_at_end(), at_start_);
}

// The second hand grabs while the first one still holds: the piece stays where it is, and follows the
// second hand from there.
TEST(PieceInTwoHands, DoesNotLeapWhenTheOtherHandTakesOver) {
  auto made = ready_two_blocks();
  ASSERT_TRUE(made) << made.error().text;
  PieceMode mode(*made->session, nullptr);
  for (int n = 0; n < 1000 && mode.state().rows.empty(); ++n) {
    static_cast<void>(mode.look(true));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_FALSE(mode.state().rows.empty());
  mode.take(0);
  const auto carry = [&mode](const Vec3& hand, int which) {
    PieceMode::Carrier by;
    by.hand.p = hand;
    by.grabs = true;
    by.which = which;
    mode.carry(by);
    return Vec3(mode.state().mm[0], mode.state().mm[1], mode.state().mm[2]);
  };
  mode.carry({});
  EXPECT_NEAR(carry(Vec3::Zero(), 0).norm(), 0, 1e-9);
  const Vec3 first = carry({2 * kMm, 0, 0}, 0);
  EXPECT_NEAR(first.norm(), 2, 1e-9);
  const Vec3 taken_over = carry({50 * kMm, 0, 0}, 1);
  EXPECT_NEAR((taken_over - first).norm(), 0, 1e-9);
  EXPECT_NEAR((carry({51 * kMm, 0, 0}, 1) - first).norm(), 1, 1e-9);
}

}  // namespace
}  // namespace burr::app

// tests/sim/lifted.h - a recorded session in which the right part of a block is lifted, carried and put down, by
// commands: at known times it is at known places.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "burr/device/replayed_hand.h"
#include "burr/math/turn.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/recorder.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/held_piece.h"
#include "burr/tick/servo.h"

namespace burr::sim::test {

// The part: half its sides, and its middle where it came free.
inline const math::Vec3 kPart = math::Vec3(2.25, 5, 4) * 1e-3,
                        kPartAt = math::Vec3(5.75, 0, 0) * 1e-3;

struct Lifted {
  double before = 0;                     // nothing is lifted yet  [s]
  double out[2] = {0, 0};                // it is out
  math::Pose at[2];                      // where its body is then: middle, turn
  double lies = 0;                       // it is bone again, where it was put down
  math::Vec3 part = math::Vec3::Zero();  // middle of its voxels where it came free
};

// Two times: straight up, then, from where it was put down, up and turned; then it goes back to there.
inline Lifted record_lifted(const std::string& path) {
  using math::Vec3;
  constexpr double kMm = 1e-3;
  Lifted told;
  NoProgress quiet;
  const phantom::Depth whole = phantom::box({8 * kMm, 5 * kMm, 4 * kMm});
  auto bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-12, -9, -8) * kMm, Vec3(14, 9, 10) * kMm, 0.25 * kMm), {},
      [whole](const Vec3& p) { return std::min(whole(p), std::abs(p.x() - 3 * kMm) - 0.5 * kMm); },
      4096);
  SessionSettings settings;
  settings.servo.burr.radius = 1 * kMm;
  settings.servo.undo_bricks = 8192;
  settings.surface.reserve_blocks = 1 << 14;
  auto hand = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
  device::HandState away;
  away.world_from_tool.p = Vec3(9, 8, 20) * kMm;  // a picture of the work shows the part from above
  hand->set(away);
  auto made = Session::make(std::move(bone), std::move(hand), settings, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  Session& session = **made;
  record::SessionInfo info;
  describe(session.settings(), session.hand().spec(), info);
  info.volume.content_hash = session.bone().content_hash();
  info.volume.grid = session.bone().grid();
  info.volume.tissues = session.bone().tissues();
  info.volume.recipe.reserve_bricks = 4096;
  record::Recorder recorder(info.rate_hz, 8192);
  EXPECT_TRUE(recorder.start(path, info, &session.bone()).ok());
  session.set_recorder(&recorder);
  const auto now = [&session, &info] {
    return static_cast<double>(session.outcome().ticks) / info.rate_hz - 0.01;
  };
  session.run(0.2, quiet);
  told.before = now();
  edit::PieceStore store;
  Vec3 near = kPartAt;
  for (int n = 0; n < 2; ++n) {
    const auto lifted = lift_piece(session, store, near, quiet);
    EXPECT_TRUE(lifted.ok()) << lifted.error().text;
    if (!lifted.ok()) return told;
    told.part = lifted->centre;
    math::Pose to = session.servo().piece().pose();
    to.p += Vec3(2.5, 0, 14) * kMm;
    if (n == 1) to.q = math::turned(to.q, Vec3(0, 0.6, 0));
    const edit::PieceMove move = put_at(lifted->move.piece, Vec3::Zero(), to);
    session.command({tick::CommandKind::shift_piece, static_cast<double>(move.piece), move});
    session.run(0.3, quiet);
    told.out[n] = now();
    told.at[n] = session.servo().piece().pose();
    EXPECT_LT((told.at[n].p - to.p).norm(), 1e-6);
    if (n == 1) {
      EXPECT_TRUE(leave_piece(session).ok());
      break;
    }
    const math::Pose down = {lifted->centre + Vec3(2, 0, 0) * kMm, math::Quat::Identity()};
    const edit::PieceMove lower = put_at(lifted->move.piece, Vec3::Zero(), down);
    session.command({tick::CommandKind::shift_piece, static_cast<double>(lower.piece), lower});
    session.run(0.3, quiet);
    const auto put = put_down(session, store, *lifted, quiet);
    EXPECT_TRUE(put.ok()) << put.error().text;
    session.run(0.2, quiet);
    told.lies = now();
    near = kPartAt + Vec3(2, 0, 0) * kMm;
  }
  session.run(0.2, quiet);
  session.set_recorder(nullptr);
  EXPECT_TRUE(recorder.finish().ok());
  return told;
}

}  // namespace burr::sim::test

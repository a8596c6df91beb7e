// A piece of bone was moved in a session: score and report say so as facts, and no item changes.
#include <gtest/gtest.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/report/make_report.h"
#include "burr/report/report_page.h"
#include "burr/report/report_pictures.h"
#include "burr/report/scored.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/session.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recording.h"
#include "render/gpu.h"
#include "support/folder.h"

namespace burr::report {
namespace {

using math::Vec3;
constexpr double kMm = 1e-3;

// The case of the block with a plan for its right part, which a kerf of 1 mm at x = 10 parts from the rest.
scenario::Case planned() {
  const auto block = scenario::read_case("block");
  EXPECT_TRUE(block.ok());
  auto work = scenario::parse_case(
      block->text + "\n[[piece]]\nnear = [15, 0, 0]\nby_mm = [3, 0, 0]\n", "block.toml");
  EXPECT_TRUE(work.ok()) << work.error().text;
  return std::move(*work);
}

// Records a session in which nothing is cut and, unless `by` is zero, the right part is moved. ends: lift: it ends
// with the part out of the bone, as one that was killed; leave: it was lifted and left.
enum class Ends { whole, lift, leave };
void record_session(const std::string& file, const Vec3& by, const Vec3& turn,
                    Ends ends = Ends::whole) {
  NoProgress quiet;
  const scenario::Case work = planned();
  scenario::BoneRecipe coarse;
  coarse.voxel_mm = 0.5;
  auto prepared = workshop::prepare(work, quiet, {}, coarse);
  ASSERT_TRUE(prepared.ok()) << prepared.error().text;
  const phantom::Depth whole = phantom::box({20 * kMm, 20 * kMm, 15 * kMm});
  prepared->bone = phantom::bone_from_distance(
      phantom::box_grid(Vec3(-24, -24, -19) * kMm, Vec3(32, 24, 19) * kMm, 0.5 * kMm),
      prepared->bone->tissues(),
      [whole](const Vec3& p) { return std::min(whole(p), std::abs(p.x() - 10 * kMm) - 0.5 * kMm); },
      4096);
  prepared->recipe.reserve_bricks = 4096;
  auto hand = std::make_unique<device::ReplayedHand>(device::DeviceSpec{});
  device::HandState away;
  away.world_from_tool.p = Vec3(0, 0, 18) * kMm;
  hand->set(away);
  sim::SessionSettings settings = workshop::settings_of(*prepared);
  settings.servo.undo_bricks = 8192;
  workshop::About about{prepared->recipe, "formula", "none", true, std::nullopt, work};
  auto made = workshop::begin(*prepared, std::move(hand), settings, quiet);
  ASSERT_TRUE(made.ok()) << made.error().text;
  sim::Session& session = **made;
  auto recorder = workshop::record(session, file, about);
  ASSERT_TRUE(recorder.ok()) << recorder.error().text;
  session.run(0.3, quiet);
  if (by.norm() > 0) {
    edit::PieceStore store;
    const auto moved = sim::move_piece(session, store, {Vec3(15, 0, 0) * kMm, by, turn}, quiet);
    ASSERT_TRUE(moved.ok()) << moved.error().text;
  }
  if (ends != Ends::whole) {
    edit::PieceStore store;
    const auto lifted = sim::lift_piece(session, store, Vec3(15, 0, 0) * kMm, quiet);
    ASSERT_TRUE(lifted.ok()) << lifted.error().text;
    if (ends == Ends::leave) {
      ASSERT_TRUE(sim::leave_piece(session).ok());
    }
    session.run(0.3, quiet);
  }
  session.set_recorder(nullptr);
  ASSERT_TRUE((*recorder)->finish().ok());
}

Scored score_of(const std::string& file) {
  NoProgress quiet;
  auto judged = judged_by(file, "");
  EXPECT_TRUE(judged.ok()) << judged.error().text;
  auto made = scored(std::move(*judged), {}, quiet);
  EXPECT_TRUE(made.ok()) << made.error().text;
  return std::move(*made);
}

// The pictures of a moment show a piece that was out of the bone then, and not before.
TEST(MovedPieces, ThatAreOutAreInTheEvidence) {
  BURR_NEEDS_GPU(gpu);
  const test::Folder folder;
  const std::string file = (folder.path() / "lifted.mcap").string();
  record_session(file, Vec3::Zero(), Vec3::Zero(), Ends::lift);
  if (HasFatalFailure()) return;
  Scored out = score_of(file);
  ASSERT_FALSE(out.score.outcomes.empty());
  NoProgress quiet;
  auto artist = ReportArtist::make(out, quiet);
  ASSERT_TRUE(artist.ok()) << artist.error().text;
  const auto blue_at = [&](std::uint64_t tick) {
    out.score.outcomes[0].tick = tick;
    const std::size_t first = 0;
    auto made = (*artist)->evidence(std::span(&first, 1), 1);
    EXPECT_TRUE(made.ok());
    if (!made.ok() || (*made)[0].empty()) return -1;
    const std::string& png = (*made)[0][0].png;
    int width = 0, height = 0, count = 0;
    unsigned char* rgb =
        stbi_load_from_memory(reinterpret_cast<const unsigned char*>(png.data()),
                              static_cast<int>(png.size()), &width, &height, nullptr, 3);
    EXPECT_NE(rgb, nullptr);
    for (int n = 0; rgb != nullptr && n < width * height; ++n)
      count += int{rgb[3 * n + 2]} > rgb[3 * n] + 40 ? 1 : 0;
    stbi_image_free(rgb);
    return count;
  };
  const int before = blue_at(250);
  EXPECT_LT(before, 50);
  EXPECT_GT(blue_at(out.judged.player->end_tick() - 1), before + 500);
}

TEST(MovedPieces, AreFactsBesideTheItemsAndChangeNone) {
  const test::Folder folder;
  const std::string with = (folder.path() / "moved.mcap").string(),
                    without = (folder.path() / "still.mcap").string();
  record_session(with, Vec3(2.5, 0, 0) * kMm, Vec3(0, 0, 2 * M_PI / 180));
  record_session(without, Vec3::Zero(), Vec3::Zero());
  if (HasFatalFailure()) return;
  Scored moved = score_of(with), still = score_of(without);
  EXPECT_TRUE(still.pieces.empty());
  ASSERT_EQ(moved.pieces.size(), 1U);
  const MovedPiece& piece = moved.pieces[0];
  EXPECT_NEAR(1e9 * piece.volume, 9.5 * 40 * 30, 0.02 * 9.5 * 40 * 30);
  EXPECT_NEAR(1e3 * piece.by.norm(), 2.5, 0.001);
  EXPECT_NEAR(piece.turned * 180 / M_PI, 2, 0.001);
  ASSERT_TRUE(piece.plan);
  EXPECT_NEAR(1e3 * piece.plan->off.off, 0.5, 0.001);
  EXPECT_NEAR(piece.plan->off.turned_off * 180 / M_PI, 2, 0.001);

  ASSERT_EQ(moved.score.outcomes.size(), still.score.outcomes.size());
  ASSERT_FALSE(moved.score.outcomes.empty());
  for (std::size_t n = 0; n < moved.score.outcomes.size(); ++n) {
    const scoring::Outcome &a = moved.score.outcomes[n], &b = still.score.outcomes[n];
    EXPECT_EQ(a.verdict, b.verdict) << a.id;
    EXPECT_EQ(a.value, b.value) << a.id;
  }

  NoProgress quiet;
  ReportSettings settings;
  settings.most_pictures = 0;
  const auto told = report_on(moved, settings, quiet), silent = report_on(still, settings, quiet);
  ASSERT_TRUE(told.ok() && silent.ok());
  ASSERT_EQ(told->pieces.size(), 1U);
  EXPECT_NE(told->pieces[0].second.find("moved 2.5 mm and turned 2.0°"), std::string::npos)
      << told->pieces[0].second;
  EXPECT_NE(told->pieces[0].second.find("0.5 mm and 2.0° off the plan"), std::string::npos)
      << told->pieces[0].second;
  EXPECT_NE(page_of(*told).find("id=\"pieces\""), std::string::npos);
  EXPECT_EQ(page_of(*silent).find("id=\"pieces\""), std::string::npos);
}

// A session that was killed while a piece was in a hand: the bone of the recording has a hole there, but the piece
// was not cut away.
TEST(MovedPieces, OneThatIsOutAtTheEndCountsAsItLay) {
  const test::Folder folder;
  const std::string out = (folder.path() / "out.mcap").string(),
                    left = (folder.path() / "left.mcap").string(),
                    without = (folder.path() / "still.mcap").string();
  record_session(out, Vec3::Zero(), Vec3::Zero(), Ends::lift);
  record_session(left, Vec3::Zero(), Vec3::Zero(), Ends::leave);
  record_session(without, Vec3::Zero(), Vec3::Zero());
  if (HasFatalFailure()) return;
  Scored lifted = score_of(out), back = score_of(left), still = score_of(without);
  EXPECT_NE(lifted.after->content_hash(), still.after->content_hash()) << "it is out";
  EXPECT_EQ(back.after->content_hash(), still.after->content_hash());
  EXPECT_TRUE(back.pieces.empty());
  ASSERT_EQ(lifted.pieces.size(), 1U);
  EXPECT_TRUE(lifted.pieces[0].out);
  EXPECT_NEAR(1e9 * lifted.pieces[0].volume, 9.5 * 40 * 30, 0.02 * 9.5 * 40 * 30);
  ASSERT_EQ(lifted.score.outcomes.size(), still.score.outcomes.size());
  for (std::size_t n = 0; n < still.score.outcomes.size(); ++n) {
    EXPECT_EQ(lifted.score.outcomes[n].verdict, still.score.outcomes[n].verdict);
    EXPECT_EQ(lifted.score.outcomes[n].value, still.score.outcomes[n].value);
  }
  EXPECT_EQ(lifted.score.worked, still.score.worked);
  ASSERT_EQ(pieces_text(lifted.pieces).size(), 1U);
  EXPECT_NE(pieces_text(lifted.pieces)[0].find("out of the bone"), std::string::npos);
  NoProgress quiet;
  ReportSettings settings;
  settings.most_pictures = 0;
  const auto told = report_on(lifted, settings, quiet);
  ASSERT_TRUE(told.ok());
  ASSERT_EQ(told->pieces.size(), 1U);
  EXPECT_NE(told->pieces[0].second.find("out of the bone"), std::string::npos);
  auto player = record::Player::open(out);
  ASSERT_TRUE(player.ok());
  EXPECT_TRUE(sim::moves_pieces(**player));
}

// `burr info` asks for it before it opens a bone.
TEST(MovedPieces, ARecordingSaysWhetherThereAreAny) {
  const test::Folder folder;
  for (const bool moves : {true, false}) {
    const std::string file = (folder.path() / (moves ? "a.mcap" : "b.mcap")).string();
    record_session(file, moves ? Vec3(1 * kMm, 0, 0) : Vec3(Vec3::Zero()), Vec3::Zero());
    auto player = record::Player::open(file);
    ASSERT_TRUE(player.ok());
    EXPECT_EQ(sim::moves_pieces(**player), moves);
  }
}

}  // namespace
}  // namespace burr::report

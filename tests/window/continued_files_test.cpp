// What every command makes of a session that was left and continued twice: one session, to the bit, and
// nobody can change a value of it unseen.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/progress.h"
#include "burr/record/chain.h"
#include "burr/record/player.h"
#include "burr/sim/replay.h"
#include "burr/tick/tick_hash.h"
#include "burr/workshop/recorded_bone.h"
#include "record/forged.h"
#include "shared/window_session.h"
#include "shared/work.h"
#include "support/folder.h"
#include "support/test_places.h"
#include "window/parts/autosave.h"
#include "window/parts/kept_sessions.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

class ContinuedFiles : public testing::Test {
 protected:
  static constexpr int kParts = 3;

  void SetUp() override {
    // the practice block in coarse voxels, which open faster
    std::ifstream in(fs::path(test::source_dir()) / "cases" / "block.toml");
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::string fine = "voxel_mm = 0.25";
    ASSERT_NE(text.find(fine), std::string::npos);
    text.replace(text.find(fine), fine.size(), "voxel_mm = 0.5");
    std::ofstream(folder_ / "block.toml") << text;
    WorkOptions options;
    options.volume.source = folder_ / "block.toml";
    options.identity.mode = record::Mode::practise;
    ASSERT_TRUE(take_case(options));
    auto work = open_work(options, quiet_);
    ASSERT_TRUE(work) << work.error().text;
    auto ready = make_window_session(options, std::move(*work), quiet_);
    KeptSession before;
    for (int part = 0; part < kParts; ++part) {
      ASSERT_TRUE(ready) << ready.error().text;
      mill(*ready, options, part > 0 ? &before : nullptr);
      ASSERT_EQ(kept_sessions(folder_.path()).size(), 1U) << "one session, one row";
      before = kept_sessions(folder_.path()).front();
      if (part + 1 < kParts) ready = continue_session(before, quiet_);
    }
    file_ = before.file.string();
  }

  // A short cut into the surface, and the hand in the air before it.
  void mill(WindowSession& ready, const WorkOptions& options, const KeptSession* goes_on) {
    Autosave autosave(folder_.path(), ready, options, {}, goes_on);
    ASSERT_EQ(autosave.trouble(), "");
    ASSERT_EQ(autosave.apart(), "");
    sim::Session& session = *ready.session;
    session.run(0.05, quiet_);
    mouse::MouseHand::Aim aim;
    aim.world_from_tool = ready.scene.burr.world_from_tool;
    aim.world_from_tool.p = ready.scene.camera.target;
    aim.pedal = 1;
    ready.hands.mouse->aim(aim);
    session.run(0.4, quiet_);
    removed_mm3_ += 1e9 * session.outcome().ledger.removed;
    ASSERT_TRUE(autosave.finish()) << autosave.trouble();
  }

  // The program's output, with "exit N" as the last line.
  std::string burr(const std::string& words) const {
    const std::string command =
        fmt::format("cd {} && HOME={} {}/burr {} 2>&1; echo \"exit $?\"", folder_.path().string(),
                    folder_.path().string(), test::build_dir(), words);
    std::string said;
    FILE* const pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> part{};
    while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr)
      said += part.data();
    if (pipe != nullptr) ::pclose(pipe);
    return said;
  }
  static nlohmann::json json_of(const std::string& said) {
    const std::size_t at = said.find('{');
    return nlohmann::json::parse(said.substr(at, said.rfind('}') + 1 - at), nullptr, false);
  }
  std::unique_ptr<volume::Bone> uncut(record::Player& player) {
    auto bone = workshop::bone_of(player, {}, quiet_);
    EXPECT_TRUE(bone) << bone.error().text;
    return bone ? std::move(*bone) : nullptr;
  }

  NoProgress quiet_;
  const test::Folder folder_;
  std::string file_;
  double removed_mm3_ = 0;
};

TEST_F(ContinuedFiles, EveryCommandReadsThemAsOneSession) {
  const auto good = [](const std::string& said) {
    EXPECT_NE(said.find("exit 0"), std::string::npos) << said;
    return said;
  };
  EXPECT_GT(removed_mm3_, 0) << "nothing was cut: the test shows nothing";
  auto player = record::Player::open(file_);
  ASSERT_TRUE(player) << player.error().text;
  ASSERT_EQ((*player)->continued().size(), static_cast<std::size_t>(kParts - 1));
  for (const record::SessionInfo& part : (*player)->continued())
    EXPECT_EQ(part.goes_on_with.size(), 40U);

  const std::string said = good(burr("info " + file_));
  for (const record::SessionInfo& part : (*player)->continued())
    EXPECT_NE(
        said.find(fmt::format("left and continued at {:.1f} s",
                              static_cast<double>(part.first_tick) / (*player)->info().rate_hz)),
        std::string::npos)
        << said;
  const auto checked = json_of(good(burr("replay --check --json " + file_)));
  EXPECT_EQ(checked.value("ticks", 0U), (*player)->end_tick()) << checked.dump();
  const auto score = json_of(good(burr("score --json " + file_)));
  EXPECT_TRUE(score.is_object());
  good(burr("report " + file_ + " --out report.html"));
  EXPECT_GT(fs::file_size(folder_ / "report.html"), 1000U);
  const std::string text = good(burr("score " + file_));
  EXPECT_EQ(text.find("changed"), std::string::npos) << text;
}

// Forged behind a joint: found by whoever reads the values, and by a replay even where all hashes from
// there on were computed again.
TEST_F(ContinuedFiles, AValueThatWasForgedBehindAJointIsFound) {
  std::uint64_t at = 0;
  {
    const auto player = record::Player::open(file_);
    ASSERT_TRUE(player) << player.error().text;
    at = (*player)->continued()[1].first_tick + 20;
    EXPECT_TRUE(record::check_chain(**player, quiet_));
  }
  const std::string plain = folder_ / "plain.mcap", clever = folder_ / "clever.mcap";
  fs::copy_file(file_, plain);
  fs::copy_file(file_, clever);
  record::test::forge(plain, [&](tick::TickRow& row) {
    if (row.tick == at) row.ledger.removed *= 2;
    return true;
  });
  const std::string found = fmt::format("tick {} was changed", at);
  for (const char* words : {"info", "score", "report --out r.html"}) {
    const std::string said = burr(std::string(words) + " " + plain);
    EXPECT_NE(said.find(found), std::string::npos) << said;
    EXPECT_EQ(said.find("exit 0"), std::string::npos) << said;
  }
  EXPECT_EQ(burr("replay --check " + plain).find("exit 0"), std::string::npos);

  std::uint64_t last = 0;
  record::test::forge(clever, [&](tick::TickRow& row) {
    if (row.tick == at) row.ledger.removed *= 2;
    row.hash = last = row.tick < at ? row.hash : tick::tick_hash(row, last);
    return true;
  });
  auto player = record::Player::open(clever);
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_TRUE(record::check_chain(**player, quiet_)) << "every hash fits";
  const auto again = sim::replay(**player, uncut(**player), quiet_);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(again->first_different_tick, at) << again->difference;
}

// A jump into any part gives the bone that the replay has there.
TEST_F(ContinuedFiles, AJumpIntoAnyPartGivesItsBone) {
  auto player = record::Player::open(file_);
  ASSERT_TRUE(player) << player.error().text;
  const double rate = (*player)->info().rate_hz;
  auto shown = uncut(**player);
  ASSERT_TRUE(shown);
  const std::uint64_t whole = shown->content_hash();
  for (const std::size_t part : {1U, 0U, 1U}) {
    const record::SessionInfo& info = (*player)->continued()[part];
    ASSERT_TRUE((*player)->bone_at(static_cast<double>(info.first_tick - 1) / rate, *shown));
    EXPECT_EQ(shown->content_hash(), info.volume.content_hash) << part;
  }
  ASSERT_TRUE((*player)->bone_at(1e9, *shown));
  const std::uint64_t end = shown->content_hash();
  EXPECT_NE(end, whole);
  const auto again = sim::replay(**player, uncut(**player), quiet_);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_FALSE(again->first_different_tick) << again->difference;
  EXPECT_EQ(again->bone->content_hash(), end);
}

}  // namespace
}  // namespace burr::app

// A user who takes bone, what was removed, and a picture out of a session that goes on.
#include "window/parts/export_job.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <csignal>
#include <cstdlib>

#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "burr/io/export_part.h"
#include "burr/volume/removed_part.h"
#include "burr/volume/shared_copy.h"
#include "shared/piece_files.h"
#include "shared/window_session.h"
#include "window/mill/window.h"
#include "window/parts/documents_folder.h"
#include "window/user.h"

namespace burr::app {
namespace {

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Export : public Window {
 protected:
  // the cursor at the end of the path, so that what is typed comes after it
  [[nodiscard]] static std::function<void()> types(const std::string& text) {
    return [text] {
      press(SDLK_END);
      type(text);
    };
  }
  [[nodiscard]] std::function<bool()> says(const std::string& words) const {
    return [this, words] { return desk_->status_text.find(words) != std::string::npos; };
  }
  // the middle of what the page has, at 1280 x 720
  static constexpr int kX = 240, kY = 155;
  enum Choice { kBone, kRemoved, kAdded, kPieces, kPicture };
  static void choose(Choice what) { click(kX + 28 + 58 + 124 * what, kY + 80); }
  static void into_path() { click(kX + 300, kY + 174); }
  static void write() { click(kX + 692, kY + 288); }
  // writes into folder_ by the path that stands there when the page opens
  void mill_in(WindowSession& ready, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    const auto left = mill(*desk_, *ready.session, ready.hands, *ready.worker, ready.scene,
                           {.folder = folder_.string()});
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
  // some bone to be cut, the button still down
  [[nodiscard]] std::vector<Script::Step> cuts(sim::Session& session) {
    rt::ChangedBits& changed = session.bone().add_watcher();
    return {{"the first picture", looks(3),
             [] {
               move_to(640, 340);
               button(SDL_BUTTON_LEFT, true);
             }},
            {"bone to be cut", pressing_until([&changed, bricks = 0]() mutable {
               changed.take_all([&bricks](std::size_t) { ++bricks; });
               return bricks > 60;
             }),
             [] {
               button(SDL_BUTTON_LEFT, false);
               press(SDLK_e);
             }}};
  }
};

TEST_F(Export, WritesTheBoneWhileTheSessionGoesOn) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  bool running = false;
  auto steps = cuts(session);
  steps.push_back({"the page", looks(5), [] { write(); }});
  steps.push_back({"the word that it is written", says("Written: "), nullptr});
  steps.push_back({"... in triangles", says("triangles"), [&] {
                     running = session.running();
                     leave_work();
                   }});
  mill_in(*ready, std::move(steps));
  EXPECT_TRUE(running);
  // the burr was lifted before: what is there now is what was written
  NoProgress quiet;
  const fs::path truth = folder_ / "truth.stl";
  ASSERT_TRUE(io::export_part(session.bone(), session.bone(), truth.string(), {}, quiet));
  EXPECT_TRUE(bytes_of(folder_ / "bone.stl") == bytes_of(truth));
  EXPECT_GT(fs::file_size(truth), 10'000U);
}

TEST_F(Export, WritesWhatWasRemovedAndItsVolumeIsThatOfTheLedger) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  auto steps = cuts(session);
  steps.push_back({"the page", looks(5), [] { choose(kRemoved); }});
  steps.push_back({"the choice", looks(5), [] { write(); }});
  steps.push_back({"the word that it is written", says("triangles"), [] { leave_work(); }});
  mill_in(*ready, std::move(steps));
  const double removed = session.outcome().ledger.removed;
  ASSERT_GT(removed, 0) << "nothing was cut: the test shows nothing";
  EXPECT_NE(desk_->status_text.find("removed.stl"), std::string::npos) << desk_->status_text;
  EXPECT_NE(desk_->status_text.find(fmt::format("{:.1f} mm", 1e9 * removed)), std::string::npos)
      << desk_->status_text << " but removed were " << 1e9 * removed;
  EXPECT_GT(fs::file_size(folder_ / "removed.stl"), 1000U);
}

// As `burr export --part added` and `--part pieces` of the same bone: the same bytes.
TEST_F(Export, WritesWhatWasAddedAndEachPiece) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  rt::ChangedBits& changed = session.bone().add_watcher();
  NoProgress quiet;
  std::string told;
  const auto bare = volume::shared_copy(session.bone(), changed, quiet);
  ASSERT_TRUE(bare) << bare.error().text;
  // a layer that is too thin has no surface to be written
  const auto is_thick = [&] {
    const auto now = volume::shared_copy(session.bone(), changed, quiet);
    return now && volume::removed_part(**now, **bare).ok();
  };
  mill_in(*ready, {{"the first picture", looks(3),
                    [] {
                      press(SDLK_2);
                      move_to(640, 340);
                      button(SDL_BUTTON_LEFT, true);
                    }},
                   {"enough to be added", pressing_until(is_thick),
                    [] {
                      button(SDL_BUTTON_LEFT, false);
                      press(SDLK_e);
                    }},
                   {"the page", looks(5), [] { choose(kAdded); }},
                   {"what was added", looks(5), [] { write(); }},
                   {"the word that it is written", says("triangles"),
                    [&] {
                      told = desk_->status_text;
                      press(SDLK_e);
                    }},
                   {"the page again", looks(5), [] { choose(kPieces); }},
                   {"the pieces", looks(5), [] { write(); }},
                   {"the word that they are written", says("piece_1.stl"), [] { leave_work(); }}});
  EXPECT_NE(told.find("added.stl"), std::string::npos) << told;
  ASSERT_GT(session.outcome().ledger.added, 0) << "nothing was added: the test shows nothing";
  const fs::path truth = folder_ / "truth.stl";
  const auto before = session.bone_before();
  ASSERT_TRUE(
      io::export_part(*before, session.bone(), truth.string(), {.part = io::Part::added}, quiet));
  EXPECT_TRUE(bytes_of(folder_ / "added.stl") == bytes_of(truth));
  const auto pieces = write_pieces(
      session.bone(), (folder_ / "own.stl").string(), {}, [](const std::string&) { return fine(); },
      quiet);
  ASSERT_TRUE(pieces) << pieces.error().text;
  ASSERT_GE(pieces->files.size(), 1U);
  EXPECT_TRUE(bytes_of(folder_ / "piece_1.stl") == bytes_of(pieces->files.front().path));
  EXPECT_FALSE(fs::exists(folder_ / numbered("piece.stl", pieces->files.size() + 1)));
}

TEST_F(Export, AsksBeforeItReplacesAFile) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  std::ofstream(folder_ / "picture.png") << "mine";
  std::string before;
  mill_in(*ready, {{"the first picture", looks(3), [] { press(SDLK_e); }},
                   {"the page", looks(5), [] { choose(kPicture); }},
                   {"a picture", looks(5), [] { write(); }},
                   {"the question", looks(20),
                    [&] {
                      before = bytes_of(folder_ / "picture.png");
                      write();  // now it says: replace it
                    }},
                   {"the word that it is written", says("Written: "), [] { leave_work(); }}});
  EXPECT_EQ(before, "mine");
  EXPECT_EQ(bytes_of(folder_ / "picture.png").substr(1, 3), "PNG");
}

TEST_F(Export, SaysWhatIsWrongAndOneGoesOn) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  sim::Session& session = *ready->session;
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  std::string full;
  // a disk that takes no more than 4 kB of a file
  const auto was = std::signal(SIGXFSZ, SIG_IGN);
  mill_in(
      *ready,
      {{"the first picture", looks(3), [] { press(SDLK_e); }},
       {"the page", looks(5), [] { into_path(); }},
       {"the field", looks(5), types(".doc")},
       {"the letters", looks(5), [] { press(SDLK_RETURN); }},
       {"the sentence",
        [&] { return desk_->status_text.find(".stl.doc: unknown file ext") != std::string::npos; },
        [] { press(SDLK_ESCAPE); }},
       {"no page", looks(5), [] { press(SDLK_e); }},
       {"the page", looks(5),
        [&] {
          const rlimit little = {4096, old.rlim_max};
          ::setrlimit(RLIMIT_FSIZE, &little);
          choose(kBone);
        }},
       {"its path anew", looks(5), [] { write(); }},
       {"the sentence about the disk",
        [&] {
          full = desk_->status_text;
          return full.find("File too large") != std::string::npos;
        },
        [] { press(SDLK_ESCAPE); }},
       {"no page", looks(5), [] { leave_work(); }}});
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, was);
  EXPECT_NE(full.find("bone"), std::string::npos) << full;
  EXPECT_FALSE(fs::exists(folder_ / "bone.stl.doc.stl")) << "half a file was left";
  EXPECT_GT(session.outcome().ticks, 100U);
}

// ---- without a window

TEST(ExportRequest, KeepsThePathInStepWithWhatIsWritten) {
  EXPECT_EQ(path_for("/a/bone.stl", ExportWhat::removed, ".stl"), "/a/removed.stl");
  EXPECT_EQ(path_for("/a/removed.seg.nrrd", ExportWhat::bone, ".ply"), "/a/bone.ply");
  EXPECT_EQ(path_for("/a/bone.stl", ExportWhat::picture, ".png"), "/a/picture.png");
  EXPECT_EQ(path_for("/a/petrous.STL", ExportWhat::removed, ".3mf"), "/a/petrous.3mf");
  EXPECT_EQ(path_for("/a.stl/mine", ExportWhat::bone, ".obj"), "/a.stl/mine.obj");
  EXPECT_EQ(path_for("/a/bone.stl", ExportWhat::added, ".stl"), "/a/added.stl");
  EXPECT_EQ(path_for("/a/added.stl", ExportWhat::pieces, ".ply"), "/a/piece.ply");
  EXPECT_EQ(path_for("/a/piece.ply", ExportWhat::bone, ".ply"), "/a/bone.ply");
  EXPECT_EQ(ending_of("x.SEG.NRRD", ExportWhat::bone), ".seg.nrrd");
  EXPECT_EQ(ending_of("x.nrrd", ExportWhat::bone), ".nrrd");
  EXPECT_EQ(ending_of("x.png", ExportWhat::bone), "");
}

// Variables as a desktop sets them; put back afterwards.
class DocumentsFolder : public testing::Test {
 protected:
  DocumentsFolder() {
    for (const char* name : kNames) {
      const char* now = std::getenv(name);
      before_.emplace_back(now != nullptr ? std::optional<std::string>(now) : std::nullopt);
      ::unsetenv(name);
    }
    ::setenv("HOME", home_.c_str(), 1);
  }
  ~DocumentsFolder() override {
    for (std::size_t n = 0; n < std::size(kNames); ++n)
      if (before_[n])
        ::setenv(kNames[n], before_[n]->c_str(), 1);
      else
        ::unsetenv(kNames[n]);
  }
  static constexpr const char* kNames[] = {"HOME", "XDG_DOCUMENTS_DIR", "XDG_CONFIG_HOME"};
  std::vector<std::optional<std::string>> before_;
  const test::Folder own_;
  const fs::path home_ = own_.path();
};

TEST_F(DocumentsFolder, IsTheUsersOwnThenTheUsualThenHome) {
  EXPECT_EQ(documents_folder(), home_);
  fs::create_directory(home_ / "Documents");
  EXPECT_EQ(documents_folder(), home_ / "Documents");
  fs::create_directories(home_ / ".config");
  std::ofstream(home_ / ".config/user-dirs.dirs")
      << "# of a Swedish desktop\nXDG_DESKTOP_DIR=\"$HOME/Skrivbord\"\n"
         "XDG_DOCUMENTS_DIR=\"$HOME/Dokument\"\n";
  EXPECT_EQ(documents_folder(), home_ / "Documents") << "the one that is named is not there";
  fs::create_directory(home_ / "Dokument");
  EXPECT_EQ(documents_folder(), home_ / "Dokument");
  fs::create_directory(home_ / "mine");
  ::setenv("XDG_DOCUMENTS_DIR", (home_ / "mine").c_str(), 1);
  EXPECT_EQ(documents_folder(), home_ / "mine");
  ::setenv("XDG_DOCUMENTS_DIR", "mine", 1);
  EXPECT_EQ(documents_folder(), home_ / "Dokument") << "a relative path there is to be ignored";
}

TEST(ExportRequest, IsRefusedInOneSentence) {
  const auto why = [](ExportWhat what, const std::string& path) {
    const Status possible = check_request({what, path});
    return possible ? std::string() : possible.error().text;
  };
  EXPECT_NE(why(ExportWhat::bone, "").find("name"), std::string::npos);
  EXPECT_NE(why(ExportWhat::bone, "/tmp").find("is a folder"), std::string::npos);
  EXPECT_NE(why(ExportWhat::bone, "/tmp/x.doc").find("unknown file ext"), std::string::npos);
  EXPECT_NE(why(ExportWhat::picture, "/tmp/x.stl").find(".png"), std::string::npos);
  EXPECT_NE(why(ExportWhat::bone, "/tmp/no/such/x.stl").find("does not exist"), std::string::npos);
  EXPECT_EQ(why(ExportWhat::removed, "/tmp/x.stl"), "");
  EXPECT_EQ(why(ExportWhat::picture, "/tmp/x.PNG"), "");
}

}  // namespace
}  // namespace burr::app

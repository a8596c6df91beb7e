// burr's own file dialog: what it lists, and the way through it by keyboard and by mouse.
#include "window/ui/file_dialog.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "user.h"

namespace burr::app {
namespace {

TEST(FileDialogList, KnowsWhatBurrReads) {
  for (const char* name : {"a.nrrd", "b.SEG.NRRD", "c.nii.gz", "d.toml", "e.mcap", "IM0001",
                           "1.2.840.10008.17", "f.DCM"})
    EXPECT_TRUE(burr_reads(name)) << name;
  for (const char* name : {"a.txt", "b.jpg", "c.tar.gz", "report.html"})
    EXPECT_FALSE(burr_reads(name)) << name;
}

// somebody whose home is a folder with a scan in a folder
class FileDialogWindow : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    const char* now = std::getenv("HOME");
    home_ = now != nullptr ? now : "";
    fs::create_directories(home() / "scans");
    fs::create_directories(home() / "Bilder");
    fs::rename(scan(), home() / "scans" / "karin.nrrd");
    for (const char* name : {"notes.txt", "anna.nrrd", ".hidden.nrrd"})
      std::ofstream(home() / "scans" / name) << "x";
    ::setenv("HOME", home().c_str(), 1);
  }
  void TearDown() override {
    ::setenv("HOME", home_.c_str(), 1);
    Window::TearDown();
  }
  [[nodiscard]] fs::path home() const { return folder_ / "home"; }
  static void open_dialog() { click(1030, 278); }  // start_page.cpp

 private:
  std::string home_;
};

TEST_F(FileDialogWindow, ListsFoldersFirstAndHidesTheRest) {
  const auto some = entries_of(home() / "scans", Listed::burr_reads);
  ASSERT_TRUE(some) << some.error().text;
  ASSERT_EQ(some->size(), 2U);
  EXPECT_EQ((*some)[0].name, "anna.nrrd");
  EXPECT_EQ((*some)[1].name, "karin.nrrd");
  EXPECT_GT((*some)[1].bytes, 20'000U);
  const auto all = entries_of(home() / "scans", Listed::all);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->size(), 3U) << "hidden files are not listed";
  const auto top = entries_of(home(), Listed::burr_reads);
  ASSERT_TRUE(top);
  ASSERT_EQ(top->size(), 2U);
  EXPECT_EQ((*top)[0].name, "Bilder") << "large and small letters do not matter";
  EXPECT_TRUE((*top)[1].folder);
  EXPECT_FALSE(entries_of(home() / "nowhere", Listed::burr_reads));
  std::ofstream(home() / "scans" / "Session.MCAP") << "x";
  const auto recordings = entries_of(home() / "scans", Listed::recordings);
  ASSERT_TRUE(recordings);
  ASSERT_EQ(recordings->size(), 1U) << "no scan can be played";
  EXPECT_EQ((*recordings)[0].name, "Session.MCAP");
}

// letters find "scans", Enter goes in, an arrow goes to the second file, Enter opens it
TEST_F(FileDialogWindow, TheKeyboardOpensAScan) {
  pages_by({{"the start page", on(Page::start), nullptr},
            {"a picture", looks(3), [] { open_dialog(); }},
            {"the dialog", looks(5), [] { type("sc"); }},
            {"found", looks(3), [] { press(SDLK_RETURN); }},
            {"the folder", looks(3), [] { press(SDLK_DOWN); }},
            {"the second", looks(3), [] { press(SDLK_RETURN); }},
            {"the scan", on(Page::import), nullptr},
            {"a picture", looks(3), [] { press(SDLK_ESCAPE); }},
            {"back", on(Page::start), [] { close_window(); }}});
}

// Esc closes the dialog and not burr; Backspace goes up; a typed folder is gone to.
TEST_F(FileDialogWindow, EscLeavesOnlyTheDialog) {
  render::Image bare, open, up;
  pages_by({{"the start page", on(Page::start), nullptr},
            {"a picture", looks(3),
             [&] {
               bare = desk_->renderer().shown();
               open_dialog();
             }},
            {"the dialog", looks(5),
             [&] {
               open = desk_->renderer().shown();
               press(SDLK_BACKSPACE);
             }},
            {"the folder above", looks(4),
             [&] {
               up = desk_->renderer().shown();
               press(SDLK_ESCAPE);
             }},
            {"closed", looks(4), [&] {
               EXPECT_EQ(desk_->page, Page::start);
               EXPECT_GT(differ(open, desk_->renderer().shown(), 200, 60, 1080, 660), 50'000);
               close_window();
             }}});
  EXPECT_GT(differ(bare, open, 200, 60, 1080, 660), 50'000);
  EXPECT_GT(differ(open, up, 200, 120, 1080, 560), 200);
}

}  // namespace
}  // namespace burr::app

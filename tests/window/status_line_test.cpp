// An answer to a key and a force that was let go in the same moment are both to be read.
#include "window/ui/status_line.h"

#include <gtest/gtest.h>

namespace burr::app {
namespace {

using std::chrono::milliseconds;
const StatusLine::Clock::time_point kStart =
    StatusLine::Clock::time_point() + std::chrono::hours(1);

TEST(StatusLine, ForceThatWasLetGoDoesNotHideTheAnswerToAKey) {
  StatusLine told;
  told.note("no view is kept here", kStart);
  told.warn_released("Force released", kStart + milliseconds(1));
  EXPECT_EQ(told.note(kStart + milliseconds(200), "exporting"), "no view is kept here");
  EXPECT_EQ(told.warning(kStart + milliseconds(200), ""), "Force released");
}

TEST(StatusLine, WhatHoldsNowGoesBeforeWhatHasHappened) {
  StatusLine told;
  told.warn_released("Force released", kStart);
  EXPECT_EQ(told.warning(kStart + milliseconds(1), "disk full"), "disk full");
  EXPECT_EQ(told.warning(kStart + milliseconds(2), ""), "Force released");
}

TEST(StatusLine, IsGoneAfterItsTime) {
  StatusLine told;
  EXPECT_EQ(told.note(kStart, "exporting"), "exporting");
  EXPECT_EQ(told.warning(kStart, ""), "");
  told.note("sound off", kStart);
  told.warn_released("Force released", kStart);
  const auto after = kStart + StatusLine::kShown + milliseconds(1);
  EXPECT_EQ(told.note(after, "exporting"), "exporting");
  EXPECT_EQ(told.warning(after, ""), "");
}

// What somebody waited for is there when he comes back.
TEST(StatusLine, AKeptNoteStaysUntilItIsForgottenOrAnotherOneComes) {
  StatusLine told;
  told.keep("Written: film.mp4");
  EXPECT_TRUE(told.kept());
  EXPECT_EQ(told.note(kStart + std::chrono::hours(1), ""), "Written: film.mp4");
  told.note("sound off", kStart);
  EXPECT_FALSE(told.kept());
  told.forget_kept();
  EXPECT_EQ(told.note(kStart, ""), "sound off") << "only a kept one is clicked away";
  told.keep("Written: film.mp4");
  told.forget_kept();
  EXPECT_EQ(told.note(kStart, ""), "");
}

}  // namespace
}  // namespace burr::app

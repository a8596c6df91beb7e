// What burr says about a scan in the window: in the user's language, rounded, without options of the
// command line.
#include "window/import/notice_words.h"

#include <gtest/gtest.h>

#include <string>

#include "shared/word_names.h"
#include "user.h"

namespace burr::app {
namespace {

class NoticeWords : public testing::Test {
 protected:
  void TearDown() override { speak("en"); }
};

TEST_F(NoticeWords, RoundVolumesAndNameNoOption) {
  EXPECT_EQ(notice_words("3856 of 3857 separate parts were removed (`keep`): 19563 mm3 in all, the "
                         "largest of 9660.032431837088 mm3 at 61.6,96.8,-89.6 mm."),
            "3856 of 3857 separate parts were left out: 19.6 cm³ in all, the largest 9.7 cm³.");
  EXPECT_EQ(notice_words("One of 2 separate parts was removed (`keep` and `drop_islands_mm3`): "
                         "0.524 mm3, at 1,2,3 mm."),
            "One of 2 separate parts was left out: 0.52 mm³.");
  EXPECT_EQ(notice_words("Noise of 31.2 HU is smoothed out along the surface; see `smooth`."),
            "Noise of 31.2 HU is smoothed out along the surface.");
}

TEST_F(NoticeWords, SpeakTheLanguageOfTheUser) {
  const std::string sentence = "Noise of 31.2 HU is smoothed out along the surface; see `smooth`.";
  const std::string lies =
      "The file does not state its orientation: left, posterior, superior is assumed.";
  speak("sv");
  EXPECT_EQ(notice_words(sentence), "Brus på 31.2 HU jämnas ut längs ytan.");
  EXPECT_EQ(notice_words(lies),
            "Filen säger inte hur patienten ligger: åt vänster, bakåt, uppåt antas.");
  speak("de");
  EXPECT_EQ(notice_words(sentence), "Rauschen von 31.2 HU wird entlang der Oberfläche geglättet.");
}

// A rarer sentence stays as it is, but for what only a command line needs.
TEST_F(NoticeWords, OfOtherSentencesLeaveOutTheOptions) {
  EXPECT_EQ(notice_words("The ADF's scale of 0.5 is applied."),
            "The ADF's scale of 0.5 is applied.");
  EXPECT_EQ(notice_words("Something was done (`thing`) here; choose another with `other`."),
            "Something was done here.");
  EXPECT_EQ(notice_words("One was taken. To use the other, give `series` 2."), "One was taken.");
}

TEST_F(NoticeWords, VolumesHaveAsManyDigitsAsAPersonNeeds) {
  EXPECT_EQ(volume_words(0.0314159), "0.031 mm³");
  EXPECT_EQ(volume_words(42.4242), "42 mm³");
  EXPECT_EQ(volume_words(12345.6), "12.3 cm³");
}

class NoticeWindow : public Window {};

// At 1280 x 720 the line is between the buttons of the views and the scale bar, in several lines if it
// has to be.
TEST_F(NoticeWindow, ALongLineCoversNeitherTheViewsNorTheScaleBar) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  std::string text;
  while (text.size() < 260) text += "a long sentence about the scan, ";
  render::Image before, after;
  mill_by(*ready,
          {{"a picture", looks(40),
            [&] {
              before = desk_->renderer().shown();
              desk_->troubles.push_back(text);
            }},
           {"told", [&] { return desk_->status_text.find(text) != std::string::npos; }, nullptr},
           {"a picture", looks(5), [&] {
              after = desk_->renderer().shown();
              leave_work();
            }}});
  ASSERT_EQ(before.width, 1280);
  // the hint of the beginning has gone, and the text is there
  EXPECT_GT(differ(before, after, 300, 560, 1000, 640), 1000);
  EXPECT_LT(differ(before, after, 104, 540, 264, 646), 20) << "the buttons of the views";
  // left of the slices; the handpiece may still move a little
  EXPECT_LT(differ(before, after, 916, 616, 1056, 646), 300) << "the scale bar";
}

}  // namespace
}  // namespace burr::app

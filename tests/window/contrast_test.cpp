// Every text of the window can be read: its contrast against what lies behind it is that of WCAG 2.2,
// level AA, whatever the picture behind a panel shows.
#include "window/ui/contrast.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "window/ui/ui.h"
#include "window/user.h"

namespace burr::app {
namespace {

constexpr ImU32 kWhite = ink::rgb(255, 255, 255), kBlack = ink::rgb(0, 0, 0);

TEST(Contrast, IsThatOfTheStandard) {
  EXPECT_NEAR(contrast(kWhite, kBlack), 21, 1e-9);
  EXPECT_NEAR(contrast(kBlack, kWhite), 21, 1e-9);
  EXPECT_NEAR(contrast(kWhite, kWhite), 1, 1e-9);
  // values that other calculators give
  EXPECT_NEAR(contrast(ink::rgb(0x76, 0x76, 0x76), kWhite), 4.54, 0.005);
  EXPECT_NEAR(contrast(ink::rgb(255, 0, 0), kWhite), 4.00, 0.005);
  EXPECT_NEAR(contrast(ink::rgb(0, 0, 255), kWhite), 8.59, 0.005);
  EXPECT_EQ(over(ink::rgb(255, 255, 255, 0), kBlack), kBlack);
  EXPECT_EQ(over(ink::rgb(255, 255, 255, 51), kBlack), ink::rgb(51, 51, 51));
}

struct Named {
  std::string name;
  ImU32 colour;
};

// The colours of letters, and of marks that carry a meaning.
const std::vector<Named> kLetters = {{"text", ink::kText},     {"dim", ink::kDim},
                                     {"accent", ink::kAccent}, {"good", ink::kGood},
                                     {"warn", ink::kWarn},     {"bad", ink::kBad}};

// What lies behind letters of every colour: panels over any picture, pages.
std::vector<Named> grounds() {
  std::vector<Named> all;
  for (const auto& [name, picture] : {Named{"white", kWhite}, Named{"black", kBlack}}) {
    const ImU32 panel = over(ink::kPanel, picture);
    all.push_back({"panel over " + name, panel});
    // a time line, and a bar, on it
    all.push_back({"curve over " + name, over(ink::rgb(255, 255, 255, 14), panel)});
  }
  all.push_back({"page", over(ink::rgb(17, 19, 22, 251), kWhite)});
  all.push_back({"tool tip", over(ink::rgb(24, 27, 31, 250), kWhite)});
  all.push_back({"card", ink::rgb(30, 34, 39)});
  all.push_back({"row", over(ink::rgb(255, 255, 255, 8), over(ink::rgb(17, 19, 22, 251), kWhite))});
  return all;
}

TEST(Contrast, OfEveryLetterOnEveryGroundIsEnough) {
  for (const Named& letter : kLetters)
    for (const Named& ground : grounds())
      EXPECT_GE(contrast(letter.colour, ground.colour), kTextContrast)
          << letter.name << " on " << ground.name;
}

TEST(Contrast, OfSlicesNamesOnTheirPlatesIsEnough) {  // slices.cpp
  EXPECT_GE(contrast(ink::kText, over(ink::rgb(0, 0, 0, 150), kWhite)), kTextContrast);
}

// Letters on what ImGui paints itself: the colours are read from the style that is in use.
TEST_F(Window, LettersOnButtonsFieldsAndListsCanBeReadAndAreLargeEnough) {
  pages_by({{"the start page", on(Page::start), nullptr},
            {"a picture", looks(3), [this] {
               const ImGuiStyle& style = ImGui::GetStyle();
               const auto ink_of = [&style](ImGuiCol which) {
                 return ImGui::ColorConvertFloat4ToU32(style.Colors[which]);
               };
               const ImU32 text = ink_of(ImGuiCol_Text), dim = ink_of(ImGuiCol_TextDisabled);
               const ImU32 page = over(ink_of(ImGuiCol_WindowBg), kWhite);
               for (const auto& [name, which] : {std::pair{"field", ImGuiCol_FrameBg},
                                                 {"field under the mouse", ImGuiCol_FrameBgHovered},
                                                 {"button", ImGuiCol_Button},
                                                 {"button under the mouse", ImGuiCol_ButtonHovered},
                                                 {"button held", ImGuiCol_ButtonActive},
                                                 {"chosen row", ImGuiCol_Header},
                                                 {"row under the mouse", ImGuiCol_HeaderHovered},
                                                 {"row held", ImGuiCol_HeaderActive},
                                                 {"selected letters", ImGuiCol_TextSelectedBg},
                                                 {"list", ImGuiCol_PopupBg}})
                 EXPECT_GE(contrast(text, over(ink_of(which), page)), kTextContrast) << name;
               for (const auto& [name, which] :
                    {std::pair{"field", ImGuiCol_FrameBg}, {"button", ImGuiCol_Button}})
                 EXPECT_GE(contrast(dim, over(ink_of(which), page)), kTextContrast) << name;
               for (const ImGuiCol mark :
                    {ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_NavHighlight})
                 EXPECT_GE(contrast(ink_of(mark), page), kLargeContrast);
               // docs/use/window_settings.md: no letters below 12.5 pixels in a window of 1240 x
               // 620 or more
               using Letter = Ui::Letter;
               for (const Letter letter :
                    {Letter::small, Letter::body, Letter::strong, Letter::large, Letter::title})
                 EXPECT_GE(desk_->ui().font(letter)->FontSize, 12.5F);
               press(SDLK_ESCAPE);
             }}});
}

}  // namespace
}  // namespace burr::app

#include "window/ui/imgui_keys.h"

#include <gtest/gtest.h>

#include <utility>

namespace burr::app {
namespace {

constexpr std::pair<SDL_Scancode, ImGuiKey> kKeys[] = {
    {SDL_SCANCODE_TAB, ImGuiKey_Tab},
    {SDL_SCANCODE_LEFT, ImGuiKey_LeftArrow},
    {SDL_SCANCODE_RIGHT, ImGuiKey_RightArrow},
    {SDL_SCANCODE_UP, ImGuiKey_UpArrow},
    {SDL_SCANCODE_DOWN, ImGuiKey_DownArrow},
    {SDL_SCANCODE_PAGEUP, ImGuiKey_PageUp},
    {SDL_SCANCODE_PAGEDOWN, ImGuiKey_PageDown},
    {SDL_SCANCODE_HOME, ImGuiKey_Home},
    {SDL_SCANCODE_END, ImGuiKey_End},
    {SDL_SCANCODE_DELETE, ImGuiKey_Delete},
    {SDL_SCANCODE_BACKSPACE, ImGuiKey_Backspace},
    {SDL_SCANCODE_SPACE, ImGuiKey_Space},
    {SDL_SCANCODE_RETURN, ImGuiKey_Enter},
    {SDL_SCANCODE_ESCAPE, ImGuiKey_Escape},
    {SDL_SCANCODE_KP_ENTER, kKeypadEnter},
    {SDL_SCANCODE_A, ImGuiKey_A},
    {SDL_SCANCODE_C, ImGuiKey_C},
    {SDL_SCANCODE_V, ImGuiKey_V},
    {SDL_SCANCODE_X, ImGuiKey_X},
    {SDL_SCANCODE_Y, ImGuiKey_Y},
    {SDL_SCANCODE_Z, ImGuiKey_Z},
};

// ImGui without a window: frames, and what it thinks of the keys in them.
class ImguiKeys : public ::testing::Test {
 protected:
  ImguiKeys() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {640, 480};
    io.DeltaTime = 1.0F / 60;
    io.Fonts->Build();
    frame();
  }
  ~ImguiKeys() override { ImGui::DestroyContext(context_); }
  ImguiKeys(const ImguiKeys&) = delete;
  ImguiKeys& operator=(const ImguiKeys&) = delete;

  void frame() {
    if (begun_) ImGui::EndFrame();
    begun_ = true;
    tell_imgui(down_);
    ImGui::NewFrame();
  }

  KeysDown down_;

 private:
  ImGuiContext* context_;
  bool begun_ = false;
};

TEST_F(ImguiKeys, EachIsPressedInTheFrameInWhichItGoesDownAndNoOtherIs) {
  for (const auto& [scancode, wanted] : kKeys) {
    down_.keys.set(scancode);
    frame();
    for (const auto& [unused, key] : kKeys)
      EXPECT_EQ(key_pressed(key), key == wanted) << scancode << ", " << key;
    frame();
    EXPECT_FALSE(key_pressed(wanted)) << scancode << " is held";
    down_.keys.reset();
    frame();
    EXPECT_FALSE(key_pressed(wanted)) << scancode << " was let go";
  }
}

TEST_F(ImguiKeys, HeldItRepeats) {
  down_.keys.set(SDL_SCANCODE_DOWN);
  int pressed = 0;
  for (int n = 0; n < 60; ++n) {  // a second
    frame();
    pressed += key_pressed(ImGuiKey_DownArrow) ? 1 : 0;
  }
  EXPECT_GT(pressed, 5);
  EXPECT_LT(pressed, 30);
}

TEST_F(ImguiKeys, AWholeChordCountsInOneFrame) {
  down_.keys.set(SDL_SCANCODE_A).set(SDL_SCANCODE_TAB);
  down_.ctrl = down_.shift = true;
  frame();
  const ImGuiIO& io = ImGui::GetIO();
  EXPECT_TRUE(key_pressed(ImGuiKey_A));
  EXPECT_TRUE(key_pressed(ImGuiKey_Tab));
  EXPECT_TRUE(io.KeyCtrl);
  EXPECT_TRUE(io.KeyShift);
  EXPECT_FALSE(io.KeyAlt);

  // one key changes for another, and one modifier for another, in the next frame
  down_.keys.reset();
  down_.keys.set(SDL_SCANCODE_Z);
  down_.ctrl = down_.shift = false;
  down_.alt = true;
  frame();
  EXPECT_FALSE(key_pressed(ImGuiKey_A));
  EXPECT_TRUE(key_pressed(ImGuiKey_Z));
  EXPECT_FALSE(io.KeyCtrl);
  EXPECT_FALSE(io.KeyShift);
  EXPECT_TRUE(io.KeyAlt);
}

TEST_F(ImguiKeys, OneThatIsLetGoCountsAgain) {
  for (int n = 0; n < 3; ++n) {
    down_.keys.set(SDL_SCANCODE_RETURN);
    frame();
    EXPECT_TRUE(key_pressed(ImGuiKey_Enter)) << n;
    down_.keys.reset();
    frame();
    EXPECT_FALSE(key_pressed(ImGuiKey_Enter)) << n;
  }
}

}  // namespace
}  // namespace burr::app

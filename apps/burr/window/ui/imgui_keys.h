// apps/burr/window/ui/imgui_keys.h - the keyboard in the terms of Dear ImGui: what differs between
// its versions is here and in imgui_keys.cpp only. 1.86 (Debian 12) looks at tables that a program
// fills, 1.89 and later (Debian 13) wants to be told.
//
// Thread: main, with a context of ImGui.
#pragma once

#include <SDL2/SDL_scancode.h>
#include <imgui/imgui.h>

#include <bitset>

namespace burr::app {

// What of the keyboard is down, by the place of a key (a modifier: by what it does).
struct KeysDown {
  std::bitset<SDL_NUM_SCANCODES> keys;
  bool shift = false, ctrl = false, alt = false;
};

// Before ImGui::NewFrame(): the next frame sees exactly these.
void tell_imgui(const KeysDown& down);

// The key went down in this frame, or repeats.
[[nodiscard]] bool key_pressed(ImGuiKey key);

// the Enter of the block of digits
#if IMGUI_VERSION_NUM >= 18900
inline constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeypadEnter;
#else
inline constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeyPadEnter;
#endif

}  // namespace burr::app

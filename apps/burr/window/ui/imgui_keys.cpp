#include "window/ui/imgui_keys.h"

#include <utility>

namespace burr::app {
namespace {

// the keys that ImGui asks for
constexpr std::pair<ImGuiKey, SDL_Scancode> kKeys[] = {
    {ImGuiKey_Tab, SDL_SCANCODE_TAB},
    {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
    {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
    {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
    {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
    {ImGuiKey_PageUp, SDL_SCANCODE_PAGEUP},
    {ImGuiKey_PageDown, SDL_SCANCODE_PAGEDOWN},
    {ImGuiKey_Home, SDL_SCANCODE_HOME},
    {ImGuiKey_End, SDL_SCANCODE_END},
    {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
    {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
    {ImGuiKey_Space, SDL_SCANCODE_SPACE},
    {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
    {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
    {kKeypadEnter, SDL_SCANCODE_KP_ENTER},
    {ImGuiKey_A, SDL_SCANCODE_A},
    {ImGuiKey_C, SDL_SCANCODE_C},
    {ImGuiKey_V, SDL_SCANCODE_V},
    {ImGuiKey_X, SDL_SCANCODE_X},
    {ImGuiKey_Y, SDL_SCANCODE_Y},
    {ImGuiKey_Z, SDL_SCANCODE_Z},
};

}  // namespace

#if IMGUI_VERSION_NUM >= 18900

void tell_imgui(const KeysDown& down) {
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigInputTrickleEventQueue = false;  // otherwise it would spread them over several frames
  for (const auto& [key, scancode] : kKeys) io.AddKeyEvent(key, down.keys[scancode]);
  io.AddKeyEvent(ImGuiMod_Shift, down.shift);
  io.AddKeyEvent(ImGuiMod_Ctrl, down.ctrl);
  io.AddKeyEvent(ImGuiMod_Alt, down.alt);
}

bool key_pressed(ImGuiKey key) { return ImGui::IsKeyPressed(key); }

#else

void tell_imgui(const KeysDown& down) {
  ImGuiIO& io = ImGui::GetIO();
  for (const auto& [key, scancode] : kKeys) {
    io.KeyMap[key] = key;
    io.KeysDown[key] = down.keys[scancode];
  }
  io.KeyShift = down.shift;
  io.KeyCtrl = down.ctrl;
  io.KeyAlt = down.alt;
}

bool key_pressed(ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); }

#endif

}  // namespace burr::app

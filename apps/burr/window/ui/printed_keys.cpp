#include "window/ui/printed_keys.h"

#include <SDL2/SDL.h>

#include <cctype>
#include <string_view>

#include "shared/word_names.h"

namespace burr::app {
namespace {

constexpr unsigned kAltGr = KMOD_RALT | KMOD_MODE;  // SDL reports the one or the other
constexpr std::string_view kSigns = "+-=,.[]{}";    // that pages use, besides letters and digits

// A key that gives a character; not Return, Escape, Tab, Backspace, Delete, or Space, which is the
// same with every modifier.
bool gives_a_character(SDL_Keycode key) {
  return key > SDLK_SPACE && key != SDLK_DELETE && (key & SDLK_SCANCODE_MASK) == 0;
}

bool is_letter(SDL_Keycode key) { return key >= SDLK_a && key <= SDLK_z; }

// The digit on that key of the row of digits, or SDLK_UNKNOWN.
SDL_Keycode digit_on(SDL_Scancode place) {
  if (place == SDL_SCANCODE_0) return SDLK_0;
  if (place < SDL_SCANCODE_1 || place > SDL_SCANCODE_9) return SDLK_UNKNOWN;
  return SDLK_1 + (place - SDL_SCANCODE_1);
}

bool is_sign_of_a_page(SDL_Keycode key) {
  return key < 128 && kSigns.find(static_cast<char>(key)) != std::string_view::npos;
}

}  // namespace

void PrintedKeys::translate(SDL_Event& event) {
  if (event.type == SDL_KEYDOWN) {
    SDL_Keysym& key = event.key.keysym;
    waits_.sym = SDLK_UNKNOWN;
    // made by a program, for example by a gamepad: it has no place on a keyboard, and no text comes
    if (key.scancode == SDL_SCANCODE_UNKNOWN || !gives_a_character(key.sym)) return;
    const bool shift = (key.mod & KMOD_SHIFT) != 0, altgr = (key.mod & kAltGr) != 0;
    if (altgr || (shift && !is_letter(key.sym))) {
      waits_ = key;
      key.sym = SDLK_UNKNOWN;
    } else if (const SDL_Keycode digit = digit_on(key.scancode);
               digit != SDLK_UNKNOWN && !is_sign_of_a_page(key.sym) &&
               (key.sym < SDLK_0 || key.sym > SDLK_9)) {
      key.sym = digit;
    }
    return;
  }
  if (event.type != SDL_TEXTINPUT || waits_.sym == SDLK_UNKNOWN) return;
  SDL_Keysym key = waits_;
  waits_.sym = SDLK_UNKNOWN;
  const char* text = event.text.text;
  const auto first = static_cast<unsigned char>(text[0]);
  if (first <= ' ' || first >= 127 || text[1] != '\0') return;  // not a key of any page
  key.sym = std::tolower(first);
  // Shift and AltGr were needed for the character; they are not the user's choice
  const bool letter = std::isalpha(first) != 0;
  key.mod = static_cast<Uint16>(key.mod & ~(kAltGr | (letter ? 0U : unsigned{KMOD_SHIFT})));
  event = {};
  event.type = SDL_KEYDOWN;
  event.key.state = SDL_PRESSED;
  event.key.keysym = key;
}

bool has_bracket_keys() {
  return SDL_GetScancodeFromKey(SDLK_LEFTBRACKET) != SDL_SCANCODE_UNKNOWN &&
         SDL_GetScancodeFromKey(SDLK_RIGHTBRACKET) != SDL_SCANCODE_UNKNOWN;
}
const char* smaller_key() { return has_bracket_keys() ? "[" : word(Word::key_page_down); }
const char* larger_key() { return has_bracket_keys() ? "]" : word(Word::key_page_up); }
const char* bracket_keys() { return has_bracket_keys() ? "[  ]" : word(Word::key_pages); }

}  // namespace burr::app

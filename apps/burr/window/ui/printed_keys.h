// apps/burr/window/ui/printed_keys.h - keys act by what is printed on them, on every keyboard
// layout.
//
// SDL names a key by the character that it gives alone: on a French keyboard the key of the dot is
// `;`, and on a German one no key is `[`, because that takes AltGr. A page that looked at these
// names would miss both. So a key that is pressed with Shift or AltGr acts by the text that
// follows: this class turns the text into a key again. A letter with Shift stays that letter. Where
// the digits take Shift, as in France, their keys act as digits without it too.
//
// Thread: main.
#pragma once

#include <SDL2/SDL_events.h>

namespace burr::app {

class PrintedKeys {
 public:
  // Changes a key or a text, after the user interface has seen it, into the key that a page is to
  // see. A key that waits for its text becomes SDLK_UNKNOWN.
  void translate(SDL_Event& event);

 private:
  SDL_Keysym waits_ = {};  // the key whose text comes next; SDLK_UNKNOWN: none
};

// True: a key gives `[` without AltGr, on the layout that is used now.
[[nodiscard]] bool has_bracket_keys();
// Where not, Page up and Page down do the same as the brackets. What to print for these keys; the
// texts of `[`, `]`, and both.
[[nodiscard]] const char* smaller_key();
[[nodiscard]] const char* larger_key();
[[nodiscard]] const char* bracket_keys();

}  // namespace burr::app

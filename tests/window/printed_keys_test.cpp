// Keys act by what is printed on them: what SDL sends on an English, German, French and Swedish
// keyboard, and the key that a page sees.
#include "window/ui/printed_keys.h"

#include <gtest/gtest.h>

#include <SDL2/SDL.h>
#include <cstring>
#include <string>

#include "window/user.h"

namespace burr::app {
namespace {

constexpr Uint16 kNone = KMOD_NONE;

// A press as SDL reports it: the name of the key, its place, modifiers, the text that follows.
SDL_Keysym pressed(SDL_Keycode name, SDL_Scancode place, Uint16 held, const char* text) {
  PrintedKeys keys;
  SDL_Keysym seen = {};
  const auto see = [&](SDL_Event& event) {
    keys.translate(event);
    if (event.type == SDL_KEYDOWN && event.key.keysym.sym != SDLK_UNKNOWN) {
      EXPECT_EQ(seen.sym, SDLK_UNKNOWN) << "two keys from one press";
      seen = event.key.keysym;
    }
  };
  SDL_Event event = {};
  event.type = SDL_KEYDOWN;
  event.key.keysym.sym = name;
  event.key.keysym.scancode = place;
  event.key.keysym.mod = held;
  see(event);
  event = {};
  event.type = SDL_TEXTINPUT;
  std::strncpy(event.text.text, text, sizeof event.text.text - 1);
  if (*text != '\0') see(event);
  return seen;
}
SDL_Keycode key(SDL_Keycode name, SDL_Scancode place, Uint16 held, const char* text) {
  return pressed(name, place, held, text).sym;
}

TEST(PrintedKeys, OfAnEnglishKeyboard) {
  EXPECT_EQ(key('[', SDL_SCANCODE_LEFTBRACKET, kNone, "["), '[');
  EXPECT_EQ(key('[', SDL_SCANCODE_LEFTBRACKET, KMOD_LSHIFT, "{"), '{');
  EXPECT_EQ(key('=', SDL_SCANCODE_EQUALS, KMOD_LSHIFT, "+"), '+');
  EXPECT_EQ(key('9', SDL_SCANCODE_9, kNone, "9"), '9');
  EXPECT_EQ(key('9', SDL_SCANCODE_9, KMOD_LSHIFT, "("), '(');
  // letters keep Shift, which means something to them
  const SDL_Keysym x = pressed('x', SDL_SCANCODE_X, KMOD_LSHIFT, "X");
  EXPECT_EQ(x.sym, SDLK_x);
  EXPECT_NE(x.mod & KMOD_SHIFT, 0);
  // what gives no sign stays as it is
  EXPECT_EQ(key(SDLK_PAGEUP, SDL_SCANCODE_PAGEUP, kNone, ""), SDLK_PAGEUP);
  EXPECT_EQ(key(SDLK_F5, SDL_SCANCODE_F5, KMOD_LSHIFT, ""), SDLK_F5);
  EXPECT_EQ(key(SDLK_SPACE, SDL_SCANCODE_SPACE, KMOD_LSHIFT, " "), SDLK_SPACE);
  EXPECT_EQ(key(SDLK_KP_9, SDL_SCANCODE_KP_9, KMOD_NUM, "9"), SDLK_KP_9) << "not the 9 above O";
}

TEST(PrintedKeys, OfAGermanAndASwedishKeyboard) {
  for (const Uint16 altgr : {Uint16{KMOD_RALT}, Uint16{KMOD_MODE}}) {
    const SDL_Keysym open = pressed('8', SDL_SCANCODE_8, altgr, "[");
    EXPECT_EQ(open.sym, '[');
    EXPECT_EQ(open.mod, kNone) << "AltGr belongs to the sign";
    EXPECT_EQ(key('9', SDL_SCANCODE_9, altgr, "]"), ']') << "and not 9, which changes the loudness";
    EXPECT_EQ(key('q', SDL_SCANCODE_Q, altgr, "@"), '@') << "and not Q, which quits";
    EXPECT_EQ(key('e', SDL_SCANCODE_E, altgr, "\xe2\x82\xac"), SDLK_UNKNOWN) << "the sign of euro";
  }
  // Shift and AltGr together leave Shift nowhere
  EXPECT_EQ(pressed('8', SDL_SCANCODE_8, KMOD_RALT | KMOD_LSHIFT, "[").mod, kNone);
  EXPECT_EQ(key(0xFC, SDL_SCANCODE_LEFTBRACKET, kNone, "\xc3\xbc"), 0xFC) << "u umlaut, not [";
  EXPECT_EQ(key('+', SDL_SCANCODE_RIGHTBRACKET, kNone, "+"), '+');
  EXPECT_EQ(key('0', SDL_SCANCODE_0, KMOD_LSHIFT, "="), '=') << "and not 0";
  EXPECT_EQ(key('z', SDL_SCANCODE_Y, kNone, "z"), SDLK_z);
}

TEST(PrintedKeys, OfAFrenchKeyboard) {
  EXPECT_EQ(key(';', SDL_SCANCODE_COMMA, KMOD_LSHIFT, "."), '.');
  EXPECT_EQ(key(',', SDL_SCANCODE_M, kNone, ","), ',');
  EXPECT_EQ(key('(', SDL_SCANCODE_5, KMOD_RALT, "["), '[');
  EXPECT_EQ(key(')', SDL_SCANCODE_MINUS, KMOD_RALT, "]"), ']');
  // digits, with Shift and without
  EXPECT_EQ(key('&', SDL_SCANCODE_1, KMOD_LSHIFT, "1"), '1');
  EXPECT_EQ(key('&', SDL_SCANCODE_1, kNone, "&"), '1');
  EXPECT_EQ(key(0xE0, SDL_SCANCODE_0, kNone, "\xc3\xa0"), '0');
  EXPECT_EQ(key('-', SDL_SCANCODE_6, kNone, "-"), '-') << "is a key of its own";
  EXPECT_EQ(key('-', SDL_SCANCODE_6, KMOD_LSHIFT, "6"), '6') << "and not less deep";
  EXPECT_EQ(key('q', SDL_SCANCODE_A, kNone, "q"), SDLK_q);
}

TEST(PrintedKeys, ATextWithoutAKeyIsNoKey) {
  PrintedKeys keys;
  SDL_Event event = {};
  event.type = SDL_TEXTINPUT;
  event.text.text[0] = '[';
  keys.translate(event);
  EXPECT_EQ(event.type, SDL_TEXTINPUT);
}

class KeysWindow : public Window {};

// as on a German keyboard: AltGr + 9 gives ], AltGr + Q gives @
TEST_F(KeysWindow, AltGrChangesTheBurrAndNeitherTheLoudnessNorThePage) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const double before = ready->session->burr_radius();
  const auto with_altgr = [](SDL_Keycode name, SDL_Scancode place, char text) {
    SDL_Event event = {};
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = name;
    event.key.keysym.scancode = place;
    event.key.keysym.mod = KMOD_RALT;
    SDL_PushEvent(&event);
    event = {};
    event.type = SDL_TEXTINPUT;
    event.text.text[0] = text;
    SDL_PushEvent(&event);
  };
  mill_by(*ready, {{"the first picture", looks(3), [&] { with_altgr('q', SDL_SCANCODE_Q, '@'); }},
                   {"it is still there", looks(3), [&] { with_altgr('9', SDL_SCANCODE_9, ']'); }},
                   {"a larger burr",
                    asking_until([&] { return ready->session->burr_radius() > before; },
                                 [&] { with_altgr('9', SDL_SCANCODE_9, ']'); }),
                    [] { leave_work(); }}});
}

// the click that brings the window to the front does not mill; the next one does
TEST_F(KeysWindow, TheFirstPressAfterAnotherWindowCounts) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  tick::TickRow row;
  const auto pedal = [&] { return ready->session->view(row) ? row.hand.pedal : -1.0; };
  const auto focus = [](SDL_WindowEventID what) {
    SDL_Event event = {};
    event.type = SDL_WINDOWEVENT;
    event.window.event = what;
    SDL_PushEvent(&event);
  };
  ASSERT_STREQ(SDL_GetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH), "1") << "SDL would drop the press";
  Clock::time_point back;
  mill_by(*ready,
          {{"the first picture", looks(3),
            [] {
              move_to(640, 340);
              button(SDL_BUTTON_LEFT, true);
            }},
           {"the press", [&] { return pedal() == 1; }, [&] { focus(SDL_WINDOWEVENT_FOCUS_LOST); }},
           {"the lift", [&] { return pedal() == 0; },
            [&] {  // the button was held all the time; then a click brings the window back
              focus(SDL_WINDOWEVENT_FOCUS_GAINED);
              button(SDL_BUTTON_LEFT, true);
              back = Clock::now();
            }},
           {"a while without milling",
            [&] {
              EXPECT_NE(pedal(), 1.0);
              return Clock::now() - back > std::chrono::milliseconds(200);
            },
            [] {
              button(SDL_BUTTON_LEFT, false);
              button(SDL_BUTTON_LEFT, true);
            }},
           {"the press", [&] { return pedal() == 1; }, [&] { button(SDL_BUTTON_LEFT, false); }},
           {"the lift, and more than a second since the window came to the front",
            [&] { return pedal() == 0 && Clock::now() - back > std::chrono::milliseconds(1200); },
            [] {  // Space is held: the keyboard repeats it
              SDL_Event event = {};
              event.type = SDL_KEYDOWN;
              event.key.keysym.sym = SDLK_SPACE;
              SDL_PushEvent(&event);
              event.key.repeat = 1;
              SDL_PushEvent(&event);
            }},
           {"the press, once", [&] { return pedal() == 1; }, [] { leave_work(); }}});
}

}  // namespace
}  // namespace burr::app

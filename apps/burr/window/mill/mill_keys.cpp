// The table of keys: the action of each key, how the mouse does the same, and its row on the help
// page.
#include "window/mill/mill_keys.h"

#include <SDL2/SDL.h>

#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "shared/word_names.h"
#include "window/mill/menu_panel.h"
#include "window/mill/mill_actions.h"
#include "window/ui/printed_keys.h"

namespace burr::app {

namespace {

using Does = std::function<void(MillActions&)>;

// How the mouse does what a key does: by a button of the bar, by an item of the menu, or by what
// `other` names (a gesture, a button on another panel). Every key has one of these.
struct Reach {
  std::optional<Action> button;
  std::string item;
  std::optional<Word> other;
  bool twin = false;  // the key before it in the row does the same
};
struct Key {
  SDL_Keycode code;
  unsigned held;  // modifiers, of which one must be down; 0: any or none
  Does does;
  Reach reach;
};
struct KeyRow {
  HelpBlock block;
  std::string label;
  Word says;
  std::vector<Key> keys;
};
using KeyRows = std::vector<KeyRow>;

constexpr double kDeeper = MillHand::kDeeper;

void take(MillActions& m, ViewKind kind) { m.parts().view.take(kind, m.parts().hand.work()); }

Key act_key(SDL_Keycode code, Action action) {
  return {code, 0, [action](MillActions& m) { m.act(action); }, {action, {}, {}}};
}
Key item_key(SDL_Keycode code, Does does, std::string item, unsigned held = 0) {
  return {code, held, std::move(does), {{}, std::move(item), {}}};
}
Key other_key(SDL_Keycode code, Does does, Word other, unsigned held = 0) {
  return {code, held, std::move(does), {{}, {}, other}};
}
Key twin_key(SDL_Keycode code, Does does, unsigned held = 0) {
  return {code, held, std::move(does), {{}, {}, {}, true}};
}

// A row without a label is not on the help page. A row without keys is for the mouse, or its keys
// are handled elsewhere. If a key has several entries, the first that fits is used, so entries with
// a modifier stand first. The rows are in the order of the help page.
KeyRows hand_keys(bool left_handed) {
  const auto deeper = [](MillActions& m) { m.parts().hand.push(kDeeper); };
  const auto less = [](MillActions& m) { m.parts().hand.push(1 / kDeeper); };
  const auto down = [](MillActions& m) { m.parts().hand.deepen(1); };
  const auto up = [](MillActions& m) { m.parts().hand.deepen(-1); };
  const auto stop = [](MillActions& m) { m.parts().hand.stop_or_go_on(); };
  return {
      {HelpBlock::hand, word(left_handed ? Word::key_right : Word::key_left), Word::help_mill, {}},
      {HelpBlock::hand,
       word(Word::key_space),
       Word::help_hold,
       {item_key(
           SDLK_SPACE, [](MillActions& m) { m.parts().hand.toggle_hold(); },
           word(Word::help_hold))}},
      {HelpBlock::hand,
       "+  -",
       Word::help_push,
       {item_key(SDLK_PLUS, deeper, word(Word::menu_deeper)), twin_key(SDLK_EQUALS, deeper),
        twin_key(SDLK_KP_PLUS, deeper), item_key(SDLK_MINUS, less, word(Word::menu_less_deep)),
        twin_key(SDLK_KP_MINUS, less)}},
      {HelpBlock::hand,
       word(Word::key_ctrl_wheel),
       Word::help_push,
       {other_key(SDLK_PAGEUP, down, Word::key_ctrl_wheel, KMOD_CTRL),
        other_key(SDLK_PAGEDOWN, up, Word::key_ctrl_wheel, KMOD_CTRL),
        other_key(SDLK_KP_9, down, Word::key_ctrl_wheel),
        other_key(SDLK_KP_3, up, Word::key_ctrl_wheel)}},
      {HelpBlock::hand,
       "G",
       Word::help_plane,
       {item_key(
           SDLK_g, [](MillActions& m) { m.parts().hand.toggle_plane(); }, word(Word::help_plane))}},
      {HelpBlock::hand, word(Word::key_ctrl_arrows), Word::help_aim, {}},
      // for a haptic device: shown on the help page about pads
      {HelpBlock::hand,
       "",
       Word::real_does,
       {item_key(SDLK_BACKSPACE, stop, word(Word::menu_stop)), twin_key(SDLK_PAUSE, stop),
        // held down; a device has a button for it, and the mouse needs none
        other_key(
            SDLK_c, [](MillActions& m) { m.parts().hand.lift_by_key(true); }, Word::real_does)}},
  };
}

// Back to a saved view; with Shift the present one is saved.
KeyRow saved_view_keys() {
  KeyRow views = {HelpBlock::view, "F5  F6  F7  F8", Word::help_views, {}};
  for (int slot = 1; slot <= 4; ++slot) {
    const SDL_Keycode code = SDLK_F5 + slot - 1;
    views.keys.push_back(item_key(
        code, [slot](MillActions& m) { m.parts().view.saved(slot, true); },
        say(Word::menu_save_view, slot), KMOD_SHIFT));
    views.keys.push_back(item_key(
        code, [slot](MillActions& m) { m.parts().view.saved(slot, false); },
        say(Word::view_shown, slot)));
  }
  return views;
}

KeyRows view_keys(bool left_handed) {
  constexpr double kArrow = 12;  // an arrow key counts as this many pixels of the mouse
  const Word turns = left_handed ? Word::key_left : Word::key_right;
  const auto turn = [turns](SDL_Keycode code, unsigned held, double right, double up) {
    return other_key(
        code, [=](MillActions& m) { m.parts().view.turn(right, up, held != 0); },
        held != 0 ? Word::key_middle : turns, held);
  };
  return {
      {HelpBlock::view, word(turns), Word::help_turn, {}},
      {HelpBlock::view,
       "",
       Word::help_shift,
       {turn(SDLK_LEFT, KMOD_SHIFT, -kArrow, 0), turn(SDLK_RIGHT, KMOD_SHIFT, kArrow, 0),
        turn(SDLK_UP, KMOD_SHIFT, 0, kArrow), turn(SDLK_DOWN, KMOD_SHIFT, 0, -kArrow)}},
      {HelpBlock::view,
       word(Word::key_arrows),
       Word::help_turn,
       {turn(SDLK_LEFT, 0, -kArrow, 0), turn(SDLK_RIGHT, 0, kArrow, 0), turn(SDLK_UP, 0, 0, kArrow),
        turn(SDLK_DOWN, 0, 0, -kArrow)}},
      {HelpBlock::view, word(Word::key_middle), Word::help_shift, {}},
      {HelpBlock::view, word(Word::key_shift_arrows), Word::help_shift, {}},
      {HelpBlock::view, word(Word::key_wheel), Word::help_zoom, {}},
      {HelpBlock::view,
       "F",
       Word::help_first_view,
       {item_key(
           SDLK_f, [](MillActions& m) { m.parts().view.first(); }, word(Word::help_first_view))}},
      saved_view_keys(),
      {HelpBlock::view,
       word(Word::key_focus),
       Word::help_focus,
       {item_key(
            SDLK_F9, [](MillActions& m) { m.parts().view.deep_or_not(); }, word(Word::menu_deep),
            KMOD_SHIFT),
        item_key(
            SDLK_F11, [](MillActions& m) { m.parts().view.refocus(-1); }, word(Word::focus_nearer),
            KMOD_CTRL),
        item_key(
            SDLK_F12, [](MillActions& m) { m.parts().view.refocus(1); }, word(Word::focus_farther),
            KMOD_CTRL)}},
      {HelpBlock::view,
       "F9  F11  F12",
       Word::help_looks,
       {item_key(
            SDLK_F11, [](MillActions& m) { take(m, ViewKind::free); }, word(Word::view_free),
            KMOD_SHIFT),
        item_key(
            SDLK_F9, [](MillActions& m) { take(m, ViewKind::microscope); },
            word(Word::view_microscope)),
        item_key(
            SDLK_F11, [](MillActions& m) { take(m, ViewKind::whole); }, word(Word::view_whole)),
        item_key(
            SDLK_F12, [](MillActions& m) { take(m, ViewKind::endoscope); },
            word(Word::view_endoscope))}},
  };
}

// What is shown of the bone.
KeyRows shown_keys() {
  return {
      {HelpBlock::view,
       "V  B  N",
       Word::help_slices,
       {act_key(SDLK_v, Action::slices),
        item_key(
            SDLK_b, [](MillActions& m) { m.parts().view.slices().zoom(1); },
            word(Word::menu_nearer)),
        item_key(
            SDLK_n, [](MillActions& m) { m.parts().view.slices().zoom(-1); },
            word(Word::menu_farther))}},
      {HelpBlock::view,
       "W",
       Word::help_window,
       {item_key(
           SDLK_w, [](MillActions& m) { m.note(m.parts().view.slices().next_window()); },
           word(Word::help_window))}},
      {HelpBlock::view,
       "F4  Z",
       Word::help_names,
       {act_key(SDLK_F4, Action::structures),
        // the list pins with a click
        other_key(
            SDLK_z, [](MillActions& m) { m.parts().names.pin_under_pointer(); },
            Word::leaf_structures)}},
      {HelpBlock::view,
       "L",
       Word::help_labels,
       {item_key(
           SDLK_l, [](MillActions& m) { m.parts().view.toggle_labels(); },
           word(Word::help_labels))}},
      {HelpBlock::view,
       "T",
       Word::help_see_through,
       {item_key(
            SDLK_t, [](MillActions& m) { m.parts().view.step_opacity(true); },
            word(Word::menu_less_through), KMOD_SHIFT),
        act_key(SDLK_t, Action::see_through)}},
  };
}

KeyRows tool_keys() {
  return {
      {HelpBlock::tools,
       "1  2  3  4  5",
       Word::help_modes,
       {act_key(SDLK_1, Action::cut), act_key(SDLK_2, Action::add), act_key(SDLK_3, Action::touch),
        act_key(SDLK_4, Action::back), act_key(SDLK_5, Action::smooth)}},
      {HelpBlock::tools,
       bracket_keys(),
       Word::help_sizes,
       {act_key(SDLK_LEFTBRACKET, Action::smaller), act_key(SDLK_RIGHTBRACKET, Action::larger),
        act_key(SDLK_PAGEDOWN, Action::smaller), act_key(SDLK_PAGEUP, Action::larger)}},
      {HelpBlock::tools, word(Word::key_shift_wheel), Word::help_sizes, {}},
      {HelpBlock::tools,
       "7  8",
       Word::help_rack,
       {act_key(SDLK_7, Action::rack),
        item_key(
            SDLK_8, [](MillActions& m) { m.parts().tools.roll(-1); }, word(Word::menu_roll_back),
            KMOD_SHIFT),
        item_key(
            SDLK_8, [](MillActions& m) { m.parts().tools.lean_on(); }, word(Word::menu_lean),
            KMOD_CTRL),
        item_key(
            SDLK_8, [](MillActions& m) { m.parts().tools.roll(1); }, word(Word::menu_roll))}},
      {HelpBlock::tools,
       ",  .",
       Word::help_speeds,
       {act_key(SDLK_COMMA, Action::slower), act_key(SDLK_PERIOD, Action::faster)}},
      {HelpBlock::tools,
       "U  Y",
       Word::help_undo,
       {act_key(SDLK_u, Action::undo), act_key(SDLK_y, Action::redo)}},
      {HelpBlock::tools, "R", Word::help_reset, {act_key(SDLK_r, Action::reset)}},
      {HelpBlock::tools,
       "Ctrl + M",
       Word::help_pieces,
       {item_key(
           SDLK_m, [](MillActions& m) { m.toggle_menu(Menu::pieces); }, word(Word::help_pieces),
           KMOD_CTRL)}},
      {HelpBlock::tools, "D", Word::help_measure, {act_key(SDLK_d, Action::measure)}},
      {HelpBlock::tools,
       "X",
       Word::help_mirror,
       {item_key(
            SDLK_x, [](MillActions& m) { m.parts().tools.mirror_at_tip(); },
            word(Word::menu_mirror_tip), KMOD_SHIFT),
        item_key(
            SDLK_x, [](MillActions& m) { m.parts().tools.mirror_next_plane(); },
            word(Word::menu_mirror_plane), KMOD_CTRL),
        act_key(SDLK_x, Action::mirror)}},
      {HelpBlock::tools, "K", Word::help_kind, {act_key(SDLK_k, Action::kind)}},
      {HelpBlock::tools,
       "I  6",
       Word::help_water,
       {act_key(SDLK_i, Action::coolant), act_key(SDLK_6, Action::suction)}},
  };
}

KeyRows program_keys() {
  const auto done = [](MillActions& m) { m.declare_done(); };
  const auto answer = [](MillActions& m) { m.answer(); };
  return {
      {HelpBlock::program,
       "Tab",
       Word::help_hide,
       {item_key(
           SDLK_TAB, [](MillActions& m) { m.hide_panels(); }, word(Word::help_hide))}},
      {HelpBlock::program,
       "F10",
       Word::menu_all,
       {act_key(SDLK_F1, Action::help), act_key(SDLK_h, Action::help),
        act_key(SDLK_F10, Action::menu)}},
      {HelpBlock::program,
       "O  J  A",
       Word::help_steps,
       {act_key(SDLK_o, Action::task),
        item_key(
            SDLK_j, [](MillActions& m) { m.parts().work_case.step_done(); },
            word(Word::menu_step_done)),
        item_key(
            SDLK_a, [](MillActions& m) { m.parts().work_case.light_target(); },
            word(Word::menu_light))}},
      {HelpBlock::program,
       word(Word::key_ctrl_enter),
       Word::help_done,
       {item_key(SDLK_RETURN, done, word(Word::done_button), KMOD_CTRL),
        twin_key(SDLK_KP_ENTER, done, KMOD_CTRL),
        // the answer to the question
        other_key(SDLK_RETURN, answer, Word::done_yes), twin_key(SDLK_KP_ENTER, answer)}},
      {HelpBlock::program, "F2", Word::help_settings, {act_key(SDLK_F2, Action::settings)}},
      // works on every page: desk.cpp; the settings have it for the mouse
      {HelpBlock::program, "F3", Word::help_stereo, {}},
      {HelpBlock::program, "S", Word::key_save, {act_key(SDLK_s, Action::keep)}},
      {HelpBlock::program, "P", Word::help_picture, {act_key(SDLK_p, Action::picture)}},
      {HelpBlock::program, "E", Word::export_help, {act_key(SDLK_e, Action::export_)}},
      {HelpBlock::program, "M", Word::help_sound, {act_key(SDLK_m, Action::sound)}},
      {HelpBlock::program,
       "9  0",
       Word::help_loudness,
       {item_key(
            SDLK_9, [](MillActions& m) { m.change_loudness(-1); }, word(Word::menu_quieter)),
        item_key(
            SDLK_0, [](MillActions& m) { m.change_loudness(1); }, word(Word::menu_louder))}},
      {HelpBlock::program,
       "Esc  Q",
       Word::help_quit,
       // Esc also closes a page, which has a button for it
       {other_key(
            SDLK_ESCAPE, [](MillActions& m) { m.go_back(); }, Word::leave),
        act_key(SDLK_q, Action::leave)}},
  };
}

KeyRows key_rows(bool left_handed) {
  KeyRows all;
  for (KeyRows& part : std::vector<KeyRows>{hand_keys(left_handed), view_keys(left_handed),
                                            shown_keys(), tool_keys(), program_keys()})
    std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

// "Shift+F5"
std::string key_name(SDL_Keycode code, unsigned held) {
  return ((held & KMOD_SHIFT) != 0  ? "Shift + "
          : (held & KMOD_CTRL) != 0 ? "Ctrl + "
                                    : "") +
         std::string(SDL_GetKeyName(code));
}

// Of the menu of views.
bool in_views(HelpBlock block) { return block == HelpBlock::view; }

// Ctrl + A is known from fields, Ctrl + C from copying: a letter with Ctrl does what the table gives to
// both together, never what it gives to the letter alone.
bool fits(const Key& key, const SDL_Keysym& pressed) {
  if (key.code != pressed.sym) return false;
  if (key.held != 0) return (pressed.mod & key.held) != 0;
  const bool letter = key.code >= SDLK_a && key.code <= SDLK_z;
  return !letter || (pressed.mod & (KMOD_CTRL | KMOD_GUI)) == 0;
}

}  // namespace

bool press_key(MillActions& actions, const SDL_Keysym& pressed, bool left_handed) {
  for (const KeyRow& row : key_rows(left_handed))
    for (const Key& key : row.keys)
      if (fits(key, pressed)) {
        key.does(actions);
        return true;
      }
  return false;
}

std::vector<HelpRow> mill_help_rows(bool left_handed) {
  std::vector<HelpRow> rows;
  for (const KeyRow& row : key_rows(left_handed))
    if (!row.label.empty()) rows.push_back({row.block, row.label, row.says});
  return rows;
}

std::vector<KeyReach> key_reaches() {
  std::vector<KeyReach> all;
  for (const KeyRow& row : key_rows(false))
    for (const Key& key : row.keys) {
      KeyReach one;
      if (key.reach.twin && !all.empty()) one = all.back();
      one.key = key_name(key.code, key.held);
      if (!key.reach.twin) {
        one.button = key.reach.button;
        one.item = key.reach.item;
        if (key.reach.other) one.other = word(*key.reach.other);
      }
      all.push_back(std::move(one));
    }
  return all;
}

bool draw_key_menu(Ui& ui, MillActions& actions, bool views, bool left_handed) {
  std::vector<MenuItem> items;
  std::vector<Does> does;
  for (const KeyRow& row : key_rows(left_handed))
    for (const Key& key : row.keys) {
      if (key.reach.item.empty() || in_views(row.block) != views) continue;
      std::string name = key.reach.item;
      if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
      items.push_back({std::move(name), key_name(key.code, key.held)});
      does.push_back(key.does);
    }
  const MenuPressed pressed = draw_menu(ui, word(views ? Word::menu_views : Word::menu_all), items);
  if (pressed.item) does[*pressed.item](actions);
  return pressed.close;
}

}  // namespace burr::app

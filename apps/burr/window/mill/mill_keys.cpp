// The table of keys: the action of each key, and its row on the help page.
#include "window/mill/mill_keys.h"

#include <SDL2/SDL.h>

#include <iterator>
#include <utility>

#include "window/mill/mill.h"
#include "window/shell/printed_keys.h"
#include "window/shell/words.h"

namespace burr::app {

// A row without a label is not on the help page. A row without keys is for the mouse, or its keys
// are handled elsewhere. If a key has several entries, the first that fits is used, so entries with
// a modifier stand first. The rows are in the order of the help page.
Mill::KeyRows Mill::hand_keys(bool left_handed) {
  return {
      {HelpBlock::hand, word(left_handed ? Word::key_right : Word::key_left), Word::help_mill, {}},
      {HelpBlock::hand,
       word(Word::key_space),
       Word::help_hold,
       {{SDLK_SPACE, 0, [](Mill& m) { m.press_.toggle_hold(); }}}},
      {HelpBlock::hand,
       "+  -",
       Word::help_push,
       {{SDLK_PLUS, 0, [](Mill& m) { m.push(kDeeper); }},
        {SDLK_EQUALS, 0, [](Mill& m) { m.push(kDeeper); }},
        {SDLK_KP_PLUS, 0, [](Mill& m) { m.push(kDeeper); }},
        {SDLK_MINUS, 0, [](Mill& m) { m.push(1 / kDeeper); }},
        {SDLK_KP_MINUS, 0, [](Mill& m) { m.push(1 / kDeeper); }}}},
      {HelpBlock::hand,
       word(Word::key_ctrl_wheel),
       Word::help_push,
       {{SDLK_PAGEUP, KMOD_CTRL, [](Mill& m) { m.deepen(1); }},
        {SDLK_PAGEDOWN, KMOD_CTRL, [](Mill& m) { m.deepen(-1); }},
        {SDLK_KP_9, 0, [](Mill& m) { m.deepen(1); }},
        {SDLK_KP_3, 0, [](Mill& m) { m.deepen(-1); }}}},
      {HelpBlock::hand, "G", Word::help_plane, {{SDLK_g, 0, [](Mill& m) { m.toggle_plane(); }}}},
      {HelpBlock::hand, word(Word::key_ctrl_arrows), Word::help_aim, {}},
      // for a haptic device: shown on the help page about pads
      {HelpBlock::hand,
       "",
       Word::real_does,
       {{SDLK_BACKSPACE, 0, [](Mill& m) { m.stop_or_go_on(); }},
        {SDLK_PAUSE, 0, [](Mill& m) { m.stop_or_go_on(); }},
        {SDLK_c, 0, [](Mill& m) { m.lifts_.by_key = true; }}}},
  };
}

Mill::KeyRows Mill::view_keys(bool left_handed) {
  constexpr double kArrow = 12;  // an arrow key counts as this many pixels of the mouse
  const auto turn = [](SDL_Keycode code, unsigned held, double right, double up) {
    return Key{code, held, [=](Mill& m) { m.turn_view(right, up, held != 0); }};
  };
  KeyRow views = {HelpBlock::view, "F5  F6  F7  F8", Word::help_views, {}};
  for (int slot = 1; slot <= 4; ++slot) {
    const SDL_Keycode code = SDLK_F5 + slot - 1;
    views.keys.push_back({code, KMOD_SHIFT, [slot](Mill& m) { m.saved_view(slot, true); }});
    views.keys.push_back({code, 0, [slot](Mill& m) { m.saved_view(slot, false); }});
  }
  return {
      {HelpBlock::view, word(left_handed ? Word::key_left : Word::key_right), Word::help_turn, {}},
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
      {HelpBlock::view, "F", Word::help_first_view, {{SDLK_f, 0, [](Mill& m) { m.first_view(); }}}},
      std::move(views),
      {HelpBlock::view,
       "F9  F10  F11  F12",
       Word::help_looks,
       {{SDLK_F9, 0, [](Mill& m) { m.take_view(ViewKind::microscope); }},
        {SDLK_F10, 0, [](Mill& m) { m.take_view(ViewKind::whole); }},
        {SDLK_F11, 0, [](Mill& m) { m.take_view(ViewKind::endoscope); }},
        {SDLK_F12, 0, [](Mill& m) { m.take_view(ViewKind::free); }}}},
      {HelpBlock::view,
       "V  B  N",
       Word::help_slices,
       {{SDLK_v, 0, [](Mill& m) { m.slices_shown_ = !m.slices_shown_; }},
        {SDLK_b, 0, [](Mill& m) { m.slices_->zoom(1); }},
        {SDLK_n, 0, [](Mill& m) { m.slices_->zoom(-1); }}}},
      {HelpBlock::view,
       "W",
       Word::help_window,
       {{SDLK_w, 0, [](Mill& m) { m.note(m.slices_->next_window()); }}}},
      {HelpBlock::view, "L", Word::help_labels, {{SDLK_l, 0, [](Mill& m) { m.toggle_labels(); }}}},
      {HelpBlock::view,
       "T",
       Word::help_see_through,
       {{SDLK_t, KMOD_SHIFT, [](Mill& m) { m.step_opacity(true); }},
        {SDLK_t, 0, [](Mill& m) { m.step_opacity(false); }}}},
  };
}

Mill::KeyRows Mill::tool_keys() {
  const auto act = [](SDL_Keycode code, Action action) {
    return Key{code, 0, [action](Mill& m) { m.act(action); }};
  };
  return {
      {HelpBlock::tools,
       "1  2  3  4  5",
       Word::help_modes,
       {act(SDLK_1, Action::cut), act(SDLK_2, Action::add), act(SDLK_3, Action::touch),
        act(SDLK_4, Action::back), act(SDLK_5, Action::smooth)}},
      {HelpBlock::tools,
       bracket_keys(),
       Word::help_sizes,
       {act(SDLK_LEFTBRACKET, Action::smaller), act(SDLK_RIGHTBRACKET, Action::larger),
        act(SDLK_PAGEDOWN, Action::smaller), act(SDLK_PAGEUP, Action::larger)}},
      {HelpBlock::tools, word(Word::key_shift_wheel), Word::help_sizes, {}},
      {HelpBlock::tools,
       ",  .",
       Word::help_speeds,
       {act(SDLK_COMMA, Action::slower), act(SDLK_PERIOD, Action::faster)}},
      {HelpBlock::tools,
       "U  Y",
       Word::help_undo,
       {act(SDLK_u, Action::undo), act(SDLK_y, Action::redo)}},
      {HelpBlock::tools, "R", Word::help_reset, {act(SDLK_r, Action::reset)}},
      {HelpBlock::tools, "D", Word::help_measure, {act(SDLK_d, Action::measure)}},
      {HelpBlock::tools,
       "X",
       Word::help_mirror,
       {{SDLK_x, KMOD_SHIFT, [](Mill& m) { m.mirror_at_tip(); }},
        {SDLK_x, KMOD_CTRL, [](Mill& m) { m.mirror_next_plane(); }},
        act(SDLK_x, Action::mirror)}},
      {HelpBlock::tools,
       "K",
       Word::help_kind,
       {{SDLK_k, 0, [](Mill& m) { m.note(m.drill_.toggle_kind()); }}}},
      {HelpBlock::tools,
       "I",
       Word::help_coolant,
       {{SDLK_i, 0, [](Mill& m) { m.note(m.drill_.toggle_coolant()); }}}},
  };
}

Mill::KeyRows Mill::program_keys() {
  const auto act = [](SDL_Keycode code, Action action) {
    return Key{code, 0, [action](Mill& m) { m.act(action); }};
  };
  return {
      {HelpBlock::program,
       "Tab",
       Word::help_hide,
       {{SDLK_TAB, 0, [](Mill& m) { m.panels_ = !m.panels_; }}}},
      {HelpBlock::program, "", Word::help, {act(SDLK_F1, Action::help), act(SDLK_h, Action::help)}},
      {HelpBlock::program,
       "O  J  A",
       Word::help_steps,
       {{SDLK_o, 0, [](Mill& m) { m.show_task(); }},
        {SDLK_j, 0, [](Mill& m) { m.step_done(); }},
        {SDLK_a, 0, [](Mill& m) { m.light_target(); }}}},
      {HelpBlock::program,
       word(Word::key_ctrl_enter),
       Word::help_done,
       {{SDLK_RETURN, KMOD_CTRL, [](Mill& m) { m.declare_done(); }},
        {SDLK_KP_ENTER, KMOD_CTRL, [](Mill& m) { m.declare_done(); }},
        // the answer to the question
        {SDLK_RETURN, 0, [](Mill& m) { m.answer_done(); }},
        {SDLK_KP_ENTER, 0, [](Mill& m) { m.answer_done(); }}}},
      {HelpBlock::program, "F2", Word::help_settings, {act(SDLK_F2, Action::settings)}},
      {HelpBlock::program, "F3", Word::help_stereo, {}},  // works on every page: desk.cpp
      {HelpBlock::program, "S", Word::key_save, {{SDLK_s, 0, [](Mill& m) { m.keep(); }}}},
      {HelpBlock::program,
       "P",
       Word::help_picture,
       {{SDLK_p, 0, [](Mill& m) { m.picture_ = true; }}}},
      {HelpBlock::program, "E", Word::export_help, {act(SDLK_e, Action::export_)}},
      {HelpBlock::program, "M", Word::help_sound, {{SDLK_m, 0, [](Mill& m) { m.toggle_sound(); }}}},
      {HelpBlock::program,
       "9  0",
       Word::help_loudness,
       {{SDLK_9, 0, [](Mill& m) { m.change_loudness(-1); }},
        {SDLK_0, 0, [](Mill& m) { m.change_loudness(1); }}}},
      {HelpBlock::program,
       "Esc  Q",
       Word::help_quit,
       {{SDLK_ESCAPE, 0, [](Mill& m) { m.go_back(); }}, act(SDLK_q, Action::leave)}},
  };
}

Mill::KeyRows Mill::key_rows(bool left_handed) {
  KeyRows all;
  for (KeyRows& part : std::vector<KeyRows>{hand_keys(left_handed), view_keys(left_handed),
                                            tool_keys(), program_keys()})
    std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

void Mill::key(const SDL_Keysym& pressed) {
  for (const KeyRow& row : key_rows(desk_.settings.left_handed))
    for (const Key& key : row.keys)
      if (key.code == pressed.sym && (key.held == 0 || (pressed.mod & key.held) != 0))
        return key.does(*this);
}

std::vector<HelpRow> Mill::help_rows(bool left_handed) {
  std::vector<HelpRow> rows;
  for (const KeyRow& row : key_rows(left_handed))
    if (!row.label.empty()) rows.push_back({row.block, row.label, row.says});
  return rows;
}

std::vector<HelpRow> mill_help_rows(bool left_handed) { return Mill::help_rows(left_handed); }

}  // namespace burr::app

// Texts of the window fit their boxes in every language, at 1280 x 720.
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "user.h"
#include "window/mill/mill_keys.h"
#include "window/ui/help.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

struct Box {
  Letter letter;
  float points;  // of width, from the code that draws it
  std::vector<Word> texts;
};

// toolbar.cpp, help.cpp, settings_page.cpp, hud.cpp, export_page.cpp
const std::vector<Box>& boxes() {
  static const std::vector<Box> all = {
      {Letter::small,
       70,
       {Word::cut, Word::add, Word::touch, Word::back, Word::smooth, Word::burr, Word::speed,
        Word::stroke, Word::bar_session, Word::help_tools, Word::export_word, Word::help_program,
        Word::help_view, Word::leave, Word::replay_bar_beside, Word::time}},
      {Letter::strong,
       164,
       {Word::key_left, Word::key_right, Word::key_middle, Word::key_wheel, Word::key_ctrl_wheel,
        Word::key_shift_wheel, Word::key_space, Word::key_arrows, Word::key_shift_arrows,
        Word::key_ctrl_arrows, Word::key_sticks, Word::key_right_trigger, Word::key_left_trigger,
        Word::key_shoulders, Word::key_cross, Word::key_clicks, Word::key_real, Word::replay_drag}},
      {Letter::body, 280, {Word::help_mill,          Word::help_hold,
                           Word::help_push,          Word::help_plane,
                           Word::help_aim,           Word::help_turn,
                           Word::help_shift,         Word::help_zoom,
                           Word::help_first_view,    Word::help_slices,
                           Word::help_labels,        Word::help_window,
                           Word::help_views,         Word::help_names,
                           Word::help_see_through,   Word::help_focus,
                           Word::replay_help_play,   Word::replay_help_step,
                           Word::replay_help_small,  Word::replay_help_stroke,
                           Word::replay_help_ends,   Word::replay_help_drag,
                           Word::replay_help_beside, Word::replay_help_shift,
                           Word::film_marks,         Word::replay_help_compare,
                           Word::replay_help_slices}},
      {Letter::body,
       262,
       {Word::help_modes, Word::help_sizes,    Word::help_speeds,   Word::help_undo,
        Word::help_reset, Word::help_measure,  Word::help_mirror,   Word::help_kind,
        Word::help_water, Word::help_hide,     Word::help_settings, Word::help_stereo,
        Word::key_save,   Word::help_picture,  Word::export_help,   Word::film_help,
        Word::help_sound, Word::help_loudness, Word::help_quit,     Word::help_steps}},
      {Letter::body,
       715,
       {Word::pad_sticks, Word::pad_trigger, Word::pad_slow, Word::pad_lift, Word::pad_cross,
        Word::pad_clicks, Word::pad_menu, Word::pedal_does, Word::cap_does, Word::real_does}},
      {Letter::body,
       186,
       {Word::set_language,
        Word::set_scale,
        Word::set_panels,
        Word::set_help,
        Word::set_autosave,
        Word::set_kept,
        Word::set_mb,
        Word::set_left_handed,
        Word::set_force,
        Word::set_press,
        Word::set_shaft,
        Word::set_turn,
        Word::set_zoom,
        Word::set_effects,
        Word::set_stereo,
        Word::set_stereo_depth,
        Word::set_swap_eyes,
        Word::set_headset,
        Word::set_recent_names,
        Word::set_remember_scans,
        Word::set_pad_pace,
        Word::set_pad_dead,
        Word::set_pedal_mill,
        Word::set_pedal_burr,
        Word::set_pedal_coolant,
        Word::set_pedal_clutch,
        Word::set_pedal_rest,
        Word::set_device_scale,
        Word::set_device_force,
        Word::set_device_vibration,
        Word::set_device_torque,
        Word::set_device_dead_man}},
      {Letter::body, 78, {Word::ticks_good, Word::ticks_busy, Word::ticks_lost}},
      {Letter::small, 146, {Word::nearest_far}},
      {Letter::small, 98, {Word::ticks}},
      {Letter::body,
       140,
       {Word::export_bone, Word::export_removed, Word::export_picture, Word::export_film,
        Word::film_pictures, Word::export_replace, Word::export_write, Word::export_stop,
        Word::cancel}},
      {Letter::body, 664, {Word::film_told, Word::film_as_seen, Word::film_aside}},
      // comparison.cpp: beside two columns of 86
      {Letter::small,
       232,
       {Word::beside_title, Word::beside_nearest, Word::beside_violations, Word::beside_nothing}},
      {Letter::small, 60, {Word::beside_left, Word::beside_right}},
      {Letter::small, 82, {Word::beside_left_only, Word::beside_right_only, Word::beside_both}},
      {Letter::strong, 90, {Word::hand_title}},
      {Letter::body, 48, {Word::kind_solid, Word::kind_soft, Word::kind_air}},
      {Letter::body, 62, {Word::kind_spare}},
      // steps_panel.cpp, self_marks_page.cpp, start_page.cpp
      {Letter::body, 120, {Word::done_button}},
      {Letter::body,
       98,
       {Word::report_verdict_met, Word::report_verdict_unmet, Word::report_self_unknown}},
      {Letter::body, 72, {Word::start_marks}},
      // side_panel.cpp: three leaves beside each other; menu_panel.cpp
      {Letter::body, 84, {Word::leaf_task, Word::leaf_steps, Word::leaf_structures}},
      {Letter::small, 210, {Word::list_hint}},
      {Letter::small, 84, {Word::list_distance}},
      {Letter::body,
       250,
       {Word::menu_deeper, Word::menu_less_deep, Word::menu_stop, Word::menu_nearer,
        Word::menu_farther, Word::menu_less_through, Word::menu_mirror_tip, Word::menu_mirror_plane,
        Word::menu_step_done, Word::menu_light, Word::menu_quieter, Word::menu_louder}},
  };
  return all;
}

TEST_F(Window, TextsFitTheirBoxesInEveryLanguage) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  // the fonts are there from the first picture on; the widths are those of Inter
  mill_by(*ready, {{"a picture", looks(3), [] { leave_work(); }}});
  const Ui& ui = desk_->ui();
  if (ui.letters().find("Inter") == std::string::npos)
    GTEST_SKIP() << "not Inter: " << ui.letters();
  for (const Language& language : languages()) {
    speak(language.code);
    for (const Box& box : boxes())
      for (const Word text : box.texts)
        EXPECT_LE(ui.width_of(box.letter, word(text)) / ui.unit(), box.points)
            << language.code << ": " << word(text);
    // help.cpp: every row of the page of keys, in its column
    for (const HelpRow& row : mill_help_rows(false)) {
      const bool left = row.block == HelpBlock::hand || row.block == HelpBlock::view;
      EXPECT_LE(ui.width_of(Letter::strong, row.keys) / ui.unit(), 164)
          << language.code << ": " << row.keys;
      EXPECT_LE(ui.width_of(Letter::body, word(row.does)) / ui.unit(), left ? 280 : 262)
          << language.code << ": " << word(row.does);
    }
    // steps_panel.cpp: the list, and its two buttons side by side
    for (const std::string& name : scenario::built_in_cases()) {
      const auto lesson = scenario::lesson_of(*scenario::read_case(name));
      ASSERT_TRUE(lesson) << lesson.error().text;
      for (const scenario::Step& step : lesson->steps)
        EXPECT_LE(ui.width_of(Letter::body, step.title.in(language.code)) / ui.unit(), 310)
            << language.code << ": " << step.title.in(language.code);
    }
    const std::string buttons = say(Word::steps_done, "J") + say(Word::steps_unlight, "A");
    EXPECT_LE(ui.width_of(Letter::body, buttons) / ui.unit(), 284) << language.code;
  }
}

}  // namespace
}  // namespace burr::app

// apps/burr/window/words.h - all that the window says, in the user's language.
//
//     speak(Language::swedish);
//     word(Word::undo)                          "Ångra"
//     say(Word::picture_left, "burr_001.png")   filled in, as fmt does
//
// Sentences of the library about files and options stay English: they name fields of files.
// Thread: main. Text is UTF-8.
#pragma once

#include <fmt/format.h>

#include <string>

namespace burr::app {

enum class Language { english, swedish };

// One for each thing said; words.cpp has the table in the same order.
enum class Word {
  // while milling
  force,
  limit_user,
  limit_device,
  press,
  pressing,
  lifted,
  speed,
  load,
  burr,
  removed,
  time,
  nearest,
  nearest_far,
  ticks,
  ticks_good,
  ticks_busy,
  ticks_lost,
  ticks_tail,
  picture_whole,
  picture_no_hollows,
  picture_coarser,
  picture_fewer,
  picture_fewest,
  // tools
  cut,
  add,
  touch,
  undo,
  redo,
  reset,
  smaller,
  larger,
  slower,
  faster,
  settings,
  help,
  leave,
  // what was done
  undone,
  redone,
  back_to_start,
  now_cut,
  now_add,
  now_touch,
  burr_now,
  speed_now,
  no_room,
  no_burr,
  picture_left,
  let_go,
  // help
  help_title,
  help_hand,
  help_view,
  help_tools,
  help_program,
  help_mill,
  help_hold,
  help_push,
  help_turn,
  help_shift,
  help_zoom,
  help_first_view,
  help_sizes,
  help_speeds,
  help_modes,
  help_undo,
  help_reset,
  help_hide,
  help_settings,
  help_picture,
  help_quit,
  help_slices,
  help_labels,
  axial,
  coronal,
  sagittal,
  sound_on,
  sound_off,
  sound_loudness,
  help_sound,
  help_loudness,
  help_ghost,
  // names of keys and of what a mouse has
  key_left,
  key_right,
  key_middle,
  key_wheel,
  key_ctrl_wheel,
  key_shift_wheel,
  key_space,
  key_arrows,
  key_shift_arrows,
  // watching a recording
  replay_play,
  replay_pause,
  replay_pace,
  replay_stroke,
  replay_limit,
  replay_setting,
  replay_help_title,
  replay_help_play,
  replay_help_step,
  replay_help_small,
  replay_help_stroke,
  replay_help_ends,
  replay_help_pace,
  replay_help_drag,
  replay_drag,
  key_ctrl_arrows,
  // out of the window
  export_word,
  export_help,
  export_title,
  export_bone,
  export_removed,
  export_picture,
  export_write,
  export_replace,
  export_stop,
  export_exists,
  export_writing,
  export_done,
  export_mesh,
  export_volume,
  export_stopped,
  export_wait,
  // settings
  settings_title,
  language,
  set_look,
  set_scale,
  set_panels,
  set_help,
  set_sessions,
  set_autosave,
  set_kept,
  set_mb,
  set_hand,
  set_left_handed,
  set_force,
  set_press,
  set_view,
  set_turn,
  set_zoom,
  set_privacy,
  set_recent_names,
  set_file,
  set_not_kept,
  // loading and the start
  cancel,
  stopping,
  loading,
  start_hello,
  start_cases,
  start_own,
  start_drop,
  start_path,
  start_open,
  start_file,
  start_folder,
  start_recent,
  start_sessions,
  start_none,
  start_quit,
  start_scan,
  start_case_file,
  start_recording,
  start_unclean,
  start_kept,
  start_trouble,
  case_temporal_bone,
  case_jaw,
  case_spine,
  case_tooth,
  case_block,
  session_kept,
  session_not_kept,
  key_save,
  // flags of haptics/contact.h
  flag_not_finite,
  flag_hand_lost,
  flag_watchdog,
  flag_jump,
  flag_force_limited,
  flag_thermal,
  flag_candidates,
  flag_reserve,
  flag_undo_full,
  flag_restoring,
  flag_not_cut,
  flag_put_off,
  count_,
};

void speak(Language language);
[[nodiscard]] Language spoken();

[[nodiscard]] const char* word(Word which);
[[nodiscard]] const char* word(Word which, Language language);
template <class... Values>
[[nodiscard]] std::string say(Word which, const Values&... values) {
  return fmt::format(fmt::runtime(word(which)), values...);
}

// For the test of the table: the place of each entry is its Word.
[[nodiscard]] bool words_in_order();

}  // namespace burr::app

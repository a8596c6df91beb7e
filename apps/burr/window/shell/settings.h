// apps/burr/window/shell/settings.h - what the user commands of the window, kept as one readable TOML file.
//
//     SettingsRead read = read_settings(path);       // no file: the defaults, and no trouble
//     Status kept = write_settings(read.settings, path, !read.troubles.empty());
//
// A value that cannot be is left at its default, with one sentence that names file and field; so is
// a name that is not known. A file with such trouble is not lost when settings are written: it is
// kept beside as settings.toml.old. Units: as in the file, mm and N. Thread: any.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/render/stereo.h"

namespace burr::app {

struct Settings {
  std::string language = "en";  // one of languages(): the name of its file in words/
  double scale = 1;             // of letters and panels, on top of the display's own
  bool left_handed = false;     // the right button mills, the handle leans left
  std::string device = {};      // that leads the burr, as after --device; empty: the mouse
  double force_limit_n = 3.3;   // the user's own limit of the force in the hand
  double press_mm = 4;          // how deep the mouse presses at first
  double turn_pace = 1;         // of the view, by mouse and arrows
  double zoom_pace = 1;         // by wheel and two fingers
  double pad_pace = 1;          // of the point that a gamepad or SpaceMouse moves
  double pad_dead = 0.15;       // share of a stick's way that counts as rest
  double pedal_mill = 0;        // buttons of a pedal, from 0
  double pedal_burr = 1;
  double pedal_coolant = 2;
  double pedal_clutch = 3;  // lifts a haptic device while it is down
  double pedal_rest = -1;   // where its axis is with no foot on it
  bool effects = true;      // bone freshly cut and wet looks so for a while
  render::Stereo stereo = render::Stereo::off;
  double stereo_depth = 1;    // how far the eyes are apart; 1: as `burr picture` has it
  bool headset = false;       // by OpenXR, where there is one
  bool swap_eyes = false;     // for screens that have left and right the other way round
  bool panels = true;         // shown at the start
  bool help = false;          // shown at the start
  bool autosave = true;       // sessions at the window are recorded
  double sessions_kept = 10;  // at most so many of them
  double sessions_mb = 2000;  // ... and together so large
  bool recent_names = false;  // file names of one's own scans in lists and titles
};

struct SettingsRead {
  Settings settings;
  std::vector<std::string> troubles;  // sentences
};

[[nodiscard]] SettingsRead read_settings(const std::filesystem::path& path);
[[nodiscard]] SettingsRead parse_settings(std::string_view text, std::string_view file);

// The whole file, each setting with what it means and what it may be.
[[nodiscard]] std::string settings_text(const Settings& settings);

// Makes the folder. keep_old: what is there now goes to settings.toml.old first.
[[nodiscard]] Status write_settings(const Settings& settings, const std::filesystem::path& path,
                                    bool keep_old);

// "line_interleaved"; as the file has it.
[[nodiscard]] const char* name_of(render::Stereo stereo);

// What a setting may be, for the page that changes it.
struct SettingRange {
  double least, most;
};
[[nodiscard]] SettingRange range_of(std::string_view key);

}  // namespace burr::app

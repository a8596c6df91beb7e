// apps/burr/shared/user_settings.h - the user's settings of the window, in one TOML file.
//
//     SettingsRead read = read_settings(path);       // no file: the defaults, and no trouble
//     Status kept = write_settings(read.settings, path, !read.troubles.empty());
//
// A value that is not allowed is left at its default, with one sentence that names file and field.
// An unknown name is ignored, also with a sentence. A file with such an error is not lost when
// settings are written: it is kept as settings.toml.old. Units: as in the file, mm and N. Thread:
// any.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/render/stereo.h"

namespace burr::app {

struct Settings {
  // one of languages(): the name of its file in words/; empty: that of the environment
  std::string language = {};
  std::string mode = "free";   // of the next session, as record::word_of() says it
  double scale = 1;            // of letters and panels, in addition to the display's own scale
  bool left_handed = false;    // the right button mills, the handle leans to the left
  std::string device = {};     // that moves the burr, as after --device; empty: the mouse
  double force_limit_n = 3.3;  // the user's own limit for the force on the hand
  double press_mm = 4;         // depth of the press with the mouse at the start
  double turn_pace = 1;        // speed of turning the view, by mouse and arrow keys
  double zoom_pace = 1;        // speed of zooming, by wheel and two fingers
  double pad_pace = 1;         // speed of the point that a gamepad or SpaceMouse moves
  double pad_dead = 0.15;      // dead zone, as a share of a stick's way
  double pedal_mill = 0;       // numbers of a pedal's buttons, from 0
  double pedal_burr = 1;
  double pedal_coolant = 2;
  double pedal_tool = 4;
  double pedal_clutch = 3;     // lifts a haptic device while it is down
  double pedal_rest = -1;      // value of its axis with no foot on it
  bool shaft_touches = false;  // the burr's shaft touches the bone too, as with --touch shaft
  bool effects = true;         // freshly cut bone and wet bone look so for a while
  render::Stereo stereo = render::Stereo::off;
  double stereo_depth = 1;     // distance between the eyes; 1: as in `burr picture`
  bool headset = false;        // through OpenXR, if there is one
  bool swap_eyes = false;      // for screens on which left and right are exchanged
  bool panels = true;          // shown at the start
  bool help = false;           // shown at the start
  bool autosave = true;        // sessions at the window are recorded
  double sessions_kept = 10;   // most sessions that are kept ...
  double sessions_mb = 2000;   // ... and their largest size together
  bool recent_names = false;   // show file names of the user's scans in lists and titles
  bool remember_scans = true;  // keep a list of where the scans of recordings lie
};

struct SettingsRead {
  Settings settings;
  std::vector<std::string> troubles;  // sentences
};

[[nodiscard]] SettingsRead read_settings(const std::filesystem::path& path);
[[nodiscard]] SettingsRead parse_settings(std::string_view text, std::string_view file);

// The whole file, with the meaning and range of each setting.
[[nodiscard]] std::string settings_text(const Settings& settings);

// Makes the folder if needed. keep_old: the present file is first renamed to settings.toml.old.
[[nodiscard]] Status write_settings(const Settings& settings, const std::filesystem::path& path,
                                    bool keep_old);

// In which the window speaks.
[[nodiscard]] std::string language_of(const Settings& settings);

// The name used in the file: "line_interleaved".
[[nodiscard]] const char* name_of(render::Stereo stereo);

// The range of a setting, for the page that changes it.
struct SettingRange {
  double least, most;
};
[[nodiscard]] SettingRange range_of(std::string_view key);

}  // namespace burr::app

#include "shared/user_settings.h"

#include <fmt/format.h>

#include <safe_toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <system_error>

#include "burr/base/check.h"
#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "burr/record/identity.h"
#include "burr/workshop/hand_device.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

constexpr std::uintmax_t kLargestFile = 1U << 16;  // far more than settings need  [byte]

// One line of the file. Exactly one of the six pointers is set.
struct Field {
  const char *key, *means;
  double Settings::*number = nullptr;
  bool Settings::*yes = nullptr;
  std::string Settings::*language = nullptr;
  double least = 0, most = 0;
  render::Stereo Settings::*stereo = nullptr;
  std::string Settings::*device = nullptr;
  std::string Settings::*mode = nullptr;
};

constexpr std::array kFields = {
    Field{"language",
          "of the window; empty: that of your computer (LC_ALL, LC_MESSAGES, LANG), or English",
          nullptr, nullptr, &Settings::language},
    Field{"mode", "what the next session is for, as chosen last on the start page", nullptr,
          nullptr, nullptr, 0, 0, nullptr, nullptr, &Settings::mode},
    Field{"scale", "size of letters and panels, on top of the display's own scale",
          &Settings::scale, nullptr, nullptr, 0.5, 3},
    Field{"left_handed", "the right button mills and the left one turns; the handle leans left",
          nullptr, &Settings::left_handed},
    Field{"device",
          "the haptic device that moves the burr, chosen on the start page; empty: the mouse",
          nullptr, nullptr, nullptr, 0, 0, nullptr, &Settings::device},
    Field{"force_limit_n", "your own limit of the force in the hand [N]", &Settings::force_limit_n,
          nullptr, nullptr, 0.2, 20},
    Field{"press_mm", "how deep the mouse presses at first [mm]", &Settings::press_mm, nullptr,
          nullptr, 0.5, 6},
    Field{"turn_pace", "how fast mouse and arrows turn the view", &Settings::turn_pace, nullptr,
          nullptr, 0.1, 5},
    Field{"zoom_pace", "how fast wheel and two fingers zoom", &Settings::zoom_pace, nullptr,
          nullptr, 0.1, 5},
    Field{"pad_pace", "how fast a gamepad or SpaceMouse moves the ring", &Settings::pad_pace,
          nullptr, nullptr, 0.1, 5},
    Field{"pad_dead", "share of a stick's travel that counts as rest", &Settings::pad_dead, nullptr,
          nullptr, 0.02, 0.6},
    Field{"pedal_mill", "button of a pedal that mills, counted from 0", &Settings::pedal_mill,
          nullptr, nullptr, 0, 31},
    Field{"pedal_burr", "button of a pedal for the next burr", &Settings::pedal_burr, nullptr,
          nullptr, 0, 31},
    Field{"pedal_coolant", "button of a pedal for coolant on and off", &Settings::pedal_coolant,
          nullptr, nullptr, 0, 31},
    Field{"pedal_tool", "button of a pedal for the next tool", &Settings::pedal_tool, nullptr,
          nullptr, 0, 31},
    Field{"pedal_clutch", "button of a pedal that lifts a haptic device while it is down",
          &Settings::pedal_clutch, nullptr, nullptr, 0, 31},
    Field{"pedal_rest", "where a pedal's axis is with no foot on it: -1, 0 in the middle, or 1",
          &Settings::pedal_rest, nullptr, nullptr, -1, 1},
    Field{"shaft_touches",
          "the burr's shaft touches the bone too, in sessions that begin afterwards", nullptr,
          &Settings::shaft_touches},
    Field{"effects",
          "shows for a while what milling leaves on bone: fresh surfaces, water, dust, blood",
          nullptr, &Settings::effects},
    Field{"stereo",
          "two eyes: \"off\", \"side_by_side\", \"anaglyph\", \"line_interleaved\" or "
          "\"quad_buffer\"; F3 goes on to the next",
          nullptr, nullptr, nullptr, 0, 0, &Settings::stereo},
    Field{"stereo_depth", "distance between the eyes; 1 is a thirtieth of the viewing distance",
          &Settings::stereo_depth, nullptr, nullptr, 0.1, 3},
    Field{"swap_eyes", "exchanges left and right, for screens that need it", nullptr,
          &Settings::swap_eyes},
    Field{"headset", "uses a headset through OpenXR, as `burr run --xr` does", nullptr,
          &Settings::headset},
    Field{"panels", "shown at the start; Tab hides them", nullptr, &Settings::panels},
    Field{"help", "shows keys and mouse at the start", nullptr, &Settings::help},
    Field{"autosave", "sessions at the window are recorded, so that they can be continued", nullptr,
          &Settings::autosave},
    Field{"sessions_kept", "largest number of sessions kept; the oldest are deleted first",
          &Settings::sessions_kept, nullptr, nullptr, 1, 1000},
    Field{"sessions_mb", "largest size of all kept sessions together [MB]", &Settings::sessions_mb,
          nullptr, nullptr, 10, 1e6},
    Field{"recent_names",
          "shows the names of your own scans in lists and titles; they may be names of patients",
          nullptr, &Settings::recent_names},
    Field{"remember_scans",
          "keeps a list of where the scans of recordings lie, so that a recording finds its scan "
          "again; false also deletes the list",
          nullptr, &Settings::remember_scans},
};

constexpr const char* kStereoNames[] = {"off", "side_by_side", "anaglyph", "line_interleaved",
                                        "quad_buffer"};

// "en" English, "de" Deutsch, ...
std::string languages_known() {
  std::string all;
  for (const Language& one : languages())
    all += fmt::format("{}\"{}\" {}", all.empty() ? "" : ", ", one.code, one.name);
  return all;
}

// The values that burr wrote until 0.1.0: "english" and "swedish".
std::string code_of_language(const std::string& value) {
  return value == "english" ? "en" : value == "swedish" ? "sv" : value;
}

// Takes the value into `settings`; returns "" or what is wrong with it.
std::string take(const Field& field, const toml::node& node, Settings& settings) {
  if (field.yes != nullptr) {
    const auto value = node.value_exact<bool>();
    if (!value) return "must be true or false";
    settings.*field.yes = *value;
  } else if (field.number != nullptr) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= field.least) || !(*value <= field.most))
      return fmt::format("must be a number from {:g} to {:g}", field.least, field.most);
    settings.*field.number = *value;
  } else if (field.device != nullptr) {
    const auto value = node.value_exact<std::string>();
    if (!value || (!value->empty() && !workshop::is_hand_kind(*value)))
      return fmt::format("must be empty, or one of {}, with :WHICH where there are several",
                         workshop::kinds_known());
    settings.*field.device = *value;
  } else if (field.mode != nullptr) {
    const std::string value = node.value_exact<std::string>().value_or("");
    if (!record::mode_of(value)) return "must be \"free\", \"learn\", \"practise\" or \"exam\"";
    settings.*field.mode = value;
  } else if (field.stereo != nullptr) {
    const std::string value = node.value_exact<std::string>().value_or("");
    const auto* const found = std::find(std::begin(kStereoNames), std::end(kStereoNames), value);
    if (found == std::end(kStereoNames))
      return "must be \"off\", \"side_by_side\", \"anaglyph\", \"line_interleaved\" or "
             "\"quad_buffer\"";
    settings.*field.stereo = static_cast<render::Stereo>(found - std::begin(kStereoNames));
  } else {
    const auto value = node.value_exact<std::string>();
    const std::string code = code_of_language(value.value_or("-"));
    if (!code.empty() && words::language_of(code) == nullptr)
      return "must be empty, or one of " + languages_known();
    settings.*field.language = code;
  }
  return {};
}

}  // namespace

const char* name_of(render::Stereo stereo) {
  return kStereoNames[static_cast<std::size_t>(stereo)];
}

SettingsRead parse_settings(std::string_view text, std::string_view file) {
  SettingsRead read;
  const auto table = parse_toml(text, file);
  if (!table) {
    read.troubles.push_back(table.error().text + "; the default settings are used");
    return read;
  }
  for (const auto& [key, node] : *table) {
    const Field* known = nullptr;
    for (const Field& field : kFields)
      if (key.str() == field.key) known = &field;
    const std::string wrong =
        known == nullptr ? "is not a setting of this version" : take(*known, node, read.settings);
    if (!wrong.empty())
      read.troubles.push_back(
          fmt::format("{}: {}: {}; {}", file, base::printable(key.str()), wrong,
                      known == nullptr ? "it is ignored" : "the default is used"));
  }
  return read;
}

SettingsRead read_settings(const std::filesystem::path& path) {
  std::error_code nobody_asks;
  if (!std::filesystem::exists(path, nobody_asks)) return {};
  const auto text = base::text_of_file(path.string(), kLargestFile,
                                       "a settings file; check that this is the right file");
  if (text) return parse_settings(*text, path.filename().string());
  SettingsRead read;
  read.troubles.push_back(text.error().text + "; the default settings are used");
  return read;
}

std::string settings_text(const Settings& settings) {
  std::string text =
      "# Settings of burr's window. Changed from the window (F2) or here; read at the start.\n";
  for (const Field& field : kFields) {
    text += fmt::format("\n# {}", field.means);
    if (field.number != nullptr)
      text += fmt::format("; {:g} to {:g}\n{} = {:g}\n", field.least, field.most, field.key,
                          settings.*field.number);
    else if (field.yes != nullptr)
      text += fmt::format("\n{} = {}\n", field.key, settings.*field.yes);
    else if (field.mode != nullptr)
      text += fmt::format("\n{} = \"{}\"\n", field.key, settings.*field.mode);
    else if (field.device != nullptr)
      text += fmt::format("\n{} = {}\n", field.key, base::toml_text(settings.*field.device));
    else if (field.stereo != nullptr)
      text += fmt::format("\n{} = \"{}\"\n", field.key, name_of(settings.*field.stereo));
    else
      text += fmt::format("; {}\n{} = \"{}\"\n", languages_known(), field.key,
                          settings.*field.language);
  }
  return text;
}

Status write_settings(const Settings& settings, const std::filesystem::path& path, bool keep_old) {
  std::error_code trouble;
  std::filesystem::create_directories(path.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: cannot make this folder ({}); settings are not saved",
                             path.parent_path().string(), trouble.message()));
  if (keep_old && std::filesystem::exists(path, trouble)) {
    std::filesystem::path old = path;
    old += ".old";
    std::filesystem::rename(path, old, trouble);
    if (trouble)
      return error(Trouble::io,
                   fmt::format("{}: the old file cannot be renamed ({}); settings are not saved",
                               path.string(), trouble.message()));
  }
  auto file = base::NewFile::create(path.string());
  if (!file) return file.error();
  file->write(settings_text(settings));
  return file->put_in_place();
}

std::string language_of(const Settings& settings) {
  return settings.language.empty() ? language_of_environment() : settings.language;
}

SettingRange range_of(std::string_view key) {
  for (const Field& field : kFields)
    if (key == field.key) return {field.least, field.most};
  BURR_CHECK(false);
}

}  // namespace burr::app

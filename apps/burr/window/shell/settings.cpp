#include "window/shell/settings.h"

#include <fmt/format.h>

#include <safe_toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <system_error>

#include "burr/base/check.h"
#include "burr/base/new_file.h"
#include "burr/base/shown.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "workshop/hand_device.h"

namespace burr::app {
namespace {

constexpr std::uintmax_t kLargestFile = 1U << 16;  // a page of settings  [byte]

// One line of the file. Exactly one of the five is set.
struct Field {
  const char *key, *means;
  double Settings::*number = nullptr;
  bool Settings::*yes = nullptr;
  Language Settings::*language = nullptr;
  double least = 0, most = 0;
  render::Stereo Settings::*stereo = nullptr;
  std::string Settings::*device = nullptr;
};

constexpr std::array kFields = {
    Field{"language", "of the window: \"english\" or \"swedish\"", nullptr, nullptr,
          &Settings::language},
    Field{"scale", "of letters and panels, on top of the display's own", &Settings::scale, nullptr,
          nullptr, 0.5, 3},
    Field{"left_handed", "the right button mills and the left one turns; the handle leans left",
          nullptr, &Settings::left_handed},
    Field{"device",
          "a haptic device that leads the burr, chosen on the start page; empty: the mouse",
          nullptr, nullptr, nullptr, 0, 0, nullptr, &Settings::device},
    Field{"force_limit_n", "your own limit of the force in the hand [N]", &Settings::force_limit_n,
          nullptr, nullptr, 0.2, 20},
    Field{"press_mm", "how deep the mouse presses at first [mm]", &Settings::press_mm, nullptr,
          nullptr, 0.5, 6},
    Field{"turn_pace", "of the view, by mouse and arrows", &Settings::turn_pace, nullptr, nullptr,
          0.1, 5},
    Field{"zoom_pace", "by wheel and two fingers", &Settings::zoom_pace, nullptr, nullptr, 0.1, 5},
    Field{"pad_pace", "of the point that a gamepad or SpaceMouse moves", &Settings::pad_pace,
          nullptr, nullptr, 0.1, 5},
    Field{"pad_dead", "share of a stick's way that counts as rest", &Settings::pad_dead, nullptr,
          nullptr, 0.02, 0.6},
    Field{"pedal_mill", "button of a pedal that mills, counted from 0", &Settings::pedal_mill,
          nullptr, nullptr, 0, 31},
    Field{"pedal_burr", "button of a pedal for the next burr", &Settings::pedal_burr, nullptr,
          nullptr, 0, 31},
    Field{"pedal_coolant", "button of a pedal for coolant on and off", &Settings::pedal_coolant,
          nullptr, nullptr, 0, 31},
    Field{"pedal_clutch", "button of a pedal that lifts a haptic device while it is down",
          &Settings::pedal_clutch, nullptr, nullptr, 0, 31},
    Field{"pedal_rest", "where a pedal's axis is with no foot on it: -1, 0 in the middle, or 1",
          &Settings::pedal_rest, nullptr, nullptr, -1, 1},
    Field{"effects", "what milling leaves on bone for a while: fresh faces, water, dust, blood",
          nullptr, &Settings::effects},
    Field{"stereo",
          "two eyes: \"off\", \"side_by_side\", \"anaglyph\", \"line_interleaved\" or "
          "\"quad_buffer\"; F3 goes on to the next",
          nullptr, nullptr, nullptr, 0, 0, &Settings::stereo},
    Field{"stereo_depth",
          "how far the two eyes are apart; 1 is a thirtieth of the distance to what is looked at",
          &Settings::stereo_depth, nullptr, nullptr, 0.1, 3},
    Field{"swap_eyes", "left and right changed over, for screens that show them so", nullptr,
          &Settings::swap_eyes},
    Field{"headset", "a headset by OpenXR, where there is one; as `burr run --xr`", nullptr,
          &Settings::headset},
    Field{"panels", "shown at the start; Tab hides them", nullptr, &Settings::panels},
    Field{"help", "keys and mouse are shown at the start", nullptr, &Settings::help},
    Field{"autosave", "sessions at the window are recorded, so that they can be continued", nullptr,
          &Settings::autosave},
    Field{"sessions_kept", "at most so many of them, the oldest go first", &Settings::sessions_kept,
          nullptr, nullptr, 1, 1000},
    Field{"sessions_mb", "... and together so large [MB]", &Settings::sessions_mb, nullptr, nullptr,
          10, 1e6},
    Field{"recent_names", "names of your own scans in lists and titles; they may be a patient's",
          nullptr, &Settings::recent_names},
};

constexpr const char* kStereoNames[] = {"off", "side_by_side", "anaglyph", "line_interleaved",
                                        "quad_buffer"};

const char* name_of(Language language) {
  return language == Language::swedish ? "swedish" : "english";
}

// "" when it is good
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
    if (!value || (!value->empty() && !is_hand_kind(*value)))
      return fmt::format("must be empty, or one of {}, with :WHICH where there are several",
                         kinds_known());
    settings.*field.device = *value;
  } else if (field.stereo != nullptr) {
    const std::string value = node.value_exact<std::string>().value_or("");
    const auto* const found = std::find(std::begin(kStereoNames), std::end(kStereoNames), value);
    if (found == std::end(kStereoNames))
      return "must be \"off\", \"side_by_side\", \"anaglyph\", \"line_interleaved\" or "
             "\"quad_buffer\"";
    settings.*field.stereo = static_cast<render::Stereo>(found - std::begin(kStereoNames));
  } else {
    const auto value = node.value_exact<std::string>();
    if (!value || (*value != "english" && *value != "swedish"))
      return "must be \"english\" or \"swedish\"";
    settings.*field.language = *value == "swedish" ? Language::swedish : Language::english;
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
        known == nullptr ? "is no setting of this version" : take(*known, node, read.settings);
    if (!wrong.empty())
      read.troubles.push_back(
          fmt::format("{}: {}: {}; {}", file, base::shown(key.str()), wrong,
                      known == nullptr ? "it is left aside" : "the default is used"));
  }
  return read;
}

SettingsRead read_settings(const std::filesystem::path& path) {
  std::error_code nobody_asks;
  if (!std::filesystem::exists(path, nobody_asks)) return {};
  const auto text =
      base::text_of_file(path.string(), kLargestFile, "a page of settings; is this another file?");
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
    else if (field.device != nullptr)
      text += fmt::format("\n{} = {}\n", field.key, base::toml_text(settings.*field.device));
    else
      text += fmt::format("\n{} = \"{}\"\n", field.key,
                          field.stereo != nullptr ? name_of(settings.*field.stereo)
                                                  : name_of(settings.*field.language));
  }
  return text;
}

Status write_settings(const Settings& settings, const std::filesystem::path& path, bool keep_old) {
  std::error_code trouble;
  std::filesystem::create_directories(path.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot make this folder ({}); settings are not kept",
                                          path.parent_path().string(), trouble.message()));
  if (keep_old && std::filesystem::exists(path, trouble)) {
    std::filesystem::path old = path;
    old += ".old";
    std::filesystem::rename(path, old, trouble);
    if (trouble)
      return error(Trouble::io, fmt::format("{}: cannot be kept aside ({}); settings are not kept",
                                            path.string(), trouble.message()));
  }
  auto file = base::NewFile::beside(path.string());
  if (!file) return file.error();
  file->write(settings_text(settings));
  return file->put_in_place();
}

SettingRange range_of(std::string_view key) {
  for (const Field& field : kFields)
    if (key == field.key) return {field.least, field.most};
  BURR_CHECK(false);
}

}  // namespace burr::app

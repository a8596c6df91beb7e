#include "burr/workshop/device_book.h"

#include <fmt/format.h>
#include <safe_toml.h>

#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "burr/device/axes.h"

namespace burr::workshop {
namespace {

constexpr std::uintmax_t kLargestFile = 1U << 16;  // [byte]

// One line of a device. Exactly one of the four is set.
struct Field {
  const char *key, *means;
  double least = 0, most = 0;
  double& (*number)(DevicePreferences&) = nullptr;
  int& (*button)(DevicePreferences&) = nullptr;
  bool& (*yes)(DevicePreferences&) = nullptr;
  math::Quat& (*axes)(DevicePreferences&) = nullptr;
};

const std::array kFields = {
    Field{"scale", "travel of the tip / travel of the hand", 0.1, 10,
          [](DevicePreferences& w) -> double& { return w.mapping.scale; }},
    Field{"max_force_n", "your own limit of its force [N]; 0: the device's limit", 0, 40,
          [](DevicePreferences& w) -> double& { return w.max_force_n; }},
    Field{"vibration", "gain of the spindle's vibration; 0: none, 1: as designed", 0, 4,
          [](DevicePreferences& w) -> double& { return w.vibration; }},
    Field{"torque",
          "gain of the motor's torque, for devices that can turn the hand; 0: no torque at all", 0,
          4, [](DevicePreferences& w) -> double& { return w.torque; }},
    Field{"takes_torque_nm", "largest torque that a robot arm (crtk) takes [N m]; 0: none", 0, 0.5,
          [](DevicePreferences& w) -> double& { return w.takes_torque_nm; }},
    Field{"mill_button", "the button that mills, counted from 0; -1: none", -1, 30, nullptr,
          [](DevicePreferences& w) -> int& { return w.mapping.mill_button; }},
    Field{"clutch_button",
          "the button that lifts the burr, so that the hand can move elsewhere; -1: none", -1, 30,
          nullptr, [](DevicePreferences& w) -> int& { return w.mapping.clutch_button; }},
    Field{"dead_man", "force only while the mill button or the pedal is down", 0, 1, nullptr,
          nullptr, [](DevicePreferences& w) -> bool& { return w.mapping.dead_man; }},
    Field{"axes", "directions of its x, y, z: right, left, up, down, near or far", 0, 0, nullptr,
          nullptr, nullptr, [](DevicePreferences& w) -> math::Quat& { return w.mapping.axes; }},
};

// "" when it is good
std::string take(const Field& field, const toml::node& node, DevicePreferences& preferences) {
  if (field.yes != nullptr) {
    const auto value = node.value_exact<bool>();
    if (!value) return "must be true or false";
    field.yes(preferences) = *value;
    return {};
  }
  if (field.axes != nullptr) {
    const auto words = node.value_exact<std::string>();
    const auto axes = words ? device::axes_from_words(*words) : std::nullopt;
    if (!axes)
      return "must be three of the words right, left, up, down, near, far, in quotes, as a "
             "right-handed frame; \"right up near\" changes nothing";
    field.axes(preferences) = *axes;
    return {};
  }
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  const bool whole = field.button != nullptr;
  if (!value || !(*value >= field.least) || !(*value <= field.most) ||
      (whole && *value != std::floor(*value)))
    return fmt::format("must be a {}number from {:g} to {:g}", whole ? "whole " : "", field.least,
                       field.most);
  if (whole)
    field.button(preferences) = static_cast<int>(*value);
  else
    field.number(preferences) = *value;
  return {};
}

const Field* field_named(std::string_view key) {
  for (const Field& field : kFields)
    if (key == field.key) return &field;
  return nullptr;
}

std::string known_keys() {
  std::string all;
  for (const Field& field : kFields) all += fmt::format("{}{}", all.empty() ? "" : ", ", field.key);
  return all;
}

}  // namespace

DeviceBook DeviceBook::parse(std::string_view text, std::string_view file) {
  DeviceBook book;
  const auto table = parse_toml(text, file);
  if (!table) {
    book.troubles_.push_back(table.error().text + "; the default settings of the devices are used");
    return book;
  }
  for (const auto& [id, node] : *table) {
    const toml::table* device = node.as_table();
    if (device == nullptr) {
      book.troubles_.push_back(fmt::format("{}: {}: is not a [\"device\"]; it is ignored", file,
                                           base::printable(id.str())));
      continue;
    }
    DevicePreferences& preferences = book.preferences_[std::string(id.str())];
    for (const auto& [key, value] : *device) {
      const Field* field = field_named(key.str());
      const std::string wrong =
          field == nullptr ? fmt::format("is not a setting; the settings are {}", known_keys())
                           : take(*field, value, preferences);
      if (!wrong.empty())
        book.troubles_.push_back(fmt::format("{}: {}: {}: {}; it is ignored", file,
                                             base::printable(id.str()), base::printable(key.str()),
                                             wrong));
    }
  }
  return book;
}

DeviceBook DeviceBook::read(const std::filesystem::path& path) {
  std::error_code nobody_asks;
  if (path.empty() || !std::filesystem::exists(path, nobody_asks)) return {};
  const auto text = base::text_of_file(path.string(), kLargestFile,
                                       "a settings file; check that this is the right file");
  if (text) return parse(*text, path.filename().string());
  DeviceBook book;
  book.troubles_.push_back(text.error().text + "; the default settings of the devices are used");
  return book;
}

DevicePreferences DeviceBook::of(const std::string& id) const {
  const auto known = preferences_.find(id);
  return known != preferences_.end() ? known->second : DevicePreferences{};
}

Status DeviceBook::set(const std::string& id, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string key(assignment.substr(0, equals));
  const Field* field = field_named(key);
  if (field == nullptr || equals == std::string_view::npos)
    return error(Trouble::usage,
                 fmt::format("{}: is not a setting of a device; write one of {} with =VALUE",
                             base::printable(assignment), known_keys()));
  std::string written(assignment);
  if (field->axes != nullptr && written.find('"') == std::string::npos)  // the shell took them
    written = key + "=" + base::toml_text(written.substr(equals + 1));
  const auto table = parse_toml(written, "the setting");
  const toml::node* value = table ? table->get(key) : nullptr;
  DevicePreferences preferences = of(id);
  const std::string wrong =
      value == nullptr ? std::string("has no readable value") : take(*field, *value, preferences);
  if (!wrong.empty())
    return error(Trouble::usage, fmt::format("{}: {} {}", base::printable(assignment), key, wrong));
  preferences_[id] = preferences;
  return fine();
}

std::string DeviceBook::text() const {
  std::string text = "# What burr does with each haptic device. Changed by burr or here.\n";
  for (const auto& [id, kept] : preferences_) {
    text += fmt::format("\n[{}]\n", base::toml_text(id));
    DevicePreferences preferences = kept;
    for (const Field& field : kFields) {
      text += fmt::format("# {}\n{} = ", field.means, field.key);
      if (field.number != nullptr)
        text += fmt::format("{:g}\n", field.number(preferences));
      else if (field.button != nullptr)
        text += fmt::format("{}\n", field.button(preferences));
      else if (field.axes != nullptr)
        text += fmt::format("\"{}\"\n", device::words_of_axes(field.axes(preferences)));
      else
        text += fmt::format("{}\n", field.yes(preferences));
    }
  }
  return text;
}

Status DeviceBook::write(const std::filesystem::path& path) const {
  std::error_code trouble;
  std::filesystem::create_directories(path.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: cannot make this folder ({}); the setting is not saved",
                             path.parent_path().string(), trouble.message()));
  if (!troubles_.empty() && std::filesystem::exists(path, trouble)) {
    std::filesystem::path old = path;
    old += ".old";
    std::filesystem::rename(path, old, trouble);
    if (trouble)
      return error(Trouble::io,
                   fmt::format("{}: the old file cannot be renamed ({}); the setting is not saved",
                               path.string(), trouble.message()));
  }
  auto file = base::NewFile::create(path.string());
  if (!file) return file.error();
  file->write(text());
  return file->put_in_place();
}

PreferenceRange range_of_preference(std::string_view key) {
  const Field* field = field_named(key);
  return field != nullptr ? PreferenceRange{field->least, field->most} : PreferenceRange{0, 0};
}

std::string id_of(const device::DeviceSpec& spec) {
  return spec.serial.empty() ? spec.name : spec.name + " " + spec.serial;
}

std::filesystem::path users_book() {
  const std::filesystem::path config = users_places().config;
  return config.empty() ? config : config / "devices.toml";
}

}  // namespace burr::workshop

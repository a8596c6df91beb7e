#include "window/ui/settings_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "shared/word_names.h"

namespace burr::app {
namespace {

constexpr float kNumber = 76;  // room for a slider's number [point]

// One setting per line: its name on the left, its control on the right.
class Lines {
 public:
  Lines(const Ui& ui, float x, float y) : ui_(ui), u_(ui.unit()), x_(x), y_(y) {}

  void heading(Word text) { heading(std::string(word(text))); }
  void heading(const std::string& text) {
    y_ += 6 * u_;
    ui_.write(x_, y_, Ui::Letter::strong, ink::kAccent, text);
    y_ += 26 * u_;
  }
  void remark(Word text) {
    ui_.write(x_, y_ + 2 * u_, Ui::Letter::small, ink::kDim, word(text));
    y_ += 24 * u_;
  }

  void number(Word name, const char* key, double& value, const char* format) {
    number(name, key, value, format, range_of(key));
  }
  void number(Word name, const char* key, double& value, const char* format,
              const SettingRange& range) {
    begin(name);
    auto now = static_cast<float>(value);
    // letters that grow would move the slider away from the mouse: take the value when it is
    // released
    const bool later = std::string_view(key) == "scale";
    float* const kept =
        ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID(key), static_cast<float>(value));
    if (later && ImGui::IsMouseDown(0)) now = *kept;
    const bool types = ImGui::GetIO().WantTextInput;  // Ctrl + click: the number as text
    ImGui::SetNextItemWidth((200 - kNumber) * u_);
    // the number stands beside the slider: in it, the knob would cover it
    if (!types) ImGui::PushStyleColor(ImGuiCol_Text, ink::rgb(0, 0, 0, 0));
    const bool moved =
        ImGui::SliderFloat(fmt::format("##{}", key).c_str(), &now, static_cast<float>(range.least),
                           static_cast<float>(range.most), format,
                           range.least > 0 && range.most / range.least > 50
                               ? ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp
                               : ImGuiSliderFlags_AlwaysClamp);
    if (!types) ImGui::PopStyleColor();
    if (moved) {
      *kept = now;
      if (!later) value = static_cast<double>(now);
    }
    std::array<char, 32> text = {};
    std::snprintf(text.data(), text.size(), format, static_cast<double>(now));
    ui_.write(x_ + 390 * u_, y_ + 5 * u_, Ui::Letter::body, ink::kText, text.data(), 1);
    if (later && ImGui::IsItemDeactivatedAfterEdit()) value = static_cast<double>(*kept);
    if (!ImGui::IsItemActive()) *kept = static_cast<float>(value);
    // written to the file when the slider is released
    changed_ = changed_ || ImGui::IsItemDeactivatedAfterEdit();
    end();
  }

  void yes(Word name, const char* key, bool& value) {
    begin(name);
    changed_ = ImGui::Checkbox(fmt::format("##{}", key).c_str(), &value) || changed_;
    end();
  }

  void language(std::string& value) {
    begin(Word::set_language);
    ImGui::SetNextItemWidth(200 * u_);
    if (ImGui::BeginCombo("##language", spoken().name.c_str())) {
      for (const Language& one : languages())
        if (ImGui::Selectable(one.name.c_str(), one.code == spoken().code) && one.code != value) {
          value = one.code;
          changed_ = true;
        }
      ImGui::EndCombo();
    }
    end();
  }

  void stereo(render::Stereo& value) {
    begin(Word::set_stereo);
    constexpr Word kNames[] = {Word::stereo_off, Word::stereo_side_by_side, Word::stereo_anaglyph,
                               Word::stereo_interleaved, Word::stereo_quad_buffer};
    std::string all;
    for (const Word name : kNames) all += std::string(word(name)) + '\0';
    int now = static_cast<int>(value);
    ImGui::SetNextItemWidth(200 * u_);
    changed_ = ImGui::Combo("##stereo", &now, all.c_str()) || changed_;
    value = static_cast<render::Stereo>(now);
    end();
  }

  [[nodiscard]] bool changed() const { return changed_; }

 private:
  void begin(Word name) {
    ui_.write(x_, y_ + 5 * u_, Ui::Letter::body, ink::kText, word(name));
    ImGui::SetCursorScreenPos({x_ + 190 * u_, y_});
  }
  void end() { y_ += 37 * u_; }

  const Ui& ui_;
  float u_, x_, y_;
  bool changed_ = false;
};

void main_leaf(Lines& left, Lines& right, Settings& settings) {
  left.heading(Word::set_look);
  left.language(settings.language);
  left.number(Word::set_scale, "scale", settings.scale, "%.2f x");
  left.yes(Word::set_panels, "panels", settings.panels);
  left.yes(Word::set_help, "help", settings.help);
  left.heading(Word::set_sessions);
  left.yes(Word::set_autosave, "autosave", settings.autosave);
  left.number(Word::set_kept, "sessions_kept", settings.sessions_kept, "%.0f");
  left.number(Word::set_mb, "sessions_mb", settings.sessions_mb, "%.0f MB");
  left.yes(Word::set_shaft, "shaft_touches", settings.shaft_touches);
  left.heading(Word::set_privacy);
  left.yes(Word::set_recent_names, "recent_names", settings.recent_names);
  left.yes(Word::set_remember_scans, "remember_scans", settings.remember_scans);
  right.heading(Word::set_hand);
  right.yes(Word::set_left_handed, "left_handed", settings.left_handed);
  right.number(Word::set_force, "force_limit_n", settings.force_limit_n, "%.1f N");
  right.number(Word::set_press, "press_mm", settings.press_mm, "%.1f mm");
  right.heading(Word::set_view);
  right.number(Word::set_turn, "turn_pace", settings.turn_pace, "%.1f x");
  right.number(Word::set_zoom, "zoom_pace", settings.zoom_pace, "%.1f x");
  right.yes(Word::set_effects, "effects", settings.effects);
  right.heading(Word::set_two_eyes);
  right.stereo(settings.stereo);
  right.number(Word::set_stereo_depth, "stereo_depth", settings.stereo_depth, "%.2f x");
  right.yes(Word::set_swap_eyes, "swap_eyes", settings.swap_eyes);
  right.yes(Word::set_headset, "headset", settings.headset);
}

void pads_leaf(Lines& left, Lines& right, Settings& settings, DeviceLeaf* device) {
  left.heading(Word::set_sticks);
  left.number(Word::set_pad_pace, "pad_pace", settings.pad_pace, "%.1f x");
  left.number(Word::set_pad_dead, "pad_dead", settings.pad_dead, "%.2f");
  if (device != nullptr) {
    const bool before = left.changed();
    workshop::DevicePreferences& preferences = device->preferences;
    left.heading(device->id);
    // in the book 0 means "as much as the device can"; the left end of the slider is the smallest
    // force
    double force = preferences.max_force_n > 0 ? std::min(preferences.max_force_n, device->peak)
                                               : device->peak;
    const double shown = force;
    left.number(Word::set_device_force, "device_force", force, "%.1f N", {0.1, device->peak});
    if (force != shown) preferences.max_force_n = force;
    const auto preference = [&left](Word name, const char* key, double& value, const char* format) {
      const workshop::PreferenceRange range = workshop::range_of_preference(key);
      left.number(name, ("device_" + std::string(key)).c_str(), value, format,
                  {range.least, range.most});
    };
    preference(Word::set_device_scale, "scale", preferences.mapping.scale, "%.2f x");
    preference(Word::set_device_vibration, "vibration", preferences.vibration, "%.1f x");
    if (device->turns) preference(Word::set_device_torque, "torque", preferences.torque, "%.1f x");
    left.yes(Word::set_device_dead_man, "device_dead_man", preferences.mapping.dead_man);
    if (!device->turns) left.remark(Word::set_device_no_torque);
    left.remark(Word::set_device_next);
    device->changed = left.changed() && !before;
  }
  right.heading(Word::set_pedal);
  right.number(Word::set_pedal_mill, "pedal_mill", settings.pedal_mill, "%.0f");
  right.number(Word::set_pedal_burr, "pedal_burr", settings.pedal_burr, "%.0f");
  right.number(Word::set_pedal_coolant, "pedal_coolant", settings.pedal_coolant, "%.0f");
  right.number(Word::set_pedal_tool, "pedal_tool", settings.pedal_tool, "%.0f");
  right.number(Word::set_pedal_clutch, "pedal_clutch", settings.pedal_clutch, "%.0f");
  right.number(Word::set_pedal_rest, "pedal_rest", settings.pedal_rest, "%.0f");
}

}  // namespace

SettingsPage draw_settings(Ui& ui, Settings& settings, const std::string& file, bool& pads,
                           DeviceLeaf* device) {
  const float u = ui.unit(), w = 900 * u, h = 582 * u;
  const float x = (ui.width() - w) / 2, y = std::max(6 * u, (ui.height() - h) / 2 - 20 * u);
  ui.page("##settings", x, y, w, h);
  ui.write(x + 28 * u, y + 22 * u, Ui::Letter::large, ink::kText, word(Word::settings_title));
  Lines left(ui, x + 28 * u, y + 66 * u), right(ui, x + 480 * u, y + 66 * u);
  if (pads)
    pads_leaf(left, right, settings, device);
  else
    main_leaf(left, right, settings);
  ui.write(x + 28 * u, y + h - 34 * u, Ui::Letter::small, ink::kDim,
           file.empty() ? word(Word::set_not_kept) : say(Word::set_file, file));
  SettingsPage page;
  page.changed = left.changed() || right.changed();
  ImGui::SetCursorScreenPos({x + w - 390 * u, y + 20 * u});
  if (ImGui::Button(word(pads ? Word::settings_title : Word::help_pad), {276 * u, 0})) pads = !pads;
  ImGui::SetCursorScreenPos({x + w - 100 * u, y + 20 * u});
  page.done = ImGui::Button("OK  [F2]", {76 * u, 0});
  ImGui::End();
  return page;
}

}  // namespace burr::app

#include "window/mill/over_pages.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "window/ui/help.h"

namespace burr::app {

OverPages::OverPages(Desk& desk, sim::Session& session, const render::Scene& scene,
                     const WindowOptions& options, HelpRows help_rows)
    : desk_(desk),
      help_rows_(help_rows),
      help_(desk.settings.help),
      export_(desk, &session, scene, options.folder, options.film_of) {}

void OverPages::close() {
  if (export_.choosing()) return export_.stop_choosing();
  help_ = settings_ = asks_done_ = asks_leave_ = false;
  export_.show(false);
}

void OverPages::toggle_help(bool pads) {
  const bool shown = !help_;
  close();
  help_ = shown;
  help_pads_ = pads;
}

void OverPages::toggle_settings() {
  const bool shown = !settings_;
  close();
  settings_ = shown;
}

void OverPages::toggle_export() {
  const bool shown = !export_.shown();
  close();
  export_.show(shown);
}

namespace {

// A question with two buttons. told: what the answer does; warning: what there is to know first, or
// "". Returns true for yes, false for no, nothing while it is open.
std::optional<bool> ask(Ui& ui, const char* name, Word title, const std::string& told,
                        const std::string& warning, Word yes, Word no) {
  const float u = ui.unit(), w = 520 * u, h = 190 * u;
  const float x = (ui.width() - w) / 2, y = (ui.height() - h) / 2;
  ui.page(name, x, y, w, h);
  ui.write(x + 28 * u, y + 20 * u, Ui::Letter::large, ink::kText, word(title));
  ImGui::SetCursorScreenPos({x + 28 * u, y + 58 * u});
  ImGui::PushTextWrapPos(w - 28 * u);
  ui.tell(told);
  ImGui::TextUnformatted(told.c_str());
  if (!warning.empty()) {
    ImGui::SetCursorPosX(28 * u);
    ImGui::PushStyleColor(ImGuiCol_Text, ink::kWarn);
    ImGui::TextUnformatted(warning.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::PopTextWrapPos();
  ImGui::SetCursorScreenPos({x + 28 * u, y + h - 50 * u});
  std::optional<bool> answer;
  if (ImGui::Button(fmt::format("{}  [{}]", word(yes), word(Word::key_enter)).c_str()))
    answer = true;
  ImGui::SameLine();
  if (ImGui::Button(fmt::format("{}  [Esc]", word(no)).c_str())) answer = false;
  ImGui::End();
  return answer;
}

}  // namespace

bool OverPages::draw_done(std::size_t open_steps) {
  const std::string warning =
      open_steps > 0 ? say(Word::done_open_steps, open_steps) : std::string();
  const auto answer = ask(desk_.ui(), "##done", Word::done_title, word(Word::done_told), warning,
                          Word::done_yes, Word::done_no);
  if (answer) asks_done_ = *answer;
  return answer.value_or(false);
}

bool OverPages::draw_leave(Word told) {
  const auto answer = ask(desk_.ui(), "##leave", Word::leave_title, word(told),
                          export_.progress().empty() ? "" : word(Word::leave_writes),
                          Word::leave_yes, Word::leave_no);
  if (answer) asks_leave_ = *answer;
  return answer.value_or(false);
}

OverPages::Changed OverPages::draw(DeviceLeaf* device, std::size_t open_steps, Word leaving) {
  if (help_) help_ = draw_help(desk_.ui(), help_rows_(desk_.settings.left_handed), help_pads_);
  if (export_.shown()) export_.draw();
  if (settings_) return draw_settings_page(device);
  if (asks_leave_) return {.leave = draw_leave(leaving)};
  return {.done = asks_done_ && draw_done(open_steps)};
}

OverPages::Changed OverPages::draw_settings_page(DeviceLeaf* device) {
  const double limit = desk_.settings.force_limit_n;
  const bool worn = desk_.settings.headset;
  const std::filesystem::path& config = desk_.places().config;
  const SettingsPage page = draw_settings(
      desk_.ui(), desk_.settings,
      config.empty() ? std::string() : (config / "settings.toml").string(), settings_pads_, device);
  if (page.changed) desk_.settings_changed();
  if (desk_.settings.headset != worn) desk_.headset_wanted = desk_.settings.headset;
  if (page.done) settings_ = false;
  return {.settings = page.changed,
          .force_limit = desk_.settings.force_limit_n != limit,
          .device = device != nullptr && device->changed};
}

}  // namespace burr::app

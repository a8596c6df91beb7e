#include "window/mill/over_pages.h"

#include <filesystem>
#include <utility>

#include "window/shell/help.h"

namespace burr::app {

OverPages::OverPages(Desk& desk, sim::Session& session, const render::Scene& scene,
                     const WindowOptions& options, HelpRows help_rows)
    : desk_(desk),
      help_rows_(help_rows),
      help_(desk.settings.help),
      export_(desk, &session, scene, options.folder, options.film_of) {}

void OverPages::close() {
  help_ = settings_ = false;
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

OverPages::Changed OverPages::draw(DeviceLeaf* device) {
  if (help_) help_ = draw_help(desk_.ui(), help_rows_(desk_.settings.left_handed), help_pads_);
  if (export_.shown()) export_.draw();
  return settings_ ? draw_settings_page(device) : Changed();
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
  return {page.changed, desk_.settings.force_limit_n != limit,
          device != nullptr && device->changed};
}

}  // namespace burr::app

#include "window/mill/saved_views.h"

#include <fmt/format.h>
#include <safe_toml.h>

#include <cmath>
#include <cstdint>
#include <system_error>

#include "burr/base/new_file.h"
#include "burr/base/text_file.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

constexpr std::uintmax_t kLargestFile = 1U << 20;  // room for some thousand views  [byte]

bool is_key(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// Reads one entry of the file; none if a value is missing or out of range.
std::optional<SavedView> view_of(const toml::table& entry) {
  constexpr double kFar = 10;  // [m]
  bool good = true;
  const auto number = [&](const char* key, double least, double most, double per_unit = 1) {
    const auto value = entry[key].value<double>();
    good = good && value && *value * per_unit >= least && *value * per_unit <= most;
    return good ? *value * per_unit : 0;
  };
  const auto yes = [&](const char* key) {
    const auto value = entry[key].value_exact<bool>();
    good = good && value;
    return good && *value;
  };
  SavedView view;
  render::Camera& camera = view.camera;
  camera.target = {number("x_mm", -kFar, kFar, 1e-3), number("y_mm", -kFar, kFar, 1e-3),
                   number("z_mm", -kFar, kFar, 1e-3)};
  camera.distance = number("distance_mm", 2e-3, 5, 1e-3);  // as render::zoom()
  camera.azimuth = number("azimuth", -1e6, 1e6);
  camera.elevation = number("elevation", -1.57, 1.57);
  camera.field_of_view = number("field_of_view", 0.01, 2.5);
  view.opacity = number("opacity", 0.05, 1);
  view.labels = yes("labels");
  view.slices = yes("slices");
  return good ? std::optional(view) : std::nullopt;
}

}  // namespace

std::string key_of(const volume::Grid& grid) {
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a, 64 bit
  const auto add = [&hash](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      hash ^= value >> (8 * byte) & 0xFF;
      hash *= 1099511628211U;
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    add(static_cast<std::uint64_t>(grid.size[axis]));
    // in micrometres, so that rounding of the numbers does not change the key
    add(static_cast<std::uint64_t>(std::llround(1e6 * grid.frame.p[axis])));
  }
  add(static_cast<std::uint64_t>(std::llround(1e9 * grid.voxel)));
  return fmt::format("{:016x}", hash);
}

SavedViews::SavedViews(std::filesystem::path file, std::string bone)
    : file_(std::move(file)), bone_(std::move(bone)) {
  read();
}

void SavedViews::read() {
  std::error_code nobody_asks;
  if (file_.empty() || !std::filesystem::exists(file_, nobody_asks)) return;
  const auto text = base::text_of_file(file_.string(), kLargestFile, "views that were kept");
  if (!text) {
    trouble_ = in_options(text.error()).text + "; the views kept before are not available";
    keep_old_ = true;
    return;
  }
  const std::string name = file_.filename().string();
  const auto table = parse_toml(*text, name);
  if (!table) {
    trouble_ = in_options(table.error()).text + "; the views kept before are not available";
    keep_old_ = true;
    return;
  }
  int odd = 0;
  const toml::array* all = (*table)["view"].as_array();
  for (std::size_t n = 0; all != nullptr && n < all->size(); ++n) {
    const toml::table* entry = (*all)[n].as_table();
    const auto bone = entry == nullptr ? std::nullopt : (*entry)["bone"].value_exact<std::string>();
    const auto slot =
        entry == nullptr ? std::nullopt : (*entry)["slot"].value_exact<std::int64_t>();
    const auto view = entry == nullptr ? std::nullopt : view_of(*entry);
    if (bone && is_key(*bone) && slot && *slot >= 1 && *slot <= kSavedViews && view)
      views_[{*bone, static_cast<int>(*slot)}] = *view;
    else
      ++odd;
  }
  if (odd == 0) return;
  trouble_ = fmt::format("{}: {} of the views cannot be used and are ignored", name, odd);
  keep_old_ = true;
}

std::optional<SavedView> SavedViews::at(int slot) const {
  const auto found = views_.find({bone_, slot});
  return found == views_.end() ? std::nullopt : std::optional(found->second);
}

std::string SavedViews::text() const {
  std::string text = "# Views kept with Shift+F5 to F8 in burr's window. Angles in rad.\n";
  for (const auto& [of, view] : views_) {
    const render::Camera& c = view.camera;
    text += fmt::format(
        "\n[[view]]\nbone = \"{}\"\nslot = {}\nx_mm = {:.17g}\ny_mm = {:.17g}\nz_mm = {:.17g}\n"
        "distance_mm = {:.17g}\nazimuth = {:.17g}\nelevation = {:.17g}\nfield_of_view = {:.17g}\n"
        "opacity = {:.17g}\nlabels = {}\nslices = {}\n",
        of.first, of.second, 1e3 * c.target.x(), 1e3 * c.target.y(), 1e3 * c.target.z(),
        1e3 * c.distance, c.azimuth, c.elevation, c.field_of_view, view.opacity, view.labels,
        view.slices);
  }
  return text;
}

Status SavedViews::keep(int slot, const SavedView& view) {
  views_[{bone_, slot}] = view;
  if (file_.empty()) return fine();
  std::error_code trouble;
  std::filesystem::create_directories(file_.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: cannot make this folder ({}); the view is kept until "
                             "burr ends",
                             file_.parent_path().string(), trouble.message()));
  if (keep_old_ && std::filesystem::exists(file_, trouble)) {
    std::filesystem::path old = file_;
    old += ".old";
    std::filesystem::rename(file_, old, trouble);
    if (trouble)
      return error(
          Trouble::io,
          fmt::format("{}: the old file cannot be renamed ({}); the view is kept until burr ends",
                      file_.string(), trouble.message()));
  }
  auto file = base::NewFile::create(file_.string());
  if (!file) return file.error();
  file->write(text());
  const Status put = file->put_in_place();
  if (put) keep_old_ = false;
  return put;
}

}  // namespace burr::app

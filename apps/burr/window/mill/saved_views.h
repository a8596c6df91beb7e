// apps/burr/window/mill/saved_views.h - ways a bone was looked at that its user wants to come back to:
// four of them for each bone, kept in a file of the user's.
//
//     SavedViews views(state / "views.toml", key_of(bone.grid()));
//     views.keep(1, {scene.camera, ...});      // a Status: a disk may be full
//     if (const auto view = views.at(1)) ...
//
// A bone is known by where its grid lies, so the file names nobody. Thread: main.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "burr/base/result.h"
#include "burr/render/camera.h"
#include "burr/volume/grid.h"

namespace burr::app {

struct SavedView {
  render::Camera camera;
  double opacity = 1;  // of the bone
  bool labels = true, slices = true;
};

inline constexpr int kSavedViews = 4;  // slots 1 to 4 of a bone

// 16 hexadecimal digits.
[[nodiscard]] std::string key_of(const volume::Grid& grid);

class SavedViews {
 public:
  // An empty path: kept as long as the program runs.
  SavedViews(std::filesystem::path file, std::string bone);

  [[nodiscard]] std::optional<SavedView> at(int slot) const;
  // Of an older one nothing is left. Errors: io; the view is there until the program ends.
  Status keep(int slot, const SavedView& view);
  // What was wrong with the file, one sentence; "" if nothing.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void read();
  [[nodiscard]] std::string text() const;

  std::filesystem::path file_;
  std::string bone_, trouble_;
  bool keep_old_ = false;                                   // the file could not be read whole
  std::map<std::pair<std::string, int>, SavedView> views_;  // of all bones
};

}  // namespace burr::app

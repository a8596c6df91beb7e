// apps/burr/window/mill/saved_views.h - views of a bone that the user saved: four per bone, in one
// file of the user.
//
//     SavedViews views(state / "views.toml", key_of(bone.grid()));
//     views.keep(1, {scene.camera, ...});      // a Status: a disk may be full
//     if (const auto view = views.at(1)) ...
//
// A bone is identified by the position of its grid, so the file contains no names. Thread: main.
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

inline constexpr int kSavedViews = 4;  // numbers 1 to 4

// The key of a bone: 16 hexadecimal digits.
[[nodiscard]] std::string key_of(const volume::Grid& grid);

class SavedViews {
 public:
  // An empty path: views are kept only until the program ends.
  SavedViews(std::filesystem::path file, std::string bone);

  [[nodiscard]] std::optional<SavedView> at(int slot) const;
  // Replaces the old view of this number. Error: io; the view is then kept only until the program
  // ends.
  Status keep(int slot, const SavedView& view);
  // One sentence about an error in the file; "" for none.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  void read();
  [[nodiscard]] std::string text() const;

  std::filesystem::path file_;
  std::string bone_, trouble_;
  bool keep_old_ = false;                                   // part of the file could not be read
  std::map<std::pair<std::string, int>, SavedView> views_;  // of all bones
};

}  // namespace burr::app

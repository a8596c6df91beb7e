// base/places.h - where burr keeps things of its user. Thread: any.
#pragma once

#include <filesystem>

namespace burr {

// An empty folder: that is not kept.
struct DeskPlaces {
  std::filesystem::path config, state, cache;
  std::filesystem::path data = {};  // what must not be lost: the store of learners
};
// By the XDG base directories: ~/.config/burr and so on.
[[nodiscard]] DeskPlaces users_places();

}  // namespace burr

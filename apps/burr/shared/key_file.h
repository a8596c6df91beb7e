// apps/burr/shared/key_file.h - where the keys of this user lie: that of the station, and that of a person who decides.
//
// Thread: any.
#pragma once

#include <string>

#include "burr/base/places.h"

namespace burr::app {

enum class KeyOf { station, decider };
// Empty: there is no folder for it.
[[nodiscard]] inline std::string key_file(const DeskPlaces& places, KeyOf whose) {
  if (places.data.empty()) return {};
  return (places.data / (whose == KeyOf::station ? "station.key" : "decider.key")).string();
}

}  // namespace burr::app

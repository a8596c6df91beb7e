#include "workshop/spared_distance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "burr/base/shown.h"

namespace burr::app {
namespace {

constexpr const char* kWord = "spare";  // in a recording: numbers of tissues

Tissues marked(const volume::TissueTable& table) {
  Tissues spared;
  for (std::size_t id = 1; id < table.tissues.size(); ++id)
    if (table.tissues[id].spare) spared.push_back(static_cast<volume::TissueId>(id));
  return spared;
}

}  // namespace

Tissues to_spare(const volume::TissueTable& table, const std::vector<std::string>& named) {
  if (named.empty()) return marked(table);
  Tissues spared;
  for (const std::string& name : named) {
    const auto found = std::find_if(table.tissues.begin() + 1, table.tissues.end(),
                                    [&name](const volume::Tissue& t) { return t.name == name; });
    if (found != table.tissues.end())
      spared.push_back(static_cast<volume::TissueId>(found - table.tissues.begin()));
    else
      fmt::print(stderr, "this bone has no structure \"{}\" to spare\n", base::shown(name));
  }
  return spared;
}

void write_spared(const Tissues& spared, record::SessionInfo& info) {
  std::string& text = info.words[kWord];
  for (const volume::TissueId id : spared) text += (text.empty() ? "" : " ") + std::to_string(id);
}

Tissues read_spared(const record::SessionInfo& info) {
  const auto word = info.words.find(kWord);
  if (word == info.words.end()) return marked(info.volume.tissues);
  std::istringstream text(word->second);
  Tissues spared;
  for (unsigned id = 0; text >> id && id < info.volume.tissues.tissues.size();)
    spared.push_back(static_cast<volume::TissueId>(id));
  return spared;
}

Result<SparedDistance> SparedDistance::make(const volume::Bone& bone, const Tissues& spared,
                                            Progress& progress) {
  auto distance = volume::DistanceTo::make(bone, spared, {}, progress);
  if (!distance) return distance.error();
  SparedDistance made;
  made.distance_ = std::move(*distance);
  made.table_ = bone.tissues();
  return made;
}

Hearing::ToSpare SparedDistance::distances() const {
  if (distance_.empty()) return {};
  return [this](const math::Vec3& p) { return distance_.at(p).distance; };
}

std::optional<SparedDistance::Near> SparedDistance::nearest(const math::Vec3& p) const {
  const volume::Nearest nearest = distance_.at(p);
  if (!std::isfinite(nearest.distance)) return std::nullopt;
  return Near{base::shown(table_[nearest.tissue].name, 30), nearest.distance};
}

}  // namespace burr::app

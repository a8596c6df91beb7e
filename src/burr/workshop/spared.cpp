#include "burr/workshop/spared.h"

#include <algorithm>
#include <sstream>

namespace burr::workshop {
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

}  // namespace burr::workshop

// io/read/yaml.h - a YAML file as a tree of texts. Parsed by libyaml, event by event; an alias
// (*name) is kept as such and not expanded, so the tree is no larger than the file. Internal to io.
//
// Thread: any. Errors: one sentence.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::io {

struct Yaml {
  enum class Kind { text, list, map, alias };
  Kind kind = Kind::text;
  std::string text;               // of a text; of an alias its name
  std::vector<std::string> keys;  // of a map, one for each value
  std::vector<Yaml> values;       // of a list or a map

  // The first value of that key in a map; nullptr: there is none, or this is no map.
  [[nodiscard]] const Yaml* find(std::string_view key) const;
};

// The first document of the text.
[[nodiscard]] Result<Yaml> parse_yaml(std::string_view text, std::string_view file);

}  // namespace burr::io

// net/field_name.h - the name of a field of a head. Capital and small letters are the same there; burr keeps small ones.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::net {

[[nodiscard]] inline std::string small_letters(std::string_view name) {
  std::string out(name);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

}  // namespace burr::net

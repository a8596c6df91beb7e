// A page opens a recording by its index alone, and reads a chunk when a moment needs it: to unpack all of a
// long one would take a minute of one thread. Damage is then found, and said, at the moment it concerns.
// In place of record/mcap/whole_chunks.cpp.
#include "burr/record/mcap/whole_chunks.h"

namespace burr::record {

std::vector<std::uint8_t> whole_chunks(const McapReader&, const std::vector<std::size_t>& chunks) {
  return std::vector<std::uint8_t>(chunks.size(), 1);
}

}  // namespace burr::record

#include "burr/record/text_sums.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "burr/base/hash.h"
#include "burr/record/schema.h"

namespace burr::record {

bool is_summed(std::string_view topic) {
  const auto is_it = [topic](const Topic& one) { return topic == one.name; };
  const std::array texts = {kSession, kCommands, kEvents, kViews, kCourse};
  return std::any_of(texts.begin(), texts.end(), is_it);
}

void add_to(TextSums& sums, const std::string& topic, ByteSpan text) {
  std::uint64_t hash = base::mix(0, static_cast<std::uint64_t>(text.size()));
  for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
    hash = base::mix(hash, word);
  }
  sums[topic] += hash;
}

}  // namespace burr::record

// record/text_sums.h - a sum over the texts of a recording: session, commands, view, course and events. It shows
// that one of them was changed, taken out or added, as the hashes of the ticks do for these.
//
// The sum of a topic does not depend on the order of its messages, since other programs may write them in another
// one. It stands in the account at the end of the file. Who changes a text can compute it anew: only a seal
// (record/sealer.h) is proof against that. Plain functions. Thread: any.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record {

using TextSums = std::map<std::string, std::uint64_t>;  // by topic

inline constexpr const char* kSumOf = "sum ";  // in the account: "sum /course"

[[nodiscard]] bool is_summed(std::string_view topic);
void add_to(TextSums& sums, const std::string& topic, ByteSpan text);

}  // namespace burr::record

// record/earlier_part.h - what a recorder needs to go on with a recording whose session was left: the
// session is continued, and its recording stays one file.
//
//     auto part = (*player)->earlier_part();       // of the recording as it is
//     recorder.start(path, info, nullptr, {}, &*part);
//
// The file is copied up to its last good chunk and grows from there. Its ticks are counted on, its
// ledger too, and what the bone is at the end of the earlier part is what the new one begins with.
// Plain struct. Thread: any.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "burr/record/counted_on.h"
#include "burr/record/recording_stats.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"
#include "burr/record/text_sums.h"

namespace burr::record {

struct EarlierPart {
  std::string file;         // the recording
  SessionInfo info;         // Player::info() of it
  std::string sha1;         // of that file as it is, 40 digits; empty: nobody asks
  std::uint64_t ticks = 0;  // the first one of the new part
  PartEnd hand, second;     // of both hands, at the end
  // Where the bone differs from the one that the recording began with.
  std::unordered_map<volume::BrickIndex, BrickContent> bricks;
  std::uint64_t batch = 0;  // the last one of the changes
  TextSums sums;            // of its texts
  RecordingStats account;   // of what is in the file, and of what is missing in it
};

// May a recording of `was` go on with a session of `is`? Error: a sentence that says what differs and
// that readers of the file could not know of.
[[nodiscard]] Status goes_on(const SessionInfo& was, const SessionInfo& is);

class McapReader;
class McapWriter;
// Copies everything but its account, and of the chunks those that are good. For use of this room only.
[[nodiscard]] Status copy_earlier_part(const McapReader& from, McapWriter& to);

}  // namespace burr::record

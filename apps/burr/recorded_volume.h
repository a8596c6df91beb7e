// apps/burr/recorded_volume.h - which bone a session was cut from: said when it is recorded, found
// again when the recording is opened.
//
// A recording names the volume by hashes and by the options it was opened with, never by path or
// UID. What cannot be written down for that reason (a series given by its UID, a tissue table) has
// to be given again; the Error says so.
#pragma once

#include <memory>

#include "burr/record/player.h"
#include "burr/record/session_info.h"
#include "volume_options.h"

namespace burr::app {

// For SessionInfo::volume. opened: what open_volume(options) made, not cut yet.
[[nodiscard]] Result<record::VolumeInfo> volume_info(const VolumeOptions& options,
                                                     const io::Imported& opened);

// The bone as it was before the first tick, with room for the session's deposits: the one in the
// recording, or made again from the user's own volume and held against its hash.
// given: what the user says now; an empty path: search (record::find_volume), other empty options:
// as recorded.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> recorded_bone(const record::Player& player,
                                                                  const VolumeOptions& given,
                                                                  Progress& progress);

}  // namespace burr::app

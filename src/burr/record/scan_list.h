// record/scan_list.h - where the scans of this computer lie that recordings were made from.
//
//     remember_scan(list, {print, bone.content_hash(), "/scans/ct.nrrd"});  // a session is recorded
//     for (const std::string& path : remembered(list, info.volume)) ...     // it is opened elsewhere
//
// A recording names its bone by hashes only. This list leads from the hashes to the path. It is one
// text file in the user's state folder, ~/.local/state/burr/scans.txt, which only the user can
// read. It never goes into a recording. Each writer reads the list again behind a lock and replaces
// the file as a whole, so two sessions that begin at the same time keep both entries. It holds at
// most 1000 entries; the oldest go first.
//
// The list only says where to look: find_volume() compares the fingerprint, check_volume() the
// content. Thread: any. Errors: sentences; a list that cannot be read counts as empty.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/session_info.h"

namespace burr::record {

struct RememberedScan {
  std::uint64_t fingerprint = 0;   // of the file or folder, see find_volume.h
  std::uint64_t content_hash = 0;  // of the bone that was made from it
  std::string path;                // may be relative; kept as absolute
};

// The list of this user. "": nothing is remembered, because BURR_REMEMBER_SCANS is 0, or because
// there is no home folder.
[[nodiscard]] std::string scan_list();
[[nodiscard]] std::string scan_list(const std::filesystem::path& state);  // in that folder

// Puts the scan on top of the list. With an empty list it does nothing.
Status remember_scan(const std::string& list, const RememberedScan& scan);

// Paths that may hold the bone, the likeliest first. They may be gone, or hold something else now.
[[nodiscard]] std::vector<std::string> remembered(const std::string& list,
                                                  const VolumeInfo& wanted);

// Removes all entries of a path that is gone or holds something else.
Status forget_scan(const std::string& list, const std::string& path);

}  // namespace burr::record

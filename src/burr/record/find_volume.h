// record/find_volume.h - finds the bone of a recording, which names it by its hash only.
//
// The content hash is that of the bone after import; it takes too long to compute it for every
// file. So a cheap fingerprint of the raw file picks the candidates, and check_volume() decides.
// Thread: any. Errors: one sentence for the user.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/session_info.h"
#include "burr/volume/bone.h"

namespace burr::record {

// Of a file: from its size, its first and last 16 KiB. Of a folder (a DICOM series): from all files
// in it, whatever their names and order, without hidden files and the files that burr writes
// (.mcap, .part, .png, .stl, .ply, .obj, .3mf, .glb, .json, .csv). Never 0.
[[nodiscard]] Result<std::uint64_t> fingerprint(const std::string& path);

struct VolumeHints {
  std::string given;        // --volume; empty: search
  std::string search_path;  // folders, separated by :; see volume_search_path()
  std::string recording;    // its folder and the working folder are searched too
  std::string list = {};    // of the scans of this computer, see scan_list.h; empty: none
};

// BURR_VOLUME_PATH, or "".
[[nodiscard]] std::string volume_search_path();

// The file or folder from which the recording's bone was read. Searches the folders of the search
// path and that of the recording, then the list, then the working folder: each folder itself (as a
// DICOM series), the volumes in it, and its subfolders, two levels down. An entry of the list that
// is gone or has another fingerprint is forgotten. Error: not found, and what to do. With
// hints.given that one is returned even if its fingerprint differs; check_volume() then decides.
[[nodiscard]] Result<std::string> find_volume(const VolumeInfo& wanted, const VolumeHints& hints);

// Checks that this is exactly the bone at the start of the session. The Error says what differs.
[[nodiscard]] Status check_volume(const VolumeInfo& wanted, const volume::Bone& bone,
                                  const std::string& where);

}  // namespace burr::record

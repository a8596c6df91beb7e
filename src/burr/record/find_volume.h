// record/find_volume.h - where the bone of a recording may be: a recording names it by hash only.
//
// The content hash is that of the bone after import, too slow to compute for every file around. So
// a cheap fingerprint of the raw file picks the candidates, and check_volume() has the last word.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/session_info.h"
#include "burr/volume/bone.h"

namespace burr::record {

// Of a file: its size, its first and last 16 KiB. Of a folder (a DICOM series): of all files in it,
// whatever their names and order, but not of hidden files and of what burr writes (.mcap, .part,
// .png, .stl, .ply, .obj, .3mf, .glb, .json, .csv). Never 0.
[[nodiscard]] Result<std::uint64_t> fingerprint(const std::string& path);

struct VolumeHints {
  std::string given;        // --volume; empty: search
  std::string search_path;  // folders with : between; see volume_search_path()
  std::string recording;    // its folder is searched too, and the working folder
};

// BURR_VOLUME_PATH, or "".
[[nodiscard]] std::string volume_search_path();

// The file or folder the recording's bone was read from. Searched: each folder itself (as a DICOM
// series), the volumes in it, and the folders in it, two levels down. Error: not found, and what to
// do. With hints.given that one is taken, found alike or not; check_volume() then decides.
[[nodiscard]] Result<std::string> find_volume(const VolumeInfo& wanted, const VolumeHints& hints);

// Is this the bone the session began with, to the bit? The Error says what differs.
[[nodiscard]] Status check_volume(const VolumeInfo& wanted, const volume::Bone& bone,
                                  const std::string& where);

}  // namespace burr::record

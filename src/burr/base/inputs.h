// base/inputs.h - the files that this process has read. burr never writes over one of them.
//
//     base::note_input("scan.nrrd");                       // when it is read
//     Status allowed = base::check_not_input("link.nrrd"); // an Error if this is the same file
//
// A file is known by device and inode, so links and other spellings of its name are seen through.
// NewFile calls check_not_input(), therefore no writer can forget it. Commands check earlier,
// before the work (apps/burr/shared/outputs.h). Thread: any; takes a lock, not for the 1 kHz
// path.
#pragma once

#include <string>

#include "burr/base/result.h"

namespace burr::base {

// True: both names are the same file or folder, by device and inode.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

// True: `path` exists and lies in `folder`, at any depth, links resolved.
[[nodiscard]] bool lies_in(const std::string& path, const std::string& folder);

// A file that was read; a name that is no regular file is ignored.
void note_input(const std::string& path);

// Error: a noted file.
[[nodiscard]] Status check_not_input(const std::string& path);

}  // namespace burr::base

// base/plain_file.h - a name that a person gave, where burr needs a file: not a pipe, a socket, a device or a
// folder. Opening a pipe waits until somebody writes to it, perhaps for ever; opening a device can have an
// effect.
//
//     if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
//
//     auto file = base::open_plain_file(path);       // the check holds for what was opened
//
// Whoever opens a name that comes from outside does one of these first. Links are followed. Thread: any.
#pragma once

#include <sys/types.h>

#include <string>

#include "burr/base/handle.h"
#include "burr/base/result.h"

namespace burr::base {

// "is a pipe, ..." as the end of a sentence after the file's name; "": it is a file.
[[nodiscard]] std::string no_plain_file(mode_t mode);

// Error: something else than a file stands there. Fine: a file, or nothing. shown: the name in the sentence;
// empty: the path.
[[nodiscard]] Status check_plain_file(const std::string& path, const std::string& shown = {});

// Opens for reading, and does not wait.
[[nodiscard]] Result<Handle> open_plain_file(const std::string& path,
                                             const std::string& shown = {});

// The bytes from here on, `most` at most.
[[nodiscard]] Result<std::string> bytes_of(const Handle& file, std::size_t most,
                                           const std::string& shown);

}  // namespace burr::base

// io/read/several_volumes.h - a file that holds several volumes of one place (times, directions, channels):
// which of them is read. Internal to io.
//
// Thread: any.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

// The index of the volume that ReadOptions::series names by its number, "3" or "#3". Where it names
// none, the first, with a question that says how many there are; they are listed in Scan::series.
// Error: there is no such volume.
[[nodiscard]] Result<std::uint64_t> take_volume(std::uint64_t count, const ReadOptions& options,
                                                const std::string& file, Scan& scan);

// Where the numbers of one volume lie among those of all: `length` of each `period`, from `from` on.
struct Share {
  std::uint64_t from = 0, length = 1, period = 1;
  [[nodiscard]] bool all() const { return length == period; }
};
// index of `count` volumes; before: the product of the sizes of the axes before that of the volumes
[[nodiscard]] inline Share share_of(std::uint64_t index, std::uint64_t count,
                                    std::uint64_t before) {
  return {index * before, before, count * before};
}

// The bytes of one volume among those of all; the numbers of `share` are bytes.
[[nodiscard]] std::unique_ptr<ByteSource> only_share(std::unique_ptr<ByteSource> all,
                                                     const Share& share);

}  // namespace burr::io

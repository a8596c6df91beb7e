// io/sandbox/fence_letter.h - what the two sides of the fence say to each other. A header of this room
// only.
//
// The letter is a piece of shared memory of fixed size: the request lies in it before the reader
// starts, the outcome when it is done. Voxels lie in further pieces, lent on request. All else are
// messages of one fixed form over a socket, so that neither side ever waits for a length the other
// one claims. The asking side believes nothing: not a number, not a size, not a letter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "burr/base/result.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/scan.h"

namespace burr::io {

inline constexpr std::size_t kLetterBytes = std::size_t{4} << 20;
inline constexpr int kFenceSocket = 0, kFenceLetter = 3;  // handles the reader is started with
inline constexpr std::uint32_t kMostLoans = 32;

struct FenceMessage {
  enum Kind : std::uint32_t {
    ready = 1,  // reader: the walls stand; bytes: memory limit, value: seconds
    want,       // reader: lend me `bytes`
    lent,       // asker: here they are, as loan `loan`, its handle comes along
    refused,    // asker: no
    back,       // reader: loan `loan` is not needed any more
    report,     // reader: value: 0..1, words: the stage
    done,       // reader: the outcome lies in the letter, `bytes` long
    stranger,   // reader: the letter is of another version of burr
    no_walls,   // reader: the kernel offers a wall but refuses to put it up
  };
  std::uint32_t kind = 0;
  std::uint32_t loan = 0;
  std::uint64_t bytes = 0;
  double value = 0;
  char words[104] = {};
};
static_assert(sizeof(FenceMessage) == 128);

struct FenceRequest {
  std::string path;
  ReadOptions options;
};

// A scan without its voxels, or an error.
struct FenceOutcome {
  Result<Scan> scan = error(Trouble::internal, "nothing was read");
  // which loans hold the voxels, and how many; number 0: none
  std::uint32_t values_loan = 0, labels_loan = 0;
  std::uint64_t values = 0, labels = 0;
};

// Writes into a letter; returns the bytes used, 0 where they do not fit.
[[nodiscard]] std::size_t pack(const FenceRequest& request, std::span<std::uint8_t> letter);
[[nodiscard]] std::size_t pack(const FenceOutcome& outcome, std::span<std::uint8_t> letter);

// False: the bytes are not what they should be; nothing of them may be used.
[[nodiscard]] bool unpack(std::span<const std::uint8_t> bytes, FenceRequest& request);
[[nodiscard]] bool unpack(std::span<const std::uint8_t> bytes, FenceOutcome& outcome);

}  // namespace burr::io

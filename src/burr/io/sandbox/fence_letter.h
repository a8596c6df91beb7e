// io/sandbox/fence_letter.h - the messages between the two sides of the fence. For use of this room
// only.
//
// The letter is a piece of shared memory of fixed size. It holds the request before the reader
// starts, and the outcome when the reader is done. Voxels lie in further pieces of memory, which
// the reader asks for. Everything else is a message of one fixed form over a socket, so that
// neither side ever waits for a length that the other side claims. The asking side checks
// everything it receives: every number, every size, every letter.
// Thread: any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "burr/base/result.h"
#include "burr/io/read/read_options.h"
#include "burr/io/scan.h"

namespace burr::io {

inline constexpr std::size_t kLetterBytes = std::size_t{4} << 20;
inline constexpr int kFenceSocket = 0, kFenceLetter = 3;  // file descriptors the reader is started
                                                          // with
inline constexpr std::uint32_t kMostLoans = 32;

struct FenceMessage {
  enum Kind : std::uint32_t {
    ready = 1,  // reader: the limits are in force; bytes: memory limit, value: seconds
    want,       // reader: asks for `bytes` of memory
    lent,       // asker: the memory, with number `loan` and its file descriptor
    refused,    // asker: no
    back,       // reader: loan `loan` is no longer needed
    report,     // reader: progress; value: 0..1, words: the stage
    done,       // reader: the outcome is in the letter, `bytes` long
    stranger,   // reader: the letter comes from another version of burr
    no_walls,   // reader: the kernel supports a limit but refuses to set it
    mesh,       // reader: loan `loan` holds `bytes` points of three floats, then `value` triangles
                // of three numbers of points
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
  bool mesh = false;  // a mesh is asked for, no scan; its options count for nothing
};

// A scan without its voxels, or an error.
struct FenceOutcome {
  Result<Scan> scan = error(Trouble::internal, "nothing was read");
  // numbers of the loans that hold the voxels, and how many voxels; loan 0: none
  std::uint32_t values_loan = 0, labels_loan = 0;
  std::uint64_t values = 0, labels = 0;
};

// Writes into a letter. Returns the bytes used, or 0 if they do not fit.
[[nodiscard]] std::size_t pack(const FenceRequest& request, std::span<std::uint8_t> letter);
[[nodiscard]] std::size_t pack(const FenceOutcome& outcome, std::span<std::uint8_t> letter);

// False: the bytes are not valid, and nothing of them may be used.
[[nodiscard]] bool unpack(std::span<const std::uint8_t> bytes, FenceRequest& request);
[[nodiscard]] bool unpack(std::span<const std::uint8_t> bytes, FenceOutcome& outcome);

}  // namespace burr::io

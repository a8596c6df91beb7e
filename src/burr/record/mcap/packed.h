// record/mcap/packed.h - zstd, with a limit on the memory that a false header can make us allocate.
//
// Thread: unpack() any.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/mcap/mcap_bytes.h"

namespace burr::record {

// Reuses its working memory from call to call. Thread: one at a time.
class Packer {
 public:
  explicit Packer(int level = 1);
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  // Appends the packed bytes to `out`; one zstd frame.
  void pack(ByteSpan bytes, std::vector<std::uint8_t>& out);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

// One frame of zstd or several. False: not zstd, damaged, or not exactly `size` bytes long. Above 32 MiB
// memory grows only as bytes really come out, so a header that promises gigabytes costs nothing.
[[nodiscard]] bool unpack(ByteSpan packed, std::uint64_t size, std::vector<std::uint8_t>& out);

}  // namespace burr::record

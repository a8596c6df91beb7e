// Decompression: gzip, zlib, deflate without header, bzip2 and zstd. The first byte chooses, and
// sets how much is requested at once; zstd also gets the expected length.
#include <vector>

#include "burr/io/read/bytes.h"
#include "burr/record/mcap/packed.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  constexpr std::size_t kMost = std::size_t{1} << 24;  // to unpack more of a bomb shows nothing new
  fuzz::Pieces in({data, size});
  const std::uint8_t choice = in.byte();
  if (choice % 5 == 4) {
    const std::uint64_t wanted = in.word();
    std::vector<std::uint8_t> out;
    if (record::unpack(in.rest(), wanted, out))
      fuzz::must(out.size() == wanted, "as long as it was said");
    return 0;
  }
  const fuzz::Bytes packed = in.rest();
  auto source = io::memory_source({packed.begin(), packed.end()});
  if (choice % 5 == 0) source = io::gunzip(std::move(source));
  if (choice % 5 == 1) source = io::inflate_zlib(std::move(source));
  if (choice % 5 == 2) source = io::inflate_raw(std::move(source));
  if (choice % 5 == 3) source = io::bunzip2(std::move(source));
  std::vector<std::uint8_t> block(std::size_t{1} << (choice / 5 % 17));
  for (std::size_t total = 0; total < kMost;) {
    const auto got = source->read(block.data(), block.size());
    fuzz::look_at_error(got);
    if (!got || *got == 0) break;
    fuzz::must(*got <= block.size(), "no more than was asked for");
    total += *got;
  }
  return 0;
}

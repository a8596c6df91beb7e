#include "burr/record/mcap/whole_chunks.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "burr/rt/thread.h"

namespace burr::record {

std::vector<std::uint8_t> whole_chunks(const McapReader& reader,
                                       const std::vector<std::size_t>& chunks) {
  constexpr unsigned kMostThreads = 4;
  std::vector<std::uint8_t> whole(chunks.size());
  std::atomic<std::size_t> next{0};
  const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads);
  rt::on_threads(static_cast<int>(threads), [&](int) {
    for (std::size_t n = next++; n < whole.size(); n = next++)
      whole[n] = reader.read_chunk(chunks[n]).ok() ? 1 : 0;
  });
  return whole;
}

}  // namespace burr::record

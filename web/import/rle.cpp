// DICOM's run lengths (PS3.5, annex G): each byte of the values in a part of its own, the highest first.
#include <algorithm>

#include "unpack.h"

namespace burr::web {

bool unpack_rle(std::span<const std::uint8_t> bytes, int width, Unpacked& to) {
  constexpr std::size_t kHead = 64;
  if (bytes.size() < kHead || width < 1 || width > 4) return false;
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16) |
           static_cast<std::uint32_t>(bytes[at + 3]) << 24;
  };
  if (number(0) != static_cast<std::uint32_t>(width)) return false;
  const auto count = static_cast<std::size_t>(to.columns) * static_cast<std::size_t>(to.rows);
  std::vector<std::uint32_t> values(count);
  for (std::size_t part = 0; part < static_cast<std::size_t>(width); ++part) {
    const std::size_t from = number(4 + 4 * part);
    const std::size_t end = part + 1 < static_cast<std::size_t>(width)
                                ? std::size_t{number(8 + 4 * part)}
                                : bytes.size();
    if (from < kHead || from > end || end > bytes.size()) return false;
    std::size_t at = from, done = 0;
    while (done < count && at < end) {
      const int head = static_cast<std::int8_t>(bytes[at++]);
      if (head == -128) continue;
      const auto length = static_cast<std::size_t>(head >= 0 ? head + 1 : 1 - head);
      if (at + (head >= 0 ? length : 1) > end) return false;
      for (std::size_t n = 0; n < length && done < count; ++n, ++done)
        values[done] = values[done] << 8 | bytes[head >= 0 ? at + n : at];
      at += head >= 0 ? length : 1;
    }
    if (done < count) return false;
  }
  to.values.resize(count);
  std::transform(values.begin(), values.end(), to.values.begin(),
                 [](std::uint32_t one) { return static_cast<std::int32_t>(one); });
  return true;
}

}  // namespace burr::web

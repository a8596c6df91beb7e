#include "burr/base/base64.h"

#include <cstddef>
#include <cstdint>

namespace burr::base {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    std::uint32_t three = 0;
    for (std::size_t m = 0; m < 3; ++m)
      three = three << 8 | (n + m < bytes.size() ? static_cast<unsigned char>(bytes[n + m]) : 0U);
    for (std::size_t m = 0; m < 4; ++m)
      text += n + m > bytes.size() ? '=' : kDigits[three >> (18 - 6 * m) & 63U];
  }
  return text;
}

}  // namespace burr::base

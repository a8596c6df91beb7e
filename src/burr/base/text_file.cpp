#include "burr/base/text_file.h"
#include "burr/base/plain_file.h"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace burr::base {

Result<std::string> text_of_file(const std::string& path, std::uintmax_t most,
                                 std::string_view for_what) {
  const std::string file = std::filesystem::path(path).filename().string();
  if (const Status plain = check_plain_file(path, file); !plain) return plain.error();
  std::error_code trouble;
  const auto size = std::filesystem::file_size(path, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be read: {}", file, trouble.message()));
  if (size > most)
    return error(fmt::format("{}: the file is too large ({} bytes) for {}", file, size, for_what));
  std::ifstream stream(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) return error(Trouble::io, fmt::format("{}: cannot be read", file));
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return error(fmt::format("{}: is text in UTF-16; save it as UTF-8", file));
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // a byte-order mark, as Excel writes it
  return text;
}

}  // namespace burr::base

// A zip archive: its table, and every file inside as far as its first megabyte.
#include <vector>

#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const std::string& path = fuzz::as_file("a.zip", {data, size});
  io::set_files_inside(nullptr);
  const Status opened = io::open_archive(path);
  fuzz::look_at_error(opened);
  if (!opened) return 0;
  const auto files = io::files_in_archive(path);
  fuzz::must(files.has_value() && !files->empty(), "an archive that opens has files");
  for (const auto& file : *files) {
    fuzz::must(file.lexically_normal().string().starts_with(path), "no name leads out");
    constexpr std::size_t kMost = std::size_t{1} << 20;
    const auto bytes = io::first_bytes(file, kMost);
    fuzz::look_at_error(bytes);
    fuzz::must(!bytes || bytes->size() <= kMost, "no more bytes than were asked for");
  }
  return 0;
}

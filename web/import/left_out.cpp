// What a page leaves out of reading scans. In place of io/read/read_adf.cpp, picture_stack.cpp, png.cpp, tiff.cpp, yaml.cpp
// and of libraries.
#include "left_out.h"

#include <emscripten.h>

#include <cstdlib>

#include "burr/io/read/foreign.h"
#include "burr/io/read/picture_stack.h"
#include "burr/io/read/readers.h"

// clang-format off
EM_JS(void, burr_leave_out, (const char* key, const char* part), {
  throw Object.assign(new Error(UTF8ToString(key)), {why: UTF8ToString(key), parts: [UTF8ToString(part)]});
});
// clang-format on

namespace burr::web {

void leave_out(const char* key, const char* part) {
  burr_leave_out(key, part);
  std::abort();
}

}  // namespace burr::web

namespace burr::io {

Result<Scan> read_adf(const std::filesystem::path&, const ReadOptions&, Progress&) {
  web::leave_out("no_pictures", "");
}
Result<Scan> read_picture(const std::filesystem::path&, const ReadOptions&, Progress&) {
  web::leave_out("no_pictures", "");
}
Result<Scan> read_picture_stack(const std::vector<std::filesystem::path>&, const std::string&,
                                const ReadOptions&, Progress&) {
  web::leave_out("no_pictures", "");
}
// By their names alone.
std::vector<std::filesystem::path> pictures_among(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> out;
  for (const auto& path : files)
    if (named_as_picture(path)) out.push_back(path);
  return out;
}
Result<bool> describes_pictures(const std::filesystem::path&) { return true; }

}  // namespace burr::io

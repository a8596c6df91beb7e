// What a page leaves out of reading scans. In place of io/read/read_adf.cpp, png.cpp, yaml.cpp and of libraries.
#include "left_out.h"

#include <emscripten.h>

#include <cstdlib>

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
Result<bool> describes_pictures(const std::filesystem::path&) { return true; }

}  // namespace burr::io

// MetaImage: header, data after it or "beside" it (the file may be named as its own data).
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  static_cast<void>(fuzz::read_scan_bytes(io::read_meta, "a.mhd", {data, size}));
  return 0;
}

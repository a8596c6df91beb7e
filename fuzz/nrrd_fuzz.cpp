// NRRD: header, attached data, and data "beside" it (the file may be named as its own data).
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  static_cast<void>(fuzz::read_scan_bytes(io::read_nrrd, "a.nrrd", {data, size}));
  return 0;
}

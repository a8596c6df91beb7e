// One TIFF file of several pages: its directories, its description by ImageJ or OME, and its pixels.
#include "burr/io/read/picture_stack.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  static_cast<void>(fuzz::read_scan_bytes(io::read_picture, "a.tif", {data, size}));
  return 0;
}

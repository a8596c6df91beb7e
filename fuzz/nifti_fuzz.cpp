// NIfTI-1 and -2, compressed or not, one file or a pair (then the same bytes are its image).
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const fuzz::Bytes bytes(data, size);
  // if it begins like the header of a pair, read it as a pair with itself
  if (size > 348 && bytes[344] == 'n' && bytes[345] == 'i') fuzz::as_file("a.img", bytes);
  static_cast<void>(fuzz::read_scan_bytes(io::read_nifti, "a.hdr", bytes));
  return 0;
}

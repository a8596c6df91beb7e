// One DICOM file: the header with any structure, plain and deflated pixels. Compressed pixels (JPEG
// and the like) are decoded by another library, behind the fence.
#include "burr/io/read/dicom_header.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const std::string& path = fuzz::as_file("a.dcm", {data, size});
  const auto header = io::read_dicom_header(path);
  fuzz::look_at_error(header);
  if (!header) return 0;
  fuzz::must(header->frames.size() == static_cast<std::size_t>(header->frame_count),
             "a header has the facts of every frame");
  if (header->encapsulated) return 0;
  NoProgress progress;
  const auto scan = io::read_dicom(path, {}, progress);
  fuzz::look_at_error(scan);
  if (scan) fuzz::look_at(*scan);
  return 0;
}

// The table of tissues (TOML), with a label map that has labels 1 to 3.
#include "burr/importing/tissues.h"

#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  io::Scan scan;
  scan.label_names = {{.value = 1, .name = "Facial nerve"}, {.value = 2, .name = "bone"}};
  std::array<bool, 256> present{};
  present[0] = present[1] = present[2] = present[3] = true;
  const auto tissues =
      importing::label_tissues(scan, present, fuzz::as_file("a.toml", {data, size}));
  fuzz::look_at_error(tissues);
  if (tissues) fuzz::look_at(tissues->table);
  return 0;
}

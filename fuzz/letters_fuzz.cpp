// Names: a line with a Specific Character Set of DICOM, then two names.
#include "burr/io/read/letters.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  fuzz::Pieces in({data, size});
  const std::string_view set = in.line(), a = in.line(), b = fuzz::text_of(in.rest());
  // three bytes of UTF-8 for each byte at most
  fuzz::must(io::utf8_of_dicom(b, set).size() <= 3 * b.size(), "no text grows without end");
  fuzz::must(io::utf8_of_name(b).size() <= 3 * b.size(), "no name grows without end");
  const std::string slashed = io::with_slashes(std::string(b));
  fuzz::must(slashed.size() == b.size(), "slashes take the place of backslashes");
  fuzz::must(io::same_name(b, b), "a name is itself");
  fuzz::must(io::same_name(a, b) == io::same_name(b, a),
             "of two names each is the other, or neither");
  return 0;
}

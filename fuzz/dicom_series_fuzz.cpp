// A folder of DICOM slices with valid files but invalid facts: positions, directions, spacings,
// numbers. Each line of the input sets one fact of the present slice ("p=0\0\1.5"); "x" ends a
// slice.
#include <array>
#include <filesystem>
#include <map>
#include <vector>

#include "burr/record/mcap/mcap_bytes.h"
#include "support.h"

namespace {

using namespace burr;

struct Element {
  std::uint32_t tag;
  const char* vr;
  char key;
  const char* value;
};
constexpr std::array<Element, 25> kElements = {{
    {0x00080008, "CS", 'y', "ORIGINAL\\PRIMARY\\AXIAL"},
    {0x00080060, "CS", 'n', "CT"},
    {0x0008103E, "LO", 'd', ""},
    {0x00180050, "DS", 't', "1.5"},
    {0x00180088, "DS", 'b', ""},
    {0x00181210, "SH", 'k', ""},
    {0x0020000E, "UI", 'u', "1.2.3"},
    {0x00200011, "IS", 'e', "1"},
    {0x00200012, "IS", 'a', "1"},
    {0x00200013, "IS", 'i', "1"},
    {0x00200032, "DS", 'p', "0\\0\\0"},
    {0x00200037, "DS", 'o', "1\\0\\0\\0\\1\\0"},
    {0x00280004, "CS", 'h', "MONOCHROME2"},
    {0x00280008, "IS", 'f', ""},
    {0x00280030, "DS", 's', "0.5\\0.5"},
    {0x00281052, "DS", 'c', "-1024"},
    {0x00281053, "DS", 'm', "1"},
    {0x00080018, "UI", 'g', ""},
    {0x00080032, "TM", 'w', ""},
    {0x00181060, "DS", 'r', ""},
    {0x00182005, "DS", 'v', ""},
    {0x00200052, "UI", 'j', ""},
    {0x00200100, "IS", 'q', ""},
    {0x00201041, "DS", 'l', ""},
    {0x00209157, "UL", 'z', ""},
}};
constexpr int kRows = 2, kColumns = 3, kMostSlices = 6, kMostFrames = 8;

void put_head(record::BytesOut& out, std::uint32_t tag, const char* vr, std::size_t length) {
  out.put(static_cast<std::uint16_t>(tag >> 16));
  out.put(static_cast<std::uint16_t>(tag));
  out.raw(vr, 2);
  out.put(static_cast<std::uint16_t>(length));
}

void put_number(record::BytesOut& out, std::uint32_t tag, int value) {
  put_head(out, tag, "US", 2);
  out.put(static_cast<std::uint16_t>(value));
}

record::BytesOut slice(const std::map<char, std::string>& facts) {
  record::BytesOut out;
  out.raw(record::as_bytes(std::string(128, '\0') + "DICM"));
  put_head(out, 0x00020010, "UI", 20);
  out.raw(record::as_bytes(std::string_view("1.2.840.10008.1.2.1\0", 20)));
  for (const Element& element : kElements) {
    const auto own = facts.find(element.key);
    std::string value = own == facts.end() ? element.value : own->second;
    if (value.empty()) continue;
    value.resize(std::min<std::size_t>((value.size() + 1) / 2 * 2, 512), ' ');
    put_head(out, element.tag, element.vr, value.size());
    out.raw(record::as_bytes(value));
  }
  put_number(out, 0x00280002, 1);
  put_number(out, 0x00280010, kRows);
  put_number(out, 0x00280011, kColumns);
  put_number(out, 0x00280100, 16);
  put_number(out, 0x00280101, 16);
  put_number(out, 0x00280102, 15);
  put_number(out, 0x00280103, 1);
  const auto frames = facts.find('f');
  const int count =
      frames == facts.end() ? 1 : std::clamp(std::atoi(frames->second.c_str()), 1, kMostFrames);
  const std::uint32_t length = static_cast<std::uint32_t>(kRows * kColumns * 2 * count);
  put_head(out, 0x7FE00010, "OW", 0);
  out.put(length);
  for (std::uint32_t n = 0; n < length / 2; ++n) out.put(static_cast<std::uint16_t>(n * 311));
  return out;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string place = [] {
    std::filesystem::create_directory(fuzz::folder() + "/series");
    return fuzz::folder() + "/series";
  }();
  fuzz::Pieces in({data, size});
  std::map<char, std::string> facts;
  int slices = 0;
  const auto write = [&] {
    fuzz::as_file("series/" + std::to_string(slices++) + ".dcm", slice(facts).span());
  };
  while (!in.empty() && slices < kMostSlices - 1) {
    const std::string_view line = in.line();
    if (line == "x") write();
    if (line.size() >= 2 && line[1] == '=') facts[line[0]] = line.substr(2);
  }
  write();
  for (int n = slices; n < kMostSlices; ++n)
    std::filesystem::remove(place + "/" + std::to_string(n) + ".dcm");

  NoProgress progress;
  const auto scan = io::read_dicom(place, {}, progress);
  fuzz::look_at_error(scan);
  if (scan) fuzz::look_at(*scan);
  return 0;
}

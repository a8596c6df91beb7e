// A structure set (RTSTRUCT) beside a small CT: valid as a file, with odd structures, types, points and planes. Each line of
// the input sets one fact ("d=0\0\0\1\0\0\0\1\0", the points of a contour); "c" writes a contour with the facts so far,
// "s" a structure with the contours so far; "x" and what follows are the bytes of a whole file instead.
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "burr/io/read/readers.h"
#include "support.h"

namespace {

using namespace burr;
using std::string;

constexpr std::size_t kMostContours = 40, kMostStructures = 12;

string number16(std::size_t v) {
  return {static_cast<char>(v & 0xFF), static_cast<char>(v >> 8 & 0xFF)};
}
string number32(std::size_t v) { return number16(v & 0xFFFF) + number16(v >> 16 & 0xFFFF); }
string element(std::uint32_t tag, const string& vr, string text) {
  text.resize((std::min<std::size_t>(text.size(), 60000) + 1) / 2 * 2, ' ');
  string out = number16(tag >> 16) + number16(tag & 0xFFFF) + vr;
  if (vr == "OW") return out + number16(0) + number32(text.size()) + text;
  return out + number16(text.size()) + text;
}
string sequence(std::uint32_t tag, const std::vector<string>& items) {
  string all;
  for (const string& item : items) all += number32(0xE000FFFE) + number32(item.size()) + item;
  return number16(tag >> 16) + number16(tag & 0xFFFF) + "SQ" + number16(0) + number32(all.size()) +
         all;
}
string start() {
  return string(128, '\0') + "DICM" +
         element(0x00020010, "UI", string("1.2.840.10008.1.2.1\0", 20));
}

string slice(int k) {
  return start() + element(0x00080060, "CS", "CT") + element(0x00180050, "DS", "1") +
         element(0x0020000E, "UI", "1.3") + element(0x00200013, "IS", std::to_string(k + 1)) +
         element(0x00200032, "DS", "0\\0\\" + std::to_string(k)) +
         element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + element(0x00200052, "UI", "1.5") +
         element(0x00280002, "US", number16(1)) + element(0x00280010, "US", number16(7)) +
         element(0x00280011, "US", number16(9)) + element(0x00280030, "DS", "1\\1") +
         element(0x00280100, "US", number16(16)) + element(0x00280101, "US", number16(16)) +
         element(0x00280102, "US", number16(15)) + element(0x00280103, "US", number16(0)) +
         element(0x7FE00010, "OW", string(2 * 7 * 9, '\3'));
}

class Facts {
 public:
  string& operator[](char key) { return all_[key]; }
  [[nodiscard]] string text(char key) const {
    const auto found = all_.find(key);
    return found == all_.end() ? string() : found->second;
  }

 private:
  std::map<char, string> all_ = {{'t', "CLOSED_PLANAR"},
                                 {'n', "1"},
                                 {'l', "Bone"},
                                 {'f', "1.5"},
                                 {'d', "1\\1\\1\\6\\1\\1\\6\\5\\1\\1\\5\\1"}};
};

// The whole file of these lines.
string file_of(fuzz::Pieces& in) {
  Facts facts;
  std::vector<string> contours, structures, drawn, seen;
  while (!in.empty()) {
    const std::string_view line = in.line();
    if (line == "x") {
      const fuzz::Bytes rest = in.rest();
      return {reinterpret_cast<const char*>(rest.data()), rest.size()};
    }
    if (line == "c" && contours.size() < kMostContours)
      contours.push_back(element(0x30060042, "CS", facts.text('t')) +
                         element(0x30060044, "DS", facts.text('w')) +
                         element(0x30060050, "DS", facts.text('d')));
    if (line == "s" && structures.size() < kMostStructures) {
      structures.push_back(element(0x30060022, "IS", facts.text('n')) +
                           element(0x30060024, "UI", facts.text('f')) +
                           element(0x30060026, "LO", facts.text('l')));
      drawn.push_back(element(0x3006002A, "IS", facts.text('h')) + sequence(0x30060040, contours) +
                      element(0x30060084, "IS", facts.text('n')));
      seen.push_back(element(0x30060084, "IS", facts.text('n')) +
                     element(0x300600A4, "CS", facts.text('i')));
      contours.clear();
    }
    if (line.size() >= 2 && line[1] == '=')
      facts[line[0]] = string(line.substr(2, std::min<std::size_t>(line.size() - 2, 1024)));
  }
  return start() + element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3") +
         element(0x00080060, "CS", "RTSTRUCT") + element(0x0020000E, "UI", "1.9") +
         sequence(0x30060020, structures) + sequence(0x30060039, drawn) +
         sequence(0x30060080, seen);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const string place = [] {
    std::filesystem::create_directory(fuzz::folder() + "/drawn");
    for (int k = 0; k < 6; ++k) {
      const string file = slice(k);
      fuzz::as_file("drawn/" + std::to_string(k) + ".dcm",
                    {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
    }
    return fuzz::folder() + "/drawn";
  }();
  fuzz::Pieces in({data, size});
  const string file = file_of(in);
  fuzz::as_file("drawn/rs.dcm", {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  NoProgress progress;
  io::ReadOptions options;
  options.series = "#2";
  const auto scan = io::read_dicom(place, options, progress);
  fuzz::look_at_error(scan);
  if (!scan) return 0;
  fuzz::look_at(*scan);
  if (scan->format != "DICOM contours") return 0;
  fuzz::must(scan->values.empty() && scan->labels.size() == 9U * 7U * 6U,
             "contours become labels on the voxels of the scan");
  for (const io::Label& label : scan->label_names)
    fuzz::must(label.value >= 1 && label.value <= 255, "a label has a number up to 255");
  return 0;
}

// A DICOM segmentation that is valid as a file, with invalid facts: segments, references, places,
// sizes. Each line of the input sets one fact ("p=0\0\1.5"); "f" writes a frame, "n" a segment.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "burr/io/read/dicom_seg.h"
#include "support.h"

namespace {

using namespace burr;
using std::string;

constexpr std::size_t kMostFrames = 24, kMostSegments = 300;

string number16(std::size_t v) {
  return {static_cast<char>(v & 0xFF), static_cast<char>(v >> 8 & 0xFF)};
}
string number32(std::size_t v) { return number16(v & 0xFFFF) + number16(v >> 16 & 0xFFFF); }

string element(std::uint32_t tag, const string& vr, string text) {
  text.resize((std::min<std::size_t>(text.size(), 60000) + 1) / 2 * 2, ' ');
  string out = number16(tag >> 16) + number16(tag & 0xFFFF) + vr;
  if (vr == "OB" || vr == "SQ")
    out += number16(0) + number32(text.size());
  else
    out += number16(text.size());
  return out + text;
}
string sequence(std::uint32_t tag, const std::vector<string>& items) {
  string all;
  for (const string& item : items) all += number32(0xE000FFFE) + number32(item.size()) + item;
  string out = number16(tag >> 16) + number16(tag & 0xFFFF) + "SQ" + number16(0);
  return out + number32(all.size()) + all;
}

class Facts {
 public:
  string& operator[](char key) { return all_[key]; }
  [[nodiscard]] string text(char key) const {
    const auto found = all_.find(key);
    return found == all_.end() ? string() : found->second;
  }
  [[nodiscard]] std::size_t number(char key) const {
    return static_cast<std::size_t>(std::clamp(std::atoi(text(key).c_str()), 0, 65535));
  }

 private:
  std::map<char, string> all_ = {{'t', "BINARY"},
                                 {'b', "1"},
                                 {'c', "3"},
                                 {'r', "3"},
                                 {'o', "1\\0\\0\\0\\1\\0"},
                                 {'s', "0.5\\0.5"},
                                 {'k', "1"},
                                 {'p', "0\\0\\0"},
                                 {'w', "1.2.840.10008.5.1.4.1.1.66.4"}};
};

string frame_item(const Facts& facts) {
  string item = sequence(0x00209113, {element(0x00200032, "DS", facts.text('p'))});
  if (!facts.text('j').empty()) item += element(0x00200052, "UI", facts.text('j'));
  if (!facts.text('m').empty())
    item += sequence(0x0062000A, {element(0x0062000B, "US", number16(facts.number('m')))});
  return item;
}

string segment_item(const Facts& facts) {
  string item = element(0x00620004, "US", number16(facts.number('a'))) +
                element(0x00620005, "LO", facts.text('l'));
  if (!facts.text('h').empty()) item += element(0x0062000D, "US", facts.text('h'));
  if (!facts.text('e').empty())
    item += sequence(
        0x0062000F, {element(0x00080100, "SH", facts.text('e')) + element(0x00080102, "SH", "SCT") +
                     element(0x00080104, "LO", facts.text('d'))});
  return item;
}

string file_of(const Facts& facts, const std::vector<string>& frames,
               const std::vector<string>& segments, fuzz::Bytes pixels) {
  const std::size_t bits = facts.number('b');
  string out(128, '\0');
  out += "DICM" + element(0x00020010, "UI", string("1.2.840.10008.1.2.1\0", 20)) +
         element(0x00080005, "CS", facts.text('u')) + element(0x00080016, "UI", facts.text('w')) +
         element(0x00080060, "CS", "SEG") + element(0x0020000E, "UI", "1.2") +
         element(0x00200052, "UI", "1.5") + element(0x00280002, "US", number16(1)) +
         element(0x00280008, "IS", std::to_string(frames.size())) +
         element(0x00280010, "US", number16(facts.number('r'))) +
         element(0x00280011, "US", number16(facts.number('c'))) +
         element(0x00280100, "US", number16(bits)) + element(0x00280101, "US", number16(bits)) +
         element(0x00280102, "US", number16(bits == 0 ? 0 : bits - 1)) +
         element(0x00280103, "US", number16(0));
  if (!facts.text('q').empty()) out += element(0x00280120, "US", number16(facts.number('q')));
  out += element(0x00620001, "CS", facts.text('t')) + sequence(0x00620002, segments) +
         element(0x0062000E, "US", number16(facts.number('v')));
  string measures = element(0x00180050, "DS", facts.text('k'));
  if (!facts.text('g').empty()) measures += element(0x00180088, "DS", facts.text('g'));
  measures += element(0x00280030, "DS", facts.text('s'));
  out += sequence(0x52009229, {sequence(0x00209116, {element(0x00200037, "DS", facts.text('o'))}) +
                               sequence(0x00289110, {measures})}) +
         sequence(0x52009230, frames);
  // as many bytes as it needs, from those of the input
  const std::size_t needed = std::min<std::size_t>(
      (frames.size() * facts.number('r') * facts.number('c') * bits + 7) / 8, 50000);
  string stored(needed, '\0');
  for (std::size_t n = 0; n < needed && !pixels.empty(); ++n)
    stored[n] = static_cast<char>(pixels[n % pixels.size()]);
  return out + element(0x7FE00010, "OB", stored);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces in({data, size});
  Facts facts;
  std::vector<string> frames, segments;
  while (!in.empty()) {
    const std::string_view line = in.line();
    if (line == "x") break;  // the pixels follow
    if (line == "f" && frames.size() < kMostFrames) frames.push_back(frame_item(facts));
    if (line == "n" && segments.size() < kMostSegments) segments.push_back(segment_item(facts));
    if (line.size() >= 2 && line[1] == '=')
      facts[line[0]] = string(line.substr(2, std::min<std::size_t>(line.size() - 2, 256)));
  }
  const string file = file_of(facts, frames, segments, in.rest());
  const string& path =
      fuzz::as_file("a.dcm", {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  NoProgress progress;
  const auto scan = io::read_dicom(path, {}, progress);
  fuzz::look_at_error(scan);
  if (!scan) return 0;
  fuzz::look_at(*scan);
  if (scan->format != "DICOM segmentation") return 0;
  fuzz::must(scan->values.empty() && !scan->labels.empty(), "a segmentation is labels");
  for (const io::Label& label : scan->label_names)
    fuzz::must(label.value >= 1 && label.value <= 255, "a label has a number up to 255");
  return 0;
}

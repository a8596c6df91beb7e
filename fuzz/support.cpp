#include "support.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace burr::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestSentence = 1500;  // [byte]

std::string make_folder() {
  std::error_code trouble;
  const fs::path memory = "/dev/shm";
  const fs::path place = fs::is_directory(memory, trouble) ? memory : fs::temp_directory_path();
  std::string name = (place / "burr-fuzz-XXXXXX").string();
  must(::mkdtemp(name.data()) != nullptr, "a folder for the input can be made");
  return name;
}

struct Folder {
  std::string path = make_folder();
  Folder() = default;
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

const std::string& folder() {
  static const Folder mine;
  return mine.path;
}

const std::string& as_file(const std::string& name, Bytes bytes) {
  static std::map<std::string, std::string> paths;
  std::string& path = paths[name];
  if (path.empty()) path = folder() + "/" + name;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  must(file >= 0, "the input can be written into a file");
  must(::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
       "the input is written whole");
  ::close(file);
  return path;
}

void must(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "not true: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

void look_at(const Error& error) {
  must(!error.text.empty(), "an error is a sentence");
  if (error.text.size() > kLongestSentence)
    std::fprintf(stderr, "%.200s ... (%zu bytes)\n", error.text.c_str(), error.text.size());
  must(error.text.size() <= kLongestSentence, "an error is short enough to be read");
  must(std::none_of(error.text.begin(), error.text.end(),
                    [](char c) { return (c >= 0 && c < ' ') || c == '\x7F'; }),
       "an error is one line without control characters");
}

void look_at(const volume::TissueTable& tissues) {
  must(!tissues.tissues.empty() && tissues.tissues.size() <= 256, "a table has 1 to 256 tissues");
  must(tissues.tissues[0].kind == volume::TissueKind::air, "tissue 0 is air");
  for (const volume::Tissue& tissue : tissues.tissues) {
    must(std::isfinite(tissue.cutting_energy) && tissue.cutting_energy > 0 &&
             std::isfinite(tissue.friction) && tissue.friction >= 0,
         "cutting energy and friction can be worked with");
    for (const float c : tissue.colour) must(c >= 0 && c <= 1, "colours are from 0 to 1");
  }
}

void look_at(const io::Scan& scan) {
  must(scan.size.minCoeff() >= 1, "a scan has voxels");
  const std::size_t count = static_cast<std::size_t>(scan.size.x()) *
                            static_cast<std::size_t>(scan.size.y()) *
                            static_cast<std::size_t>(scan.size.z());
  must(scan.values.empty() != scan.labels.empty(), "a scan has either values or labels");
  must(std::max(scan.values.size(), scan.labels.size()) == count, "as many voxels as the size");
  must(
      std::all_of(scan.values.begin(), scan.values.end(), [](float v) { return std::isfinite(v); }),
      "every value is finite");
  must(scan.spacing_mm.allFinite() && scan.spacing_mm.minCoeff() > 0, "the spacing is above 0");
  must(scan.origin_mm.allFinite(), "the origin is finite");
  must(scan.axes.allFinite() && std::abs(scan.axes.determinant() - 1) < 1e-6 &&
           (scan.axes.transpose() * scan.axes - math::Mat3::Identity()).norm() < 1e-6,
       "the axes are a rotation");
  for (const io::Label& label : scan.label_names) {
    must(label.value >= 0 && label.value <= 255, "labels are from 0 to 255");
    for (const float c : label.colour) must(c >= 0 && c <= 1, "colours are from 0 to 1");
  }
}

Result<io::Scan> read_scan_bytes(Reader reader, const std::string& name, Bytes bytes) {
  NoProgress progress;
  auto scan = reader(as_file(name, bytes), {}, progress);
  look_at_error(scan);
  if (scan) look_at(*scan);
  return scan;
}

std::uint8_t Pieces::byte() {
  const Bytes one = take(1);
  return one.empty() ? std::uint8_t{0} : one[0];
}

std::uint16_t Pieces::word() {
  const auto low = byte(), high = byte();
  return static_cast<std::uint16_t>(low | high << 8);
}

Bytes Pieces::take(std::size_t size) {
  const Bytes taken = left_.first(std::min(size, left_.size()));
  left_ = left_.subspan(taken.size());
  return taken;
}

std::string_view Pieces::line() {
  const auto end = std::find(left_.begin(), left_.end(), '\n');
  const Bytes taken = take(static_cast<std::size_t>(end - left_.begin()));
  static_cast<void>(take(1));
  return text_of(taken);
}

}  // namespace burr::fuzz

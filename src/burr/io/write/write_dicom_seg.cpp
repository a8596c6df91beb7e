// The asking side: says what the file shall hold, starts burr-seg, and puts what it wrote in its place.
#include "burr/io/write/write_dicom_seg.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>

#include "burr/base/handle.h"
#include "burr/base/helper_program.h"
#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/base/version.h"
#include "burr/io/read/bytes.h"
#include "burr/io/write/dicom_seg_child.h"
#include "burr/io/write/write_volume.h"

namespace burr::io {
namespace {

constexpr std::size_t kLongestText = 64;  // of LO [letter]
constexpr int kMostPixels = 65535;        // of a row or a column

using base::Handle;

bool write_all(int file, const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(file, from, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

// One line of at most 64 letters, without the letters that DICOM separates values by.
std::string line_of(const std::string& text, std::size_t longest = kLongestText) {
  std::string out;
  std::size_t letters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0) != 0x80 && ++letters > longest) break;
    out += byte < 0x20 || byte == 0x7F ? ' ' : c == '\\' ? '/' : c;
  }
  const std::size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return out.substr(first, out.find_last_not_of(' ') + 1 - first);
}

// "1, 2 and 5 more"
std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 8;
  std::string out;
  for (std::size_t n = 0; n < std::min(names.size(), kNamed); ++n)
    out += (n > 0 ? ", " : "") + names[n];
  if (names.size() > kNamed) out += fmt::format(" and {} more", names.size() - kNamed);
  return out;
}

nlohmann::json json_of(const DicomCode& code) {
  return {line_of(code.value), line_of(code.scheme), line_of(code.meaning)};
}

std::array<std::size_t, 256> voxels_of_labels(const Scan& scan) {
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t label : scan.labels) ++count[label];
  return count;
}

// The segments that have voxels, and what must be said of them.
nlohmann::json segments_of(const Scan& scan, const SegOptions& options, SegWritten& written) {
  // SNOMED CT: "Anatomical structure". It says nothing more than that this is a part of a body.
  const DicomCode general{"123037004", "SCT", "Anatomical Structure"};
  const std::array<std::size_t, 256> count = voxels_of_labels(scan);
  std::vector<std::string> empty, uncoded, shortened;
  nlohmann::json out = nlohmann::json::array();
  for (int label = 1; label < 256; ++label) {
    const auto named = std::find_if(scan.label_names.begin(), scan.label_names.end(),
                                    [label](const Label& one) { return one.value == label; });
    const bool known = named != scan.label_names.end();
    std::string name = known ? named->name : std::string();
    if (line_of(name).empty()) name = fmt::format("label {}", label);
    const std::size_t voxels = count[static_cast<std::size_t>(label)];
    if (voxels == 0) {
      if (known) empty.push_back(base::printable(name));
      continue;
    }
    const std::string line = line_of(name);
    if (line_of(name, 10000) != line) shortened.push_back(base::printable(line));
    const auto codes = options.codes.find(label);
    const SegmentCodes own = codes != options.codes.end() ? codes->second : SegmentCodes{};
    if (!own.type) uncoded.push_back(base::printable(line));
    const auto number = static_cast<int>(out.size()) + 1;
    out.push_back({{"value", label},
                   {"name", line},
                   {"category", json_of(own.category.value_or(general))},
                   {"type", json_of(own.type.value_or(general))},
                   {"lab", dicom_lab_of_srgb(known ? named->colour : volume::Tissue{}.colour)}});
    written.segments.push_back({number, label, line, voxels});
  }
  if (!empty.empty())
    written.notices.push_back(
        fmt::format("Left out, because no voxel has these labels: {}.", list_of(empty)));
  if (!shortened.empty())
    written.notices.push_back(
        fmt::format("A name in DICOM has at most 64 letters; shortened: {}.", list_of(shortened)));
  if (!uncoded.empty())
    written.notices.push_back(fmt::format(
        "These segments are coded as \"Anatomical Structure\" and nothing more, because no table "
        "says what they are: {}; give codes as \"sct\" in a table (`labels`).",
        list_of(uncoded)));
  return out;
}

// Date and time of now, as DICOM writes them.
std::pair<std::string, std::string> date_and_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  localtime_r(&now, &parts);
  std::array<char, 16> date = {}, time = {};
  std::strftime(date.data(), date.size(), "%Y%m%d", &parts);
  std::strftime(time.data(), time.size(), "%H%M%S", &parts);
  return {date.data(), time.data()};
}

const char* word_of(SegmentedBy by) {
  switch (by) {
    case SegmentedBy::automatic:
      return "AUTOMATIC";
    case SegmentedBy::manual:
      return "MANUAL";
    default:
      return "SEMIAUTOMATIC";
  }
}

Result<nlohmann::json> uids_of(const SegOptions& options) {
  nlohmann::json uids;
  for (const char* what : {"instance", "series", "study", "frame_of_reference", "dimensions"}) {
    auto uid = new_uid(options.uid_root);
    if (!uid) return uid.error();
    uids[what] = *uid;
  }
  if (!options.study) return uids;
  for (const auto& [tag, what] :
       {std::pair{kStudyUid, "study"}, std::pair{kFrameOfReference, "frame_of_reference"}}) {
    const auto own = options.study->values.find(tag);
    if (own != options.study->values.end() && !own->second.empty()) uids[what] = own->second;
  }
  return uids;
}

Result<nlohmann::json> job_of(const Scan& scan, const SegOptions& options, SegWritten& written) {
  auto uids = uids_of(options);
  if (!uids) return uids.error();
  const auto [date, time] = date_and_time();
  nlohmann::json job = {
      {"version", base::version()},
      {"date", date},
      {"time", time},
      {"uids", *uids},
      {"by", word_of(options.by)},
      {"algorithm", line_of(options.algorithm.empty() ? std::string("burr ") + base::version()
                                                      : options.algorithm)},
      {"segments", segments_of(scan, options, written)}};
  for (int a = 0; a < 3; ++a) {
    job["size"].push_back(scan.size[a]);
    job["spacing"].push_back(scan.spacing_mm[a]);
    job["origin"].push_back(scan.origin_mm[a]);
    for (int b = 0; b < 3; ++b) job["axes"].push_back(scan.axes(b, a));  // column by column
  }
  job["characters"] = options.study ? options.study->characters : "";
  job["study"] = nlohmann::json::array();
  if (options.study)
    for (const auto& [tag, text] : options.study->values) job["study"].push_back({tag, text});
  return job;
}

// The process that writes, from its start to its end.
class Writer {
 public:
  explicit Writer(std::string path) : path_(std::move(path)) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { stop(); }

  Status write(const nlohmann::json& job, const Voxels<std::uint8_t>& labels, std::size_t& frames,
               Progress& progress) {
    if (Status status = start(job, labels); !status) return status;
    if (Status status = watch(progress); !status) return status;
    frames = frames_;
    return take_over();
  }

 private:
  [[nodiscard]] Error failed(const char* what, int reason) const {
    return error(Trouble::io,
                 fmt::format("{}: cannot be written: {}: {}", path_, what, std::strerror(reason)));
  }

  Status start(const nlohmann::json& job, const Voxels<std::uint8_t>& labels) {
    const std::string program = base::helper_program("burr-seg", "BURR_SEG");
    if (program.empty())
      return error(Trouble::io,
                   "the program burr-seg, which writes DICOM segmentations, is not beside "
                   "libburr.so; install burr again or give its path in BURR_SEG");
    Handle told(::memfd_create("burr-seg-job", MFD_CLOEXEC));
    out_ = Handle(::memfd_create("burr-seg-file", MFD_CLOEXEC));
    std::array<int, 2> ends = {-1, -1};
    if (!told.open() || !out_.open()) return failed("memory cannot be had", errno);
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failed("a pipe cannot be opened", errno);
    messages_ = Handle(ends[0]);
    Handle theirs(ends[1]);
    const std::vector<std::uint8_t> text = nlohmann::json::to_cbor(job);
    const std::uint64_t length = text.size();
    if (!write_all(told.get(), &length, sizeof length) ||
        !write_all(told.get(), text.data(), text.size()) ||
        !write_all(told.get(), labels.data(), labels.size()))
      return failed("memory cannot be had", errno);

    pid_t child = -1;
    const int reason = base::start_helper(program, "burr-seg",
                                          {{base::kNothing, STDIN_FILENO},
                                           {out_.get(), STDOUT_FILENO},
                                           {told.get(), kSegJob},
                                           {theirs.get(), kSegMessages}},
                                          child);
    if (reason != 0) return failed("burr-seg cannot be started", reason);
    child_ = child;
    return fine();
  }

  // Reads its messages until it has ended.
  Status watch(Progress& progress) {
    constexpr int kTick = 50;  // [ms]
    std::array<char, 4096> block = {};
    std::string text;
    while (true) {
      if (progress.cancelled()) {
        stop();
        return error(Trouble::interrupted, path_ + ": stopped, nothing was written");
      }
      pollfd waiting{messages_.get(), POLLIN, 0};
      if (::poll(&waiting, 1, kTick) <= 0) continue;
      const ssize_t got = ::read(messages_.get(), block.data(), block.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;  // its end of the pipe is closed
      text.append(block.data(), static_cast<std::size_t>(got));
      for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
        take(text.substr(0, end), progress);
        text.erase(0, end + 1);
      }
    }
    while (::waitpid(child_, &status_, 0) < 0 && errno == EINTR) continue;
    child_ = -1;
    if (!sentence_.empty()) return error(path_ + ": " + sentence_);
    if (WIFSIGNALED(status_))
      return error(Trouble::internal,
                   fmt::format("{}: burr-seg was ended ({}), most likely because memory ran out; "
                               "close other programs, or write .seg.nrrd",
                               path_, ::strsignal(WTERMSIG(status_))));
    if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0)
      return error(Trouble::internal,
                   fmt::format("{}: burr-seg ended without writing it; install burr again", path_));
    return fine();
  }

  void take(const std::string& line, Progress& progress) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string word = line.substr(0, space);
    const std::string rest = line.substr(std::min(space + 1, line.size()));
    if (word == "progress") progress.report(std::strtod(rest.c_str(), nullptr), "writing DICOM");
    if (word == "frames") frames_ = std::strtoul(rest.c_str(), nullptr, 10);
    if (word == "error") sentence_ = base::printable(rest, 400);
  }

  Status take_over() {
    auto file = base::NewFile::create(path_, base::kForAll);
    if (!file) return file.error();
    const off_t size = ::lseek(out_.get(), 0, SEEK_END);
    if (size <= 0) return error(Trouble::internal, path_ + ": burr-seg wrote nothing");
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    std::vector<char> block(kBlock);
    for (off_t at = 0; at < size && file->ok();) {
      const ssize_t got = ::pread(out_.get(), block.data(), block.size(), at);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return failed("memory cannot be read", errno);
      file->write(block.data(), static_cast<std::size_t>(got));
      at += got;
    }
    return file->put_in_place();
  }

  void stop() {
    if (child_ < 0) return;
    ::kill(child_, SIGKILL);
    while (::waitpid(child_, &status_, 0) < 0 && errno == EINTR) continue;
    child_ = -1;
  }

  std::string path_;
  Handle out_, messages_;
  pid_t child_ = -1;
  int status_ = 0;
  std::size_t frames_ = 0;
  std::string sentence_;
};

}  // namespace

std::array<int, 3> dicom_lab_of_srgb(const std::array<float, 3>& rgb) {
  constexpr double kDelta = 6.0 / 29.0, kSteps = 65535.0;
  math::Vec3 linear;
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = std::clamp(static_cast<double>(rgb[c]), 0.0, 1.0);
    linear[static_cast<Eigen::Index>(c)] =
        v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  math::Mat3 xyz_of;  // linear sRGB to XYZ of D50, adapted by Bradford
  xyz_of << 0.4360747, 0.3850649, 0.1430804, 0.2225045, 0.7168786, 0.0606169, 0.0139322, 0.0971045,
      0.7141733;
  const math::Vec3 xyz = xyz_of * linear;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const double x = f(xyz.x() / 0.96422), y = f(xyz.y()), z = f(xyz.z() / 0.82521);
  const auto stored = [](double v, double low, double span) {
    return static_cast<int>(std::lround(std::clamp((v - low) / span, 0.0, 1.0) * kSteps));
  };
  return {stored(116 * y - 16, 0, 100), stored(500 * (x - y), -128, 255),
          stored(200 * (y - z), -128, 255)};
}

Result<std::string> new_uid(const std::string& root) {
  constexpr std::size_t kLongestRoot = 40;
  const std::string from = root.empty() ? "2.25" : root;
  bool good = from.size() <= kLongestRoot && from.front() != '.' && from.back() != '.' &&
              from.find("..") == std::string::npos && from.find('.') != std::string::npos &&
              from.find_first_not_of("0123456789.") == std::string::npos;
  for (std::size_t at = 0; good && at < from.size(); ++at) {  // no part begins with a 0
    const bool first = at == 0 || from[at - 1] == '.';
    if (first && from[at] == '0' && at + 1 < from.size() && from[at + 1] != '.') good = false;
  }
  if (!good)
    return error(Trouble::usage,
                 fmt::format("`uid_root`: {} is no root of UIDs; give numbers with points between "
                             "them, for example 1.2.826.0.1.3680043.9.1234, of at most {} letters",
                             base::printable(root, 80), kLongestRoot));
  // 64 bits fit behind the longest root; behind 2.25 stands a whole UUID (version 4) of 128
  std::random_device random;
  std::vector<std::uint32_t> words(root.empty() ? 4 : 2);  // the highest first
  for (std::uint32_t& word : words) word = random();
  if (root.empty()) {
    words[1] = (words[1] & 0xFFFF0FFFU) | 0x4000U;
    words[2] = (words[2] & 0x3FFFFFFFU) | 0x80000000U;
  }
  std::string digits;  // the last first
  while (digits.empty() || std::any_of(words.begin(), words.end(), [](auto w) { return w > 0; })) {
    std::uint64_t rest = 0;
    for (std::uint32_t& word : words) {
      rest = rest << 32 | word;
      word = static_cast<std::uint32_t>(rest / 10);
      rest %= 10;
    }
    digits += static_cast<char>('0' + static_cast<int>(rest));
  }
  std::reverse(digits.begin(), digits.end());
  return from + "." + digits;
}

Scan labels_of_bone(const volume::Bone& bone) {
  using volume::kBrickEdge;
  const auto& tissues = bone.tissues().tissues;
  const std::vector<int> values = label_values(bone.tissues());
  const volume::Grid& grid = bone.grid();
  Scan scan;
  scan.size = grid.size;
  scan.spacing_mm = math::Vec3::Constant(1e3 * grid.voxel);
  scan.axes = grid.frame.q.toRotationMatrix();
  scan.origin_mm = 1e3 * grid.frame.p;
  for (std::size_t id = 1; id < tissues.size(); ++id)
    scan.label_names.push_back(
        {.value = values[id], .name = tissues[id].name, .colour = tissues[id].colour});
  const auto nx = static_cast<std::size_t>(grid.size.x()),
             ny = static_cast<std::size_t>(grid.size.y());
  scan.labels.assign(nx * ny * static_cast<std::size_t>(grid.size.z()), 0);
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::TissueId* tissue = bone.brick_tissue(brick);
    if (tissue == nullptr) continue;
    const volume::Field* field = bone.brick_field(brick);
    const math::Ijk first = bone.brick_ijk(brick);
    const math::Ijk room = (grid.size - first).cwiseMin(kBrickEdge);
    for (int k = 0; k < room.z(); ++k)
      for (int j = 0; j < room.y(); ++j)
        for (int i = 0; i < room.x(); ++i) {
          const int v = i + kBrickEdge * (j + kBrickEdge * k);
          if (tissue[v] >= tissues.size()) continue;
          const volume::TissueKind kind = tissues[tissue[v]].kind;
          const bool there =
              kind == volume::TissueKind::soft ||
              (kind == volume::TissueKind::solid && field != nullptr && field[v] >= volume::kIso);
          if (there)
            scan.labels[static_cast<std::size_t>(first.x() + i) +
                        nx * (static_cast<std::size_t>(first.y() + j) +
                              ny * static_cast<std::size_t>(first.z() + k))] =
                static_cast<std::uint8_t>(values[tissue[v]]);
        }
  }
  return scan;
}

Result<SegWritten> write_dicom_seg(const Scan& labels, const std::string& path,
                                   const SegOptions& options, Progress& progress) {
  if (labels.labels.empty())
    return error(path +
                 ": a DICOM segmentation holds labels, and this scan has grey values only; write "
                 "the bone that burr makes of it, or give a label map");
  if (labels.size.x() > kMostPixels || labels.size.y() > kMostPixels)
    return error(fmt::format("{}: a frame of DICOM has at most {} pixels in a row; {} are too many",
                             path, kMostPixels, labels.size.head<2>().maxCoeff()));
  SegWritten written;
  const auto job = job_of(labels, options, written);
  if (!job) return job.error();
  if (written.segments.empty())
    return error(path + ": no voxel has a label, so nothing was written");
  progress.report(0, "writing DICOM");
  if (Status status = Writer(path).write(*job, labels.labels, written.frames, progress); !status)
    return status.error();
  progress.report(1, "writing DICOM");
  if (!options.study)
    written.notices.emplace_back(
        "The file names no patient and is a study of its own with new UIDs; `study` puts "
        "it into the study of a DICOM scan.");
  else if (options.study->values.count(kFrameOfReference) == 0)
    written.notices.emplace_back(
        "The scan states no Frame of Reference UID, so other programs may not lay the segments "
        "over it.");
  return written;
}

}  // namespace burr::io

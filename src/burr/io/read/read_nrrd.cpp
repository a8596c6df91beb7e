// NRRD and .seg.nrrd, after https://teem.sourceforge.net/nrrd/format.html; segments after 3D
// Slicer's vtkMRMLSegmentationStorageNode.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/compare_frames.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/nrrd_header.h"
#include "burr/io/read/nrrd_shape.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/several_volumes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;

std::map<std::string, double> unit_mm() {
  return {{"mm", 1},           {"cm", 10},       {"m", 1000},       {"um", 1e-3},
          {"\xC2\xB5m", 1e-3}, {"micron", 1e-3}, {"microns", 1e-3}, {"nm", 1e-6}};
}

// lps = flip * file space
Mat3 lps_from_space(const std::string& space, const std::string& file, Scan& scan) {
  const std::string name = lower(space);
  const auto is = [&](const char* words, const char* letters) {
    return name.rfind(words, 0) == 0 || name == letters || name == std::string(letters) + "t";
  };
  (void)file;
  if (is("left-posterior-superior", "lps")) return Mat3::Identity();
  if (is("right-anterior-superior", "ras")) return Vec3(-1, -1, 1).asDiagonal();
  if (is("left-anterior-superior", "las")) return Vec3(1, -1, 1).asDiagonal();
  if (name.rfind("3d-left-handed", 0) == 0) {
    scan.notices.emplace_back(
        "The file's space is left-handed and does not name its directions: rows to the left, "
        "columns to the back and slices downwards are assumed.");
    return Vec3(1, 1, -1).asDiagonal();
  }
  scan.notices.emplace_back(
      "The file does not state its orientation: left, posterior, superior is assumed.");
  return Mat3::Identity();
}

// The standard allows either space directions or spacings for an axis. Where a file has both, they
// must agree.
void compare_with_spacings(const std::vector<std::string>& spacings, const NrrdShape& shape,
                           const Affine& directions, const std::string& file, Scan& scan) {
  Affine sized = directions;
  bool commas = false;
  for (std::size_t a = 0; a < 3; ++a) {
    double step = 0;
    if (shape.axes[a] >= spacings.size() || !to_number(spacings[shape.axes[a]], step, commas) ||
        !std::isfinite(step) || step == 0)
      return;
    const auto axis = static_cast<Eigen::Index>(a);
    sized.step.col(axis) = directions.step.col(axis).normalized() * std::abs(step);
  }
  if (usable(sized) && usable(directions) &&
      (sized.step - directions.step).norm() > 0.02 * directions.step.norm())
    compare_frames({directions, "space directions"}, {sized, "spacings"}, file, scan);
}

// stated: for how many axes there is one; unread: what the file has in its place.
void ask_for_spacing(int stated, const std::string& unread, const std::string& file,
                     bool check_scan, Scan& scan) {
  if (stated > 0 && !check_scan) return;
  if (stated > 0)
    scan.ask(Ask::spacing, fmt::format("{}: states its voxel spacing for {} of 3 axes only (the "
                                       "others are taken for 1 mm)",
                                       file, stated));
  else if (!unread.empty() && unread.find("nan") == std::string::npos)
    scan.ask(Ask::spacing, fmt::format("{}: its voxel spacing \"{}\" cannot be read as numbers "
                                       "(taken for 1 mm)",
                                       file, base::printable(unread)));
  else
    no_spacing(file, check_scan, scan);
}

Affine affine_of(const NrrdHeader& header, const NrrdShape& shape, const std::string& file,
                 bool check_scan, Scan& scan) {
  const auto get = [&](const char* name) {
    const auto found = header.fields.find(name);
    return found == header.fields.end() ? std::string() : found->second;
  };
  const Mat3 flip = lps_from_space(get("space"), file, scan);
  Affine affine;

  const std::vector<std::string> moves = nrrd_directions(header);
  // some writers leave out axes without direction
  const bool only_space = moves.size() == 3;
  bool directed = !moves.empty(), commas = false;
  for (std::size_t a = 0; a < 3 && directed; ++a) {
    const std::size_t axis = only_space ? a : shape.axes[a];
    const std::vector<double> move =
        axis < moves.size() ? numbers(moves[axis], 3, commas) : std::vector<double>();
    directed = move.size() == 3;
    if (directed) affine.step.col(static_cast<Eigen::Index>(a)) = Vec3(move[0], move[1], move[2]);
  }
  if (directed && check_scan)
    compare_with_spacings(words(get("spacings")), shape, affine, file, scan);
  if (!directed) {
    affine.step.setIdentity();
    const std::vector<std::string> spacings = words(get("spacings"));
    int stated = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      double step = 0;
      if (shape.axes[a] < spacings.size() && to_number(spacings[shape.axes[a]], step, commas) &&
          std::isfinite(step) && step != 0) {
        affine.step(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a)) = std::abs(step);
        ++stated;
      }
    }
    const std::string unread = moves.empty() ? get("spacings") : get("spacedirections");
    if (stated < 3) ask_for_spacing(stated, unread, file, check_scan, scan);
  }
  const std::vector<double> origin = numbers(get("spaceorigin"), 3, commas);
  if (commas)
    scan.notices.emplace_back(
        "The file writes numbers with a decimal comma (\"0,5\"): read as decimal points.");
  if (origin.size() == 3) affine.origin = Vec3(origin[0], origin[1], origin[2]);

  std::string unit = get("spaceunits");
  unit.erase(std::remove(unit.begin(), unit.end(), '"'), unit.end());
  const std::vector<std::string> units = words(unit);
  double scale = 1;
  const auto known = unit_mm();
  if (!units.empty()) {
    const auto found = known.find(units.back());
    if (found != known.end()) scale = found->second;
  }
  affine.step = flip * affine.step * scale;
  affine.origin = flip * affine.origin * scale;
  return affine;
}

Result<std::int64_t> skip_field(const NrrdHeader& header, const char* name, const std::string& file,
                                std::int64_t lowest) {
  const auto found = header.fields.find(name);
  std::int64_t n = 0;
  if (found != header.fields.end() && (!to_number(found->second, n) || n < lowest))
    return error(fmt::format("{}: {}: \"{}\" is not a number of bytes or lines", file, name,
                             base::printable(found->second)));
  return n;
}

Status skip_lines(ByteSource& source, std::int64_t lines) {
  char c = 0;
  while (lines > 0) {
    if (Status status = read_exactly(source, &c, 1); !status) return status;
    if (c == '\n') --lines;
  }
  return fine();
}

// numbers as text, separated by spaces and commas
Status read_ascii(ByteSource& source, std::size_t count, const Share& share, VoxelSink& sink) {
  std::string word;
  std::vector<float> values;
  std::uint64_t where = 0;  // in the period of the share
  const auto take = [&] {
    if (word.empty()) return true;
    double value = 0;
    const bool good = to_number(word, value);
    if (where >= share.from && where < share.from + share.length)
      values.push_back(static_cast<float>(value));
    where = (where + 1) % share.period;
    word.clear();
    return good;
  };
  std::vector<char> block(65536);
  while (values.size() < count) {
    auto got = source.read(block.data(), block.size());
    if (!got) return got.error();
    if (*got == 0) break;
    for (std::size_t i = 0; i < *got; ++i) {
      const char c = block[i];
      if (c != ' ' && c != '\n' && c != '\t' && c != '\r' && c != ',') {
        word += c;
        if (word.size() < 64) continue;
      }
      if (!take()) return error("the text data holds a word that is not a number; correct it");
    }
  }
  if (values.size() < count && !take())
    return error("the text data holds a word that is not a number; correct it");
  if (values.size() < count)
    return error(fmt::format("{} numbers expected, {} found; the file is cut off, copy it again",
                             count, values.size()));
  sink.add(values.data(), count);
  return fine();
}

// The data: opened, decompressed and positioned at its first byte.
Result<std::unique_ptr<ByteSource>> data_source(const NrrdHeader& header,
                                                const std::filesystem::path& path,
                                                const std::string& encoding, std::size_t bytes,
                                                std::vector<std::string>& notices) {
  const std::string file = short_name(path);
  auto files = nrrd_data_files(header, path, notices);
  if (!files) return files.error();
  auto lines = skip_field(header, "lineskip", file, 0);
  if (!lines) return lines.error();
  auto skip_bytes = skip_field(header, "byteskip", file, -1);
  if (!skip_bytes) return skip_bytes.error();

  std::uint64_t size = 0, offset = 0;
  bool packed = false;  // the whole file, header and all
  if (files->empty()) {
    auto own = open_unpacked(path);
    if (!own) return error(own.error().trouble, fmt::format("{}: {}", file, own.error().text));
    offset = header.end;
    size = own->most;
    packed = own->packed;
  } else {
    for (const auto& one : *files) {
      const auto there = open_file(one, 0, false);  // in an archive too
      if (!there) return there.error();
      size += there->size;
    }
  }
  const bool raw = encoding == "raw", gzip = encoding == "gzip" || encoding == "gz",
             bzip = encoding == "bzip2" || encoding == "bz2";
  const std::uint64_t there = size > offset ? size - offset : 0;
  const std::uint64_t most = gzip ? there * kMostGzip : bzip ? there * kMostBzip2 : there;
  const std::uint64_t needed =
      raw || gzip || bzip ? bytes : bytes / 8;  // text: at least one digit each
  if (needed > most)
    return error(
        fmt::format("{}: sizes need {} bytes of data, but the file holds {}; it is cut off or its "
                    "header is wrong",
                    file, needed, there));

  const auto open = [&](std::int64_t from_end) -> Result<std::unique_ptr<ByteSource>> {
    std::unique_ptr<ByteSource> source;
    if (packed) {
      auto opened = open_unpacked(path);
      if (!opened) return opened.error();
      source = std::move(opened->source);
      if (Status status = skip(*source, offset); !status) return status.error();
    } else if (files->empty() || files->size() == 1) {
      const std::uint64_t at = from_end >= 0 ? size - static_cast<std::uint64_t>(from_end) : offset;
      auto opened = open_file(files->empty() ? path : files->front(), at, files->empty());
      if (!opened) return opened.error();
      source = std::move(opened->source);
    } else {
      source = concatenate_files(
          *files, raw && *skip_bytes > 0 ? static_cast<std::uint64_t>(*skip_bytes) : 0);
      return source;
    }
    if (from_end < 0)
      if (Status status = skip_lines(*source, *lines); !status) return status.error();
    if (gzip) source = gunzip(std::move(source));
    if (bzip) source = bunzip2(std::move(source));
    return source;
  };

  if (*skip_bytes == -1 && raw && files->size() <= 1 && !packed)
    return open(static_cast<std::int64_t>(bytes));
  if (*skip_bytes == -1 && files->size() <= 1) {
    // the last `bytes` of the decompressed data: count first
    auto counting = open(-1);
    if (!counting) return counting.error();
    std::vector<std::uint8_t> block(std::size_t{1} << 16);
    std::uint64_t total = 0;
    while (true) {
      auto got = (*counting)->read(block.data(), block.size());
      if (!got) return got.error();
      if (*got == 0) break;
      total += *got;
      if (total > (std::uint64_t{1} << 36))
        return error(fmt::format(
            "{}: its data decompresses to more than 64 GiB; the file is damaged or made to do harm",
            file));
    }
    if (total < bytes)
      return error(fmt::format(
          "{}: holds {} bytes of voxels, but {} are needed; the file is cut off, copy it again",
          file, total, bytes));
    auto source = open(-1);
    if (!source) return source.error();
    if (Status status = skip(**source, total - bytes); !status) return status.error();
    return source;
  }
  auto source = open(-1);
  if (!source) return source.error();
  if (*skip_bytes > 0 && files->size() <= 1)
    if (Status status = skip(**source, static_cast<std::uint64_t>(*skip_bytes)); !status)
      return status.error();
  return source;
}

}  // namespace

Result<Scan> read_nrrd(const std::filesystem::path& path, const ReadOptions& options,
                       Progress& progress) {
  const std::string file = short_name(path);
  constexpr std::size_t kLongestHeader = std::size_t{4} << 20;
  auto head = first_unpacked_bytes(path, kLongestHeader);
  if (!head) return head.error();
  auto header = parse_nrrd(std::string(head->begin(), head->end()), file);
  if (!header) return header.error();

  Scan scan;
  scan.format = "NRRD";
  NrrdSegments named = nrrd_segments(*header, scan.notices);
  scan.label_names = named.labels;
  const bool segmentation = !scan.label_names.empty();
  if (segmentation) scan.format = "NRRD segmentation";

  auto shape = nrrd_shape(*header, file, segmentation);
  if (!shape) return shape.error();
  auto count = voxel_count(file, shape->sizes[0], shape->sizes[1], shape->sizes[2]);
  if (!count) return count.error();
  for (int a = 0; a < 3; ++a)
    scan.size[a] = static_cast<int>(shape->sizes[static_cast<std::size_t>(a)]);

  SampleFormat format;
  const std::string type = lower(header->fields["type"]);
  if (!nrrd_type(type, format.type))
    return error(fmt::format("{}: type: burr does not read \"{}\"", file, base::printable(type)));
  const std::string endian = lower(header->fields["endian"]);
  format.big_endian = endian == "big";
  const std::string encoding = lower(header->fields["encoding"]);
  const bool text = encoding == "text" || encoding == "txt" || encoding == "ascii";
  if (!text && encoding != "raw" && encoding != "gzip" && encoding != "gz" && encoding != "bzip2" &&
      encoding != "bz2")
    return error(
        fmt::format("{}: encoding: burr does not read \"{}\"; save the file as raw or gzip", file,
                    base::printable(encoding)));
  if (encoding == "raw" && endian.empty() && bytes_of(format.type) > 1)
    scan.notices.emplace_back("The file does not state its byte order: little endian is assumed.");

  const auto layers = static_cast<std::size_t>(shape->layers);
  if (*count > static_cast<std::size_t>(kMostVoxels) / layers)
    return error(
        fmt::format("{}: {} layers of {} voxels are more than burr reads (2^31); crop or "
                    "shrink it first",
                    file, layers, *count));
  for (std::size_t n = 0; n < named.labels.size() && layers > 1; ++n)
    if (named.bare[n]) {
      named.layers[n] = scan.label_names[n].value - 1;
      scan.label_names[n].value = 1;
    }
  const std::size_t samples = *count * layers, width = bytes_of(format.type);
  const auto volumes = static_cast<std::uint64_t>(shape->volumes),
             before = static_cast<std::uint64_t>(shape->before_volumes);
  const auto volume = take_volume(volumes, options, file, scan);
  if (!volume) return volume.error();
  auto source = data_source(*header, path, encoding, samples * volumes * width, scan.notices);
  if (!source) return source.error();
  VoxelSink sink(samples);
  if (!text) *source = only_share(std::move(*source), share_of(*volume, volumes, before * width));
  Status read = text ? read_ascii(**source, samples, share_of(*volume, volumes, before), sink)
                     : read_samples(**source, format, samples, sink, progress);
  if (!read) return error(read.error().trouble, fmt::format("{}: {}", file, read.error().text));
  Status status = layers > 1 ? sink.finish_layers(scan, layers, shape->layers_first, named.layers)
                             : sink.finish(scan, segmentation, options.check_values);
  if (!status) return error(fmt::format("{}: {}", file, status.error().text));
  const Affine affine = affine_of(*header, *shape, file, options.check_scan, scan);
  status = place(scan, affine, options.spacing_mm, file, progress);
  if (!status) return status.error();
  return scan;
}

}  // namespace burr::io

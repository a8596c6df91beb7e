// MetaImage (.mha, .mhd), after https://itk.org/Wiki/ITK/MetaIO/Documentation. World is LPS.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/io/read/beside.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/modality.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/several_volumes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;

bool sample_type(const std::string& name, SampleType& type) {
  static const std::map<std::string, SampleType> known = {
      {"MET_CHAR", SampleType::i8},       {"MET_UCHAR", SampleType::u8},
      {"MET_SHORT", SampleType::i16},     {"MET_USHORT", SampleType::u16},
      {"MET_INT", SampleType::i32},       {"MET_UINT", SampleType::u32},
      {"MET_LONG", SampleType::i32},      {"MET_ULONG", SampleType::u32},
      {"MET_LONG_LONG", SampleType::i64}, {"MET_ULONG_LONG", SampleType::u64},
      {"MET_FLOAT", SampleType::f32},     {"MET_DOUBLE", SampleType::f64}};
  const auto found = known.find(name);
  if (found == known.end()) return false;
  type = found->second;
  return true;
}

struct Header {
  std::string file;  // its name, for errors
  std::map<std::string, std::string> fields;
  mutable bool commas = false;  // a number had a decimal comma
  std::size_t end = 0;          // where LOCAL data begins

  // The first of these fields that is there; empty: none is.
  [[nodiscard]] std::string get(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto found = fields.find(name);
      if (found != fields.end()) return found->second;
    }
    return {};
  }
  [[nodiscard]] Error bad(const char* field, const std::string& what) const {
    return error(fmt::format("{}: {}: {}", file, field, what));
  }
};

Header parse(const std::string& text) {
  Header header;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = std::min(end + 1, text.size());
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string name(trimmed(line.substr(0, equals)));
    header.fields.emplace(name, std::string(trimmed(line.substr(equals + 1))));
    if (name == "ElementDataFile") {  // always the last line
      header.end = at;
      break;
    }
  }
  return header;
}

bool is_true(const std::string& text) {
  return !text.empty() && (text[0] == 'T' || text[0] == 't' || text[0] == '1');
}

// Three axes of space, and perhaps a fourth that counts volumes.
struct Size {
  math::Ijk voxels = {0, 0, 0};
  std::int64_t volumes = 1;
  std::size_t axes = 3;
};

Result<Size> size_of(const Header& header) {
  std::int64_t dims = 0;
  if (!to_number(header.get({"NDims"}), dims))
    return header.bad("NDims", "is missing; this is not a MetaImage");
  if (dims != 3 && dims != 4)
    return header.bad("NDims", fmt::format("3 axes expected, {} found; {}", dims,
                                           dims < 3 ? "a single picture is not a volume"
                                                    : "save one volume of it"));
  const std::vector<double> size = numbers(header.get({"DimSize"}));
  if (size.size() != static_cast<std::size_t>(dims))
    return header.bad("DimSize", dims == 3 ? "must be three sizes" : "must be four sizes");
  for (const double n : size)
    if (!(n >= 1 && n <= 1e9) || n != std::floor(n))
      return header.bad("DimSize", "must be whole numbers above 0");
  Size out;
  for (int a = 0; a < 3; ++a) out.voxels[a] = static_cast<int>(size[static_cast<std::size_t>(a)]);
  out.axes = size.size();
  if (dims == 4) out.volumes = static_cast<std::int64_t>(size[3]);
  return out;
}

// A factor of the values, if the file gives one.
Status read_factor(const Header& header, const char* field, double& out) {
  double value = 0;
  const std::string text = header.get({field});
  if (text.empty()) return fine();
  if (!to_number(text, value, header.commas) || !std::isfinite(value))
    return header.bad(field, fmt::format("\"{}\" is not a number", base::printable(text)));
  out = value;
  return fine();
}

Result<SampleFormat> format_of(const Header& header) {
  std::int64_t channels = 1;
  const std::string channel_text = header.get({"ElementNumberOfChannels"});
  if (!channel_text.empty() && (!to_number(channel_text, channels) || channels != 1))
    return header.bad("ElementNumberOfChannels",
                      "burr reads one value per voxel, not colours or vectors");

  SampleFormat format;
  const std::string type = header.get({"ElementType"});
  if (!sample_type(type, format.type))
    return header.bad("ElementType",
                      fmt::format("burr does not read \"{}\"", base::printable(type)));
  format.big_endian = is_true(header.get({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
  const std::string binary = header.get({"BinaryData"});
  if (!binary.empty() && !is_true(binary))
    return header.bad("BinaryData", "burr does not read numbers as text; save the file as binary");
  double slope = 1;
  if (Status good = read_factor(header, "ElementToIntensityFunctionSlope", slope); !good)
    return good.error();
  if (slope != 0) format.slope = slope;
  if (Status good = read_factor(header, "ElementToIntensityFunctionOffset", format.intercept);
      !good)
    return good.error();
  return format;
}

// The one file beside the header that holds the voxels. Its name may hold blanks and per cent signs;
// where no such file is there, it is a list or a pattern.
Result<DataFile> data_file(const std::filesystem::path& header, const std::string& name) {
  auto exact = data_file_beside(header, name);
  if (exact && file_is_there(exact->path)) return exact;
  const std::vector<std::string> parts = words(name);
  if (parts.empty() || parts.front() == "LIST" ||
      (parts.size() > 1 && name.find('%') != std::string::npos))
    return error(
        fmt::format("{}: ElementDataFile: burr reads no lists or patterns of files; save one file",
                    short_name(header)));
  return exact;
}

// The file of the voxels, from offset on. Only the header's own file may be packed as a whole
// ("x.mha.gz"): size is then the most that it can give.
Result<OpenFile> open_voxels(const std::filesystem::path& path, std::uint64_t offset, bool own) {
  if (!own) return open_file(path, offset, false);
  auto packed = open_unpacked(path);
  if (!packed) return error(packed.error().trouble, short_name(path) + ": " + packed.error().text);
  if (!packed->packed) return open_file(path, offset, true);
  if (Status status = skip(*packed->source, offset); !status)
    return error(short_name(path) + ": " + status.error().text);
  return OpenFile{std::move(packed->source), packed->most};
}

// Opens the data: after the header, or in one file beside it. The size is that of the data.
Result<OpenFile> open_data(const std::filesystem::path& path, const Header& header,
                           std::vector<std::string>& notices) {
  const std::string name = header.get({"ElementDataFile"});
  if (name.empty()) return header.bad("ElementDataFile", "is missing");
  const bool own = name == "LOCAL" || name == "Local" || name == "local";
  const auto data = own ? Result<DataFile>(DataFile{path, ""}) : data_file(path, name);
  if (!data) return data.error();
  if (!data->notice.empty()) notices.push_back(data->notice);
  auto opened = open_voxels(data->path, own ? header.end : 0, own);
  if (!opened && own) return opened.error();
  if (!opened)  // the header is wrong, or the data file was left behind
    return error(fmt::format("{}: its data file: {}; put it in the same folder", header.file,
                             opened.error().text));
  opened->size -= std::min<std::uint64_t>(opened->size, own ? header.end : 0);
  return opened;
}

// Of `volumes` in the file the one with this index.
struct Wanted {
  std::size_t count = 0;  // its voxels
  std::uint64_t index = 0, volumes = 1;
};

// Reads the voxels of an opened file into the scan.
Status read_voxels(const Header& header, const SampleFormat& format, const Wanted& wanted,
                   OpenFile data, bool check_values, Scan& scan, Progress& progress) {
  const std::size_t count = wanted.count;
  const std::uint64_t each = count * bytes_of(format.type), needed = each * wanted.volumes,
                      there = data.size;
  const bool packed = is_true(header.get({"CompressedData"}));
  std::int64_t header_size = 0;
  const std::string header_text = header.get({"HeaderSize"});
  if (!header_text.empty() && (!to_number(header_text, header_size) || header_size < -1))
    return header.bad("HeaderSize", "is not a number of bytes");
  if (header_size == -1)
    header_size = there >= needed && !packed ? static_cast<std::int64_t>(there - needed) : 0;
  if (needed > (packed ? there * kMostGzip : there))
    return error(
        fmt::format("{}: DimSize needs {} bytes of voxels, but the file holds {}; it is cut off or "
                    "its header is wrong",
                    header.file, needed, there));
  std::unique_ptr<ByteSource> source = std::move(data.source);
  Status read = skip(*source, static_cast<std::uint64_t>(header_size));
  if (packed) source = inflate_zlib(std::move(source));
  source = only_share(std::move(source), share_of(wanted.index, wanted.volumes, each));
  VoxelSink sink(count);
  if (read) read = read_samples(*source, format, count, sink, progress);
  if (!read)
    return error(read.error().trouble, fmt::format("{}: {}", header.file, read.error().text));
  if (Status status = sink.finish(scan, false, check_values); !status)
    return error(fmt::format("{}: {}", header.file, status.error().text));
  return fine();
}

// Without a spacing it is taken for 1 mm, and asked for.
Result<Affine> affine_of(const Header& header, std::size_t axes, bool check_scan, Scan& scan) {
  std::vector<std::string>& notices = scan.notices;
  Affine affine;
  const auto vector = [&](std::initializer_list<const char*> names, std::size_t count) {
    return numbers(header.get(names), count, header.commas);
  };
  const std::vector<double> turn =
      vector({"TransformMatrix", "Rotation", "Orientation"}, axes * axes);
  if (turn.size() == axes * axes)  // the file lists the direction of i, then of j, then of k
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        affine.step(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) =
            turn[axes * a + b];
  const std::string spacing_text = header.get({"ElementSpacing", "ElementSize"});
  std::vector<double> spacing = vector({"ElementSpacing", "ElementSize"}, axes);
  if (spacing.empty() && !spacing_text.empty())
    return header.bad("ElementSpacing",
                      fmt::format("\"{}\" is not {} numbers; correct the header",
                                  base::printable(spacing_text), axes == 3 ? "three" : "four"));
  const bool spaced = spacing.size() == axes &&
                      std::isfinite(spacing[0] + spacing[1] + spacing[2]) &&
                      spacing[0] * spacing[1] * spacing[2] != 0;
  if (!spaced) {
    spacing = {1, 1, 1};
    if (check_scan)
      no_spacing(header.file, check_scan, scan);
    else
      notices.emplace_back(
          "The file states no usable voxel spacing: 1 mm is assumed; see `spacing_mm`.");
  }
  for (int a = 0; a < 3; ++a) affine.step.col(a) *= std::abs(spacing[static_cast<std::size_t>(a)]);
  const std::vector<double> origin = vector({"Offset", "Position", "Origin"}, axes);
  if (origin.size() == axes) affine.origin = Vec3(origin[0], origin[1], origin[2]);
  if (header.commas)
    notices.emplace_back(
        "The file writes numbers with a decimal comma (\"0,5\"): read as decimal points.");
  return affine;
}

// "MET_MOD_MR" as DICOM says it; empty: not stated, or another word.
std::string modality_in(const Header& header) {
  constexpr std::string_view kBefore = "MET_MOD_";
  const std::string text = header.get({"Modality"});
  if (!text.starts_with(kBefore)) return {};
  const std::string kind = text.substr(kBefore.size());
  const bool known = kind == "CT" || kind == "MR" || kind == "NM" || kind == "US";
  return known ? kind : std::string();
}

}  // namespace

Result<Scan> read_meta(const std::filesystem::path& path, const ReadOptions& options,
                       Progress& progress) {
  auto head = first_unpacked_bytes(path, std::size_t{1} << 20);
  if (!head) return head.error();
  Header header = parse(std::string(head->begin(), head->end()));
  header.file = short_name(path);
  Scan scan;
  scan.format = "MetaImage";
  const auto size = size_of(header);
  if (!size) return size.error();
  scan.size = size->voxels;
  const auto count = voxel_count(header.file, scan.size.x(), scan.size.y(), scan.size.z());
  if (!count) return count.error();
  const auto volumes = static_cast<std::uint64_t>(size->volumes);
  const auto volume = take_volume(volumes, options, header.file, scan);
  if (!volume) return volume.error();
  const auto format = format_of(header);
  if (!format) return format.error();
  auto data = open_data(path, header, scan.notices);
  if (!data) return data.error();
  if (Status read = read_voxels(header, *format, {*count, *volume, volumes}, std::move(*data),
                                options.check_values, scan, progress);
      !read)
    return read.error();
  if (options.check_scan && scan.labels.empty())
    take_modality(modality_in(header), "", header.file, scan);
  const auto affine = affine_of(header, size->axes, options.check_scan, scan);
  if (!affine) return affine.error();
  if (Status placed = place(scan, *affine, options.spacing_mm, header.file, progress); !placed)
    return placed.error();
  return scan;
}

}  // namespace burr::io

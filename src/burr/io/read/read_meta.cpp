// MetaImage (.mha, .mhd), after https://itk.org/Wiki/ITK/MetaIO/Documentation. World is LPS.
#include <fmt/core.h>

#include <cmath>
#include <map>
#include <system_error>

#include "burr/base/shown.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
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
  std::map<std::string, std::string> fields;
  std::size_t end = 0;  // where LOCAL data begins
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

// The first of these fields that is there.
std::string field_of(const Header& header, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto found = header.fields.find(name);
    if (found != header.fields.end()) return found->second;
  }
  return {};
}

Result<Affine> affine_of(const Header& header, const std::string& file, bool& commas, Scan& scan) {
  Affine affine;
  const auto vector = [&](std::initializer_list<const char*> names, std::size_t size_wanted) {
    return numbers(field_of(header, names), size_wanted, commas);
  };
  const std::vector<double> turn = vector({"TransformMatrix", "Rotation", "Orientation"}, 9);
  if (turn.size() == 9)  // the file lists the direction of i, then of j, then of k
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) affine.step(b, a) = turn[static_cast<std::size_t>(3 * a + b)];
  const std::string spacing_text = field_of(header, {"ElementSpacing", "ElementSize"});
  std::vector<double> spacing = vector({"ElementSpacing", "ElementSize"}, 3);
  if (spacing.empty() && !spacing_text.empty())
    return error(fmt::format("{}: ElementSpacing: \"{}\" is not three numbers; correct the header",
                             file, base::shown(spacing_text)));
  const bool spaced = spacing.size() == 3 && std::isfinite(spacing[0] + spacing[1] + spacing[2]) &&
                      spacing[0] * spacing[1] * spacing[2] != 0;
  if (!spaced) {
    spacing = {1, 1, 1};
    scan.notices.emplace_back(
        "The file states no usable voxel spacing: taken for 1 mm; see --spacing-mm.");
  }
  for (int a = 0; a < 3; ++a) affine.step.col(a) *= std::abs(spacing[static_cast<std::size_t>(a)]);
  const std::vector<double> origin = vector({"Offset", "Position", "Origin"}, 3);
  if (origin.size() == 3) affine.origin = Vec3(origin[0], origin[1], origin[2]);
  if (commas)
    scan.notices.emplace_back(
        "The file writes numbers with a decimal comma (\"0,5\"): read as decimal points.");
  return affine;
}

}  // namespace

Result<Scan> read_meta(const std::filesystem::path& path, const ReadOptions& options,
                       Progress& progress) {
  const std::string file = short_name(path);
  auto head = first_bytes(path, std::size_t{1} << 20);
  if (!head) return head.error();
  Header header = parse(std::string(head->begin(), head->end()));
  const auto get = [&](std::initializer_list<const char*> names) {
    return field_of(header, names);
  };
  const auto bad = [&](const char* field, const std::string& what) {
    return error(fmt::format("{}: {}: {}", file, field, what));
  };

  std::int64_t dims = 0;
  if (!to_number(get({"NDims"}), dims)) return bad("NDims", "is missing; this is no MetaImage");
  if (dims != 3)
    return bad("NDims", fmt::format("3 axes expected, {} found; burr reads single volumes", dims));
  const std::vector<double> size = numbers(get({"DimSize"}));
  if (size.size() != 3) return bad("DimSize", "three sizes expected");
  for (const double n : size)
    if (!(n >= 1 && n <= 1e9) || n != std::floor(n))
      return bad("DimSize", "a size is no whole number above 0");
  auto count = voxel_count(file, static_cast<std::int64_t>(size[0]),
                           static_cast<std::int64_t>(size[1]), static_cast<std::int64_t>(size[2]));
  if (!count) return count.error();
  std::int64_t channels = 1;
  const std::string channel_text = get({"ElementNumberOfChannels"});
  if (!channel_text.empty() && (!to_number(channel_text, channels) || channels != 1))
    return bad("ElementNumberOfChannels", "burr reads one value a voxel, not colours or vectors");

  SampleFormat format;
  const std::string type = get({"ElementType"});
  if (!sample_type(type, format.type))
    return bad("ElementType", fmt::format("\"{}\" is not read", base::shown(type)));
  format.big_endian = is_true(get({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
  const std::string binary = get({"BinaryData"});
  if (!binary.empty() && !is_true(binary))
    return bad("BinaryData", "numbers as text are not read; save it as binary");
  bool commas = false;
  const auto scale = [&](const char* field, double& out) -> Status {
    double value = 0;
    const std::string text = get({field});
    if (text.empty()) return fine();
    if (!to_number(text, value, commas) || !std::isfinite(value))
      return bad(field, fmt::format("\"{}\" is no number", base::shown(text)));
    out = value;
    return fine();
  };
  double slope = 1;
  if (Status good = scale("ElementToIntensityFunctionSlope", slope); !good) return good.error();
  if (slope != 0) format.slope = slope;
  if (Status good = scale("ElementToIntensityFunctionOffset", format.intercept); !good)
    return good.error();

  Scan scan;
  scan.format = "MetaImage";
  scan.size = {static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2])};

  // the data: after the header, or in one file beside it
  const std::string name = get({"ElementDataFile"});
  if (name.empty()) return bad("ElementDataFile", "is missing");
  if (words(name).size() > 1 || name.rfind("LIST", 0) == 0 || name.find('%') != std::string::npos)
    return bad("ElementDataFile", "lists and patterns of files are not read; save it as one file");
  const bool own = name == "LOCAL" || name == "Local" || name == "local";
  std::filesystem::path data = path;
  if (!own) {
    auto other = beside(path, name);
    if (!other) return other.error();
    data = *other;
  }
  auto opened = open_file(data, own ? header.end : 0, own);
  if (!opened && own) return opened.error();
  if (!opened)  // the header is wrong, or the data file was left behind
    return error(
        fmt::format("{}: its data file: {}; put it in the same folder", file, opened.error().text));
  const std::uint64_t needed = *count * bytes_of(format.type);
  std::uint64_t there = opened->size - std::min<std::uint64_t>(opened->size, own ? header.end : 0);
  const bool packed = is_true(get({"CompressedData"}));
  std::int64_t header_size = 0;
  const std::string header_text = get({"HeaderSize"});
  if (!header_text.empty() && (!to_number(header_text, header_size) || header_size < -1))
    return bad("HeaderSize", "is no number of bytes");
  if (header_size == -1)
    header_size = there >= needed && !packed ? static_cast<std::int64_t>(there - needed) : 0;
  if (needed > (packed ? there * kMostGzip : there))
    return error(
        fmt::format("{}: DimSize promises {} bytes of voxels, the file holds {}; it is cut off "
                    "or its header is wrong",
                    file, needed, there));
  std::unique_ptr<ByteSource> source = std::move(opened->source);
  Status read = skip(*source, static_cast<std::uint64_t>(header_size));
  if (packed) source = inflate_zlib(std::move(source));
  VoxelSink sink(*count);
  if (read) read = read_samples(*source, format, *count, sink, progress);
  if (!read) return error(read.error().trouble, fmt::format("{}: {}", file, read.error().text));
  if (Status status = sink.finish(scan, false); !status)
    return error(fmt::format("{}: {}", file, status.error().text));

  const auto affine = affine_of(header, file, commas, scan);
  if (!affine) return affine.error();
  if (Status status = place(scan, *affine, options.spacing_mm, file, progress); !status)
    return status.error();
  return scan;
}

}  // namespace burr::io

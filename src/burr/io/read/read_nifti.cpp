// NIfTI-1 and NIfTI-2, one file or a pair, with or without gzip, after https://nifti.nimh.nih.gov
// (nifti1.h, nifti2.h). World is RAS there: x and y change sign here.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include <Eigen/Geometry>

#include "burr/io/read/beside.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/compare_frames.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/label_lists.h"
#include "burr/io/read/modality.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/several_volumes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Mat3;
using math::Vec3;

// NIfTI-2 has 540 bytes, and says so in its first number.
std::size_t header_size(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() >= 540 && (bytes[0] == 0x1C || bytes[3] == 0x1C) ? 540 : 348;
}

// The fields that burr needs, of either version.
struct Nifti {
  bool big_endian = false, pair = false;
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  std::string description;
  int datatype = 0, qform = 0, sform = 0, units = 0;
  double offset = 0, slope = 0, intercept = 0;
  Vec3 quaternion = Vec3::Zero(), quaternion_offset = Vec3::Zero();
  Eigen::Matrix<double, 3, 4> rows = Eigen::Matrix<double, 3, 4>::Zero();
};

class Fields {
 public:
  Fields(const std::vector<std::uint8_t>& bytes, bool swap) : bytes_(bytes), swap_(swap) {}
  template <class T>
  [[nodiscard]] T get(std::size_t at) const {
    std::array<std::uint8_t, sizeof(T)> raw{};
    if (at + sizeof(T) <= bytes_.size()) std::memcpy(raw.data(), bytes_.data() + at, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  bool swap_;
};

Result<Nifti> parse(const std::vector<std::uint8_t>& bytes, const std::string& file) {
  if (bytes.size() < 348)
    return error(fmt::format("{}: the file has {} bytes, too few for a NIfTI header; copy it again",
                             file, bytes.size()));
  bool swap = false;
  std::int32_t length = Fields(bytes, false).get<std::int32_t>(0);
  if (length != 348 && length != 540) {
    swap = true;
    length = Fields(bytes, true).get<std::int32_t>(0);
  }
  const bool two = length == 540;
  if (length != 348 && !two)
    return error(
        fmt::format("{}: is not a NIfTI file (header length {}); check the name", file, length));
  if (two && bytes.size() < 540)
    return error(
        fmt::format("{}: the file has {} bytes, too few for a NIfTI-2 header; copy it again", file,
                    bytes.size()));
  const Fields at(bytes, swap);
  Nifti n;
  n.big_endian = swap == (std::endian::native == std::endian::little);
  const std::string magic(reinterpret_cast<const char*>(bytes.data()) + (two ? 4 : 344), 3);
  if (magic == (two ? "ni2" : "ni1"))
    n.pair = true;
  else if (magic != (two ? "n+2" : "n+1"))
    return error(
        fmt::format("{}: is not a NIfTI file (its magic string is missing); burr does not read "
                    "Analyze 7.5, convert it to NIfTI",
                    file));
  for (std::size_t i = 0; i < 8; ++i) {
    n.dim[i] = two ? at.get<std::int64_t>(16 + 8 * i) : at.get<std::int16_t>(40 + 2 * i);
    n.pixdim[i] = two ? at.get<double>(104 + 8 * i) : double{at.get<float>(76 + 4 * i)};
  }
  constexpr std::size_t kDescription = 80;  // bytes
  const auto text = bytes.begin() + (two ? 240 : 148);
  n.description.assign(text, text + kDescription);
  n.datatype = at.get<std::int16_t>(two ? 12 : 70);
  n.offset = two ? static_cast<double>(at.get<std::int64_t>(168)) : double{at.get<float>(108)};
  n.slope = two ? at.get<double>(176) : double{at.get<float>(112)};
  n.intercept = two ? at.get<double>(184) : double{at.get<float>(116)};
  n.units = two ? at.get<std::int32_t>(500) : at.get<std::uint8_t>(123);
  n.qform = two ? at.get<std::int32_t>(344) : at.get<std::int16_t>(252);
  n.sform = two ? at.get<std::int32_t>(348) : at.get<std::int16_t>(254);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    n.quaternion[a] = two ? at.get<double>(352 + 8 * i) : double{at.get<float>(256 + 4 * i)};
    n.quaternion_offset[a] = two ? at.get<double>(376 + 8 * i) : double{at.get<float>(268 + 4 * i)};
    for (int b = 0; b < 4; ++b) {
      const auto j = static_cast<std::size_t>(4 * a + b);
      n.rows(a, b) = two ? at.get<double>(400 + 8 * j) : double{at.get<float>(280 + 4 * j)};
    }
  }
  return n;
}

bool sample_type(int datatype, SampleType& type) {
  switch (datatype) {
    case 2:
      type = SampleType::u8;
      return true;
    case 4:
      type = SampleType::i16;
      return true;
    case 8:
      type = SampleType::i32;
      return true;
    case 16:
      type = SampleType::f32;
      return true;
    case 64:
      type = SampleType::f64;
      return true;
    case 256:
      type = SampleType::i8;
      return true;
    case 512:
      type = SampleType::u16;
      return true;
    case 768:
      type = SampleType::u32;
      return true;
    case 1024:
      type = SampleType::i64;
      return true;
    case 1280:
      type = SampleType::u64;
      return true;
    default:
      return false;
  }
}

std::string type_name(int datatype) {
  switch (datatype) {
    case 1:
      return "single bits";
    case 32:
    case 1792:
    case 2048:
      return "complex numbers";
    case 128:
    case 2304:
      return "colours";
    case 1536:
      return "128-bit floats";
    default:
      return fmt::format("data type {}", datatype);
  }
}

double mm_per_unit(const Nifti& n) {
  return (n.units & 7) == 1 ? 1000.0 : (n.units & 7) == 3 ? 1e-3 : 1.0;
}

Affine in_mm(Affine affine, const Nifti& n) {
  affine.step *= mm_per_unit(n);
  affine.origin *= mm_per_unit(n);
  return affine;
}

// pixdim, with 1 where it states nothing; `guessed` is set then.
Vec3 spacing_of(const Nifti& n, bool& guessed) {
  Vec3 spacing(n.pixdim[1], n.pixdim[2], n.pixdim[3]);
  for (int a = 0; a < 3; ++a) {
    spacing[a] = std::abs(spacing[a]);
    if (!std::isfinite(spacing[a]) || spacing[a] == 0) {
      spacing[a] = 1;
      guessed = true;
    }
  }
  return spacing;
}

// ras = step * ijk + origin, as the sform states it; nothing: it does not.
std::optional<Affine> sform_of(const Nifti& n) {
  if (n.sform <= 0) return std::nullopt;
  Affine affine;
  affine.step = n.rows.leftCols<3>();
  affine.origin = n.rows.col(3);
  return in_mm(affine, n);
}

// The same by the qform.
std::optional<Affine> qform_of(const Nifti& n, const Vec3& spacing) {
  if (n.qform <= 0) return std::nullopt;
  const double b = n.quaternion.x(), c = n.quaternion.y(), d = n.quaternion.z();
  const double rest = 1.0 - (b * b + c * c + d * d);
  Eigen::Quaterniond q(rest > 0 ? std::sqrt(rest) : 0.0, b, c, d);
  if (!q.coeffs().allFinite() || !(q.norm() > 0.5)) return std::nullopt;
  q.normalize();
  const double mirror = n.pixdim[0] < 0 ? -1 : 1;
  Affine affine;
  affine.step =
      q.toRotationMatrix() * Vec3(spacing.x(), spacing.y(), mirror * spacing.z()).asDiagonal();
  affine.origin = n.quaternion_offset;
  affine = in_mm(affine, n);
  return usable(affine) ? std::optional(affine) : std::nullopt;
}

// What else the file says of the place that its sform states: the qform, or pixdim alone, which
// states the spacing. A pixdim of ones was never set.
void compare_with_sform(const Nifti& n, const Affine& sform, const Vec3& spacing, bool guessed,
                        const std::string& file, Scan& scan) {
  const StatedFrame used{sform, "sform"};
  if (const auto qform = qform_of(n, spacing)) {
    compare_frames(used, {*qform, "qform"}, file, scan);
  } else if (!guessed && !spacing.isOnes(1e-6)) {
    Affine sized = sform;
    for (int a = 0; a < 3; ++a)
      sized.step.col(a) = sform.step.col(a).normalized() * spacing[a] * mm_per_unit(n);
    // of this only the size is a statement of the file
    if ((sized.step - sform.step).norm() > 0.02 * sform.step.norm() && usable(sized))
      compare_frames(used, {sized, "pixdim"}, file, scan);
  }
}

// From the sform, else the qform, else the spacing alone.
Affine affine_of(const Nifti& n, const std::string& file, bool check_scan, Scan& scan) {
  bool guessed = false;
  const Vec3 spacing = spacing_of(n, guessed);
  auto found = sform_of(n);
  if (found && !usable(*found)) {
    scan.notices.emplace_back("The sform of the file is not valid and was ignored.");
    found.reset();
  }
  if (found && check_scan) compare_with_sform(n, *found, spacing, guessed, file, scan);
  const bool sized = found.has_value();  // the sform alone states the spacing too
  if (!found) found = qform_of(n, spacing);
  Affine affine;
  if (found) {
    affine = *found;
  } else {
    affine.step = (mm_per_unit(n) * spacing).asDiagonal();
    scan.notices.emplace_back(
        "The file does not state its orientation: right, anterior, superior is assumed.");
  }
  if (!sized && guessed && (check_scan || !found)) no_spacing(file, check_scan, scan);
  const Mat3 lps_from_ras = Vec3(-1, -1, 1).asDiagonal();
  affine.step = lps_from_ras * affine.step;
  affine.origin = lps_from_ras * affine.origin;
  return affine;
}

// NIfTI states no modality. Converters write the echo time of an MR into the description, and only
// an MR has one.
bool described_as_mr(const Nifti& n) {
  const std::size_t at = n.description.find("TE=");
  return at != std::string::npos && at + 3 < n.description.size() && n.description[at + 3] >= '0' &&
         n.description[at + 3] <= '9';
}

// "x.hdr.gz" <-> "x.img.gz"; each part may be compressed or not. Empty: it is not there.
std::filesystem::path partner(const std::filesystem::path& path, const char* from, const char* to) {
  std::string name = path.filename().string();
  const std::size_t at = lower(name).rfind(from);
  if (at == std::string::npos) return {};
  name.replace(at, 4, to);
  if (const auto other = find_beside(path, name)) return *other;
  const bool packed = lower(name).ends_with(".gz");
  const auto other = find_beside(path, packed ? name.substr(0, name.size() - 3) : name + ".gz");
  return other.value_or(std::filesystem::path());
}

// Names of labels in the extensions between the header and the voxels (nifti1.h, "extension"): 4
// bytes that say whether there are any, then for each its size, its code and its text. head: the
// file's first bytes, already read from the source; end: where the voxels begin.
std::vector<Label> labels_in_extensions(const Nifti& header, std::size_t header_size,
                                        std::vector<std::uint8_t> head, std::uint64_t end,
                                        ByteSource& source) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;  // [byte]
  if (head.size() < header_size + 4 || head[header_size] == 0) return {};
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(end, kLongest));
  std::size_t have = head.size();
  if (wanted > have) head.resize(wanted);
  while (have < head.size()) {
    const auto got = source.read(head.data() + have, head.size() - have);
    if (!got || *got == 0) break;
    have += *got;
  }
  head.resize(std::min(have, wanted));
  std::vector<Label> labels;
  const bool swap = header.big_endian == (std::endian::native == std::endian::little);
  for (std::size_t at = header_size + 4; at + 8 <= head.size();) {
    const auto size = Fields(head, swap).get<std::int32_t>(at);
    if (size <= 8 || static_cast<std::size_t>(size) > head.size() - at) break;
    const std::string_view text(reinterpret_cast<const char*>(head.data()) + at + 8,
                                static_cast<std::size_t>(size) - 8);
    for (const auto& found : {labels_in_xml(text), labels_in_json(text)})
      labels.insert(labels.end(), found.begin(), found.end());
    at += static_cast<std::size_t>(size);
  }
  return labels;
}

// Axes beyond the third count volumes: times, directions, channels.
Result<std::uint64_t> volumes_in(const Nifti& header, const std::string& file) {
  if (header.dim[0] < 1 || header.dim[0] > 7)
    return error(fmt::format("{}: dim[0] is {}, but 3 was expected", file, header.dim[0]));
  if (header.dim[0] < 3)
    return error(fmt::format("{}: 3 axes expected, {} found; a single picture is not a volume",
                             file, header.dim[0]));
  std::uint64_t volumes = 1;
  constexpr std::uint64_t kMost = 1'000'000;
  for (std::size_t a = 4; a <= static_cast<std::size_t>(header.dim[0]); ++a) {
    if (header.dim[a] > 1) volumes *= static_cast<std::uint64_t>(header.dim[a]);
    if (volumes > kMost)
      return error(fmt::format("{}: dim: more than {} volumes; its header is wrong", file, kMost));
  }
  return volumes;
}

}  // namespace

Result<Scan> read_nifti(const std::filesystem::path& given, const ReadOptions& options,
                        Progress& progress) {
  const std::string file = short_name(given);
  // of a pair, the header is read first
  std::filesystem::path path = given;
  if (lower(file).find(".img") != std::string::npos) {
    path = partner(given, ".img", ".hdr");
    if (path.empty())
      return error(
          fmt::format("{}: its header (.hdr) is missing; put it in the same folder", file));
  }
  auto opened = open_unpacked(path, path == given);
  if (!opened) return opened.error();
  std::vector<std::uint8_t> head(540);
  std::size_t have = 0;
  while (have < head.size()) {
    auto got = opened->source->read(head.data() + have, head.size() - have);
    if (!got) return error(got.error().trouble, fmt::format("{}: {}", file, got.error().text));
    if (*got == 0) break;
    have += *got;
  }
  head.resize(have);
  auto header = parse(head, file);
  if (!header) return header.error();

  const auto volumes = volumes_in(*header, file);
  if (!volumes) return volumes.error();
  auto count = voxel_count(file, header->dim[1], header->dim[2], header->dim[3]);
  if (!count) return count.error();
  SampleFormat format;
  if (!sample_type(header->datatype, format.type))
    return error(fmt::format("{}: datatype: burr does not read {}; it reads one number per voxel",
                             file, type_name(header->datatype)));
  format.big_endian = header->big_endian;
  if (std::isfinite(header->slope) && header->slope != 0) {
    format.slope = header->slope;
    format.intercept = std::isfinite(header->intercept) ? header->intercept : 0;
  }

  Scan scan;
  scan.format = "NIfTI";
  scan.size = {static_cast<int>(header->dim[1]), static_cast<int>(header->dim[2]),
               static_cast<int>(header->dim[3])};
  const double first = header->pair ? 0 : have >= 540 && head[0] + head[3] != 92 ? 544 : 352;
  if (!std::isfinite(header->offset) || header->offset < 0 || header->offset > 1e12)
    return error(
        fmt::format("{}: vox_offset is not a position in the file; its header is wrong", file));
  const double at = header->offset > 0 ? header->offset : first;
  const auto offset = static_cast<std::uint64_t>(at);
  constexpr std::uint64_t kWhole = std::uint64_t{1} << 40;  // a header of its own: to its end
  scan.label_names = labels_in_extensions(*header, header_size(head), head,
                                          header->pair ? kWhole : offset, *opened->source);

  if (header->pair) {
    const auto image = partner(path, ".hdr", ".img");
    if (image.empty())
      return error(
          fmt::format("{}: its data file (.img) is missing; put it in the same folder", file));
    opened = open_unpacked(image, image == given);
  } else {
    opened = open_unpacked(path, path == given);
  }
  if (!opened) return opened.error();
  const std::uint64_t each = *count * bytes_of(format.type), needed = each * *volumes;
  if (offset > opened->most || needed > opened->most - offset)
    return error(
        fmt::format("{}: the header needs {} bytes of voxels, but the file cannot hold them; it is "
                    "cut off or its header is wrong",
                    file, needed));
  const auto volume = take_volume(*volumes, options, file, scan);
  if (!volume) return volume.error();
  VoxelSink sink(*count);
  Status read = skip(*opened->source, offset);
  opened->source = only_share(std::move(opened->source), share_of(*volume, *volumes, each));
  if (read) read = read_samples(*opened->source, format, *count, sink, progress);
  if (!read) return error(read.error().trouble, fmt::format("{}: {}", file, read.error().text));
  const bool sure = !scan.label_names.empty() && sink.all_are_among(scan.label_names);
  if (Status status = sink.finish(scan, sure, options.check_values); !status)
    return error(fmt::format("{}: {}", file, status.error().text));
  if (scan.labels.empty()) scan.label_names.clear();
  const Affine affine = affine_of(*header, file, options.check_scan, scan);
  if (options.check_scan && !scan.hounsfield && scan.labels.empty() && described_as_mr(*header))
    take_modality("MR", "", file, scan);
  if (Status status = place(scan, affine, options.spacing_mm, file, progress); !status)
    return status.error();
  return scan;
}

}  // namespace burr::io

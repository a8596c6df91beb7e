// Chooses the reader of a file: by its first bytes, else by its name.
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/io/read/adf_folder.h"
#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/foreign.h"
#include "burr/io/read/picture_stack.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/text.h"
#include "burr/io/read/volume_folder.h"

namespace burr::io {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool begins_with(const std::vector<std::uint8_t>& bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

Result<Scan> read_by_content(const std::filesystem::path& path, const ReadOptions& options,
                             Progress& progress) {
  std::string name = short_name(path);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  auto head = first_unpacked_bytes(path, 132);
  if (!head) return head.error();
  if (head->empty())
    return error(fmt::format("{}: the file is empty; copy it again", short_name(path)));

  using namespace std::string_view_literals;
  constexpr std::pair<std::string_view, const char*> kOtherPackings[] = {
      {"\xFD\x37zXZ"sv, "xz"}, {"\x28\xB5\x2F\xFD"sv, "zstd"}, {"7z\xBC\xAF\x27\x1C"sv, "7z"}};
  for (const auto& [magic, packing] : kOtherPackings)
    if (begins_with(*head, 0, magic))
      return error(fmt::format("{}: is packed with {}, which burr does not unpack; unpack it first",
                               short_name(path), packing));
  if (begins_with(*head, 0, "NRRD")) return read_nrrd(path, options, progress);
  if (is_dicomdir(path)) {
    const std::filesystem::path folder =
        path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
    auto scan = read_dicom(folder, options, progress);
    if (scan)
      scan->notices.push_back(
          fmt::format("{} is an index: the folder that it lies in was read.", short_name(path)));
    return scan;
  }
  if (begins_with(*head, 128, "DICM")) {
    if (auto own = first_bytes(path, 132); own && !begins_with(*own, 128, "DICM"))
      return error(fmt::format("{}: is a packed DICOM file; unpack it first and give the result",
                               short_name(path)));
    return read_dicom(path, options, progress);
  }
  for (const char* packing : {".gz", ".bz2", ".bgz"})  // "x.nii.gz.gz"
    while (ends_with(name, packing)) name.resize(name.size() - std::strlen(packing));
  for (const char* end : {".nii", ".hdr", ".img"})
    if (ends_with(name, end)) return read_nifti(path, options, progress);
  if (ends_with(name, ".mha") || ends_with(name, ".mhd")) return read_meta(path, options, progress);
  if (ends_with(name, ".nrrd") || ends_with(name, ".nhdr"))
    return error(
        fmt::format("{}: does not begin with \"NRRD\", so it is not an NRRD file; check the name",
                    short_name(path)));
  if (named_as_adf(path)) return read_adf(path, options, progress);
  // NIfTI under another name: the header begins with its length
  const auto first = (*head)[0] | (*head)[1] << 8 | (*head)[2] << 16;
  if (head->size() > 4 && (first == 348 || first == 540))
    return read_nifti(path, options, progress);
  if (begins_with(*head, 0, "ObjectType")) return read_meta(path, options, progress);
  if (is_zip(*head))
    return error(
        fmt::format("{}: is a zip archive inside another one; unpack it and give burr the "
                    "folder",
                    short_name(path)));
  if (!pictures_among({path}).empty()) return read_picture(path, options, progress);
  if (const Foreign other = foreign(path, *head); !other.what.empty())
    return error(
        fmt::format("{}: is {}, no scan: {}", short_name(path), other.what, other.instead));
  // perhaps DICOM without its 128-byte preamble
  return read_dicom(path, options, progress);
}

// ---- folders

constexpr std::size_t kMostFiles = 100000;
constexpr int kDeepestFolder = 10;

// What lies in a folder, without what systems leave there.
struct Inside {
  std::vector<std::filesystem::path> volumes;  // that hold a whole scan each, by their names
  std::vector<std::filesystem::path> others;   // without data files of a volume's header
};

bool has_ending(const std::string& name, std::initializer_list<const char*> all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const char* ending) { return ends_with(name, ending); });
}

void sort_in(Inside& found, const std::filesystem::path& file) {
  const std::string name = lower(file.filename().string());
  if (has_ending(name, {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".hdr", ".hdr.gz"}))
    found.volumes.push_back(file);
  else if (!has_ending(name, {".raw", ".raw.gz", ".zraw", ".img", ".img.gz"}))
    found.others.push_back(file);
}

Inside look_into(const std::filesystem::path& folder) {
  Inside found;
  if (const auto packed = files_in_archive(folder)) {
    for (const std::filesystem::path& file : *packed)
      if (!left_by_a_system(file, folder)) sort_in(found, file);
    return found;
  }
  std::error_code trouble;
  auto walk = std::filesystem::recursive_directory_iterator(
      folder, std::filesystem::directory_options::skip_permission_denied, trouble);
  std::size_t files = 0;
  for (; !trouble && walk != std::filesystem::recursive_directory_iterator() && files < kMostFiles;
       walk.increment(trouble)) {
    if (walk.depth() >= kDeepestFolder) walk.disable_recursion_pending();
    std::error_code kind;
    if (left_by_a_system(walk->path())) {
      if (walk->is_directory(kind)) walk.disable_recursion_pending();
      continue;
    }
    if (walk->is_symlink(kind) || !walk->is_regular_file(kind)) continue;
    ++files;
    sort_in(found, walk->path());
  }
  std::sort(found.volumes.begin(), found.volumes.end());
  std::sort(found.others.begin(), found.others.end());
  return found;
}

Result<Scan> read_zip(const std::filesystem::path& archive, const ReadOptions& options,
                      Progress& progress);

bool any_dicom(const std::vector<std::filesystem::path>& files) {
  return std::any_of(files.begin(), files.end(), [](const std::filesystem::path& path) {
    const auto head = first_bytes(path, 132, false);
    return head && begins_with(*head, 128, "DICM") && !is_dicomdir(path);
  });
}

// Why a folder without a scan is none, if its files are of a known kind; empty: they are not.
std::string foreign_folder(const std::filesystem::path& folder, const Inside& inside) {
  std::map<std::string, std::size_t> kinds;
  std::string instead;
  std::size_t most = 0;
  for (const std::filesystem::path& path : inside.others) {
    const auto head = first_bytes(path, 132, false);
    const Foreign other = head ? foreign(path, *head) : Foreign{};
    if (other.what.empty()) continue;
    if (const std::size_t count = ++kinds[other.what]; count > most) {
      most = count;
      instead = other.instead;
    }
  }
  if (kinds.empty()) return {};
  std::string held;
  for (const auto& [what, count] : kinds)
    held += fmt::format("{}{} {} {}", held.empty() ? "" : ", ", count,
                        count == 1 ? "time" : "times", what);
  return fmt::format("{}: holds no scan, but {}: {}", short_name(folder), held, instead);
}

Result<Scan> read_dicom_folder(const std::filesystem::path& folder, const Inside& inside,
                               const ReadOptions& options, Progress& progress) {
  auto scan = read_dicom(folder, options, progress);
  if (!scan && scan.error().trouble == Trouble::data && !any_dicom(inside.others))
    if (const std::string why = foreign_folder(folder, inside); !why.empty()) return error(why);
  if (scan && !inside.volumes.empty())
    scan->notices.push_back(
        fmt::format("Beside the DICOM files lies {}; it was left out.", names_of(inside.volumes)));
  return scan;
}

// The ADF of AMBF that describes the pictures of this folder; empty: there is none.
Result<std::filesystem::path> adf_in(const std::filesystem::path& folder, const Inside& inside) {
  std::vector<std::filesystem::path> found;
  for (const std::filesystem::path& path : inside.others)
    if (named_as_adf(path))
      if (const auto is = describes_pictures(path); is && *is) found.push_back(path);
  if (found.size() > 1)
    return error(fmt::format("{}: holds {} ADF files ({}); give burr one of them",
                             short_name(folder), found.size(), names_of(found)));
  return found.empty() ? std::filesystem::path() : found.front();
}

// A folder as a person would take it: DICOM files, or the one scan that lies there.
Result<Scan> read_folder(const std::filesystem::path& folder, const ReadOptions& options,
                         Progress& progress) {
  const Inside inside = look_into(folder);
  if (inside.volumes.empty() && inside.others.size() == 1) {
    const std::filesystem::path& only = inside.others.front();
    const auto head = first_bytes(only, 4, false);
    if (head && is_zip(*head) && !files_in_archive(folder))
      return read_zip(only, options, progress);
    return read_by_content(only, options, progress);
  }
  if (inside.volumes.empty() &&
      std::any_of(inside.others.begin(), inside.others.end(), named_as_adf)) {
    const auto adf = adf_in(folder, inside);
    if (!adf) return adf.error();
    if (!adf->empty()) return read_adf(*adf, options, progress);
  }
  if (inside.volumes.empty() && !any_dicom(inside.others)) {
    const auto pictures = pictures_among(inside.others);
    // a picture or two among files of another kind are no stack
    if (!pictures.empty() && 2 * pictures.size() >= inside.others.size())
      return read_picture_stack(pictures, short_name(folder), options, progress);
  }
  if (inside.volumes.empty() || any_dicom(inside.others))
    return read_dicom_folder(folder, inside, options, progress);
  if (inside.volumes.size() == 1) return read_by_content(inside.volumes.front(), options, progress);
  ReadOptions of_one = options;  // the series names one of the folder, not one in a file
  of_one.series.clear();
  const VolumeFolder volumes{folder, inside.volumes, [&](const std::filesystem::path& path) {
                               return read_by_content(path, of_one, progress);
                             }};
  return read_volume_folder(volumes, options, progress);
}

// A zip archive, as the folder that was packed into it.
Result<Scan> read_zip(const std::filesystem::path& archive, const ReadOptions& options,
                      Progress& progress) {
  if (Status status = open_archive(archive); !status) return status.error();
  const Inside inside = look_into(archive);
  if (inside.volumes.empty() && inside.others.empty())
    return error(fmt::format("{}: the zip archive holds no file", short_name(archive)));
  return read_folder(archive, options, progress);
}

// A distance between voxels that no scan of bone has is a mistake of units more often than not.
void doubt_spacing(Scan& scan, const std::string& file) {
  if (scan.size.minCoeff() < 2) return;
  const math::Vec3& s = scan.spacing_mm;
  constexpr double kFinest = 0.002, kWidest = 5, kThickest = 10;  // [mm]
  const double low = s.minCoeff();
  if (low >= kFinest && std::max(s.x(), s.y()) <= kWidest && s.z() <= kThickest) return;
  const double factor = low < kFinest ? 1e3 : 1e-3;
  scan.ask(
      Ask::spacing,
      fmt::format("{}: states voxels of {:.4g} x {:.4g} x {:.4g} mm, which no scan of bone has "
                  "(if the numbers are {}, they are {:.4g},{:.4g},{:.4g})",
                  file, s.x(), s.y(), s.z(), low < kFinest ? "metres" : "micrometres",
                  s.x() * factor, s.y() * factor, s.z() * factor));
}

}  // namespace

Result<Scan> read_unfenced(const std::filesystem::path& path, const ReadOptions& options,
                           Progress& progress) {
  std::error_code trouble;
  const auto status = std::filesystem::status(path, trouble);
  if (trouble || status.type() == std::filesystem::file_type::not_found)
    return error(Trouble::io, fmt::format("{}: cannot be found; check the name", short_name(path)));
  if (!options.spacing_mm.isZero() && !(options.spacing_mm.array() > 0).all())
    return error(Trouble::usage, "`spacing_mm`: must be three numbers above 0");
  try {
    set_files_inside(nullptr);
    bool zipped = false;
    if (!std::filesystem::is_directory(status))
      if (const auto head = first_bytes(path, 4)) zipped = is_zip(*head);
    auto scan = std::filesystem::is_directory(status) ? read_folder(path, options, progress)
                : zipped                              ? read_zip(path, options, progress)
                                                      : read_by_content(path, options, progress);
    if (scan && options.spacing_mm.isZero() && scan->questions.empty())
      doubt_spacing(*scan, short_name(path));
    return scan;
  } catch (const std::bad_alloc&) {
    return error(
        fmt::format("{}: reading it needs more memory than allowed; if you trust it, allow more "
                    "with `read_memory_mb`",
                    short_name(path)));
  } catch (const std::exception& problem) {  // from a library used here
    return error(fmt::format("{}: cannot be read: {}", short_name(path), problem.what()));
  }
}

}  // namespace burr::io

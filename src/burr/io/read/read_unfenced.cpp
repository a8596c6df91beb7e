// Chooses the reader of a file: by its first bytes, else by its name.
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/io/read/bytes.h"
#include "burr/io/read/readers.h"

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
  // NIfTI under another name: the header begins with its length
  const auto first = (*head)[0] | (*head)[1] << 8 | (*head)[2] << 16;
  if (head->size() > 4 && (first == 348 || first == 540))
    return read_nifti(path, options, progress);
  if (begins_with(*head, 0, "ObjectType")) return read_meta(path, options, progress);
  // perhaps DICOM without its 128-byte preamble
  return read_dicom(path, options, progress);
}

// The only file in a folder, whatever it is; otherwise the folder itself, as a DICOM series.
std::filesystem::path only_file_in(const std::filesystem::path& folder) {
  std::error_code trouble;
  std::filesystem::path only;
  for (std::filesystem::directory_iterator it(folder, trouble), end; !trouble && it != end;
       it.increment(trouble)) {
    if (!only.empty() || !it->is_regular_file(trouble)) return folder;
    only = it->path();
  }
  return trouble || only.empty() ? folder : only;
}

}  // namespace

Result<Scan> read_unfenced(const std::filesystem::path& path, const ReadOptions& options,
                           Progress& progress) {
  std::error_code trouble;
  const auto status = std::filesystem::status(path, trouble);
  if (trouble || status.type() == std::filesystem::file_type::not_found)
    return error(Trouble::io, fmt::format("{}: cannot be found; check the name", short_name(path)));
  if (!options.spacing_mm.isZero() && !(options.spacing_mm.array() > 0).all())
    return error(Trouble::usage, "--spacing-mm: must be three numbers above 0");
  try {
    if (!std::filesystem::is_directory(status)) return read_by_content(path, options, progress);
    const std::filesystem::path only = only_file_in(path);
    return only == path ? read_dicom(path, options, progress)
                        : read_by_content(only, options, progress);
  } catch (const std::bad_alloc&) {
    return error(
        fmt::format("{}: reading it needs more memory than allowed; if you trust it, allow more "
                    "with --read-memory-mb",
                    short_name(path)));
  } catch (const std::exception& problem) {  // from a library used here
    return error(fmt::format("{}: cannot be read: {}", short_name(path), problem.what()));
  }
}

}  // namespace burr::io

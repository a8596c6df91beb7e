// DICOM files as in PS3.5 and PS3.10 of the standard: with or without preamble, implicit or
// explicit value representation, little or big endian, deflated.
#include "burr/io/read/dicom_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_facts.h"
#include "burr/io/read/dicom_syntaxes.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

// Is there an element with a plausible tag and type here?
bool plausible(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  if (bytes.size() < at + 8) return false;
  const int group = bytes[at] | bytes[at + 1] << 8;
  return group == 2 || group == 8 || group == 0x10;
}

// Inflates a deflated data set. Error: why it cannot be.
Result<std::vector<std::uint8_t>> inflated(const std::filesystem::path& path, std::uint64_t at,
                                           std::uint64_t total) {
  // within deflate's largest ratio
  auto source = open_file(path, at);
  if (!source) return source.error();
  const std::uint64_t most =
      std::min<std::uint64_t>((total - at) * kMostGzip, std::uint64_t{1} << 30);
  auto inflating = inflate_raw(std::move(source->source));
  std::vector<std::uint8_t> bytes, block(std::size_t{1} << 16);
  while (bytes.size() <= most) {
    auto got = inflating->read(block.data(), block.size());
    if (!got) return error("its compressed data cannot be decompressed");
    if (*got == 0) break;
    bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  if (bytes.size() < 8) return error("its compressed data is empty");
  return bytes;
}

// Why a file that is none of the formats is refused.
std::string not_read(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  if (ending == ".raw" || ending == ".zraw")  // people choose it instead of the header beside it
    return fmt::format(
        "{}: holds the numbers of a volume without their size and type; give its header (.nhdr or "
        ".mhd)",
        short_name(path));
  return fmt::format("{}: is not a file that burr reads; give DICOM, NRRD, NIfTI or MetaImage",
                     short_name(path));
}

using Look = std::function<void(const DicomWalker& set)>;

// look: is shown the data set.
Result<DicomHeader> read_header(const std::filesystem::path& path, bool study, bool structure_set,
                                const Look& look) {
  const std::string file = short_name(path);
  const auto broken = [&](const std::string& why) {
    return error(fmt::format("{}: is a damaged DICOM file ({}); copy it again", file, why));
  };
  // a header seldom needs more than the first block; read more until it fits
  std::size_t part = std::size_t{1} << 16;
  while (true) {
    auto bytes = first_bytes(path, part);
    if (!bytes) return bytes.error();
    auto opened = open_file(path);
    if (!opened) return opened.error();
    std::uint64_t total = opened->size;
    const bool whole_file = bytes->size() >= total;

    DicomHeader header;
    header.path = path;
    std::uint64_t at = 0;
    const bool marked = bytes->size() >= 132 && std::memcmp(bytes->data() + 128, "DICM", 4) == 0;
    if (marked) at = 132;
    if (!plausible(*bytes, at))
      return marked ? broken("it holds nothing behind its mark") : error(not_read(path));

    DicomWalker meta(*bytes, total);
    if ((*bytes)[at] == 2) {
      at = meta.walk(at, total, 0, &meta.top, true);
      if (!meta.trouble.empty()) return broken(meta.trouble);
      header.transfer_syntax = dicom_text(meta.top, 0x00020010);
    }
    const std::string& syntax = header.transfer_syntax;
    if (const std::string why = why_not_read(syntax); !why.empty())
      return error(
          fmt::format("{}: {}; export the scan again as Explicit VR Little Endian", file, why));
    if (syntax == "1.2.840.10008.1.2.1.99") {
      auto set = inflated(path, at, total);
      if (!set) return broken(set.error().text);
      *bytes = std::move(*set);
      total = bytes->size();
      at = 0;
      header.deflated = true;
    }

    DicomWalker set(*bytes, total);
    set.big_endian = syntax == "1.2.840.10008.1.2.2";
    set.explicit_vr = syntax != "1.2.840.10008.1.2";
    if (syntax.empty() || !set.explicit_vr || syntax == kGePrivate) {
      // No statement, or the usual wrong one: letters in the place of the type mean explicit.
      if (at + 6 > bytes->size()) return broken("it holds no data");
      const auto letter = [&](std::uint64_t p) { return (*bytes)[p] >= 'A' && (*bytes)[p] <= 'Z'; };
      set.explicit_vr = letter(at + 4) && letter(at + 5);
    }
    set.study = study;
    set.structure_set = structure_set;
    set.walk(at, total, 0, &set.top, false);
    if (set.cut && !whole_file && !header.deflated) {
      part *= 8;
      if (part > (std::size_t{1} << 31)) return broken("its header does not end");
      continue;
    }
    header.damage = set.trouble;
    take_dicom_facts(set, header);
    if (look) look(set);
    return header;
  }
}

}  // namespace

Result<DicomHeader> read_dicom_header(const std::filesystem::path& path) {
  return read_header(path, false, false, {});
}

Result<DicomStudy> read_dicom_study(const std::filesystem::path& path) {
  DicomStudy study;
  const auto header = read_header(path, true, false, [&](const DicomWalker& set) {
    study.characters = dicom_text(set.top, 0x00080005);
    for (const Tag tag : dicom_tags_of_study())
      if (tag != 0x00080005 && set.top.count(tag) != 0)
        study.values[tag] = dicom_text(set.top, tag);
  });
  if (!header) return header.error();
  return study;
}

Status look_at_structures(const std::filesystem::path& path, const Look& look) {
  const auto header = read_header(path, false, true, look);
  if (!header) return header.error();
  if (!header->damage.empty())
    return error(fmt::format("{}: is a damaged DICOM file: {}; copy it again", short_name(path),
                             header->damage));
  return fine();
}

}  // namespace burr::io

#include "burr/record/sealer.h"

#include <fmt/core.h>

#include <algorithm>

#include "burr/record/mcap/mcap_reader.h"

namespace burr::record {
namespace {

// A reader believes the summary, which is not under the seal: it must say what the sealed bytes say.
bool summary_is_true(const McapReader& scanned, const McapReader& by_summary) {
  const auto same = [](const auto& a, const auto& b, const auto& equal) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
  };
  const auto same_place = [](const auto& a, const auto& b) {
    return a.offset == b.offset && a.length == b.length && a.name == b.name;
  };
  return same(scanned.channels(), by_summary.channels(),
              [](const mcap::Channel& a, const mcap::Channel& b) {
                return a.id == b.id && a.topic == b.topic && a.encoding == b.encoding;
              }) &&
         same(scanned.chunks(), by_summary.chunks(),
              [](const mcap::ChunkAt& a, const mcap::ChunkAt& b) {
                return a.offset == b.offset && a.length == b.length && a.start_ns == b.start_ns &&
                       a.end_ns == b.end_ns && a.compression == b.compression &&
                       a.packed_size == b.packed_size && a.unpacked_size == b.unpacked_size &&
                       std::equal(a.index_offsets.begin(), a.index_offsets.end(),
                                  b.index_offsets.begin(), b.index_offsets.end(),
                                  [](const auto& x, const auto& y) { return x.first == y.first; });
              }) &&
         same(scanned.attachments(), by_summary.attachments(), same_place) &&
         same(scanned.metadata(), by_summary.metadata(), same_place);
}

}  // namespace

Result<std::optional<SealInFile>> seal_in(const std::string& path) {
  const auto reader = McapReader::open(path, McapReader::Trust::nothing);
  if (!reader) return reader.error();
  const McapReader& file = **reader;
  std::optional<std::size_t> found;
  for (std::size_t n = 0; n < file.metadata().size(); ++n) {
    if (file.metadata()[n].name != kSealName) continue;
    if (found)
      return error(
          fmt::format("{}: the metadata {} stands in it twice, so it was put together of two "
                      "recordings; use the "
                      "original file",
                      path, kSealName));
    found = n;
  }
  if (!found) return std::optional<SealInFile>();
  if (!file.finished() || file.lost_bytes() > 0)
    return error(
        fmt::format("{}: has a seal, but the file is cut or damaged, so it is not what was sealed; "
                    "use the original file",
                    path));
  const std::uint64_t at = file.metadata()[*found].offset;
  const auto later = [at](const auto& one) { return one.offset > at; };
  if (std::any_of(file.chunks().begin(), file.chunks().end(), later) ||
      std::any_of(file.attachments().begin(), file.attachments().end(), later) ||
      std::any_of(file.metadata().begin(), file.metadata().end(), later) ||
      std::any_of(file.unknown().begin(), file.unknown().end(), later))
    return error(fmt::format(
        "{}: something was added behind the metadata {} after it was sealed; use the original file",
        path, kSealName));
  const auto again = McapReader::open(path);
  if (!again) return again.error();
  if (!summary_is_true(file, **again))
    return error(
        fmt::format("{}: its summary says something else than what was sealed, so it was changed "
                    "afterwards; use the original file",
                    path));
  const auto words = file.read_metadata(*found);
  if (!words) return words.error();
  return std::optional<SealInFile>({*words, at});
}

}  // namespace burr::record

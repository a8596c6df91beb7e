// The summary at the end of an MCAP file, and whether it names all that is there.
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/mcap_reader.h"

namespace burr::record {

using mcap::Kind;
using mcap::kRecordHead;

namespace {

bool get_counts(BytesIn& in, std::map<std::uint16_t, std::uint64_t>& counts) {
  BytesIn inner(in.block());
  while (inner.ok() && !inner.empty()) {
    const auto channel = inner.get<std::uint16_t>();
    counts[channel] = inner.get<std::uint64_t>();
  }
  return in.ok() && inner.ok();
}

bool get_chunk_index(BytesIn in, mcap::ChunkAt& chunk) {
  chunk.start_ns = in.get<std::uint64_t>();
  chunk.end_ns = in.get<std::uint64_t>();
  chunk.offset = in.get<std::uint64_t>();
  chunk.length = in.get<std::uint64_t>();
  if (!get_counts(in, chunk.index_offsets)) return false;
  chunk.index_length = in.get<std::uint64_t>();
  chunk.compression = in.text();
  chunk.packed_size = in.get<std::uint64_t>();
  chunk.unpacked_size = in.get<std::uint64_t>();
  return in.ok();
}

bool get_attachment_index(BytesIn in, mcap::AttachmentAt& attachment) {
  attachment.offset = in.get<std::uint64_t>();
  attachment.length = in.get<std::uint64_t>();
  attachment.log_ns = in.get<std::uint64_t>();
  attachment.create_ns = in.get<std::uint64_t>();
  attachment.size = in.get<std::uint64_t>();
  attachment.name = in.text();
  attachment.media_type = in.text();
  return in.ok();
}

bool get_metadata_index(BytesIn in, mcap::MetadataAt& metadata) {
  metadata.offset = in.get<std::uint64_t>();
  metadata.length = in.get<std::uint64_t>();
  metadata.name = in.text();
  return in.ok();
}

}  // namespace

McapReader::Summary McapReader::read_summary() {
  constexpr std::uint64_t kTail = mcap::kFooter + mcap::kMagic.size();
  if (size_ < mcap::kMagic.size() + kTail) return Summary::damaged;
  std::array<std::uint8_t, kTail> tail{};
  if (!read_at(size_ - kTail, tail.data(), tail.size())) return Summary::damaged;
  if (!std::equal(mcap::kMagic.begin(), mcap::kMagic.end(), tail.begin() + mcap::kFooter))
    return Summary::damaged;
  BytesIn footer(tail);
  if (footer.get<std::uint8_t>() != static_cast<std::uint8_t>(Kind::footer))
    return Summary::damaged;
  if (footer.get<std::uint64_t>() != 20) return Summary::damaged;
  const auto start = footer.get<std::uint64_t>();
  footer.get<std::uint64_t>();  // summary_offset_start: we read the whole summary anyway
  const auto crc = footer.get<std::uint32_t>();
  const std::uint64_t end = size_ - kTail;
  if (start == 0) return Summary::partial;  // its writer made none
  if (start > end || end - start > mcap::kLargestChunk) return Summary::damaged;

  std::vector<std::uint8_t> summary(static_cast<std::size_t>(end - start));
  if (!read_at(start, summary.data(), summary.size())) return Summary::damaged;
  const ByteSpan checked_footer = ByteSpan(tail).first(mcap::kFooter - sizeof crc);
  // 0: its writer computed none
  if (crc != 0 && crc32(crc32(summary), checked_footer) != crc) return Summary::damaged;
  if (!take_summary(start, summary)) return Summary::damaged;
  return names_all(start) ? Summary::whole : Summary::partial;
}

bool McapReader::take_summary(std::uint64_t start, ByteSpan summary) {
  BytesIn in(summary);
  while (!in.empty()) {
    const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
    const ByteSpan content = in.take(in.get<std::uint64_t>());
    if (!in.ok()) return false;
    bool good = true;
    if (kind == Kind::schema) good = take_schema(content);
    if (kind == Kind::channel) good = take_channel(content);
    if (kind == Kind::chunk_index) good = get_chunk_index(BytesIn(content), chunks_.emplace_back());
    if (kind == Kind::attachment_index)
      good = get_attachment_index(BytesIn(content), attachments_.emplace_back());
    if (kind == Kind::metadata_index)
      good = get_metadata_index(BytesIn(content), metadata_.emplace_back());
    if (!good) return false;
  }
  const auto inside = [&](std::uint64_t offset, std::uint64_t length) {
    return offset <= start && length <= start - offset;
  };
  for (const auto& chunk : chunks_)
    if (!inside(chunk.offset, chunk.length)) return false;
  for (const auto& attachment : attachments_)
    if (!inside(attachment.offset, attachment.length)) return false;
  for (const auto& metadata : metadata_)
    if (!inside(metadata.offset, metadata.length)) return false;
  // other writers put them in any order
  std::sort(chunks_.begin(), chunks_.end(),
            [](const mcap::ChunkAt& a, const mcap::ChunkAt& b) { return a.offset < b.offset; });
  return true;
}

// Walks over what lies between the parts that the summary names: a message or a chunk there is not
// in it, schemas and channels need not be. What cannot be read there is no reason to give up the
// summary.
bool McapReader::names_all(std::uint64_t start) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> named;  // begin, end
  const auto name = [&named](std::uint64_t offset, std::uint64_t length) {
    named.emplace_back(offset, offset + length);
  };
  for (const auto& chunk : chunks_) name(chunk.offset, chunk.length);
  for (const auto& attachment : attachments_) name(attachment.offset, attachment.length);
  for (const auto& metadata : metadata_) name(metadata.offset, metadata.length);
  std::sort(named.begin(), named.end());
  // the indexes that follow a chunk, as far as nothing else that is named begins among them
  for (const auto& chunk : chunks_) {
    const std::uint64_t after = chunk.offset + chunk.length;
    const auto next =
        std::upper_bound(named.begin(), named.end(), std::pair(chunk.offset, ~std::uint64_t{0}));
    const std::uint64_t room = (next == named.end() ? start : next->first) - after;
    if (chunk.index_length <= room) std::prev(next)->second = after + chunk.index_length;
  }
  named.emplace_back(start, start);
  std::uint64_t at = mcap::kMagic.size();
  for (const auto& [begin, end] : named) {
    while (at < begin) {
      Kind kind = {};
      std::uint64_t next = 0;
      if (!record_at(at, kind, next)) break;
      if (kind == Kind::message || kind == Kind::chunk || kind == Kind::attachment ||
          kind == Kind::metadata)
        return false;
      if (kind == Kind::schema || kind == Kind::channel)
        static_cast<void>(scan_small(at, kind, next));
      if (kind == Kind::data_end) return true;
      at = next;
    }
    at = std::max(at, end);
  }
  return true;
}

}  // namespace burr::record

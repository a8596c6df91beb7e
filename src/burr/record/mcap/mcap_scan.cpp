// A scan of an MCAP file from its beginning, where there is no summary that can be used.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/record/mcap/mcap_reader.h"

namespace burr::record {

using mcap::kChunkFixed;
using mcap::Kind;
using mcap::kRecordHead;

namespace {

// schemas, channels, metadata: none that burr writes is larger
constexpr std::uint64_t kLargestSmallRecord = std::uint64_t{1} << 28;
constexpr std::uint64_t kMessageHead = 2 + 4 + 8 + 8;  // channel, sequence, two times
// messages outside of chunks are taken together up to here [byte]
constexpr std::uint64_t kRun = std::uint64_t{1} << 20;

// A chunk begins here, to judge by its lengths: of its name, of what is packed, and of itself. One without
// content is none: it would lose nothing, and "06 28" before zeros, as bricks hold them, looks like it.
bool looks_like_a_chunk(ByteSpan bytes) {
  BytesIn in(bytes);
  in.get<std::uint8_t>();
  const auto length = in.get<std::uint64_t>();
  in.take(kChunkFixed - 4);  // times, size, crc
  const std::string_view compression = in.text();
  const auto packed = in.get<std::uint64_t>();
  return in.ok() && packed > 0 && packed <= length &&
         length - packed == kChunkFixed + compression.size() + 8;
}

}  // namespace

// The head of the record at offset. False: none begins here, or it is longer than the file.
bool McapReader::record_at(std::uint64_t offset, Kind& kind, std::uint64_t& next) const {
  std::array<std::uint8_t, kRecordHead> head{};
  if (!read_at(offset, head.data(), head.size())) return false;
  BytesIn in(head);
  kind = static_cast<Kind>(in.get<std::uint8_t>());
  const auto length = in.get<std::uint64_t>();
  if (kind == Kind{} || length > size_ - offset - kRecordHead) return false;
  next = offset + kRecordHead + length;
  return true;
}

// A record of an unknown kind, or a message of an unknown channel, may be damage that looks like one;
// the next record says.
bool McapReader::good_after(std::uint64_t next) const {
  Kind kind = {};
  std::uint64_t after = 0;
  return next == size_ || record_at(next, kind, after);
}

// Its kind alone is damaged: the lengths of a chunk agree with each other as others do not by chance.
bool McapReader::was_a_chunk(std::uint64_t offset) const {
  mcap::ChunkAt chunk;
  std::uint32_t crc = 0;
  std::uint64_t body = 0;
  return read_chunk_fields(offset, chunk, crc, body);
}

// Reads one record of the data section. False: nothing valid here.
bool McapReader::scan_record(std::uint64_t offset, std::uint64_t& next, bool check_chunks) {
  Kind kind = {};
  if (!record_at(offset, kind, next)) return false;
  switch (kind) {
    case Kind::chunk:
      return scan_chunk(offset, next, check_chunks);
    case Kind::message:
      return scan_message(offset, next);
    case Kind::message_index:
      return scan_message_index(offset, next);
    case Kind::attachment:
      return scan_attachment(offset, next);
    case Kind::header:
    case Kind::schema:
    case Kind::channel:
    case Kind::metadata:
    case Kind::data_end:
      return scan_small(offset, kind, next);
    case Kind::footer:
    case Kind::chunk_index:
    case Kind::attachment_index:
    case Kind::statistics:
    case Kind::metadata_index:
    case Kind::summary_offset:
      // of a summary without an end of the data before it
      return (kind == Kind::footer || good_after(next)) && !was_a_chunk(offset);
  }
  if (!good_after(next) || was_a_chunk(offset)) return false;
  unknown_.push_back({offset, next - offset});
  return true;
}

bool McapReader::scan_chunk(std::uint64_t offset, std::uint64_t next, bool check_chunks) {
  mcap::ChunkAt chunk;
  std::uint32_t crc = 0;
  std::uint64_t body = 0;
  if (!read_chunk_head(offset, chunk, crc, body)) return false;
  if (opaque(chunk)) {
    if (!good_after(next)) return false;
  } else if (check_chunks) {
    McapChunk content;
    if (!unpack_chunk(offset, content)) return false;
    take_channels_of(content);
  }
  chunks_.push_back(std::move(chunk));
  return true;
}

bool McapReader::scan_message(std::uint64_t offset, std::uint64_t next) {
  std::array<std::uint8_t, kMessageHead> head{};
  if (next - offset < kRecordHead + kMessageHead || was_a_chunk(offset) ||
      !read_at(offset + kRecordHead, head.data(), head.size()))
    return false;
  BytesIn in(head);
  const auto channel = in.get<std::uint16_t>();
  if (!knows(channel) && !good_after(next)) return false;
  in.get<std::uint32_t>();
  const auto time = in.get<std::uint64_t>();
  const bool goes_on = !chunks_.empty() && chunks_.back().bare &&
                       chunks_.back().offset + chunks_.back().length == offset &&
                       chunks_.back().length + (next - offset) <= kRun;
  if (!goes_on) {
    mcap::ChunkAt run;
    run.bare = true;
    run.offset = offset;
    run.start_ns = run.end_ns = time;
    chunks_.push_back(std::move(run));
  }
  mcap::ChunkAt& run = chunks_.back();
  run.length = run.packed_size = run.unpacked_size = next - run.offset;
  run.start_ns = std::min(run.start_ns, time);
  run.end_ns = std::max(run.end_ns, time);
  run.index_offsets[channel] = 0;
  return true;
}

// Its entries are times and places within the chunk before it: no checksum covers it, these do.
bool McapReader::scan_message_index(std::uint64_t offset, std::uint64_t next) {
  constexpr std::uint64_t kEntry = 8 + 8;
  if (next - offset > kLargestSmallRecord) return false;
  std::vector<std::uint8_t> content;
  if (!read_content(offset, Kind::message_index, content)) return false;
  BytesIn in(content);
  const auto channel = in.get<std::uint16_t>();
  const auto length = in.get<std::uint32_t>();
  if (!in.ok() || length % kEntry != 0 || length > in.left()) return false;
  if (chunks_.empty() || chunks_.back().bare) return true;
  mcap::ChunkAt& chunk = chunks_.back();
  for (std::uint64_t n = 0; n < length / kEntry; ++n) {
    const auto time = in.get<std::uint64_t>();
    const auto place = in.get<std::uint64_t>();
    if (time < chunk.start_ns || time > chunk.end_ns || place >= chunk.unpacked_size) return false;
  }
  chunk.index_offsets[channel] = offset;
  chunk.index_length = next - chunk.offset - chunk.length;
  return true;
}

bool McapReader::scan_attachment(std::uint64_t offset, std::uint64_t next) {
  const std::uint64_t length = next - offset - kRecordHead;
  mcap::AttachmentAt attachment;
  attachment.offset = offset;
  attachment.length = next - offset;
  std::vector<std::uint8_t> start(512);
  // its names may be longer than any that burr writes
  for (std::uint64_t most = start.size(); most <= kLargestSmallRecord; most *= 8) {
    start.resize(static_cast<std::size_t>(std::min(most, length)));
    if (!read_at(offset + kRecordHead, start.data(), start.size())) return false;
    BytesIn fields(start);
    attachment.log_ns = fields.get<std::uint64_t>();
    attachment.create_ns = fields.get<std::uint64_t>();
    attachment.name = fields.text();
    attachment.media_type = fields.text();
    attachment.size = fields.get<std::uint64_t>();
    if (fields.ok()) {
      if (attachment.size > length) return false;
      attachments_.push_back(std::move(attachment));
      return true;
    }
    if (start.size() == length) break;
  }
  return false;
}

// Records that lie in memory as a whole.
bool McapReader::scan_small(std::uint64_t offset, Kind kind, std::uint64_t next) {
  if (next - offset > kLargestSmallRecord) return false;
  std::vector<std::uint8_t> content;
  if (!read_content(offset, kind, content)) return false;
  if (kind == Kind::schema) return take_schema(content);
  if (kind == Kind::channel) return take_channel(content);
  if (kind == Kind::metadata) {
    BytesIn fields(content);
    const std::string name(fields.text());
    mcap::Pairs pairs;
    if (!mcap::get_pairs(fields, pairs)) return false;
    metadata_.push_back({offset, next - offset, name});
  }
  return true;
}

// Messages outside of chunks go on here: this one and the next two are of known channels and of about
// the time of those before. A record of an unknown kind between them proves nothing: bytes of a damaged
// message often look like one.
bool McapReader::messages_at(std::uint64_t offset) const {
  constexpr int kInOrder = 3;
  constexpr int kMostRecords = 64;
  constexpr std::uint64_t kBack = 10'000'000'000;                 // writers of many channels [ns]
  constexpr std::uint64_t kPause = 24 * 3600 * 1'000'000'000ULL;  // within one recording [ns]
  constexpr std::uint64_t kDataEnd = kRecordHead + 4;
  const std::uint64_t last = chunks_.empty() ? 0 : chunks_.back().end_ns;
  int messages = 0;
  for (int n = 0; n < kMostRecords && messages < kInOrder; ++n) {
    Kind kind = {};
    std::uint64_t next = 0;
    if (!record_at(offset, kind, next)) return false;
    if (kind == Kind::data_end) return messages > 0 && next - offset == kDataEnd;
    if (kind == Kind::message) {
      std::array<std::uint8_t, kMessageHead> head{};
      if (next - offset < kRecordHead + kMessageHead ||
          !read_at(offset + kRecordHead, head.data(), head.size()))
        return false;
      BytesIn in(head);
      if (!knows(in.get<std::uint16_t>())) return false;
      in.get<std::uint32_t>();
      const auto time = in.get<std::uint64_t>();
      if (!chunks_.empty() && (time + kBack < last || time > last + kPause)) return false;
      ++messages;
    }
    offset = next;
  }
  return messages == kInOrder;
}

// The next position after offset where a whole, undamaged chunk begins, or where messages go on in a
// file that has them outside of chunks; size() if there is none.
std::uint64_t McapReader::find_next(std::uint64_t offset) const {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  constexpr std::size_t kHead =
      kRecordHead + kChunkFixed + 4 + 8;  // the longest name is four letters
  const bool bare = std::any_of(chunks_.begin(), chunks_.end(),
                                [](const mcap::ChunkAt& chunk) { return chunk.bare; });
  std::vector<std::uint8_t> block;
  for (std::uint64_t base = offset + 1; base < size_; base += kBlock) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlock + kHead, size_ - base)));
    if (!read_at(base, block.data(), block.size())) break;
    for (std::size_t at = 0; at < std::min(block.size(), kBlock); ++at) {
      const auto kind = static_cast<Kind>(block[at]);
      McapChunk chunk;
      if (kind == Kind::chunk && looks_like_a_chunk(ByteSpan(block).subspan(at)) &&
          unpack_chunk(base + at, chunk))
        return base + at;
      if (kind == Kind::message && bare && messages_at(base + at)) return base + at;
    }
  }
  return size_;
}

void McapReader::scan(bool check_chunks) {
  std::uint64_t offset = mcap::kMagic.size();
  std::vector<std::size_t> doubtful;  // chunks whose indexes may be missing
  bool ended = false;
  while (offset < size_ && !ended) {
    std::uint64_t next = 0;
    if (scan_record(offset, next, check_chunks)) {
      std::uint8_t kind = 0;
      ended = read_at(offset, &kind, 1) && (kind == static_cast<std::uint8_t>(Kind::data_end) ||
                                            kind == static_cast<std::uint8_t>(Kind::footer));
      offset = next;
      continue;
    }
    if (!chunks_.empty()) doubtful.push_back(chunks_.size() - 1);
    const std::uint64_t resumed = find_next(offset);
    lost_bytes_ += resumed - offset;
    if (resumed < size_)
      notices_.push_back(
          fmt::format("{}: bytes {} to {} are damaged and were skipped", path_, offset, resumed));
    else
      notices_.push_back(fmt::format("{}: the last record is incomplete; its {} bytes were ignored",
                                     path_, size_ - offset));
    offset = resumed;
  }
  if (!finished_ && lost_bytes_ == 0)
    notices_.push_back(path_ + ": was not closed properly, but all its records are complete");
  if (!ended && !check_chunks) drop_damaged_end(doubtful);
  for (const std::size_t index : doubtful)
    if (index < chunks_.size()) static_cast<void>(index_by_content(index));
}

// After a power cut a chunk may have the right length and wrong bytes, but only at the end.
void McapReader::drop_damaged_end(std::vector<std::size_t>& doubtful) {
  McapChunk chunk;
  while (!chunks_.empty() && !opaque(chunks_.back()) && !load(chunks_.back(), chunk)) {
    lost_bytes_ += chunks_.back().length;
    notices_.push_back(fmt::format("{}: the last chunk, at byte {}, is damaged and was ignored",
                                   path_, chunks_.back().offset));
    chunks_.pop_back();
  }
  if (!chunks_.empty()) doubtful.push_back(chunks_.size() - 1);
}

}  // namespace burr::record

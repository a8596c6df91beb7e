#include "burr/record/mcap/mcap_reader.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/packed.h"

namespace burr::record {

using mcap::Kind;
using mcap::kRecordHead;

namespace {

// start, end, unpacked size, crc, length of the compression's name
constexpr std::uint64_t kChunkFixed = 8 + 8 + 8 + 4 + 4;
// schemas, channels, indexes: none that burr writes is larger
constexpr std::uint64_t kLargestSmallRecord = std::uint64_t{1} << 28;

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

bool get_messages(McapChunk& chunk) {
  BytesIn in(chunk.bytes);
  while (!in.empty()) {
    const std::uint64_t offset = chunk.bytes.size() - in.left();
    const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
    const ByteSpan content = in.take(in.get<std::uint64_t>());
    if (!in.ok()) return false;
    if (kind != Kind::message) continue;  // other writers put schemas and channels here too
    BytesIn fields(content);
    McapMessage message;
    message.channel = fields.get<std::uint16_t>();
    message.sequence = fields.get<std::uint32_t>();
    message.time_ns = fields.get<std::uint64_t>();
    fields.get<std::uint64_t>();  // publish_time
    message.offset = offset;
    message.data = fields.take(fields.left());
    if (!fields.ok()) return false;
    chunk.messages.push_back(message);
  }
  return true;
}

}  // namespace

McapReader::~McapReader() {
  if (file_ >= 0) ::close(file_);
}

Result<std::unique_ptr<McapReader>> McapReader::open(const std::string& path, Trust trust) {
  std::unique_ptr<McapReader> reader(new McapReader);
  reader->path_ = path;
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
  reader->file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about {};
  if (reader->file_ < 0 || ::fstat(reader->file_, &about) != 0)
    return error(Trouble::io, fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  if (!S_ISREG(about.st_mode))
    return error(Trouble::io, path + ": is not a regular file; give the recording (.mcap)");
  reader->size_ = static_cast<std::uint64_t>(about.st_size);

  std::array<std::uint8_t, 8> magic{};
  if (!reader->read_at(0, magic.data(), magic.size()) || magic != mcap::kMagic)
    return error(path + ": does not begin as an MCAP file does; give a recording of burr");

  if (trust == Trust::summary && reader->read_summary()) {
    reader->finished_ = true;
    return reader;
  }
  const bool has_summary = trust == Trust::nothing && reader->read_summary();
  reader->schemas_.clear();
  reader->channels_.clear();
  reader->chunks_.clear();
  reader->attachments_.clear();
  reader->metadata_.clear();
  reader->finished_ = has_summary;
  reader->scan(trust == Trust::nothing);
  return reader;
}

std::uint16_t McapReader::channel_of(std::string_view topic) const {
  for (const mcap::Channel& channel : channels_)
    if (channel.topic == topic) return channel.id;
  return 0;
}

bool McapReader::read_at(std::uint64_t offset, void* to, std::size_t size) const {
  if (offset > size_ || size > size_ - offset) return false;
  auto* out = static_cast<std::uint8_t*>(to);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n = ::pread(file_, out + done, size - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// The content of the record at offset, if it has this kind and lies within the file.
bool McapReader::read_content(std::uint64_t offset, Kind kind,
                              std::vector<std::uint8_t>& content) const {
  std::array<std::uint8_t, kRecordHead> head{};
  if (!read_at(offset, head.data(), head.size())) return false;
  BytesIn in(head);
  if (in.get<std::uint8_t>() != static_cast<std::uint8_t>(kind)) return false;
  const auto length = in.get<std::uint64_t>();
  if (length > size_ - offset - kRecordHead) return false;
  content.resize(static_cast<std::size_t>(length));
  return read_at(offset + kRecordHead, content.data(), content.size());
}

bool McapReader::take_schema(ByteSpan content) {
  BytesIn in(content);
  mcap::Schema schema;
  schema.id = in.get<std::uint16_t>();
  schema.name = in.text();
  schema.encoding = in.text();
  schema.data = in.text();
  if (!in.ok() || schema.id == 0) return false;
  for (const auto& known : schemas_)
    if (known.id == schema.id) return true;  // repeated in the summary
  schemas_.push_back(std::move(schema));
  return true;
}

bool McapReader::take_channel(ByteSpan content) {
  BytesIn in(content);
  mcap::Channel channel;
  channel.id = in.get<std::uint16_t>();
  channel.schema = in.get<std::uint16_t>();
  channel.topic = in.text();
  channel.encoding = in.text();
  if (!in.ok()) return false;
  for (const auto& known : channels_)
    if (known.id == channel.id) return true;
  channels_.push_back(std::move(channel));
  return true;
}

bool McapReader::read_summary() {
  constexpr std::uint64_t kTail = mcap::kFooter + mcap::kMagic.size();
  if (size_ < mcap::kMagic.size() + kTail) return false;
  std::array<std::uint8_t, kTail> tail{};
  if (!read_at(size_ - kTail, tail.data(), tail.size())) return false;
  if (!std::equal(mcap::kMagic.begin(), mcap::kMagic.end(), tail.begin() + mcap::kFooter))
    return false;
  BytesIn footer(tail);
  if (footer.get<std::uint8_t>() != static_cast<std::uint8_t>(Kind::footer)) return false;
  if (footer.get<std::uint64_t>() != 20) return false;
  const auto start = footer.get<std::uint64_t>();
  footer.get<std::uint64_t>();  // summary_offset_start: we read the whole summary anyway
  const auto crc = footer.get<std::uint32_t>();
  const std::uint64_t end = size_ - kTail;
  if (start == 0 || start > end || crc == 0) return false;

  std::vector<std::uint8_t> summary(static_cast<std::size_t>(end - start));
  if (!read_at(start, summary.data(), summary.size())) return false;
  const ByteSpan checked_footer = ByteSpan(tail).first(mcap::kFooter - sizeof crc);
  if (crc32(crc32(summary), checked_footer) != crc) return false;

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
  return true;
}

// Reads the header of a chunk and checks that all its lengths agree.
bool McapReader::read_chunk_head(std::uint64_t offset, mcap::ChunkAt& chunk, std::uint32_t& crc,
                                 std::uint64_t& body) const {
  std::array<std::uint8_t, kRecordHead + kChunkFixed + 16 + 8> head{};
  if (offset >= size_) return false;
  const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(head.size(), size_ - offset));
  if (!read_at(offset, head.data(), there)) return false;
  BytesIn in(ByteSpan(head).first(there));
  if (in.get<std::uint8_t>() != static_cast<std::uint8_t>(Kind::chunk)) return false;
  const auto length = in.get<std::uint64_t>();
  chunk.start_ns = in.get<std::uint64_t>();
  chunk.end_ns = in.get<std::uint64_t>();
  chunk.unpacked_size = in.get<std::uint64_t>();
  crc = in.get<std::uint32_t>();
  chunk.compression = in.text();
  chunk.packed_size = in.get<std::uint64_t>();
  if (!in.ok() || length > size_ - offset - kRecordHead) return false;
  chunk.offset = offset;
  chunk.length = kRecordHead + length;
  body = offset + kRecordHead + kChunkFixed + chunk.compression.size() + 8;
  return chunk.unpacked_size <= mcap::kLargestChunk && chunk.start_ns <= chunk.end_ns &&
         chunk.packed_size <= length &&
         length == kChunkFixed + chunk.compression.size() + 8 + chunk.packed_size;
}

bool McapReader::unpack_chunk(std::uint64_t offset, McapChunk& chunk) const {
  mcap::ChunkAt at;
  std::uint64_t body = 0;
  if (!read_chunk_head(offset, at, chunk.crc, body)) return false;
  std::vector<std::uint8_t> packed(static_cast<std::size_t>(at.packed_size));
  if (!read_at(body, packed.data(), packed.size())) return false;
  if (at.compression.empty()) {
    if (at.packed_size != at.unpacked_size) return false;
    chunk.bytes = std::move(packed);
  } else if (at.compression != "zstd" || !unpack(packed, at.unpacked_size, chunk.bytes)) {
    return false;
  }
  // 0 in the file: its writer computed none
  if (chunk.crc != 0 && crc32(chunk.bytes) != chunk.crc) return false;
  return get_messages(chunk);
}

Result<McapChunk> McapReader::read_chunk(std::size_t index) const {
  const mcap::ChunkAt& at = chunks_.at(index);
  if (at.compression != "zstd" && !at.compression.empty())
    return error(
        fmt::format("{}: burr does not read the chunk compression \"{}\", only zstd; this file was "
                    "not written by burr",
                    path_, base::printable(at.compression)));
  McapChunk chunk;
  if (!unpack_chunk(at.offset, chunk))
    return error(fmt::format("{}: the chunk at byte {} is damaged; `record::repair` saves the rest",
                             path_, at.offset));
  return chunk;
}

Result<std::vector<std::uint8_t>> McapReader::read_packed(std::size_t index) const {
  mcap::ChunkAt at;
  std::uint32_t crc = 0;
  std::uint64_t body = 0;
  std::vector<std::uint8_t> packed;
  if (read_chunk_head(chunks_.at(index).offset, at, crc, body)) {
    packed.resize(static_cast<std::size_t>(at.packed_size));
    if (read_at(body, packed.data(), packed.size())) return packed;
  }
  return error(fmt::format("{}: the chunk at byte {} is damaged", path_, chunks_.at(index).offset));
}

Result<std::vector<std::uint8_t>> McapReader::read_attachment(std::size_t index) const {
  const mcap::AttachmentAt& at = attachments_.at(index);
  const Error damaged =
      error(fmt::format("{}: the attachment \"{}\" is damaged; give the bone with `volume`", path_,
                        base::printable(at.name)));
  std::vector<std::uint8_t> content;
  if (!read_content(at.offset, Kind::attachment, content)) return damaged;
  BytesIn in(content);
  in.get<std::uint64_t>();
  in.get<std::uint64_t>();
  in.text();
  in.text();
  const ByteSpan data = in.take(in.get<std::uint64_t>());
  const auto crc = in.get<std::uint32_t>();
  if (!in.ok() || !in.empty()) return damaged;
  if (crc != 0 && crc32(ByteSpan(content).first(content.size() - sizeof crc)) != crc)
    return damaged;
  return std::vector<std::uint8_t>(data.begin(), data.end());
}

Result<mcap::Pairs> McapReader::read_metadata(std::size_t index) const {
  const mcap::MetadataAt& at = metadata_.at(index);
  std::vector<std::uint8_t> content;
  mcap::Pairs pairs;
  if (read_content(at.offset, Kind::metadata, content)) {
    BytesIn in(content);
    in.text();
    if (mcap::get_pairs(in, pairs)) return pairs;
  }
  return error(fmt::format("{}: the metadata \"{}\" is damaged", path_, base::printable(at.name)));
}

// Finds out which channels a chunk has from its messages; for chunks without indexes.
bool McapReader::index_by_content(std::size_t index) {
  McapChunk chunk;
  if (!unpack_chunk(chunks_[index].offset, chunk)) return false;
  chunks_[index].index_offsets.clear();
  for (const McapMessage& message : chunk.messages)
    chunks_[index].index_offsets[message.channel] = 0;
  return true;
}

// Reads one record of the data section. False: nothing valid here.
bool McapReader::scan_record(std::uint64_t offset, std::uint64_t& next, bool check_chunks) {
  std::array<std::uint8_t, kRecordHead> head{};
  if (!read_at(offset, head.data(), head.size())) return false;
  BytesIn in(head);
  const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
  const auto length = in.get<std::uint64_t>();
  if (length > size_ - offset - kRecordHead) return false;
  next = offset + kRecordHead + length;

  if (kind == Kind::chunk) {
    mcap::ChunkAt chunk;
    std::uint32_t crc = 0;
    std::uint64_t body = 0;
    if (!read_chunk_head(offset, chunk, crc, body)) return false;
    if (check_chunks) {
      McapChunk content;
      if (!unpack_chunk(offset, content)) return false;
    }
    chunks_.push_back(std::move(chunk));
    return true;
  }
  if (kind == Kind::message_index) {
    std::uint16_t channel = 0;
    if (!read_at(offset + kRecordHead, &channel, sizeof channel)) return false;
    if (chunks_.empty()) return true;
    chunks_.back().index_offsets[channel] = offset;
    chunks_.back().index_length = next - chunks_.back().offset - chunks_.back().length;
    return true;
  }
  if (kind == Kind::attachment) {
    mcap::AttachmentAt attachment;
    attachment.offset = offset;
    attachment.length = kRecordHead + length;
    std::array<std::uint8_t, 512> start{};
    const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(start.size(), length));
    if (!read_at(offset + kRecordHead, start.data(), there)) return false;
    BytesIn fields(ByteSpan(start).first(there));
    attachment.log_ns = fields.get<std::uint64_t>();
    attachment.create_ns = fields.get<std::uint64_t>();
    attachment.name = fields.text();
    attachment.media_type = fields.text();
    attachment.size = fields.get<std::uint64_t>();
    if (!fields.ok() || attachment.size > length) return false;
    attachments_.push_back(std::move(attachment));
    return true;
  }
  if (kind != Kind::header && kind != Kind::schema && kind != Kind::channel &&
      kind != Kind::metadata && kind != Kind::data_end)
    return false;
  if (length > kLargestSmallRecord) return false;
  std::vector<std::uint8_t> content;
  if (!read_content(offset, kind, content)) return false;
  if (kind == Kind::schema) return take_schema(content);
  if (kind == Kind::channel) return take_channel(content);
  if (kind == Kind::metadata) {
    BytesIn fields(content);
    const std::string name(fields.text());
    mcap::Pairs pairs;
    if (!mcap::get_pairs(fields, pairs)) return false;
    metadata_.push_back({offset, kRecordHead + length, name});
  }
  return true;
}

// The next position after offset where a whole, undamaged chunk begins; size() if there is none.
std::uint64_t McapReader::find_chunk_after(std::uint64_t offset) const {
  // a chunk that burr wrote is recognized by the length and name of its compression
  constexpr std::array<std::uint8_t, 8> kMark = {4, 0, 0, 0, 'z', 's', 't', 'd'};
  constexpr std::uint64_t kMarkAt = kRecordHead + kChunkFixed - 4;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  if (offset + kMarkAt >= size_) return size_;
  std::vector<std::uint8_t> block(static_cast<std::size_t>(
      std::min<std::uint64_t>(kBlock + kMark.size() - 1, size_ - offset - kMarkAt)));
  for (std::uint64_t base = offset + kMarkAt; base < size_; base += kBlock) {
    const auto there =
        static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size_ - base));
    if (!read_at(base, block.data(), there)) break;
    const auto end = block.begin() + static_cast<std::ptrdiff_t>(there);
    for (auto at = block.begin();; ++at) {
      at = std::search(at, end, kMark.begin(), kMark.end());
      if (at == end) break;
      const std::uint64_t start = base + static_cast<std::uint64_t>(at - block.begin()) - kMarkAt;
      McapChunk chunk;
      if (unpack_chunk(start, chunk)) return start;
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
      ended = read_at(offset, &kind, 1) && kind == static_cast<std::uint8_t>(Kind::data_end);
      offset = next;
      continue;
    }
    if (!chunks_.empty()) doubtful.push_back(chunks_.size() - 1);
    const std::uint64_t resumed = find_chunk_after(offset);
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

  // after a power cut a chunk may have the right length and wrong bytes, but only at the end
  if (!ended && !check_chunks) {
    McapChunk chunk;
    while (!chunks_.empty() && !unpack_chunk(chunks_.back().offset, chunk)) {
      lost_bytes_ += chunks_.back().length;
      notices_.push_back(fmt::format("{}: the last chunk, at byte {}, is damaged and was ignored",
                                     path_, chunks_.back().offset));
      chunks_.pop_back();
    }
    if (!chunks_.empty()) doubtful.push_back(chunks_.size() - 1);
  }
  for (const std::size_t index : doubtful)
    if (index < chunks_.size()) static_cast<void>(index_by_content(index));
}

}  // namespace burr::record

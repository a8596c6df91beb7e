#include "burr/record/mcap/mcap_reader.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/lz4_frame.h"
#include "burr/record/mcap/packed.h"

namespace burr::record {

using mcap::kChunkFixed;
using mcap::Kind;
using mcap::kRecordHead;

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 22;  // read at once of what may be huge [byte]

bool known_compression(const std::string& name) {
  return name.empty() || name == "zstd" || name == "lz4";
}

bool get_messages(McapChunk& chunk) {
  BytesIn in(chunk.bytes);
  while (!in.empty()) {
    const std::uint64_t offset = chunk.bytes.size() - in.left();
    const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
    const ByteSpan content = in.take(in.get<std::uint64_t>());
    if (!in.ok()) return false;
    if (kind != Kind::message) continue;  // schemas, channels, and what is unknown
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

  const Summary summary = reader->read_summary();
  reader->finished_ = summary != Summary::damaged;
  if (trust == Trust::nothing || summary != Summary::whole) {
    reader->forget();
    reader->scan(trust == Trust::nothing);
  }
  reader->index_the_rest();
  return reader;
}

void McapReader::forget() {
  schemas_.clear();
  channels_.clear();
  chunks_.clear();
  attachments_.clear();
  metadata_.clear();
}

std::set<std::uint16_t> McapReader::channels_of(std::string_view topic) const {
  std::set<std::uint16_t> found;
  for (const mcap::Channel& channel : channels_)
    if (channel.topic == topic) found.insert(channel.id);
  return found;
}

bool McapReader::knows(std::uint16_t id) const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [id](const mcap::Channel& channel) { return channel.id == id; });
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
  if (knows(channel.id)) return true;
  static_cast<void>(mcap::get_pairs(in, channel.metadata));  // burr needs none
  channels_.push_back(std::move(channel));
  return true;
}

void McapReader::take_channels_of(const McapChunk& chunk) {
  BytesIn in(chunk.bytes);
  while (!in.empty()) {
    const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
    const ByteSpan content = in.take(in.get<std::uint64_t>());
    if (!in.ok()) return;
    if (kind == Kind::schema) static_cast<void>(take_schema(content));
    if (kind == Kind::channel) static_cast<void>(take_channel(content));
  }
}

bool McapReader::read_chunk_head(std::uint64_t offset, mcap::ChunkAt& chunk, std::uint32_t& crc,
                                 std::uint64_t& body) const {
  Kind kind = {};
  std::uint64_t next = 0;
  return record_at(offset, kind, next) && kind == Kind::chunk &&
         read_chunk_fields(offset, chunk, crc, body);
}

// Reads the fields of a chunk and checks that all its lengths agree.
bool McapReader::read_chunk_fields(std::uint64_t offset, mcap::ChunkAt& chunk, std::uint32_t& crc,
                                   std::uint64_t& body) const {
  std::array<std::uint8_t, kRecordHead + kChunkFixed + 16 + 8> head{};
  if (offset >= size_) return false;
  const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(head.size(), size_ - offset));
  if (!read_at(offset, head.data(), there)) return false;
  BytesIn in(ByteSpan(head).first(there));
  in.get<std::uint8_t>();
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
  return chunk.start_ns <= chunk.end_ns && chunk.packed_size <= length &&
         length == kChunkFixed + chunk.compression.size() + 8 + chunk.packed_size;
}

bool McapReader::unpack_chunk(std::uint64_t offset, McapChunk& chunk) const {
  mcap::ChunkAt at;
  std::uint64_t body = 0;
  if (!read_chunk_head(offset, at, chunk.crc, body) || oversized(at)) return false;
  std::vector<std::uint8_t> packed(static_cast<std::size_t>(at.packed_size));
  if (!read_at(body, packed.data(), packed.size())) return false;
  if (at.compression.empty()) {
    if (at.packed_size != at.unpacked_size) return false;
    chunk.bytes = std::move(packed);
  } else if (at.compression == "zstd") {
    if (!unpack(packed, at.unpacked_size, chunk.bytes)) return false;
  } else if (at.compression != "lz4" || !unpack_lz4(packed, at.unpacked_size, chunk.bytes)) {
    return false;
  }
  // 0 in the file: its writer computed none
  if (chunk.crc != 0 && crc32(chunk.bytes) != chunk.crc) return false;
  return get_messages(chunk);
}

bool McapReader::load(const mcap::ChunkAt& at, McapChunk& chunk) const {
  if (!at.bare) return unpack_chunk(at.offset, chunk);
  if (oversized(at)) return false;
  chunk.bytes.resize(static_cast<std::size_t>(at.length));
  if (!read_at(at.offset, chunk.bytes.data(), chunk.bytes.size())) return false;
  chunk.crc = crc32(chunk.bytes);
  return get_messages(chunk);
}

bool McapReader::opaque(const mcap::ChunkAt& chunk) {
  return oversized(chunk) || !known_compression(chunk.compression);
}

bool McapReader::oversized(const mcap::ChunkAt& chunk) {
  return std::max({chunk.length, chunk.packed_size, chunk.unpacked_size}) >
         mcap::kLargestChunk + kRecordHead + kChunkFixed + 1024;
}

Result<McapChunk> McapReader::read_chunk(std::size_t index) const {
  const mcap::ChunkAt& at = chunks_.at(index);
  if (!known_compression(at.compression))
    return error(
        fmt::format("{}: burr does not read the chunk compression \"{}\", only zstd and lz4; this "
                    "file was not written by burr",
                    path_, base::printable(at.compression)));
  if (oversized(at))
    return error(
        fmt::format("{}: {} at byte {} holds {} bytes, and burr reads at most {} at once; "
                    "write the file again with smaller chunks",
                    path_, at.bare ? "the message" : "the chunk", at.offset,
                    std::max(at.length, at.unpacked_size), mcap::kLargestChunk));
  McapChunk chunk;
  if (!load(at, chunk))
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

Status McapReader::read_raw(mcap::RecordAt part, const std::function<Status(ByteSpan)>& use) const {
  std::vector<std::uint8_t> piece(
      static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, part.length)));
  for (std::uint64_t done = 0; done < part.length; done += piece.size()) {
    if (part.length - done < piece.size())
      piece.resize(static_cast<std::size_t>(part.length - done));
    if (!read_at(part.offset + done, piece.data(), piece.size()))
      return error(Trouble::io, fmt::format("{}: cannot be read at byte {}; copy the file again",
                                            path_, part.offset + done));
    if (Status used = use(piece); !used.ok()) return used;
  }
  return fine();
}

Status McapReader::check_attachment(std::size_t index) const {
  const mcap::AttachmentAt& at = attachments_.at(index);
  const Error damaged =
      error(fmt::format("{}: the attachment \"{}\" is damaged", path_, base::printable(at.name)));
  constexpr std::uint64_t kFixed = 8 + 8 + 4 + 4 + 8 + 4;  // times, two lengths of text, size, crc
  if (at.length != kRecordHead + kFixed + at.name.size() + at.media_type.size() + at.size)
    return damaged;
  std::uint32_t wanted = 0, found = 0;
  if (!read_at(at.offset + at.length - sizeof wanted, &wanted, sizeof wanted)) return damaged;
  if (wanted == 0) return fine();  // its writer computed none
  const mcap::RecordAt checked = {at.offset + kRecordHead, at.length - kRecordHead - sizeof wanted};
  const Status read = read_raw(checked, [&found](ByteSpan piece) {
    found = crc32(found, piece);
    return fine();
  });
  if (!read.ok()) return read;
  return found == wanted ? fine() : Status(damaged);
}

// Finds out which channels a chunk has from its messages; for chunks without indexes.
bool McapReader::index_by_content(std::size_t index) {
  McapChunk chunk;
  if (!load(chunks_[index], chunk)) return false;
  take_channels_of(chunk);
  std::map<std::uint16_t, std::uint64_t> found;  // the position of an index that is there stays
  for (const McapMessage& message : chunk.messages) {
    const auto known = chunks_[index].index_offsets.find(message.channel);
    found[message.channel] = known == chunks_[index].index_offsets.end() ? 0 : known->second;
  }
  chunks_[index].index_offsets = std::move(found);
  return true;
}

// What neither summary nor indexes tell: the messages of chunks without indexes, and channels that
// stand inside chunks alone.
void McapReader::index_the_rest() {
  std::set<std::uint16_t> nowhere;  // not in a chunk that has messages of it
  for (std::size_t n = 0; n < chunks_.size(); ++n) {
    const mcap::ChunkAt& chunk = chunks_[n];
    const bool unindexed = chunk.index_offsets.empty() && chunk.unpacked_size > 0;
    bool unknown = false;
    for (const auto& [id, at] : chunk.index_offsets)
      unknown = unknown || (!knows(id) && nowhere.insert(id).second);
    if (unindexed && opaque(chunk))
      notices_.push_back(read_chunk(n).error().text);
    else if ((unindexed || unknown) && !chunk.bare)
      static_cast<void>(index_by_content(n));
  }
}

}  // namespace burr::record

#include "burr/record/mcap/mcap_writer.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "burr/base/check.h"
#include "burr/base/disk_words.h"
#include "burr/base/plain_file.h"
#include "burr/base/version.h"
#include "burr/record/file_lock.h"
#include "burr/record/mcap/crc32.h"

namespace burr::record {
namespace mcap {

void put_record(BytesOut& out, Kind kind, ByteSpan content) {
  out.put(static_cast<std::uint8_t>(kind));
  out.put(std::uint64_t{content.size()});
  out.raw(content);
}

void put_pairs(BytesOut& out, const Pairs& pairs) {
  BytesOut inner;
  for (const auto& [key, value] : pairs) {
    inner.text(key);
    inner.text(value);
  }
  out.text(as_text(inner.span()));
}

bool get_pairs(BytesIn& in, Pairs& pairs) {
  BytesIn inner(in.block());
  while (in.ok() && inner.ok() && !inner.empty()) {
    const std::string key(inner.text());
    pairs[key] = inner.text();
  }
  return in.ok() && inner.ok();
}

}  // namespace mcap

using mcap::Kind;

namespace {

Error trouble(const std::string& shown, const char* doing) {
  return error(Trouble::io,
               fmt::format("{}: cannot {}: {}", shown, doing, base::disk_trouble(errno)));
}

void put_schema(BytesOut& out, const mcap::Schema& schema) {
  out.put(schema.id);
  out.text(schema.name);
  out.text(schema.encoding);
  out.text(schema.data);
}

void put_channel(BytesOut& out, const mcap::Channel& channel) {
  out.put(channel.id);
  out.put(channel.schema);
  out.text(channel.topic);
  out.text(channel.encoding);
  mcap::put_pairs(out, channel.metadata);
}

// array of (u16, u64), preceded by its length in bytes
void put_counts(BytesOut& out, const std::map<std::uint16_t, std::uint64_t>& counts) {
  out.put(static_cast<std::uint32_t>(counts.size() * 10));
  for (const auto& [channel, value] : counts) {
    out.put(channel);
    out.put(value);
  }
}

}  // namespace

McapWriter::~McapWriter() {
  if (file_ >= 0) ::close(file_);
}

Status McapWriter::open(const std::string& path, const std::string& shown) {
  BURR_CHECK(file_ < 0);
  shown_ = shown;
  if (Status plain = base::check_plain_file(path, shown); !plain) return plain;
  // for this user alone: a recording holds how somebody moved, and may hold who it was
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file_ < 0) return trouble(shown_, "be written");
  const FileLock got = lock(file_);
  locked_ = got == FileLock::taken;
  if (got == FileLock::of_another)
    return error(Trouble::io, shown_ + ": another burr is writing this file; choose another name");
  static_cast<void>(::fchmod(file_, 0600));  // one that was there and is replaced, too
  const Status begun = begin(path);
  if (!begun.ok()) ::unlink(path.c_str());
  return begun;
}

Status McapWriter::begin(const std::string& path) {
  if (Status empty = make_empty(path); !empty.ok()) return empty;
  if (Status written = append(mcap::kMagic); !written.ok()) return written;
  BytesOut header;
  header.text("burr");
  header.text(std::string("burr ") + base::version());
  return append_record(Kind::header, header.span());
}

// What a killed burr left under this name goes.
Status McapWriter::make_empty(const std::string& path) {
  struct stat old = {};
  if (::fstat(file_, &old) == 0 && old.st_size == 0) return fine();
  if (::ftruncate(file_, 0) == 0) return fine();
  const Error problem = trouble(shown_, "be written");
  ::close(file_);
  file_ = -1;
  // a file system that shortens no file may still let it go
  if (::unlink(path.c_str()) == 0)
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file_ < 0) return problem;
  static_cast<void>(lock(file_));
  return fine();
}

Status McapWriter::append(ByteSpan bytes) {
  if (failed_)
    return error(Trouble::io, shown_ + ": is no longer written after an earlier failure");
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(file_, bytes.data() + done, bytes.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    const Error problem = trouble(shown_, "be written further");
    failed_ = true;
    // a file cut in the middle of a record can be read, but a clean end is better: try to cut it
    // there
    static_cast<void>(::ftruncate(file_, static_cast<off_t>(size_)) == 0);
    return problem;
  }
  crc_ = crc32(crc_, bytes);
  size_ += bytes.size();
  return fine();
}

Status McapWriter::append_record(Kind kind, ByteSpan content) {
  BytesOut record;
  mcap::put_record(record, kind, content);
  return append(record.span());
}

Result<std::uint16_t> McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                             const std::string& data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  if (Status added = add(mcap::Schema{id, name, encoding, data}); !added.ok()) return added.error();
  return id;
}

Result<std::uint16_t> McapWriter::add_channel(const std::string& topic, const std::string& encoding,
                                              std::uint16_t schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  if (Status added = add(mcap::Channel{id, schema, topic, encoding, {}}); !added.ok())
    return added.error();
  return id;
}

Status McapWriter::add(const mcap::Schema& schema) {
  BytesOut content;
  put_schema(content, schema);
  schemas_.push_back(schema);
  return append_record(Kind::schema, content.span());
}

Status McapWriter::add(const mcap::Channel& channel) {
  BytesOut content;
  put_channel(content, channel);
  channels_.push_back(channel);
  return append_record(Kind::channel, content.span());
}

Status McapWriter::add_metadata(const std::string& name, const mcap::Pairs& pairs) {
  BytesOut content;
  content.text(name);
  mcap::put_pairs(content, pairs);
  metadata_.push_back({size_, mcap::kRecordHead + content.size(), name});
  return append_record(Kind::metadata, content.span());
}

Status McapWriter::add_attachment(const std::string& name, const std::string& media_type,
                                  ByteSpan data) {
  BytesOut head;
  head.put(std::uint64_t{0});  // log_time: from the start of the session
  head.put(std::uint64_t{0});  // create_time: unknown on purpose, recordings contain no dates
  head.text(name);
  head.text(media_type);
  head.put(std::uint64_t{data.size()});
  const std::uint32_t crc = crc32(crc32(head.span()), data);

  const std::uint64_t length = head.size() + data.size() + sizeof crc;
  attachments_.push_back({size_, mcap::kRecordHead + length, 0, 0, data.size(), name, media_type});
  BytesOut start;
  start.put(static_cast<std::uint8_t>(Kind::attachment));
  start.put(length);
  start.raw(head.span());
  if (Status written = append(start.span()); !written.ok()) return written;
  if (Status written = append(data); !written.ok()) return written;
  BytesOut end;
  end.put(crc);
  return append(end.span());
}

void McapWriter::add_message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                             ByteSpan data) {
  start_ns_ = chunk_.empty() ? time_ns : std::min(start_ns_, time_ns);
  end_ns_ = chunk_.empty() ? time_ns : std::max(end_ns_, time_ns);
  indexes_[channel].emplace_back(time_ns, chunk_.size());
  chunk_.put(static_cast<std::uint8_t>(Kind::message));
  chunk_.put(std::uint64_t{2 + 4 + 8 + 8 + data.size()});
  chunk_.put(channel);
  chunk_.put(sequence);
  chunk_.put(time_ns);
  chunk_.put(time_ns);
  chunk_.raw(data);
}

Status McapWriter::close_chunk() {
  if (chunk_.empty()) return fine();
  std::vector<std::uint8_t> packed;
  packer_.pack(chunk_.span(), packed);
  mcap::ChunkAt chunk;
  chunk.start_ns = start_ns_;
  chunk.end_ns = end_ns_;
  chunk.packed_size = packed.size();
  chunk.unpacked_size = chunk_.size();
  chunk.compression = "zstd";
  Status written = add_chunk(chunk, crc32(chunk_.span()), packed, indexes_);
  chunk_.clear();
  indexes_.clear();
  return written;
}

Status McapWriter::add_chunk(const mcap::ChunkAt& from, std::uint32_t unpacked_crc, ByteSpan packed,
                             const mcap::MessageIndexes& indexes) {
  mcap::ChunkAt chunk = from;
  BytesOut content;
  content.put(chunk.start_ns);
  content.put(chunk.end_ns);
  content.put(chunk.unpacked_size);
  content.put(unpacked_crc);
  content.text(chunk.compression);
  content.put(std::uint64_t{packed.size()});
  content.raw(packed);
  BytesOut whole;
  mcap::put_record(whole, Kind::chunk, content.span());
  chunk.offset = size_;
  chunk.length = whole.size();
  chunk.packed_size = packed.size();

  // the indexes are part of the same write, so that a killed writer leaves both or an incomplete
  // end
  chunk.index_offsets.clear();
  for (const auto& [channel, messages] : indexes) {
    chunk.index_offsets[channel] = size_ + whole.size();
    BytesOut index;
    index.put(channel);
    index.put(static_cast<std::uint32_t>(messages.size() * 16));
    for (const auto& [time, offset] : messages) {
      index.put(time);
      index.put(offset);
    }
    mcap::put_record(whole, Kind::message_index, index.span());
  }
  chunk.index_length = whole.size() - chunk.length;
  if (Status written = append(whole.span()); !written.ok()) return written;
  count_chunk(chunk, chunk.offset);
  return fine();
}

void McapWriter::count_time(std::uint64_t first_ns, std::uint64_t last_ns) {
  first_ns_ = timed_ ? std::min(first_ns_, first_ns) : first_ns;
  last_ns_ = std::max(last_ns_, last_ns);
  timed_ = true;
}

void McapWriter::count_chunk(const mcap::ChunkAt& chunk, std::uint64_t offset) {
  count_time(chunk.start_ns, chunk.end_ns);
  if (chunks_++ == 0) first_chunk_ = offset;
}

Status McapWriter::copy_chunk(const mcap::ChunkAt& chunk, const Pieces& with_its_indexes) {
  count_chunk(chunk, size_);
  return copy_unknown(with_its_indexes);
}

Status McapWriter::copy_attachment(const mcap::AttachmentAt& attachment, const Pieces& pieces) {
  attachments_.push_back(attachment);
  attachments_.back().offset = size_;
  return copy_unknown(pieces);
}

Status McapWriter::copy_message(std::uint16_t channel, std::uint64_t time_ns,
                                const Pieces& pieces) {
  count_time(time_ns, time_ns);
  ++message_counts_[channel];
  return copy_unknown(pieces);
}

Status McapWriter::copy_unknown(const Pieces& pieces) {
  return pieces([this](ByteSpan piece) { return append(piece); });
}

Status McapWriter::sync() {
  int failed = 0;
  do failed = ::fdatasync(file_);
  while (failed != 0 && errno == EINTR);
  if (failed != 0 && !base::not_offered(errno)) return trouble(shown_, "be flushed to the disk");
  return fine();
}

Status McapWriter::still_there() const {
  struct stat now = {};
  // a disk that cannot tell may go on to be written
  if (::fstat(file_, &now) != 0 || now.st_nlink > 0) return fine();
  return error(Trouble::io, shown_ +
                                ": was removed while it was being recorded, and its content is "
                                "lost; do not touch a recording until the session has ended");
}

// Positions of the chunks and their indexes, and the numbers of messages, read back from the headers of
// their records: to keep them in memory would cost 300 bytes for each of 25 chunks a second.
Status McapWriter::read_back(BytesOut& chunk_indexes) {
  std::array<std::uint8_t, 128> head{};
  mcap::ChunkAt chunk;
  const auto put = [&] {
    BytesOut content;
    content.put(chunk.start_ns);
    content.put(chunk.end_ns);
    content.put(chunk.offset);
    content.put(chunk.length);
    put_counts(content, chunk.index_offsets);
    content.put(chunk.index_length);
    content.text(chunk.compression);
    content.put(chunk.packed_size);
    content.put(chunk.unpacked_size);
    mcap::put_record(chunk_indexes, Kind::chunk_index, content.span());
  };
  for (std::uint64_t at = first_chunk_; chunks_ > 0 && at < size_;) {
    const ssize_t there = ::pread(file_, head.data(), head.size(), static_cast<off_t>(at));
    if (there < 0 && errno == EINTR) continue;
    if (there < 0) return fine();  // the file can be read without an index, only more slowly
    BytesIn in(ByteSpan(head).first(static_cast<std::size_t>(there)));
    const auto kind = static_cast<Kind>(in.get<std::uint8_t>());
    const std::uint64_t length = mcap::kRecordHead + in.get<std::uint64_t>();
    if (kind == Kind::chunk) {
      if (chunk.length > 0) put();
      chunk = {};
      chunk.offset = at;
      chunk.length = length;
      chunk.start_ns = in.get<std::uint64_t>();
      chunk.end_ns = in.get<std::uint64_t>();
      chunk.unpacked_size = in.get<std::uint64_t>();
      in.get<std::uint32_t>();
      chunk.compression = in.text();
      chunk.packed_size = in.get<std::uint64_t>();
    } else if (kind == Kind::message_index) {
      constexpr std::uint64_t kEntry = 16;  // a time and an offset
      const auto channel = in.get<std::uint16_t>();
      chunk.index_offsets[channel] = at;
      chunk.index_length += length;
      message_counts_[channel] += in.get<std::uint32_t>() / kEntry;
    }
    if (!in.ok() || length > size_ - at)
      return error(Trouble::io, shown_ +
                                    ": was changed by another program while it was being recorded; "
                                    "`record::repair` saves what is left of it");
    at += length;
  }
  if (chunks_ > 0) put();
  indexed_ = true;
  return fine();
}

Status McapWriter::finish() {
  if (Status closed = close_chunk(); !closed.ok()) return closed;
  if (Status written = append_end(); !written.ok()) return written;
  if (Status synced = sync(); !synced.ok()) return synced;
  const int file = file_;
  file_ = -1;
  if (::close(file) != 0) return trouble(shown_, "be closed");
  return fine();
}

// What makes the file complete: the summary and the footer.
Status McapWriter::append_end() {
  BytesOut chunk_indexes;
  if (Status read = read_back(chunk_indexes); !read.ok()) return read;
  BytesOut end;
  end.put(crc_);
  if (Status written = append_record(Kind::data_end, end.span()); !written.ok()) return written;

  // the summary: records of each kind together, and where each kind begins
  const std::uint64_t summary_start = size_;
  BytesOut summary;
  if (!indexed_) return end_file(summary, 0, 0);
  BytesOut offsets;
  const auto group = [&](Kind kind, auto&& put_all) {
    const std::uint64_t before = summary.size();
    put_all();
    if (summary.size() == before) return;
    BytesOut offset;
    offset.put(static_cast<std::uint8_t>(kind));
    offset.put(summary_start + before);
    offset.put(summary.size() - before);
    mcap::put_record(offsets, Kind::summary_offset, offset.span());
  };
  const auto put = [&](Kind kind, auto&& fill) {
    BytesOut content;
    fill(content);
    mcap::put_record(summary, kind, content.span());
  };
  group(Kind::schema, [&] {
    for (const auto& schema : schemas_)
      put(Kind::schema, [&](BytesOut& out) { put_schema(out, schema); });
  });
  group(Kind::channel, [&] {
    for (const auto& channel : channels_)
      put(Kind::channel, [&](BytesOut& out) { put_channel(out, channel); });
  });
  group(Kind::statistics, [&] {
    put(Kind::statistics, [&](BytesOut& out) {
      std::uint64_t messages = 0;
      for (const auto& [channel, count] : message_counts_) messages += count;
      out.put(messages);
      out.put(static_cast<std::uint16_t>(schemas_.size()));
      out.put(static_cast<std::uint32_t>(channels_.size()));
      out.put(static_cast<std::uint32_t>(attachments_.size()));
      out.put(static_cast<std::uint32_t>(metadata_.size()));
      out.put(static_cast<std::uint32_t>(chunks_));
      out.put(first_ns_);
      out.put(last_ns_);
      put_counts(out, message_counts_);
    });
  });
  group(Kind::chunk_index, [&] { summary.raw(chunk_indexes.span()); });
  group(Kind::attachment_index, [&] {
    for (const auto& attachment : attachments_)
      put(Kind::attachment_index, [&](BytesOut& out) {
        out.put(attachment.offset);
        out.put(attachment.length);
        out.put(attachment.log_ns);
        out.put(attachment.create_ns);
        out.put(attachment.size);
        out.text(attachment.name);
        out.text(attachment.media_type);
      });
  });
  group(Kind::metadata_index, [&] {
    for (const auto& metadata : metadata_)
      put(Kind::metadata_index, [&](BytesOut& out) {
        out.put(metadata.offset);
        out.put(metadata.length);
        out.text(metadata.name);
      });
  });

  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.raw(offsets.span());
  return end_file(summary, summary_start, offsets_start);
}

// summary: everything from its start on; empty: there is none
Status McapWriter::end_file(BytesOut& summary, std::uint64_t summary_start,
                            std::uint64_t offsets_start) {
  summary.put(static_cast<std::uint8_t>(Kind::footer));
  summary.put(std::uint64_t{20});
  summary.put(summary_start);
  summary.put(offsets_start);
  summary.put(crc32(summary.span()));
  summary.raw(mcap::kMagic);
  return append(summary.span());
}

}  // namespace burr::record

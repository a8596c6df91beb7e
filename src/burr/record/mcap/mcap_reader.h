// record/mcap/mcap_reader.h - reads any MCAP file: by its summary if there is a good one that names
// all that is there; otherwise by a scan, which drops an incomplete end, steps over damaged parts and
// reports both. Schemas and channels may stand inside chunks, messages outside of them, and records of
// an unknown kind anywhere.
//
// No number in the file is trusted: offsets are checked against the file size, chunks against their
// CRC, and memory grows only as data really comes.
// Thread: one at a time. Memory: the indexes (about 150 byte a chunk), and one chunk at a time.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/mcap/mcap.h"

namespace burr::record {

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;  // log_time
  std::uint64_t offset = 0;   // of its record in the unpacked chunk
  ByteSpan data;              // points into the chunk's bytes
};

// One unpacked chunk and its messages, in order.
struct McapChunk {
  std::vector<std::uint8_t> bytes;
  std::uint32_t crc = 0;
  std::vector<McapMessage> messages;
};

class McapReader {
 public:
  enum class Trust {
    summary,  // use a good summary; scan only without one
    nothing,  // scan and check every chunk; slow, for repair
  };

  [[nodiscard]] static Result<std::unique_ptr<McapReader>> open(const std::string& path,
                                                                Trust trust = Trust::summary);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  [[nodiscard]] const std::vector<mcap::Schema>& schemas() const { return schemas_; }
  [[nodiscard]] const std::vector<mcap::Channel>& channels() const { return channels_; }
  // Empty: no such topic. Other writers may give a topic several channels.
  [[nodiscard]] std::set<std::uint16_t> channels_of(std::string_view topic) const;
  // in the order of the file
  [[nodiscard]] const std::vector<mcap::ChunkAt>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<mcap::AttachmentAt>& attachments() const { return attachments_; }
  [[nodiscard]] const std::vector<mcap::MetadataAt>& metadata() const { return metadata_; }

  // Records of an unknown kind; only after a scan.
  [[nodiscard]] const std::vector<mcap::RecordAt>& unknown() const { return unknown_; }

  // has a footer, and a good summary or none
  [[nodiscard]] bool finished() const { return finished_; }
  // bytes after the last good record of an unfinished file, or in damaged parts
  [[nodiscard]] std::uint64_t lost_bytes() const { return lost_bytes_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  // one sentence for each oddity found
  [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }

  // Checks the CRC. An error concerns this chunk only; others may be read.
  [[nodiscard]] Result<McapChunk> read_chunk(std::size_t index) const;
  // as in the file, still packed; for repair
  [[nodiscard]] Result<std::vector<std::uint8_t>> read_packed(std::size_t index) const;
  [[nodiscard]] Result<std::vector<std::uint8_t>> read_attachment(std::size_t index) const;
  [[nodiscard]] Result<mcap::Pairs> read_metadata(std::size_t index) const;
  // Error: its bytes do not fit its CRC, or its lengths each other. In pieces, whatever its size.
  [[nodiscard]] Status check_attachment(std::size_t index) const;
  // It can be copied and not be read: too large to be read at once, or packed in a way that burr does
  // not know.
  [[nodiscard]] static bool opaque(const mcap::ChunkAt& chunk);
  // A part of the file as it is, in pieces, for records that are too large to be read at once.
  [[nodiscard]] Status read_raw(mcap::RecordAt part,
                                const std::function<Status(ByteSpan)>& use) const;

 private:
  enum class Summary { damaged, partial, whole };

  McapReader() = default;
  [[nodiscard]] bool read_at(std::uint64_t offset, void* to, std::size_t size) const;
  [[nodiscard]] bool read_content(std::uint64_t offset, mcap::Kind kind,
                                  std::vector<std::uint8_t>& content) const;
  [[nodiscard]] Summary read_summary();
  [[nodiscard]] bool take_summary(std::uint64_t start, ByteSpan summary);
  [[nodiscard]] bool names_all(std::uint64_t start);
  void forget();
  void scan(bool check_chunks);
  [[nodiscard]] bool scan_record(std::uint64_t offset, std::uint64_t& next, bool check_chunks);
  [[nodiscard]] bool scan_chunk(std::uint64_t offset, std::uint64_t next, bool check_chunks);
  [[nodiscard]] bool scan_message(std::uint64_t offset, std::uint64_t next);
  [[nodiscard]] bool scan_message_index(std::uint64_t offset, std::uint64_t next);
  [[nodiscard]] bool scan_attachment(std::uint64_t offset, std::uint64_t next);
  [[nodiscard]] bool scan_small(std::uint64_t offset, mcap::Kind kind, std::uint64_t next);
  [[nodiscard]] bool record_at(std::uint64_t offset, mcap::Kind& kind, std::uint64_t& next) const;
  [[nodiscard]] bool good_after(std::uint64_t next) const;
  void drop_damaged_end(std::vector<std::size_t>& doubtful);
  [[nodiscard]] bool read_chunk_head(std::uint64_t offset, mcap::ChunkAt& chunk, std::uint32_t& crc,
                                     std::uint64_t& body) const;
  [[nodiscard]] bool read_chunk_fields(std::uint64_t offset, mcap::ChunkAt& chunk,
                                       std::uint32_t& crc, std::uint64_t& body) const;
  [[nodiscard]] bool was_a_chunk(std::uint64_t offset) const;
  [[nodiscard]] std::uint64_t find_next(std::uint64_t offset) const;
  [[nodiscard]] bool messages_at(std::uint64_t offset) const;
  [[nodiscard]] bool index_by_content(std::size_t chunk);
  void index_the_rest();
  [[nodiscard]] bool knows(std::uint16_t channel) const;
  [[nodiscard]] bool take_schema(ByteSpan content);
  [[nodiscard]] bool take_channel(ByteSpan content);
  void take_channels_of(const McapChunk& chunk);
  [[nodiscard]] bool unpack_chunk(std::uint64_t offset, McapChunk& chunk) const;
  [[nodiscard]] static bool oversized(const mcap::ChunkAt& chunk);
  [[nodiscard]] bool load(const mcap::ChunkAt& at, McapChunk& chunk) const;

  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  bool finished_ = false;
  std::uint64_t lost_bytes_ = 0;
  std::vector<std::string> notices_;
  std::vector<mcap::Schema> schemas_;
  std::vector<mcap::Channel> channels_;
  std::vector<mcap::ChunkAt> chunks_;
  std::vector<mcap::AttachmentAt> attachments_;
  std::vector<mcap::MetadataAt> metadata_;
  std::vector<mcap::RecordAt> unknown_;
};

}  // namespace burr::record

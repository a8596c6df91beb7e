// record/mcap/mcap_reader.h - reads an MCAP file: by its summary if there is a good one; otherwise
// by a scan, which drops an incomplete end, steps over damaged parts and reports both.
//
// No number in the file is trusted: offsets are checked against the file size, chunks against their
// CRC, and memory grows only as data really comes.
// Thread: one at a time. Memory: the indexes (about 150 byte a chunk), and one chunk at a time.
#pragma once

#include <memory>
#include <string>
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
  // 0: no such topic
  [[nodiscard]] std::uint16_t channel_of(std::string_view topic) const;
  [[nodiscard]] const std::vector<mcap::ChunkAt>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<mcap::AttachmentAt>& attachments() const { return attachments_; }
  [[nodiscard]] const std::vector<mcap::MetadataAt>& metadata() const { return metadata_; }

  // has a good summary and a footer
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

 private:
  McapReader() = default;
  [[nodiscard]] bool read_at(std::uint64_t offset, void* to, std::size_t size) const;
  [[nodiscard]] bool read_content(std::uint64_t offset, mcap::Kind kind,
                                  std::vector<std::uint8_t>& content) const;
  [[nodiscard]] bool read_summary();
  void scan(bool check_chunks);
  [[nodiscard]] bool scan_record(std::uint64_t offset, std::uint64_t& next, bool check_chunks);
  [[nodiscard]] bool read_chunk_head(std::uint64_t offset, mcap::ChunkAt& chunk, std::uint32_t& crc,
                                     std::uint64_t& body) const;
  [[nodiscard]] std::uint64_t find_chunk_after(std::uint64_t offset) const;
  [[nodiscard]] bool index_by_content(std::size_t chunk);
  [[nodiscard]] bool take_schema(ByteSpan content);
  [[nodiscard]] bool take_channel(ByteSpan content);
  [[nodiscard]] bool unpack_chunk(std::uint64_t offset, McapChunk& chunk) const;

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
};

}  // namespace burr::record

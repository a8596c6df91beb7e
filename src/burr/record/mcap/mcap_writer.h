// record/mcap/mcap_writer.h - writes an MCAP file (mcap.dev/spec) by appending only, one whole
// chunk at a time, so that a killed process leaves a file that is good up to its last chunk.
//
//     writer.open(path) -> schema, channel, metadata, attachment
//                       -> [ message, message ... close_chunk | copy_to ]*  -> finish
//
// Thread: one at a time; only sync() may be called from another. Memory: one chunk, however long
// the recording; for the summary, the index of all chunks is read back from the file at the end.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/mcap/mcap.h"
#include "burr/record/mcap/packed.h"

namespace burr::record {

class McapWriter {
 public:
  McapWriter() = default;
  ~McapWriter();  // without finish(): the file stays incomplete but readable
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // Creates the file with its header; a file of this name is overwritten, or gone after an error. `shown`: its name in
  // errors. The open file is locked, so that `burr repair` knows that it is still being written, where
  // the file system has locks.
  [[nodiscard]] Status open(const std::string& path, const std::string& shown);

  // After open(). False: the file system has no locks.
  [[nodiscard]] bool locked() const { return locked_; }

  // The writer assigns the ids, from 1. Written at once, and again in the summary.
  [[nodiscard]] Result<std::uint16_t> add_schema(const std::string& name,
                                                 const std::string& encoding,
                                                 const std::string& data);
  [[nodiscard]] Result<std::uint16_t> add_channel(const std::string& topic,
                                                  const std::string& encoding,
                                                  std::uint16_t schema);
  // with the ids that they have; for repair
  [[nodiscard]] Status add(const mcap::Schema& schema);
  [[nodiscard]] Status add(const mcap::Channel& channel);

  [[nodiscard]] Status add_metadata(const std::string& name, const mcap::Pairs& pairs);
  [[nodiscard]] Status add_attachment(const std::string& name, const std::string& media_type,
                                      ByteSpan data);

  // Adds to the open chunk. time_ns: log_time and publish_time.
  void add_message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                   ByteSpan data);
  [[nodiscard]] bool chunk_open() const { return !chunk_.empty(); }
  // Packs the open chunk and appends it with its indexes in one write. Does nothing if none is
  // open. After a failure the file is cut back to its last good chunk, and nothing more can be
  // added.
  [[nodiscard]] Status close_chunk();
  // Appends a chunk of another file as it is, already checked; for repair.
  [[nodiscard]] Status add_chunk(const mcap::ChunkAt& chunk, std::uint32_t unpacked_crc,
                                 ByteSpan packed, const mcap::MessageIndexes& indexes);

  // Append records of another file as they are, which come in pieces; for repair, where they are too
  // large to be read at once, or of a kind that burr does not know.
  using Pieces = std::function<Status(const std::function<Status(ByteSpan)>&)>;
  [[nodiscard]] Status copy_chunk(const mcap::ChunkAt& chunk, const Pieces& with_its_indexes);
  [[nodiscard]] Status copy_attachment(const mcap::AttachmentAt& attachment, const Pieces& pieces);
  [[nodiscard]] Status copy_message(std::uint16_t channel, std::uint64_t time_ns,
                                    const Pieces& pieces);
  [[nodiscard]] Status copy_unknown(const Pieces& pieces);

  // Brings everything appended so far to the disk, not only to the kernel, where the file system offers
  // it. Slow.
  [[nodiscard]] Status sync();
  // Error: somebody has removed the file; what is written now belongs to no folder.
  [[nodiscard]] Status still_there() const;
  // A complete file of everything up to the last chunk, beside this one, which goes on as if nothing
  // had happened. `shown`: its name in errors. It is overwritten, and removed again if it fails.
  [[nodiscard]] Status copy_to(const std::string& path, const std::string& shown);
  // Summary, footer, sync, close. A disk from which nothing can be read back gets no summary.
  [[nodiscard]] Status finish();

  [[nodiscard]] std::uint64_t size() const { return size_; }  // of the file so far [byte]

 private:
  [[nodiscard]] Status begin(const std::string& path);
  [[nodiscard]] Status make_empty(const std::string& path);
  [[nodiscard]] Status append(ByteSpan bytes);
  [[nodiscard]] Status append_record(mcap::Kind kind, ByteSpan content);
  void count_time(std::uint64_t first_ns, std::uint64_t last_ns);
  void count_chunk(const mcap::ChunkAt& chunk, std::uint64_t offset);
  [[nodiscard]] Status read_back(BytesOut& chunk_indexes);
  [[nodiscard]] Status end_file(BytesOut& summary, std::uint64_t summary_start,
                                std::uint64_t offsets_start);
  [[nodiscard]] Status append_end();
  [[nodiscard]] Status copy_bytes_to(int file) const;

  std::string shown_;
  int file_ = -1;
  bool failed_ = false, locked_ = false;
  bool indexed_ = false;  // read_back() found all chunks
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // of everything written so far

  Packer packer_;
  BytesOut chunk_;
  mcap::MessageIndexes indexes_;
  std::uint64_t start_ns_ = 0, end_ns_ = 0;

  std::vector<mcap::Schema> schemas_;
  std::vector<mcap::Channel> channels_;
  std::uint64_t first_chunk_ = 0, chunks_ = 0;  // offset; how many
  std::vector<mcap::AttachmentAt> attachments_;
  std::vector<mcap::MetadataAt> metadata_;
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
  bool timed_ = false;  // something has a time
};

}  // namespace burr::record

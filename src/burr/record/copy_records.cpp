#include "burr/record/copy_records.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "burr/record/mcap/packed.h"
#include "burr/record/sealer.h"

namespace burr::record {
namespace {

mcap::MessageIndexes indexes_of(const McapChunk& chunk) {
  mcap::MessageIndexes indexes;
  for (const McapMessage& message : chunk.messages)
    indexes[message.channel].emplace_back(message.time_ns, message.offset);
  return indexes;
}

// A part of the file, for McapWriter.
McapWriter::Pieces part_of(const McapReader& from, std::uint64_t offset, std::uint64_t length) {
  return [&from, offset, length](const std::function<Status(ByteSpan)>& use) {
    return from.read_raw({offset, length}, use);
  };
}

// A chunk or a message that cannot be looked into.
Status copy_opaque(const McapReader& from, const mcap::ChunkAt& at, McapWriter& to) {
  if (!at.bare) return to.copy_chunk(at, part_of(from, at.offset, at.length + at.index_length));
  return to.copy_message(at.index_offsets.begin()->first, at.start_ns,
                         part_of(from, at.offset, at.length));
}

// Messages that stood outside of chunks are put into one.
Status add(const McapReader& from, std::size_t index, const McapChunk& chunk, McapWriter& to) {
  mcap::ChunkAt at = from.chunks()[index];
  if (at.bare) {
    std::vector<std::uint8_t> packed;
    Packer().pack(chunk.bytes, packed);
    at.compression = "zstd";
    return to.add_chunk(at, chunk.crc, packed, indexes_of(chunk));
  }
  const auto packed = from.read_packed(index);
  return packed ? to.add_chunk(at, chunk.crc, *packed, indexes_of(chunk)) : Status(packed.error());
}

}  // namespace

Status copy_beginning(const McapReader& from, McapWriter& to, std::string_view without) {
  for (const mcap::Schema& schema : from.schemas())
    if (Status added = to.add(schema); !added.ok()) return added;
  for (const mcap::Channel& channel : from.channels())
    if (Status added = to.add(channel); !added.ok()) return added;
  for (std::size_t i = 0; i < from.metadata().size(); ++i) {
    const std::string& name = from.metadata()[i].name;
    if (name == kSealName || (!without.empty() && name == without)) continue;
    if (const auto pairs = from.read_metadata(i))
      if (Status added = to.add_metadata(name, *pairs); !added.ok()) return added;
  }
  for (const mcap::RecordAt& at : from.unknown())
    if (Status added = to.copy_unknown(part_of(from, at.offset, at.length)); !added.ok())
      return added;
  for (std::size_t i = 0; i < from.attachments().size(); ++i) {
    const mcap::AttachmentAt& at = from.attachments()[i];
    if (!from.check_attachment(i).ok()) continue;
    if (Status added = to.copy_attachment(at, part_of(from, at.offset, at.length)); !added.ok())
      return added;
  }
  return fine();
}

Status copy_chunk(const McapReader& from, std::size_t index, McapWriter& to) {
  if (McapReader::opaque(from.chunks()[index])) return copy_opaque(from, from.chunks()[index], to);
  const auto chunk = from.read_chunk(index);
  return chunk ? add(from, index, *chunk, to) : fine();
}

}  // namespace burr::record

// The MCAP container: read by its summary and by a scan, and repaired. In most changed inputs the
// checksums (CRC) are corrected; otherwise the fuzzer would never get past them.
#include <cstring>
#include <vector>

#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/repair.h"
#include "support.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace burr;

template <class T>
T at(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Marks chunks and attachments as having no CRC, and gives the footer the right one.
void mend(std::uint8_t* data, std::size_t size) {
  using record::mcap::Kind;
  constexpr std::size_t kHead = record::mcap::kRecordHead;
  for (std::size_t start = 8; start + kHead <= size;) {
    const auto length = at<std::uint64_t>(data + start + 1);
    if (length > size - start - kHead) break;
    const auto kind = static_cast<Kind>(data[start]);
    if (kind == Kind::chunk && length >= 28) std::memset(data + start + kHead + 24, 0, 4);
    if (kind == Kind::attachment && length >= 4)
      std::memset(data + start + kHead + length - 4, 0, 4);
    start += kHead + static_cast<std::size_t>(length);
  }
  constexpr std::size_t kTail = record::mcap::kFooter + 8;
  if (size < kTail + 8) return;
  std::uint8_t* footer = data + size - kTail;
  const auto summary = at<std::uint64_t>(footer + kHead);
  if (summary > size - kTail) return;
  const std::uint32_t crc = record::crc32(
      record::crc32({data + summary, size - kTail - static_cast<std::size_t>(summary)}),
      {footer, record::mcap::kFooter - 4});
  std::memcpy(footer + record::mcap::kFooter - 4, &crc, sizeof crc);
}

void read_all(const std::string& path, record::McapReader::Trust trust) {
  const auto opened = record::McapReader::open(path, trust);
  fuzz::look_at_error(opened);
  if (!opened) return;
  const record::McapReader& file = **opened;
  fuzz::must(file.lost_bytes() <= file.size(), "no more is lost than there was");
  for (std::size_t i = 0; i < file.chunks().size(); ++i) {
    const auto chunk = file.read_chunk(i);
    fuzz::look_at_error(chunk);
    fuzz::look_at_error(file.read_packed(i));
    if (!chunk) continue;
    for (const auto& message : chunk->messages)
      fuzz::must(message.data.data() >= chunk->bytes.data() &&
                     message.data.data() + message.data.size() <=
                         chunk->bytes.data() + chunk->bytes.size(),
                 "a message lies in its chunk");
  }
  for (std::size_t i = 0; i < file.attachments().size(); ++i)
    fuzz::look_at_error(file.read_attachment(i));
  for (std::size_t i = 0; i < file.metadata().size(); ++i)
    fuzz::look_at_error(file.read_metadata(i));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  const std::size_t changed = LLVMFuzzerMutate(data, size, most);
  if (seed % 8 != 0) mend(data, changed);
  return changed;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& path = fuzz::as_file("a.mcap", {data, size});
  read_all(path, record::McapReader::Trust::summary);
  read_all(path, record::McapReader::Trust::nothing);

  NoProgress progress;
  const std::string mended = fuzz::folder() + "/mended.mcap";
  const auto report = record::repair(path, mended, progress);
  fuzz::look_at_error(report);
  if (!report || report->was_whole) return 0;
  const auto again = record::McapReader::open(mended);
  fuzz::must(again.ok() && (*again)->finished(), "what was repaired is whole");
  fuzz::must((*again)->chunks().size() == report->chunks, "with every chunk that was kept");
  for (std::size_t i = 0; i < (*again)->chunks().size(); ++i)
    fuzz::must((*again)->read_chunk(i).ok() || record::McapReader::opaque((*again)->chunks()[i]),
               "and all of them can be read");
  return 0;
}

// The bone inside a recording. The first byte chooses: the bytes as they are, or a line of JSON and
// blocks of bricks that are compressed and get their checksums (CRC) here.
#include "burr/record/bone_blob.h"

#include <algorithm>
#include <vector>

#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/packed.h"
#include "support.h"

namespace {

using namespace burr;

std::vector<std::uint8_t> blob_of(fuzz::Pieces& in) {
  record::BytesOut out;
  out.raw(record::as_bytes("BURRBON1"));
  const std::string_view head = in.line();
  out.text(head);
  out.put(record::crc32(record::as_bytes(head)));
  const bool with_intensity = head.find("\"has_intensity\":true") != std::string_view::npos;
  const std::size_t per_brick = 4 + std::size_t{512} * (with_intensity ? 5 : 3);
  static record::Packer packer(1);
  while (!in.empty()) {
    const std::size_t n = in.byte() % 8U;
    // brick numbers, and one byte of field and one of tissue for a whole brick
    record::BytesOut block;
    for (std::size_t i = 0; i < n; ++i) {
      const auto high = static_cast<std::int16_t>(in.word());
      block.put(high < 0 || high > 512 ? std::int32_t{high} * 4096 : std::int32_t{high});
    }
    while (block.size() < n * 4 + n * 1024) block.put(static_cast<std::uint16_t>(in.word()));
    const std::uint8_t tissue = in.byte();
    while (block.size() < n * per_brick) block.put(tissue);
    std::vector<std::uint8_t> packed;
    packer.pack(block.span(), packed);
    out.put(static_cast<std::uint32_t>(n));
    if (n == 0) break;
    out.put(std::uint64_t{packed.size()});
    out.raw(packed);
    out.put(record::crc32(block.span()));
  }
  out.put(std::uint32_t{0});
  out.raw(in.rest());
  return std::move(out.bytes());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Pieces in({data, size});
  const std::uint8_t choice = in.byte();
  std::vector<std::uint8_t> blob;
  if (choice % 4 == 0) {
    const fuzz::Bytes rest = in.rest();
    blob.assign(rest.begin(), rest.end());
  } else {
    blob = blob_of(in);
  }
  const std::size_t reserve = choice < 8 ? ~std::size_t{0} >> (choice * 8) : choice;
  const auto bone = record::bone_from_blob(blob, reserve, "a.mcap");
  fuzz::look_at_error(bone);
  if (!bone) return 0;
  fuzz::look_at((*bone)->tissues());
  // every brick can be reached, and is the same after writing and reading
  for (volume::BrickIndex b = 0; b < (*bone)->brick_count(); ++b)
    if ((*bone)->brick_field(b) != nullptr)
      fuzz::must((*bone)->brick_tissue(b) != nullptr, "a brick has both or none");
  const auto again = record::bone_from_blob(record::bone_to_blob(**bone), 0, "a.mcap");
  fuzz::must(again.ok() && (*again)->content_hash() == (*bone)->content_hash(),
             "a bone that was read can be written and is the same");
  return 0;
}

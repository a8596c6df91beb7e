// record/bricks.cpp - bricks of bone as messages of /bone/changes and /bone/keyframes. The part "bricks" of schema.h.
#include <cstring>

#include "burr/record/mcap/crc32.h"
#include "burr/record/protobuf.h"
#include "burr/record/schema.h"
#include "burr/record/schema_parts.h"

namespace burr::record {
namespace {

using protobuf::each_field;
using protobuf::FieldText;
using protobuf::put_block;
using protobuf::put_number;
using protobuf::Type;

constexpr std::uint32_t kBatch = 1, kPart = 2, kParts = 3, kTick = 4, kBrick = 5, kCrc = 6,
                        kField = 7, kHasTissue = 8, kTissue = 9;
const FieldText kBrickFields[] = {
    {kBatch, "batch", Type::number,
     "changes: number of this message, 1, 2, 3 ...; keyframe: the last batch it contains"},
    {kPart, "part", Type::number, "keyframe: number of this message, from 0"},
    {kParts, "parts", Type::number, "keyframe: how many messages it has"},
    {kTick, "tick", Type::u64, "per brick: its state after this tick"},
    {kBrick, "brick", Type::i32,
     "per brick: bi + nbi * (bj + nbj * bk), where nb = ceil(grid size / 8)"},
    {kCrc, "crc", Type::u32,
     "per brick: CRC-32 of its whole content after the change, field then tissue"},
    {kField, "field", Type::bytes,
     "per brick 512 little-endian uint16, x fastest: 0 air .. 32768 surface .. 65535 solid. "
     "In /bone/changes XORed with the same brick's field before (zeros the first time)"},
    {kHasTissue, "has_tissue", Type::flag, "per brick: its tissue was changed by deposit"},
    {kTissue, "tissue", Type::bytes,
     "per brick with has_tissue 512 uint8: index into the session's tissues; XORed likewise"},
};

template <class T>
ByteSpan bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
bool values_of(ByteSpan bytes, std::vector<T>& values) {
  if (bytes.size() % sizeof(T) != 0) return false;
  values.resize(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return true;
}

}  // namespace

std::string brick_schema() { return protobuf::descriptor("Bricks", kBrickFields); }

std::uint32_t BrickContent::crc() const {
  const std::uint32_t of_field =
      crc32({reinterpret_cast<const std::uint8_t*>(field.voxel), sizeof field.voxel});
  return has_tissue ? crc32(of_field, tissue) : of_field;
}

void apply_xor(BrickContent& to, const BrickContent& change) {
  for (std::size_t v = 0; v < std::size(to.field.voxel); ++v)
    to.field.voxel[v] = static_cast<volume::Field>(to.field.voxel[v] ^ change.field.voxel[v]);
  if (!change.has_tissue) return;
  to.has_tissue = true;
  for (std::size_t v = 0; v < to.tissue.size(); ++v)
    to.tissue[v] = static_cast<volume::TissueId>(to.tissue[v] ^ change.tissue[v]);
}

void encode_bricks(const Bricks& bricks, BytesOut& out) {
  put_number(out, kBatch, bricks.batch);
  put_number(out, kPart, bricks.part);
  put_number(out, kParts, bricks.parts);
  put_block(out, kTick, bytes_of(bricks.tick));
  put_block(out, kBrick, bytes_of(bricks.brick));
  put_block(out, kCrc, bytes_of(bricks.crc));
  BytesOut field, has_tissue, tissue;
  for (const BrickContent& content : bricks.content) {
    field.raw(content.field.voxel, sizeof content.field.voxel);
    has_tissue.put(static_cast<std::uint8_t>(content.has_tissue ? 1 : 0));
    if (content.has_tissue) tissue.raw(content.tissue);
  }
  put_block(out, kField, field.span());
  put_block(out, kHasTissue, has_tissue.span());
  put_block(out, kTissue, tissue.span());
}

bool decode_bricks(ByteSpan message, Bricks& bricks) {
  bricks = {};
  ByteSpan field, has_tissue, tissue;
  const bool whole =
      each_field(message, [&](std::uint64_t number, std::uint64_t value, ByteSpan block) {
        switch (number) {
          case kBatch:
            bricks.batch = value;
            return true;
          case kPart:
            bricks.part = static_cast<std::uint32_t>(value);
            return true;
          case kParts:
            bricks.parts = static_cast<std::uint32_t>(value);
            return true;
          case kTick:
            return values_of(block, bricks.tick);
          case kBrick:
            return values_of(block, bricks.brick);
          case kCrc:
            return values_of(block, bricks.crc);
          case kField:
            field = block;
            return true;
          case kHasTissue:
            has_tissue = block;
            return true;
          case kTissue:
            tissue = block;
            return true;
          default:
            return true;
        }
      });
  const std::size_t count = bricks.tick.size();
  if (!whole || bricks.brick.size() != count || bricks.crc.size() != count ||
      field.size() != count * sizeof(volume::BrickField::voxel) || has_tissue.size() != count)
    return false;
  bricks.content.resize(count);
  BytesIn fields(field), tissues(tissue);
  for (std::size_t i = 0; i < count; ++i) {
    BrickContent& content = bricks.content[i];
    const ByteSpan voxels = fields.take(sizeof content.field.voxel);
    std::memcpy(content.field.voxel, voxels.data(), voxels.size());
    content.has_tissue = has_tissue[i] != 0;
    if (!content.has_tissue) continue;
    const ByteSpan ids = tissues.take(content.tissue.size());
    if (!tissues.ok()) return false;
    std::memcpy(content.tissue.data(), ids.data(), ids.size());
  }
  return tissues.empty();
}

}  // namespace burr::record

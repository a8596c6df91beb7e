#include "burr/record/bone_blob.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/record/grid_json.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/packed.h"

namespace burr::record {
namespace {

using nlohmann::json;
using volume::BrickIndex;
using volume::kBrickVoxels;

constexpr std::string_view kMagic = "BURRBON1";
constexpr std::size_t kBricksPerBlock = 4096;
// a false header must not make us allocate gigabytes; deposits never need more
constexpr std::size_t kMostReserve = std::size_t{1} << 17;

std::size_t bytes_per_brick(bool with_intensity) {
  return sizeof(BrickIndex) +
         std::size_t{kBrickVoxels} * (2 + 1 + (with_intensity ? std::size_t{2} : std::size_t{0}));
}

struct Head {
  volume::Grid grid;
  volume::TissueTable tissues;
  bool with_intensity = false;
};

bool read_head(BytesIn& in, Head& head) {
  if (as_text(in.take(kMagic.size())) != kMagic) return false;
  const std::string_view text = in.text();
  if (in.get<std::uint32_t>() != crc32(as_bytes(text)) || !in.ok()) return false;
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object() || !object.contains("grid") || !object.contains("tissues") ||
      !object.contains("has_intensity") || !object["has_intensity"].is_boolean())
    return false;
  head.with_intensity = object["has_intensity"].get<bool>();
  return grid_from_json(object["grid"], head.grid) &&
         tissues_from_json(object["tissues"], head.tissues);
}

}  // namespace

std::vector<std::uint8_t> bone_to_blob(const volume::Bone& bone) {
  const json head = {{"grid", json_from_grid(bone.grid())},
                     {"tissues", json_from_tissues(bone.tissues())},
                     {"has_intensity", bone.has_intensity()}};
  const std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace);
  BytesOut out;
  out.raw(as_bytes(kMagic));
  out.text(text);
  out.put(crc32(as_bytes(text)));

  std::vector<BrickIndex> used;
  for (BrickIndex b = 0; b < bone.brick_count(); ++b)
    if (bone.brick_field(b) != nullptr) used.push_back(b);

  Packer packer(1);
  std::vector<std::uint8_t> packed;
  BytesOut block;
  for (std::size_t first = 0; first < used.size(); first += kBricksPerBlock) {
    const std::size_t n = std::min(kBricksPerBlock, used.size() - first);
    const std::span bricks(&used[first], n);
    block.clear();
    block.raw(bricks.data(), n * sizeof(BrickIndex));
    for (const BrickIndex b : bricks) block.raw(bone.brick_field(b), kBrickVoxels * 2);
    for (const BrickIndex b : bricks) block.raw(bone.brick_tissue(b), kBrickVoxels);
    if (bone.has_intensity())
      for (const BrickIndex b : bricks) block.raw(bone.brick_intensity(b), kBrickVoxels * 2);
    packed.clear();
    packer.pack(block.span(), packed);
    out.put(static_cast<std::uint32_t>(n));
    out.put(std::uint64_t{packed.size()});
    out.raw(packed);
    out.put(crc32(block.span()));
  }
  out.put(std::uint32_t{0});
  return std::move(out.bytes());
}

Result<std::unique_ptr<volume::Bone>> bone_from_blob(ByteSpan blob, std::size_t reserve_bricks,
                                                     const std::string& where) {
  const Error damaged =
      error(where + ": the bone inside the recording is damaged; give the scan with `volume`");
  BytesIn in(blob);
  Head head;
  if (!read_head(in, head)) return damaged;
  const std::size_t per_brick = bytes_per_brick(head.with_intensity);

  // first unpack every block once to check that all promised bricks are there, each once
  const math::Ijk edges = (head.grid.size.array() + volume::kBrickEdge - 1) / volume::kBrickEdge;
  BrickIndex last = volume::kNoBrick;
  std::size_t total = 0;
  std::vector<std::uint8_t> block;
  BytesIn look = in;
  for (;;) {
    const std::size_t n = look.get<std::uint32_t>();
    if (!look.ok() || n > kBricksPerBlock) return damaged;
    if (n == 0) break;
    const ByteSpan packed = look.take(look.get<std::uint64_t>());
    const auto crc = look.get<std::uint32_t>();
    if (!look.ok() || !unpack(packed, n * per_brick, block) || crc32(block) != crc) return damaged;
    for (std::size_t i = 0; i < n; ++i) {
      const BrickIndex before = last;
      std::memcpy(&last, block.data() + i * sizeof last, sizeof last);
      if (last <= before || last >= edges.prod()) return damaged;
    }
    total += n;
  }
  if (!look.empty()) return damaged;

  auto bone =
      std::make_unique<volume::Bone>(head.grid, std::move(head.tissues), total,
                                     std::min(reserve_bricks, kMostReserve), head.with_intensity);
  volume::BrickField field;
  for (;;) {
    const std::size_t n = in.get<std::uint32_t>();
    if (n == 0) {
      bone->pack();
      return bone;
    }
    static_cast<void>(unpack(in.take(in.get<std::uint64_t>()), n * per_brick, block));
    in.get<std::uint32_t>();
    const std::uint8_t* indexes = block.data();
    const std::uint8_t* fields = indexes + n * sizeof(BrickIndex);
    const std::uint8_t* tissues = fields + n * kBrickVoxels * 2;
    const std::uint8_t* intensities = tissues + n * kBrickVoxels;
    for (std::size_t i = 0; i < n; ++i) {
      BrickIndex brick = volume::kNoBrick;
      std::memcpy(&brick, indexes + i * sizeof brick, sizeof brick);
      std::memcpy(field.voxel, fields + i * kBrickVoxels * 2, sizeof field.voxel);
      bone->build_brick(brick, field.voxel, tissues + i * kBrickVoxels);
      if (head.with_intensity)
        std::memcpy(bone->build_intensity(brick), intensities + i * kBrickVoxels * 2,
                    kBrickVoxels * 2);
    }
  }
}

}  // namespace burr::record

// What the worker of the page "replay" calls (pages/replay/worker.js): a recording, at any moment. A module of its own, so that nobody
// who only mills waits for the reader of recordings.
//
//     core_open(file) -> [ core_patch() ]* -> core_soft()
//     then: core_seek(seconds), core_row(), [ core_patch() ]*           (core_patch() and its like: bone_api.cpp)
//
// One thread: each call belongs to it.
#include <emscripten.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bone_api.h"
#include "burr/record/bone_blob.h"
#include "burr/record/player.h"

namespace {

using namespace burr;

constexpr const char* kBoneBeside = "/burr.bone";

struct Replay : web::ShownBone {
  std::unique_ptr<record::Player> player;
  std::string why;  // it has failed
};
std::unique_ptr<Replay> core;

// The bone of a recording that does not hold it, from the file "/burr.bone" (record/bone_blob.h).
Result<std::unique_ptr<volume::Bone>> bone_beside(const record::SessionInfo& info) {
  std::ifstream in(kBoneBeside, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  auto bone = record::bone_from_blob(
      bytes, static_cast<std::size_t>(info.volume.recipe.reserve_bricks), kBoneBeside);
  if (bone && (*bone)->content_hash() != info.volume.content_hash)
    return error(Trouble::data, std::string(kBoneBeside) + ": is not the bone of this recording");
  return bone;
}

}  // namespace

extern "C" {

// Opens a recording of the module's file system that holds its bone, or has it beside it (kBoneBeside). 0: core_why() says
// why not.
EMSCRIPTEN_KEEPALIVE int core_open(const char* file) {
  core = std::make_unique<Replay>();
  web::shown = core.get();
  auto player = record::Player::open(file);
  if (!player) {
    core->why = player.error().text;
    return 0;
  }
  const record::SessionInfo& info = (*player)->info();
  auto bone = info.embedded || !std::filesystem::exists(kBoneBeside) ? (*player)->embedded_bone()
                                                                     : bone_beside(info);
  if (!bone) {
    core->why = bone.error().text;
    return 0;
  }
  core->player = std::move(*player);
  core->voxel_mm = 1e3 * (*bone)->grid().voxel;
  core->take(std::move(*bone));
  return 1;
}
EMSCRIPTEN_KEEPALIVE double core_seconds() { return core->player->seconds(); }
EMSCRIPTEN_KEEPALIVE double core_rate() { return core->player->info().rate_hz; }
// Bone and row as they were then. 0: core_why() says why not.
EMSCRIPTEN_KEEPALIVE int core_seek(double seconds) {
  Replay& c = *core;
  const Status there = c.player->bone_at(seconds, *c.bone);
  const auto row = c.player->tick_at(seconds);
  if (!there || !row) {
    c.why = !there ? there.error().text : row.error().text;
    return 0;
  }
  c.row = *row;
  return 1;
}
EMSCRIPTEN_KEEPALIVE const char* core_why() { return core->why.c_str(); }

}  // extern "C"

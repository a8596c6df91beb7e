// What the worker of the page "replay" calls (pages/replay/worker.js): a recording, at any moment. A module of its own, so that nobody
// who only mills waits for the reader of recordings.
//
//     core_open(file) -> [ core_patch() ]* -> core_soft()
//     then: core_seek(seconds), core_row(), [ core_patch() ]*           (core_patch() and its like: bone_api.cpp)
//           core_tool(), core_tool_part(), core_piece(), core_piece_skin()
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
#include "burr/workshop/out_piece.h"
#include "burr/workshop/tool_looks.h"

namespace {

using namespace burr;

constexpr const char* kBoneBeside = "/burr.bone";

struct Replay : web::ShownBone {
  std::unique_ptr<record::Player> player;
  std::unique_ptr<workshop::OutPieces> pieces;
  workshop::OutPiece piece;  // that is out of the bone now
  int piece_number = 0;      // another number: another shape; 0: none is out
  std::shared_ptr<const render::CoarseMesh> last_piece;
  std::shared_ptr<const render::ToolLook>
      look;  // of the tool that core_tool_part() was last asked for
  int look_number = -1;
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
  core->pieces = std::make_unique<workshop::OutPieces>(*core->player);
  core->voxel_mm = 1e3 * (*bone)->grid().voxel;
  core->take(std::move(*bone));
  return 1;
}
EMSCRIPTEN_KEEPALIVE double core_seconds() { return core->player->seconds(); }
EMSCRIPTEN_KEEPALIVE double core_rate() { return core->player->info().rate_hz; }
// The tool follows a mouse, which has no orientation.
EMSCRIPTEN_KEEPALIVE int core_mouse() {
  const auto device = core->player->info().words.find("device");
  return device != core->player->info().words.end() && device->second == "mouse" ? 1 : 0;
}
// Bone, row and piece as they were then. 0: core_why() says why not.
EMSCRIPTEN_KEEPALIVE int core_seek(double seconds) {
  Replay& c = *core;
  const Status there = c.player->bone_at(seconds, *c.bone);
  const auto row = c.player->tick_at(seconds);
  if (!there || !row) {
    c.why = !there ? there.error().text : row.error().text;
    return 0;
  }
  c.row = *row;
  auto piece = c.pieces->at(*row, seconds, *c.bone);
  if (!piece) {
    c.why = piece.error().text;
    return 0;
  }
  c.piece = std::move(*piece);
  if (c.piece.mesh != nullptr && c.piece.mesh != c.last_piece) {
    c.last_piece = c.piece.mesh;
    ++c.piece_number;
  }
  return 1;
}

// The tool of the rack that is in the hand: its number in the recording; -1: the round burr.
EMSCRIPTEN_KEEPALIVE int core_tool() {
  const int number = core->row.tool.number;
  return number < static_cast<int>(core->player->info().tools.size()) ? number : -1;
}
// Its surface, surface::Vertex: what cuts (part 0), what rubs (part 1).
EMSCRIPTEN_KEEPALIVE const web::Given* core_tool_part(int part) {
  Replay& c = *core;
  if (const int number = core_tool(); number != c.look_number || c.look == nullptr) {
    c.look = workshop::look_of(c.player->info().tools[static_cast<std::size_t>(number)].tool);
    c.look_number = number;
  }
  const surface::Mesh& mesh = part == 0 ? c.look->cuts : c.look->rubs;
  c.given = {part, mesh.vertices.data(), mesh.vertices.size(), mesh.triangles.data(),
             mesh.triangles.size()};
  return &c.given;
}

// The piece that is out of the bone: number of its shape (0: none is out), then how it was moved from where it came
// free: x, y, z [m], unit quaternion w, x, y, z.
EMSCRIPTEN_KEEPALIVE const double* core_piece() {
  static double out[8];
  const Replay& c = *core;
  const math::Pose& by = c.piece.by;
  out[0] = c.piece.mesh == nullptr ? 0 : c.piece_number;
  for (int n = 0; n < 3; ++n) out[1 + n] = by.p[n];
  out[4] = by.q.w();
  out[5] = by.q.x();
  out[6] = by.q.y();
  out[7] = by.q.z();
  return out;
}
// Its surface where it came free, render::SkinVertex.
EMSCRIPTEN_KEEPALIVE const web::Given* core_piece_skin() {
  const render::CoarseMesh& mesh = *core->piece.mesh;
  const auto& triangles = mesh.levels.front().indices;
  core->given = {core->piece_number, mesh.vertices.data(), mesh.vertices.size(), triangles.data(),
                 triangles.size()};
  return &core->given;
}
EMSCRIPTEN_KEEPALIVE const char* core_why() { return core->why.c_str(); }

}  // extern "C"

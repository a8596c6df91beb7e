// What the page's second worker calls to bring a session back (pages/mill/score_worker.js): what a recording says about its session,
// its bone, and its ticks one after the other, for core_redo() of the module that ticks.
//
//     redo_open(file), redo_about(), redo_bone()
//     then, again and again: redo_read(most), redo_ticks(), redo_commands()
//
// One thread. What a call gives lies in the module's memory until the next call of the same function.
#include <emscripten.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "burr/record/bone_blob.h"
#include "burr/record/player.h"
#include "page_hand.h"

namespace {

using namespace burr;
using nlohmann::ordered_json;

struct Redo {
  std::unique_ptr<record::Player> player;
  std::unique_ptr<record::StepCursor> steps;
  std::vector<std::uint8_t> bone;
  std::vector<web::RedoTick> ticks;
  std::vector<web::RedoCommand> commands;
};
std::unique_ptr<Redo> redo;
std::string trouble, answer;

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* redo_why() { return trouble.c_str(); }

// A recording of the module's file system; it may be cut off. 0: redo_why() says why not.
EMSCRIPTEN_KEEPALIVE int redo_open(const char* file) {
  redo = std::make_unique<Redo>();
  auto player = record::Player::open(file);
  if (!player) {
    trouble = player.error().text;
    redo.reset();
    return 0;
  }
  redo->player = std::move(*player);
  redo->steps = std::make_unique<record::StepCursor>(redo->player->steps());
  return 1;
}
EMSCRIPTEN_KEEPALIVE void redo_close() { redo.reset(); }

// {ticks, mode, case, course: [{tick, kind, what, where, value}], same_build}
EMSCRIPTEN_KEEPALIVE const char* redo_about() {
  const record::Player& player = *redo->player;
  const record::SessionInfo& info = player.info();
  ordered_json out = {{"ticks", player.end_tick()},
                      {"mode", info.identity ? record::word_of(info.identity->mode) : "free"},
                      {"case", info.work_case ? info.work_case->name : ""}};
  out["course"] = ordered_json::array();
  for (const record::CourseEvent& one : player.course())
    out["course"].push_back({{"tick", one.tick},
                             {"kind", record::word_of(one.kind)},
                             {"what", one.what},
                             {"where", one.where},
                             {"value", one.value}});
  answer = out.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return answer.c_str();
}

// The bone at its start, as core_take() takes it. nullptr: redo_why() says why there is none.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* redo_bone() {
  const auto bone = redo->player->embedded_bone();
  if (!bone) {
    trouble = bone.error().text;
    return nullptr;
  }
  redo->bone = record::bone_to_blob(**bone);
  return redo->bone.data();
}
EMSCRIPTEN_KEEPALIVE int redo_bone_size() { return static_cast<int>(redo->bone.size()); }

// Reads on; how many ticks there were, `most` at most. What follows a gap cannot be done again, so it is the end.
EMSCRIPTEN_KEEPALIVE int redo_read(int most) {
  redo->ticks.clear();
  redo->commands.clear();
  record::Step step;
  while (static_cast<int>(redo->ticks.size()) < most && redo->steps->next(step)) {
    if (step.gap) break;
    redo->ticks.push_back({step.row.tick, step.row.hash, step.row.hand});
    for (const tick::Command& one : step.commands)
      redo->commands.push_back({step.row.tick, static_cast<std::int32_t>(one.kind), one.value});
  }
  return static_cast<int>(redo->ticks.size());
}
EMSCRIPTEN_KEEPALIVE const web::RedoTick* redo_ticks() { return redo->ticks.data(); }
EMSCRIPTEN_KEEPALIVE int redo_tick_size() { return sizeof(web::RedoTick); }
EMSCRIPTEN_KEEPALIVE const web::RedoCommand* redo_commands() { return redo->commands.data(); }
EMSCRIPTEN_KEEPALIVE int redo_command_count() { return static_cast<int>(redo->commands.size()); }
EMSCRIPTEN_KEEPALIVE int redo_command_size() { return sizeof(web::RedoCommand); }

}  // extern "C"

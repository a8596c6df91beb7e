// What the worker of the page calls (pages/mill/worker.js): the bone, its surface, and the tick.
//
//     core_make(voxel_mm) -> [ core_patch() ]* -> core_soft() -> core_begin()
//     then, each beat: core_aim(), core_step(ticks), core_row(), [ core_patch() ]*
//
// One thread: each call belongs to it. What a call gives lies in the module's memory until the next
// call of the same function. Structs go to the page as the bytes that they are; the page runs the
// same module.
#include <emscripten.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/hash.h"
#include "burr/base/progress.h"
#include "burr/math/rotation.h"
#include "burr/phantom/build.h"
#include "burr/record/bone_blob.h"
#include "burr/record/player.h"
#include "burr/render/soft_scene.h"
#include "burr/surface/mesher.h"
#include "burr/tick/servo.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"
#include "page_recorder.h"
#include "window/hands/mouse_hand.h"
#include "work_of_page.h"

namespace {

using namespace burr;
using math::Vec3;

constexpr std::size_t kReserveBricks = 2048;
constexpr const char* kBoneBeside = "/burr.bone";
constexpr double kRpm = 80000;  // cases/temporal_bone.toml

// A piece of surface for the page.
struct Given {
  int number = -1;  // of the patch; of a soft structure: its tissue
  const void* vertices = nullptr;
  std::size_t vertex_count = 0;
  const std::uint32_t* triangles = nullptr;
  std::size_t index_count = 0;
};

struct Core {
  std::unique_ptr<volume::Bone> bone;
  std::unique_ptr<volume::IsoVertices> surface;
  std::unique_ptr<app::MouseHand> hand;
  std::unique_ptr<tick::Servo> servo;
  tick::TickRow row;
  double voxel_mm = 0;
  std::unique_ptr<record::Player> player;       // of a recording that is watched
  std::unique_ptr<web::PageRecorder> recorder;  // nullptr: it has failed, or is finished
  int undrained = 0;                            // ticks
  std::string why;                              // it has failed

  std::unique_ptr<surface::Mesher> mesher;
  rt::ChangedBits* changed = nullptr;
  rt::ChangedBits* changed_for_steps = nullptr;
  std::vector<web::ChangedBrick> bricks;  // that have changed, for the steps
  std::deque<int> due;                    // patches to mesh, oldest request first
  std::vector<bool> queued;
  std::vector<std::uint64_t>
      given_hashes;  // of each patch's surface as the page has it; 0: it has none
  std::vector<int> named;
  surface::Patch patch;
  render::Scene soft;  // its soft structures only
  std::size_t soft_given = 0;
  Given given;

  void want(int number) {
    if (queued[static_cast<std::size_t>(number)]) return;
    queued[static_cast<std::size_t>(number)] = true;
    due.push_back(number);
  }
};

std::unique_ptr<Core> core;
web::PageTask task;  // of the sessions that begin from now on

// As Session::make caps them (sim/session.cpp).
tick::ServoSettings settings_for(const device::DeviceSpec& spec) {
  tick::ServoSettings settings;
  settings.rate_hz = web::kRate;
  settings.burr.radius = web::kBurrRadius;
  settings.spindle_rad_s = kRpm * 2 * std::numbers::pi / 60;
  settings.force.stiffness = tick::coupling_of(spec, settings).stiffness;
  settings.force.damping = std::min(settings.force.damping, spec.max_damping);
  return settings;
}

std::uint64_t hash_of(const surface::Patch& patch) {
  if (patch.triangles.empty()) return 0;
  std::uint64_t hash = patch.vertices.size();
  const auto add = [&hash](const void* from, std::size_t bytes) {
    const auto* at = static_cast<const std::uint8_t*>(from);
    for (std::size_t n = 0; n < bytes; n += 4) {  // both are made of words of 4 bytes
      std::uint32_t word = 0;
      std::memcpy(&word, at + n, 4);
      hash = base::mix(hash, std::uint64_t{word});
    }
  };
  add(patch.vertices.data(), patch.vertices.size() * sizeof patch.vertices[0]);
  add(patch.triangles.data(), patch.triangles.size() * sizeof patch.triangles[0]);
  return hash;
}

// All patches, those around the work first.
void want_all(Core& c) {
  const math::Ijk along = c.mesher->patches();
  const volume::Grid& grid = c.bone->grid();
  std::vector<std::pair<double, int>> order;
  for (int n = 0; n < c.mesher->patch_count(); ++n) {
    const math::Ijk at(n % along.x(), n / along.x() % along.y(), n / along.x() / along.y());
    const Vec3 middle =
        grid.frame.p + grid.frame.q * Vec3(grid.voxel * surface::kPatchEdge *
                                           (at.cast<double>().array() + 0.5).matrix());
    order.emplace_back((middle - web::work_at()).norm(), n);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [far, n] : order) c.want(n);
}

void take_bone(Core& c, std::unique_ptr<volume::Bone> bone) {
  c.bone = std::move(bone);
  c.changed = &c.bone->add_watcher();
  c.mesher = std::make_unique<surface::Mesher>(*c.bone);
  c.queued.resize(static_cast<std::size_t>(c.mesher->patch_count()));
  c.given_hashes.resize(c.queued.size());
  want_all(c);
}

void drain(Core& c) {
  c.undrained = 0;
  const Status drained = c.recorder->drain();
  if (drained) return;
  c.why = drained.error().text;
  c.servo->set_recorder_rings({});
  c.recorder.reset();
}

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

// Makes the bone by its formula. 0: there is not enough memory.
EMSCRIPTEN_KEEPALIVE int core_make(double voxel_mm) {
  core = std::make_unique<Core>();
  core->voxel_mm = voxel_mm;
  const double voxel = 1e-3 * voxel_mm;
  const phantom::Phantom made = web::phantom_of_page(voxel);
  NoProgress quiet;
  auto bone = phantom::bone_from_formula(phantom::box_grid(made.lo, made.hi, voxel), made.tissues,
                                         made.formula, kReserveBricks, 1, quiet);
  if (!bone) return 0;
  take_bone(*core, std::move(*bone));
  core->changed_for_steps = &core->bone->add_watcher();
  return 1;
}

// What the sessions that begin from now on are for: the case (its text, and what web/case.py has read of
// it), the hash of its rubric in hexadecimal, the mode. Then core_spare() and core_target() for each.
EMSCRIPTEN_KEEPALIVE void core_task(const char* text, const char* rubric_hash, const char* mode) {
  task = {};
  task.work_case.name = web::kCase;
  task.work_case.text = text;
  task.rubric_hash = std::strtoull(rubric_hash, nullptr, 16);
  task.mode = record::mode_of(mode).value_or(record::Mode::free);
}
EMSCRIPTEN_KEEPALIVE void core_spare(const char* tissue) {
  task.work_case.spare.emplace_back(tissue);
}
EMSCRIPTEN_KEEPALIVE void core_target(const char* tissue, const char* goal, double share) {
  scenario::Target target{tissue, scenario::Goal::open, share};
  for (const scenario::Goal one : {scenario::Goal::expose, scenario::Goal::remove})
    if (std::string_view(goal) == scenario::word_of(one)) target.goal = one;
  task.work_case.targets.push_back(std::move(target));
}

// Meshes the next patch that is due. nullptr: none is. A patch without triangles had some before; number -1: the
// page has this patch already.
EMSCRIPTEN_KEEPALIVE const Given* core_patch() {
  Core& c = *core;
  c.changed->take_all([&](std::size_t brick) {
    c.named.clear();
    c.mesher->patches_of_brick(static_cast<volume::BrickIndex>(brick), c.named);
    for (const int patch : c.named) c.want(patch);
  });
  if (c.due.empty()) return nullptr;
  const int number = c.due.front();
  c.due.pop_front();
  c.queued[static_cast<std::size_t>(number)] = false;
  while (!c.mesher->mesh_patch(number, c.patch)) {  // nobody writes: it succeeds at once
  }
  // A changed brick names its neighbours too, whose surface is often the same: not worth a part of the picture.
  const std::uint64_t hash = hash_of(c.patch);
  const bool same = std::exchange(c.given_hashes[static_cast<std::size_t>(number)], hash) == hash;
  if (same) {
    c.given = {};
    return &c.given;
  }
  c.given = {number, c.patch.vertices.data(), c.patch.vertices.size(), c.patch.triangles.data(),
             c.patch.triangles.size()};
  return &c.given;
}
EMSCRIPTEN_KEEPALIVE int core_patches_due() { return static_cast<int>(core->due.size()); }

// The soft structures; their vertices are render::SkinVertex. nullptr: that was all.
EMSCRIPTEN_KEEPALIVE const Given* core_soft() {
  Core& c = *core;
  if (c.soft.materials.empty()) {
    NoProgress quiet;
    static_cast<void>(render::add_soft(c.soft, *c.bone, quiet));
  }
  if (c.soft_given == c.soft.soft.size()) return nullptr;
  const render::SoftStructure& one = c.soft.soft[c.soft_given++];
  const auto& triangles = one.mesh->levels.front().indices;
  c.given = {one.tissue, one.mesh->vertices.data(), one.mesh->vertices.size(), triangles.data(),
             triangles.size()};
  return &c.given;
}

// Makes the surface that is felt, and the hand 20 mm above the work: ticks may begin.
EMSCRIPTEN_KEEPALIVE void core_begin() {
  Core& c = *core;
  NoProgress quiet;
  c.surface = std::make_unique<volume::IsoVertices>(*c.bone, volume::IsoSettings{}, 1, quiet);
  math::Pose above;
  above.p = web::work_at() - 20e-3 * web::work_into();
  above.q = math::shortest_rotation(Vec3::UnitZ(), -web::work_into());
  c.hand = std::make_unique<app::MouseHand>(above);
  const tick::ServoSettings settings = settings_for(c.hand->spec());
  c.servo = std::make_unique<tick::Servo>(*c.bone, *c.surface, *c.hand, settings);
  auto recorder = web::PageRecorder::begin(*c.bone, settings, c.hand->spec(), c.voxel_mm, task);
  if (!recorder) {
    c.why = recorder.error().text;
    return;
  }
  c.recorder = std::move(*recorder);
  c.servo->set_recorder_rings(c.recorder->rings());
}

// Something beside the ticks, after the last one: kind is a word of record/course.h.
EMSCRIPTEN_KEEPALIVE void core_note(const char* kind, const char* what, const char* value) {
  using record::CourseKind;
  if (core->recorder == nullptr) return;
  for (int n = 0; n <= static_cast<int>(CourseKind::ended); ++n)
    if (const auto one = static_cast<CourseKind>(n); std::string_view(kind) == record::word_of(one))
      core->recorder->note({core->row.tick, one, what, {}, value});
}

// Completes the recording: the file PageRecorder::kFile. declared: the user says that the work is done. 0: core_why() says
// why there is none; it is empty when the recording was completed before.
EMSCRIPTEN_KEEPALIVE int core_finish_recording(int declared) {
  Core& c = *core;
  if (c.recorder == nullptr) return 0;
  using record::Ending;
  if (declared != 0) core_note(record::word_of(record::CourseKind::done), "", "");
  core_note(record::word_of(record::CourseKind::ended), "",
            record::word_of(declared != 0 ? Ending::declared_done : Ending::broke_off));
  const Status done = c.recorder->finish([&c] {
    if (c.servo->bricks_to_write() == 0) return false;
    c.servo->flush_bricks();
    return true;
  });
  c.servo->set_recorder_rings({});
  c.recorder.reset();
  if (!done) c.why = done.error().text;
  return done ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* core_why() { return core->why.c_str(); }

// Where the hand shall be: the bytes of a MouseHand::Aim are written here, then core_aimed() is called.
EMSCRIPTEN_KEEPALIVE void* core_aim() {
  static app::MouseHand::Aim aim;
  return &aim;
}
EMSCRIPTEN_KEEPALIVE void core_aimed() {
  core->hand->aim(*static_cast<app::MouseHand::Aim*>(core_aim()));
}

EMSCRIPTEN_KEEPALIVE void core_step(int ticks) {
  Core& c = *core;
  for (int n = 0; n < ticks; ++n) {
    c.row = c.servo->tick(false);
    c.servo->publish();
    if (c.recorder != nullptr && ++c.undrained >= web::PageRecorder::kDue) drain(c);
  }
  c.bone->commit_ahead();
  c.surface->commit_ahead();
  c.servo->commit_ahead();
}
// The row of the last tick, tick::TickRow.
EMSCRIPTEN_KEEPALIVE const void* core_row() { return &core->row; }
EMSCRIPTEN_KEEPALIVE int core_row_size() { return sizeof(tick::TickRow); }

// The bricks that have changed since the last call: web::ChangedBrick. Their number: core_changed_count().
EMSCRIPTEN_KEEPALIVE const void* core_changed() {
  Core& c = *core;
  c.bricks.clear();
  c.changed_for_steps->take_all([&c](std::size_t n) {
    web::ChangedBrick& one = c.bricks.emplace_back();
    one.brick = static_cast<std::int32_t>(n);
    volume::BrickField field;
    while (!c.bone->copy_brick(one.brick, field)) {  // nobody writes: it succeeds at once
    }
    std::copy(std::begin(field.voxel), std::end(field.voxel), one.field);
  });
  return c.bricks.data();
}
EMSCRIPTEN_KEEPALIVE int core_changed_count() { return static_cast<int>(core->bricks.size()); }

// kind: tick::CommandKind.
EMSCRIPTEN_KEEPALIVE void core_command(int kind, double value) {
  static_cast<void>(
      core->servo->commands().push({static_cast<tick::CommandKind>(kind), value, {}}));
}

// ---- a recording is watched: core_open() instead of core_make() and core_begin(), then core_seek()

// Opens a recording of the module's file system that holds its bone, or has it beside it (kBoneBeside). 0: core_why() says
// why not.
EMSCRIPTEN_KEEPALIVE int core_open(const char* file) {
  core = std::make_unique<Core>();
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
  take_bone(*core, std::move(*bone));
  return 1;
}
EMSCRIPTEN_KEEPALIVE double core_seconds() { return core->player->seconds(); }
EMSCRIPTEN_KEEPALIVE double core_rate() { return core->player->info().rate_hz; }
EMSCRIPTEN_KEEPALIVE double core_voxel_mm() { return core->voxel_mm; }
// Bone and row as they were then. 0: core_why() says why not.
EMSCRIPTEN_KEEPALIVE int core_seek(double seconds) {
  Core& c = *core;
  const Status there = c.player->bone_at(seconds, *c.bone);
  const auto row = c.player->tick_at(seconds);
  if (!there || !row) {
    c.why = !there ? there.error().text : row.error().text;
    return 0;
  }
  c.row = *row;
  return 1;
}
// Of a tissue of the bone: its kind (volume::TissueKind), colour, and how much it bleeds. nullptr: there is
// no tissue of this number. Its name: core_tissue_name().
EMSCRIPTEN_KEEPALIVE const double* core_tissue(int number) {
  static double told[5];
  const auto& tissues = core->bone->tissues().tissues;
  if (static_cast<std::size_t>(number) >= tissues.size()) return nullptr;
  const volume::Tissue& tissue = tissues[static_cast<std::size_t>(number)];
  told[0] = static_cast<double>(tissue.kind);
  std::copy(tissue.colour.begin(), tissue.colour.end(), told + 1);
  told[4] = tissue.bleeds;
  return told;
}
EMSCRIPTEN_KEEPALIVE const char* core_tissue_name(int number) {
  return core->bone->tissues().tissues[static_cast<std::size_t>(number)].name.c_str();
}

// "tick hash, hash of the bone", in hexadecimal
EMSCRIPTEN_KEEPALIVE const char* core_hashes() {
  static char text[40];
  std::snprintf(text, sizeof text, "%016llx %016llx",
                static_cast<unsigned long long>(core->row.hash),
                static_cast<unsigned long long>(core->bone->content_hash()));
  return text;
}

}  // extern "C"

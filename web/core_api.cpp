// What the worker of the page calls (pages/mill/worker.js): the bone, its surface, and the tick.
//
//     core_make(voxel_mm) -> [ core_patch() ]* -> core_soft() -> core_begin()
//     then, each beat: core_aim(), core_step(ticks), core_row(), [ core_patch() ]*
//     a session that comes back: core_begin(), [ core_redo() ]*, core_redone(), and then as above
//
// One thread: each call belongs to it. What a call gives lies in the module's memory until the next
// call of the same function. Structs go to the page as the bytes that they are; the page runs the
// same module.
#include <emscripten.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bone_api.h"
#include "burr/base/progress.h"
#include "burr/math/aabb.h"
#include "burr/math/rotation.h"
#include "burr/phantom/build.h"
#include "burr/record/bone_blob.h"
#include "burr/rt/flags.h"
#include "burr/tick/servo.h"
#include "burr/tool/burr_tool.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"
#include "page_hand.h"
#include "page_recorder.h"
#include "work_of_page.h"

namespace {

using namespace burr;
using math::Vec3;

constexpr std::size_t kReserveBricks = 2048;

struct Core : web::ShownBone {
  std::unique_ptr<volume::IsoVertices> surface;
  std::unique_ptr<web::PageHand> hand;
  std::unique_ptr<tick::Servo> servo;
  bool own = false;                             // bone of the user's own scan
  std::unique_ptr<web::PageRecorder> recorder;  // nullptr: it has failed, or is finished
  int undrained = 0;                            // ticks
  std::string why;                              // it has failed

  rt::ChangedBits* changed_for_steps = nullptr;
  std::vector<web::ChangedBrick> bricks;  // that have changed, for the steps
};

std::unique_ptr<Core> core;
web::PageTask task;  // of the sessions that begin from now on
tool::Burr first_burr;
double first_rpm = web::kRpm;

void begin_core() {
  core = std::make_unique<Core>();
  web::shown = core.get();
}

// As Session::make caps them (sim/session.cpp).
tick::ServoSettings settings_for(const device::DeviceSpec& spec) {
  tick::ServoSettings settings;
  settings.rate_hz = web::kRate;
  settings.burr = first_burr;
  settings.spindle_rad_s = first_rpm * 2 * std::numbers::pi / 60;
  settings.force.stiffness = tick::coupling_of(spec, settings).stiffness;
  settings.force.damping = std::min(settings.force.damping, spec.max_damping);
  return settings;
}

// 20 mm over the highest face of the bone's grid, the shaft upwards.
math::Pose above_all(const volume::Bone& bone) {
  const volume::Grid& grid = bone.grid();
  math::Aabb box;
  for (int corner = 0; corner < 8; ++corner) {
    const math::Ijk at((corner & 1) != 0 ? grid.size.x() : 0, (corner & 2) != 0 ? grid.size.y() : 0,
                       (corner & 4) != 0 ? grid.size.z() : 0);
    box.extend(grid.frame.p + grid.frame.q * Vec3(grid.voxel * at.cast<double>()));
  }
  math::Pose above;
  above.p = box.centre();
  above.p.z() = box.hi.z() + 20e-3;
  return above;
}

void drain(Core& c) {
  c.undrained = 0;
  const Status drained = c.recorder->drain();
  if (drained) return;
  c.why = drained.error().text;
  c.servo->set_recorder_rings({});
  c.recorder.reset();
}

}  // namespace

extern "C" {

// Makes the bone by its formula. 0: there is not enough memory.
EMSCRIPTEN_KEEPALIVE int core_make(double voxel_mm) {
  begin_core();
  core->voxel_mm = voxel_mm;
  const double voxel = 1e-3 * voxel_mm;
  const phantom::Phantom made = web::phantom_of_page(voxel);
  NoProgress quiet;
  auto bone = phantom::bone_from_formula(phantom::box_grid(made.lo, made.hi, voxel), made.tissues,
                                         made.formula, kReserveBricks, 1, quiet);
  if (!bone) return 0;
  core->take(std::move(*bone));
  core->changed_for_steps = &core->bone->add_watcher();
  return 1;
}

// Another bone: the bytes that record::bone_to_blob() made. own: not 0: of the user's own scan (web/import), else of a
// case (web/score). 0: core_why() says why not.
EMSCRIPTEN_KEEPALIVE int core_take(const std::uint8_t* bytes, int size, int own) {
  begin_core();
  auto bone =
      record::bone_from_blob({bytes, static_cast<std::size_t>(size)}, kReserveBricks, "bone");
  if (!bone) {
    core->why = bone.error().text;
    return 0;
  }
  core->own = own != 0;
  core->voxel_mm = 1e3 * (*bone)->grid().voxel;
  core->take(std::move(*bone));
  core->changed_for_steps = &core->bone->add_watcher();
  return 1;
}

// The burr that the sessions begin with from now on: its radius [m], diamond or not, its speed [rpm].
EMSCRIPTEN_KEEPALIVE void core_burr(double radius, int diamond, double rpm) {
  first_burr = {};
  first_burr.radius = radius;
  first_burr.kind = diamond != 0 ? tool::BurrKind::diamond : tool::BurrKind::cutting;
  first_rpm = rpm;
}
// What they are for: the case (its name, its text, and what web/case.py has read of it), the hash of its rubric in hexadecimal, the
// mode, its bone ("phantom:..."). Then core_spare() and core_target() for each.
EMSCRIPTEN_KEEPALIVE void core_task(const char* name, const char* text, const char* rubric_hash,
                                    const char* mode, const char* phantom) {
  task = {};
  task.phantom = phantom;
  task.work_case.name = name;
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

// Makes the surface that is felt, and the hand 20 mm above the work: ticks may begin.
EMSCRIPTEN_KEEPALIVE void core_begin() {
  Core& c = *core;
  NoProgress quiet;
  c.surface = std::make_unique<volume::IsoVertices>(*c.bone, volume::IsoSettings{}, 1, quiet);
  math::Pose above;
  above.p = web::work_at() - 20e-3 * web::work_into();
  above.q = math::shortest_rotation(Vec3::UnitZ(), -web::work_into());
  if (c.own) above = above_all(*c.bone);
  c.hand = std::make_unique<web::PageHand>(above);
  tick::ServoSettings settings = settings_for(c.hand->spec());
  // the servo takes no burr of less than four voxels
  settings.burr.radius = std::max(settings.burr.radius, 2 * c.bone->grid().voxel);
  c.servo = std::make_unique<tick::Servo>(*c.bone, *c.surface, *c.hand, settings);
  // a scan of the user's has no case
  auto recorder = web::PageRecorder::begin(*c.bone, settings, c.hand->spec(),
                                           c.own ? 0 : c.voxel_mm, c.own ? web::PageTask{} : task);
  if (!recorder) {
    c.why = recorder.error().text;
    return;
  }
  c.recorder = std::move(*recorder);
  c.servo->set_recorder_rings(c.recorder->rings());
}

// Something beside the ticks, after the last one: kind is a word of record/course.h.
EMSCRIPTEN_KEEPALIVE void core_note(const char* kind, const char* what, const char* where,
                                    const char* value) {
  using record::CourseKind;
  if (core->recorder == nullptr) return;
  for (int n = 0; n <= static_cast<int>(CourseKind::ended); ++n)
    if (const auto one = static_cast<CourseKind>(n); std::string_view(kind) == record::word_of(one))
      core->recorder->note({core->row.tick, one, what, where, value});
}

// Completes the recording: the file PageRecorder::kFile. declared: the user says that the work is done. 0: core_why() says
// why there is none; it is empty when the recording was completed before.
EMSCRIPTEN_KEEPALIVE int core_finish_recording(int declared) {
  Core& c = *core;
  if (c.recorder == nullptr) return 0;
  using record::Ending;
  if (declared != 0) core_note(record::word_of(record::CourseKind::done), "", "", "");
  core_note(record::word_of(record::CourseKind::ended), "", "",
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
// A complete file of everything so far, PageRecorder::kCopy, while the recording goes on. 0: core_why() says why there is none.
EMSCRIPTEN_KEEPALIVE int core_copy_recording() {
  Core& c = *core;
  if (c.recorder == nullptr) return 0;
  c.undrained = 0;
  const Status done = c.recorder->copy();
  if (!done) c.why = done.error().text;
  return done ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* core_why() { return core->why.c_str(); }

// Ticks of a recording once more, with the commands that were taken at their starts. How many gave what they gave then; fewer
// than `count`: the next one did not, and is part of the session all the same.
EMSCRIPTEN_KEEPALIVE int core_redo(const web::RedoTick* ticks, int count,
                                   const web::RedoCommand* commands, int command_count) {
  constexpr int kCommitEvery = 50;
  Core& c = *core;
  int next = 0;
  for (int n = 0; n < count; ++n) {
    for (; next < command_count && commands[next].tick <= ticks[n].tick; ++next)
      static_cast<void>(c.servo->commands().push(
          {static_cast<tick::CommandKind>(commands[next].kind), commands[next].value, {}}));
    c.hand->repeat(ticks[n].hand);
    c.row = c.servo->tick(false);
    c.servo->publish();
    if (c.recorder != nullptr && ++c.undrained >= web::PageRecorder::kDue) drain(c);
    if (n % kCommitEvery == 0 || n + 1 == count) {
      c.bone->commit_ahead();
      c.surface->commit_ahead();
      c.servo->commit_ahead();
    }
    if (c.row.tick != ticks[n].tick || c.row.hash != ticks[n].hash) return n;
  }
  return count;
}
// The hand is the mouse's again. It hovers where the burr is.
EMSCRIPTEN_KEEPALIVE void core_redone() {
  mouse::MouseHand::Aim aim;
  aim.world_from_tool = {core->row.contact.proxy, core->row.hand.world_from_tool.q};
  aim.hovers = true;
  core->hand->aim(aim);
}
// The number of the last tick.
EMSCRIPTEN_KEEPALIVE double core_tick() { return static_cast<double>(core->row.tick); }
// Bone that is gone now [mm^3].
EMSCRIPTEN_KEEPALIVE double core_removed() {
  return 1e9 * (core->row.ledger.removed - core->row.ledger.undone);
}
// Whether bone is being put back.
EMSCRIPTEN_KEEPALIVE int core_restoring() {
  return (core->row.contact.flags & rt::kFlagRestoring) != 0 ? 1 : 0;
}

// Where the hand shall be: the bytes of a MouseHand::Aim are written here, then core_aimed() is called.
EMSCRIPTEN_KEEPALIVE void* core_aim() {
  static mouse::MouseHand::Aim aim;
  return &aim;
}
EMSCRIPTEN_KEEPALIVE void core_aimed() {
  core->hand->aim(*static_cast<mouse::MouseHand::Aim*>(core_aim()));
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

}  // extern "C"

#include "commands/run_headless.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "burr/record/diary.h"
#include "burr/render/bone_scene.h"
#include "burr/render/picture.h"
#include "burr/render/renderer.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/rows.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/seen.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/tool_looks.h"
#include "burr/workshop/work_view.h"
#include "commands/summary.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/recorded_session.h"
#include "shared/subcommand.h"
#include "shared/work.h"

namespace burr::app {
namespace {

using run_folder::kHeight;
using run_folder::kWidth;

// The bone and the tool at half time, kept while the session goes on: a session that stops and goes on
// again lets its forces rise anew, and would give another hash than the same motion elsewhere.
struct HalfTime {
  std::unique_ptr<volume::Bone> bone;
  tick::TickRow row;
  void wait_in(sim::Session& session, double seconds) {
    const auto ticks =
        static_cast<std::uint64_t>(std::llround(0.5 * seconds * session.settings().servo.rate_hz));
    if (ticks == 0) return;
    session.set_between_ticks(
        [this, &session, ticks] {
          if (session.ticks() != ticks) return;
          static_cast<void>(session.view(row));
          bone = volume::copy_of(session.bone());
        },
        ticks);
  }
};

void put_tool_of(render::Scene& scene, const sim::Session& session, const tick::TickRow& row) {
  workshop::put_tool(scene, row, true);
  workshop::ToolLooks(session.settings().servo.tools).put(scene, row.tool.number);
}

// What the pictures show. Nobody is there whom help could be shown.
record::Sight sight_of(const render::Scene& scene) {
  record::Sight sight;
  sight.view = workshop::view_of(scene.camera, 0);
  sight.view.slices = sight.view.panels = false;
  return sight;
}

}  // namespace

Status run_headless(const RunOptions& options) {
  const std::filesystem::path folder = options.out.empty() ? "burr-out" : options.out;
  WorkOptions requested = options.work;
  const double seconds = requested.seconds > 0 ? requested.seconds : kHeadlessSeconds;
  Status made = make_run_folder(folder);
  if (made) made = check_run_folder(options, folder);
  if (!made) return made;
  if (requested.work_case) fmt::print(stderr, "{}", scenario::task_text(*requested.work_case));
  auto opened = open_work(requested, progress());
  if (!opened) return opened.error();
  workshop::PreparedBone& work = *opened;
  print_notices(work.summary.notices);
  const auto chosen = settings_of(requested, false);
  if (!chosen) return chosen.error();
  const sim::SessionSettings& settings = *chosen;
  auto path = surgeon::motion(requested.motion, work.place, settings.servo.burr.radius, seconds);
  if (!path) return path.error();
  auto started =
      workshop::begin_by_itself(std::move(work.bone), std::move(*path), settings, progress());
  if (!started) return started.error();
  sim::Session& session = **started;

  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  render::Scene scene = workshop::scene_of_work(session.bone(), settings.servo.burr.radius,
                                                work.place.at, -work.place.into);
  const auto picture = [&](const char* name, const volume::Bone& bone) -> Status {
    const Status skinned = render::skin_bone(scene, bone, settings.threads, progress());
    if (!skinned) return skinned;
    const auto image = (*renderer)->image(scene, kWidth, kHeight);
    if (!image) return image.error();
    return render::write_png(*image, folder / name);
  };
  const auto stopped = [] {
    return interrupted() ? Status(error(Trouble::interrupted, "stopped")) : fine();
  };

  Status status = picture("before.png", session.bone());
  if (!status) return status;
  Recording recording;
  recording.remember_scan_in(users_scan_list());
  recording.belongs_to(requested.identity);
  status = recording.start(
      session, (folder / "session.mcap").string(), work.recipe, work.summary, requested.motion,
      false, workshop::to_spare(session.bone_tissues(), requested.spare), requested.work_case);
  if (!status) return status;
  if (recording.diary() != nullptr) recording.diary()->look(sight_of(scene));
  HalfTime half;
  half.wait_in(session, seconds);
  session.run(seconds, progress());
  status = stopped();
  if (status && half.bone) {
    put_tool_of(scene, session, half.row);
    status = picture("working.png", *half.bone);
  }
  scene.burr.visible = false;
  scene.markers.clear();
  scene.rods.clear();
  const Status recorded = recording.finish(session);
  if (!status) return status;
  Summary summary = summary_of_run(session, work.what, "simulated hand, " + requested.motion);
  if (requested.work_case) summary.task = scenario::task_text(*requested.work_case);
  if (!recorded) fmt::print("{}", summary_text(summary));  // the page may not fit on the disk
  status = picture("after.png", session.bone());
  if (!status) return recorded ? status : recorded;

  summary.pictures = {
      {"before.png", "before"}, {"working.png", "at half time"}, {"after.png", "after"}};
  if (recorded) summary.recording = "session.mcap";
  status = write_summary(summary, folder);
  if (!recorded) return recorded;
  if (!status) return status;
  fmt::print("{}{}: before.png working.png after.png session.mcap summary.html\n",
             summary_text(summary), folder.string());
  return fine();
}

}  // namespace burr::app

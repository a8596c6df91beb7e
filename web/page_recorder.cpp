#include "page_recorder.h"

#include "burr/record/identity.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/render/scene.h"
#include "burr/scenario/case.h"
#include "burr/sim/session_words.h"
#include "burr/workshop/spared.h"
#include "work_of_page.h"

namespace burr::web {

Result<std::unique_ptr<PageRecorder>> PageRecorder::begin(const volume::Bone& bone,
                                                          const tick::ServoSettings& settings,
                                                          const device::DeviceSpec& device,
                                                          double voxel_mm, const PageTask& task,
                                                          const char* file) {
  // what workshop::record() writes of a session on the desktop
  sim::SessionSettings session;
  session.servo = settings;
  record::SessionInfo info;
  sim::describe(session, device, info);
  info.words["motion"] = task.motion;
  info.identity.emplace();
  if (!task.work_case.name.empty()) {
    info.work_case = task.work_case;
    info.work_case->text_hash = scenario::text_hash(task.work_case.text);
    info.identity->case_hash = info.work_case->text_hash;
  }
  info.identity->mode = task.mode;
  info.identity->rubric_hash = task.rubric_hash;
  info.identity->labels_hash = record::labels_hash(bone);
  workshop::write_spared(workshop::to_spare(bone.tissues(), task.work_case.spare), info);
  const render::Burr drawn;
  info.shaft = record::Shaft{drawn.shaft_radius, drawn.shaft_length};
  info.volume.content_hash = bone.content_hash();
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.has_intensity = bone.has_intensity();
  if (voxel_mm > 0) {  // of a scan nothing goes into the file but the bone itself
    info.volume.format = "formula";
    info.volume.recipe.source = task.phantom;
    info.volume.recipe.voxel_mm = voxel_mm;
  }
  info.volume.recipe.reserve_bricks = bone.free_slots();
  info = record::Pen::completed(info, settings.rate_hz, true);
  if (Status good = record::check(info); !good.ok()) return good.error();

  std::unique_ptr<PageRecorder> recorder(new PageRecorder());
  auto writer = std::make_unique<record::McapWriter>();
  if (Status opened = writer->open(file, file); !opened.ok()) return opened.error();
  auto pen = record::Pen::begin(
      writer, info, &bone, {recorder->ticks_, recorder->commands_, recorder->bricks_, nullptr});
  if (!pen) return pen.error();
  recorder->pen_ = std::move(*pen);
  return recorder;
}

}  // namespace burr::web

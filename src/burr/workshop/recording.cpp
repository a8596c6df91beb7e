#include "burr/workshop/recording.h"

#include <utility>

#include "burr/device/device.h"
#include "burr/record/find_volume.h"
#include "burr/record/identity.h"
#include "burr/record/scan_list.h"
#include "burr/render/scene.h"
#include "burr/sim/session_words.h"
#include "burr/tick/second_hand.h"

namespace burr::workshop {
namespace {

constexpr std::size_t kBrickRows = 8192;  // changed bricks that may wait for the disk

}  // namespace

About about(const PreparedBone& prepared, const volume::Bone& bone, const std::string& motion) {
  About out;
  out.recipe = prepared.recipe;
  out.format = prepared.summary.format;
  out.motion = motion;
  out.work_case = prepared.work_case;
  if (out.work_case) out.spared = to_spare(bone.tissues(), out.work_case->spare);
  return out;
}

Result<std::unique_ptr<record::Recorder>> record(sim::Session& session, const std::string& file,
                                                 const About& about,
                                                 std::function<void(const Error&)> on_trouble) {
  record::SessionInfo info;
  sim::describe(session.settings(), session.hand().spec(), info);
  tick::SecondHand* second = session.second_hand();
  if (second != nullptr) sim::describe(second->settings(), session.second_device().spec(), info);
  info.words["motion"] = about.motion;
  if (about.spared) write_spared(*about.spared, info);
  if (about.work_case) info.work_case = record::case_info(*about.work_case);
  const volume::Bone& bone = session.bone();
  info.identity = about.identity;
  info.identity->case_hash = info.work_case ? info.work_case->text_hash : 0;
  info.identity->labels_hash = record::labels_hash(bone);
  const render::Burr drawn;  // the session feels no shaft; this one is in the pictures
  info.shaft = record::Shaft{drawn.shaft_radius, drawn.shaft_length};
  info.volume.content_hash = bone.content_hash();
  if (!scenario::is_phantom(about.recipe.source)) {
    auto print = record::fingerprint(about.recipe.source);
    if (print) info.volume.source_fingerprint = *print;
  }
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.has_intensity = bone.has_intensity();
  info.volume.format = about.format;
  info.volume.recipe = scenario::without_paths(about.recipe);
  auto recorder = std::make_unique<record::Recorder>(
      info.rate_hz, kBrickRows, session.settings().realtime, second != nullptr);
  recorder->set_sealer(about.sealer);
  const Status started = recorder->start(file, info, about.embed ? &bone : nullptr,
                                         std::move(on_trouble), about.earlier.get());
  if (!started) return started.error();
  session.set_recorder(recorder.get());
  // a list that cannot be written harms nobody: the scan is then found as without a list
  static_cast<void>(record::remember_scan(
      about.scan_list,
      {info.volume.source_fingerprint, info.volume.content_hash, about.recipe.source}));
  return recorder;
}

}  // namespace burr::workshop

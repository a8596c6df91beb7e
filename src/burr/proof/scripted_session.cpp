#include "burr/proof/scripted_session.h"

#include <memory>
#include <optional>
#include <utility>

#include "burr/device/hand_path.h"
#include "burr/proof/assistant.h"
#include "burr/record/diary.h"
#include "burr/surgeon/surgeon.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recording.h"

namespace burr::proof {
namespace {

constexpr double kAside = 0.05;  // from the bone to a hand that rests [m]

// Records until the session ends.
Status run_recorded(sim::Session& session, const workshop::About& about, const ScriptedSession& how,
                    surgeon::Surgeon* surgeon, const std::string& file, Progress& progress) {
  auto recorder = workshop::record(session, file, about);
  if (!recorder) return recorder.error();
  record::Diary diary(**recorder, session.settings().servo.rate_hz);
  std::optional<Assistant> assistant;
  if (surgeon != nullptr) {
    assistant.emplace(*surgeon, session, &diary);
    session.set_between_ticks([&assistant] { assistant->work(); }, surgeon::kConsultTicks);
  }
  session.run(how.seconds, progress);
  session.set_recorder(nullptr);
  const std::uint64_t ticks = session.outcome().ticks, last = ticks > 0 ? ticks - 1 : 0;
  if (how.leaves && !diary.declared_done()) diary.declare_done(last, true);
  diary.end(last, record::Ending::time_up);
  const auto written = (*recorder)->finish();
  if (!written) return written.error();
  if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
  return fine();
}

device::HandPath resting(const math::Vec3& at, double seconds) {
  device::HandPath path;
  device::PathPoint point;
  point.world_from_tool.p = at;
  point.pedal = 0;
  path.points.push_back(point);
  point.t = seconds;
  path.points.push_back(point);
  return path;
}

}  // namespace

Status record_scripted(const scenario::Case& work, const scenario::BoneRecipe& recipe,
                       const ScriptedSession& how, const std::string& file, Progress& progress) {
  const auto lesson = workshop::placed_lesson(work);
  if (!lesson) return lesson.error();
  auto prepared = workshop::prepare(work, progress, {}, recipe);
  if (!prepared) return prepared.error();
  const sim::SessionSettings settings = workshop::settings_of(*prepared);
  workshop::About about = workshop::about(*prepared, *prepared->bone, "scripted surgeon");
  about.embed = true;
  if (!how.skill) {
    const math::Vec3 aside = prepared->place.at - kAside * prepared->place.into;
    auto begun = workshop::begin_by_itself(std::move(prepared->bone), resting(aside, how.seconds),
                                           settings, progress);
    if (!begun) return begun.error();
    return run_recorded(**begun, about, how, nullptr, file, progress);
  }
  auto surgeon =
      surgeon::Surgeon::make(*prepared->bone, *lesson, prepared->burr, prepared->place.at,
                             *how.skill, how.seed, settings.servo.rate_hz, progress);
  if (!surgeon) return surgeon.error();
  auto begun = workshop::begin(*prepared, (*surgeon)->take_hand(), settings, progress);
  if (!begun) return begun.error();
  return run_recorded(**begun, about, how, surgeon->get(), file, progress);
}

}  // namespace burr::proof

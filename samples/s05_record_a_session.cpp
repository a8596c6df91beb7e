// s05_record_a_session - a session with a recorder: every tick, every command and every changed
// brick goes into session.mcap, and the bone as it was before the first tick.
//
// The bone: a plate of hard bone, 0.5 mm thick, over soft bone, and a nerve 2.5 mm below the surface.
// s06_read_a_recording and s07_score_a_recording read the file.
#include <burr/base/progress.h>
#include <burr/device/simulated_hand.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>
#include <burr/record/player.h>
#include <burr/record/recorder.h>
#include <burr/sim/session.h>
#include <burr/sim/session_words.h>

#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

namespace {

using namespace burr;

std::unique_ptr<volume::Bone> make_bone() {
  using enum volume::TissueKind;
  const volume::TissueTable tissues{{{.name = "air", .kind = air},
                                     {.name = "hard bone", .kind = solid, .cutting_energy = 1.4e9},
                                     {.name = "soft bone", .kind = solid, .cutting_energy = 0.8e9},
                                     {.name = "nerve", .kind = soft, .spare = true}}};
  // along y, 2.5 mm below the surface z = 0; its canal is no bone
  const auto nerve = phantom::capsule({0, -20e-3, -3.5e-3}, {0, 20e-3, -3.5e-3}, 1e-3);
  phantom::Formula formula;
  formula.depth = phantom::without(phantom::slab(), nerve);
  formula.soft = nerve;
  formula.tissue = [nerve](const math::Vec3& p, double) -> volume::TissueId {
    return nerve(p) > 0 ? 3 : p.z() > -0.5e-3 ? 1 : 2;
  };
  NoProgress quiet;
  auto bone =
      phantom::bone_from_formula(phantom::cube_grid(24e-3, 60), tissues, formula, 64, 2, quiet);
  return bone ? std::move(*bone) : nullptr;
}

int trouble(const Error& error) {
  std::printf("%s\n", error.text.c_str());
  return 1;
}

}  // namespace

int main() {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 2e-3;
  // pressed down beside the nerve, then pulled across it
  const math::Quat leaning(Eigen::AngleAxisd(std::numbers::pi / 3, math::Vec3::UnitX()));
  const auto at = [&](double x, double z) { return math::Pose{.p = {x, 0, z}, .q = leaning}; };
  device::HandPath path{{{0, at(-2e-3, 5e-3), 1},
                         {1, at(-2e-3, 2e-3), 1},
                         {4, at(-2e-3, -2e-3), 1},
                         {6, at(2e-3, -2e-3), 1}}};
  NoProgress quiet;
  auto session = sim::Session::make(
      make_bone(), std::make_unique<device::SimulatedHand>(std::move(path), device::ArmSettings{}),
      settings, quiet);
  if (!session) return trouble(session.error());

  // what a reader must know before the first tick: settings, device, bone
  record::SessionInfo info;
  sim::describe((*session)->settings(), (*session)->hand().spec(), info);
  info.volume = record::volume_info((*session)->bone());
  record::Recorder recorder(info.rate_hz);
  if (const Status started = recorder.start("session.mcap", info, &(*session)->bone()); !started)
    return trouble(started.error());

  (*session)->set_recorder(&recorder);
  (*session)->run(6.0, quiet);
  (*session)->set_recorder(nullptr);
  const auto written = recorder.finish();
  if (!written) return trouble(written.error());

  const auto player = record::Player::open("session.mcap");
  if (!player) return trouble(player.error());
  std::printf("session.mcap: %.1f s, %.0f kB, %.2f mm3 removed\n", (*player)->seconds(),
              static_cast<double>(written->bytes) / 1e3,
              (*session)->outcome().ledger.removed * 1e9);
  return written->whole() && (*player)->end_tick() == (*session)->outcome().ticks ? 0 : 1;
}

#include "workshop/work.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <system_error>
#include <utility>

#include "burr/math/turn.h"
#include "burr/workshop/prepare.h"
#include "workshop/live_surface.h"

namespace burr::app {
namespace {

using math::Vec3;

// how much of the surroundings is seen: the pocket large, the anatomy around it still there
double view_height(double burr_radius) { return std::clamp(20 * burr_radius, 20e-3, 70e-3); }

bool names_a_case(const std::string& path) {
  const auto known = scenario::built_in_cases();
  const bool built_in = std::find(known.begin(), known.end(), path) != known.end();
  std::error_code nobody_asks;
  return (built_in && !std::filesystem::exists(path, nobody_asks)) ||
         std::filesystem::path(path).extension() == ".toml";
}

// a phantom's bare name; a file of that name comes first
bool bare_name(const std::string& path) {
  std::error_code nobody_asks;
  return !scenario::is_phantom(path) && path.find_first_of("./") == std::string::npos &&
         !std::filesystem::exists(path, nobody_asks);
}

}  // namespace

bool names_a_scan(const WorkOptions& options) {
  const std::string& path = options.volume.source;
  return !path.empty() && !names_a_case(path) && !scenario::is_phantom(path) && !bare_name(path);
}

Status take_case(WorkOptions& options) {
  scenario::Recipe& volume = options.volume;
  if (volume.source.empty()) volume.source = "temporal-bone";
  if (names_a_case(volume.source)) {
    const auto read = scenario::read_case(volume.source);
    if (!read) return read.error();
    take_case(options, *read);
  }
  if (options.burr_mm == 0) options.burr_mm = 5;
  if (options.rpm == 0) options.rpm = 40'000;
  return fine();
}

void take_case(WorkOptions& options, const scenario::Case& work) {
  scenario::Recipe& volume = options.volume;
  volume = workshop::recipe_of(work, volume);
  if (options.burr_mm == 0) options.burr_mm = 2e3 * work.burr.radius;
  if (options.rpm == 0) options.rpm = work.full_speed * 60 / (2 * std::numbers::pi);
  if (options.seconds == 0) options.seconds = work.seconds;
  options.title = work.title;
  options.at = work.at;
  options.into = work.into;
  options.motion = work.motion;
  options.kind = work.burr.kind;
  options.spare = work.spare;
  options.work_case = work;
}

Result<Work> open_work(WorkOptions options, Progress& progress, const io::Scan* scan) {
  scenario::Recipe& volume = options.volume;
  if (bare_name(volume.source)) volume.source = scenario::phantom_source(volume.source);
  const workshop::Tool tool{options.burr_mm, options.rpm, options.kind};
  auto prepared =
      options.work_case
          ? workshop::prepare(*options.work_case, progress, tool, volume, scan, options.keep_greys)
          : workshop::prepare(volume, progress, tool, scan, options.keep_greys);
  if (!prepared) return prepared.error();
  Work work;
  work.made = {std::move(prepared->bone), std::move(prepared->summary), std::move(prepared->greys)};
  work.volume = std::move(prepared->recipe);
  work.what = std::move(prepared->what);
  work.place = prepared->place;
  return work;
}

sim::SessionSettings settings_of(const WorkOptions& options, bool realtime) {
  sim::SessionSettings settings;
  settings.servo.burr.radius = 0.5e-3 * options.burr_mm;
  settings.servo.burr.kind = options.kind;
  settings.servo.spindle_rad_s = options.rpm * 2 * std::numbers::pi / 60;
  settings.realtime = realtime;
  return settings;
}

void fit_burr(WorkOptions& options, importing::Imported& made) {
  std::vector<std::string> told, &notices = made.summary.notices;
  workshop::fit_burr(options.burr_mm, made.bone->grid().voxel, told);
  for (std::string& one : told)  // open_work() may have told it already
    if (std::find(notices.begin(), notices.end(), one) == notices.end())
      notices.push_back(std::move(one));
}

math::Quat view_of_hand(const render::Camera& camera) {
  math::Mat3 axes;
  axes << camera.right(), camera.above(), camera.backward();
  return math::Quat(axes).normalized();
}

Result<Ready> make_ready(WorkOptions options, Work work, Progress& progress) {
  fit_burr(options, work.made);
  sim::SessionSettings settings = settings_of(options, true);
  // the hand begins two centimetres above the work
  math::Pose above;
  above.p = work.place.at - 20e-3 * work.place.into;
  above.q = math::shortest_turn(Vec3::UnitZ(), -work.place.into);
  Ready ready;
  ready.scene.camera = render::view_of_work(work.place.at, -work.place.into,
                                            2 * view_height(settings.servo.burr.radius));
  std::unique_ptr<device::Device> hand;
  if (options.hand.device.empty()) {
    auto mouse = std::make_unique<MouseHand>(above);
    ready.hands.mouse = mouse.get();
    hand = std::move(mouse);
  } else {
    auto laid = lay_hand(options.hand, above, view_of_hand(ready.scene.camera));
    if (!laid) return laid.error();
    settings.servo.rate_hz = tick_rate(laid->hand->spec());
    settings.servo.limit.user_force = laid->max_force;
    settings.servo.vibration_gain = laid->vibration;
    settings.servo.torque_gain = laid->torque;
    for (const std::string& notice : laid->notices) work.made.summary.notices.push_back(notice);
    ready.hands.real = laid->hand.get();
    ready.hands.max_force = laid->max_force;
    ready.hands.id = laid->id;
    ready.hands.preferences = laid->preferences;
    hand = std::move(laid->hand);
  }
  ready.title = options.title.empty() ? work.what : options.title;
  ready.what = work.what;
  ready.work_case = options.work_case;
  ready.volume = work.volume;
  ready.import = work.made.summary;
  ready.greys = std::move(work.made.greys);
  auto started = sim::Session::make(std::move(work.made.bone), std::move(hand), settings, progress);
  if (!started) return started.error();
  ready.session = std::move(*started);
  if (!options.suction.empty()) {
    // beside the burr, on the side of the other hand
    const math::Quat view = view_of_hand(ready.scene.camera);
    auto suction = SuctionHand::join(*ready.session, options.suction,
                                     {above.p - view * Vec3(15e-3, 0, 0), above.q}, view);
    if (!suction) return suction.error();
    ready.suction = std::move(*suction);
    ready.hands.suction = ready.suction.get();
  }
  if (!options.told_as.empty()) {
    auto arm = device::crtk::Arm::open({.name = options.told_as, .middle = above.p});
    if (!arm) return arm.error();
    ready.arm = std::move(*arm);
    ready.teller = std::make_unique<ArmPublisher>(*ready.session, *ready.arm);
  }
  volume::Bone& bone = ready.session->bone();
  ready.spared = to_spare(bone.tissues(), options.spare);
  auto spared_distance = SparedDistance::make(bone, ready.spared, progress);
  if (!spared_distance) return spared_distance.error();
  ready.spared_distance = std::make_unique<const SparedDistance>(std::move(*spared_distance));
  ready.scene.tissue_colours = render::colours_of(bone.tissues());
  ready.worker = std::make_unique<surface::Worker>(bone, 1);
  const Status status = ready.worker->first(
      progress, [&ready](const surface::Skin& skin) { put_skin(ready.scene, skin); });
  if (!status) return status.error();
  return ready;
}

}  // namespace burr::app

#include "shared/window_session.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "burr/math/rotation.h"
#include "burr/render/soft_scene.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/step_done.h"
#include "burr/workshop/hand_device.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"

namespace burr::app {
namespace {

using math::Vec3;

// height of the view: the pocket is large, and the anatomy around it is still visible
double view_height(double burr_radius) { return std::clamp(20 * burr_radius, 20e-3, 70e-3); }

// What the case teaches; nothing without a case.
Result<std::optional<scenario::CaseLesson>> lesson_of(const std::optional<scenario::Case>& work) {
  if (!work) return std::optional<scenario::CaseLesson>();
  auto read = scenario::lesson_of(*work);
  if (!read) return read.error();
  auto placed =
      scenario::place(std::move(*read), workshop::landmarks_of(*work), work->name + ".toml");
  if (!placed) return placed.error();
  if (const Status fits = scoring::check_done(*placed, work->name + ".toml"); !fits)
    return fits.error();
  return std::optional<scenario::CaseLesson>(std::move(*placed));
}

}  // namespace

math::Quat view_of_hand(const render::Camera& camera) {
  math::Mat3 axes;
  axes << camera.right(), camera.above(), camera.backward();
  return math::Quat(axes).normalized();
}

Result<WindowSession> make_window_session(const WorkOptions& options,
                                          workshop::PreparedBone prepared, Progress& progress) {
  WorkOptions with_burr = options;
  with_burr.tool = {};
  auto chosen = settings_of(with_burr, true);
  if (!chosen) return chosen.error();
  sim::SessionSettings& settings = *chosen;
  auto rack = offer_rack(options.tool, prepared.bone->grid().voxel, settings.servo);
  if (!rack) return rack.error();
  // the hand starts 20 mm above the work
  math::Pose above;
  above.p = prepared.place.at - 20e-3 * prepared.place.into;
  above.q = math::shortest_rotation(Vec3::UnitZ(), -prepared.place.into);
  WindowSession ready;
  ready.rack = std::move(*rack);
  ready.scene.camera = render::view_of_work(prepared.place.at, -prepared.place.into,
                                            2 * view_height(settings.servo.burr.radius));
  std::unique_ptr<device::Device> hand;
  if (options.hand.device.empty()) {
    auto mouse = std::make_unique<mouse::MouseHand>(above);
    ready.hands.mouse = mouse.get();
    hand = std::move(mouse);
  } else {
    auto laid = workshop::open_hand(options.hand, above, view_of_hand(ready.scene.camera));
    if (!laid) return laid.error();
    settings.servo.rate_hz = workshop::tick_rate(laid->hand->spec());
    settings.servo.limit.user_force = laid->max_force;
    settings.servo.vibration_gain = laid->vibration;
    settings.servo.torque_gain = laid->torque;
    for (const std::string& notice : laid->notices) prepared.summary.notices.push_back(notice);
    ready.hands.real = laid->hand.get();
    ready.hands.max_force = laid->max_force;
    ready.hands.id = laid->id;
    ready.hands.preferences = laid->preferences;
    hand = std::move(laid->hand);
  }
  ready.title = options.title.empty() ? prepared.what : options.title;
  ready.what = prepared.what;
  ready.earlier = options.earlier;
  ready.identity = options.identity;
  ready.work_case = options.work_case;
  auto lesson = lesson_of(options.work_case);
  if (!lesson) return lesson.error();
  ready.lesson = std::move(*lesson);
  const scenario::Feedback feedback = ready.lesson ? ready.lesson->feedback : scenario::Feedback();
  ready.mode = options.identity.mode;
  ready.allowed =
      workshop::allowed_in(ready.mode, feedback, workshop::guided_in(options.identity, feedback));
  ready.volume = prepared.recipe;
  ready.import = prepared.summary;
  ready.greys = std::move(prepared.greys);
  auto started = workshop::begin(prepared, std::move(hand), settings, progress);
  if (!started) return started.error();
  ready.session = std::move(*started);
  if (!options.suction.empty()) {
    // the suction tube starts beside the burr, on the side of the other hand
    const math::Quat view = view_of_hand(ready.scene.camera);
    auto tool = second_tool(options.tool);
    if (!tool) return tool.error();
    auto suction = workshop::SuctionHand::add(*ready.session, options.suction,
                                              {above.p - view * Vec3(15e-3, 0, 0), above.q}, view,
                                              std::move(*tool));
    if (!suction) return suction.error();
    ready.suction = std::move(*suction);
    ready.hands.suction = ready.suction.get();
  }
  if (!options.publish_as.empty()) {
    auto arm = device::crtk::Arm::open({.name = options.publish_as, .middle = above.p});
    if (!arm) return arm.error();
    fmt::print(stderr, "{} is on DDS domain {}, for programs on {}.\n", options.publish_as,
               (*arm)->domain(),
               (*arm)->on_network()
                   ? "every computer of this network"
                   : "this computer alone (ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET: on others "
                     "too)");
    ready.arm = std::move(*arm);
    ready.teller = std::make_unique<workshop::ArmPublisher>(*ready.session, *ready.arm);
  }
  volume::Bone& bone = ready.session->bone();
  ready.spared = workshop::to_spare(bone.tissues(), options.spare);
  auto spared_distance = workshop::SparedDistance::make(bone, ready.spared, progress);
  if (!spared_distance) return spared_distance.error();
  ready.spared_distance =
      std::make_unique<const workshop::SparedDistance>(std::move(*spared_distance));
  ready.scene.tissue_colours = render::colours_of(bone.tissues());
  if (const Status soft = render::add_soft(ready.scene, bone, progress); !soft) return soft.error();
  ready.worker = std::make_unique<surface::Worker>(bone, 1);
  const Status status = ready.worker->first(
      progress, [&ready](const surface::Skin& skin) { workshop::put_skin(ready.scene, skin); });
  if (!status) return status.error();
  return ready;
}

}  // namespace burr::app

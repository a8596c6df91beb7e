// burr arm - burr as a robot arm on the bus of ROS 2 (CRTK): other programs drive it into a bone,
// get the bone's force, watch and record.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "burr/device/crtk/arm.h"
#include "burr/math/rotation.h"
#include "burr/workshop/arm_publisher.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/recorded_session.h"
#include "shared/setting_options.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "shared/work.h"

namespace burr::app {
namespace {

struct Options {
  WorkOptions work;
  device::crtk::ArmSettings arm;
  std::string record;
  double seconds = 0;
  bool json = false, force = false;
};

constexpr double kForGood = 1e9;  // [s]
constexpr double kAbove = 20e-3;  // start height above the work [m]

Status run(const Options& options) {
  WorkOptions requested = options.work;
  const Status possible = check_outputs({requested.volume.source},
                                        {{"--record", options.record, {".mcap"}}}, options.force);
  if (!possible) return possible;
  if (const Status taken = take_case(requested); !taken) return taken;
  auto work = open_work(requested, progress());
  if (!work) return work.error();
  print_notices(work->summary.notices);
  const auto chosen = settings_of(requested, true);
  if (!chosen) return chosen.error();
  const sim::SessionSettings& settings = *chosen;
  math::Pose start;
  start.p = work->place.at - kAbove * work->place.into;
  start.q = math::shortest_rotation(math::Vec3::UnitZ(), -work->place.into);

  device::crtk::ArmSettings named = options.arm;
  named.middle = start.p;
  auto arm = device::crtk::Arm::open(named);
  if (!arm) return arm.error();
  auto driven = std::make_unique<device::crtk::DrivenHand>(**arm, start);
  device::crtk::DrivenHand& hand = *driven;
  auto made = workshop::begin(*work, std::move(driven), settings, progress());
  if (!made) return made.error();
  sim::Session& session = **made;
  Recording recording;
  if (!options.record.empty()) {
    recording.remember_scan_in(users_scan_list());
    const Status started = recording.start(
        session, options.record, work->recipe, work->summary, "CRTK " + named.name, false,
        workshop::to_spare(session.bone_tissues(), requested.spare), requested.work_case);
    if (!started) return started;
  }
  fmt::print(stderr,
             "{0} is on DDS domain {1} (ROS_DOMAIN_ID), for programs on {5}. Move it with "
             "{0}/servo_cp or move_cp [m, "
             "LPS]; the spindle is {0}/spindle (Joy, axis 0). It starts at {2:.4f} {3:.4f} "
             "{4:.4f}. Ctrl-C ends it.\n",
             named.name, (*arm)->domain(), start.p.x(), start.p.y(), start.p.z(),
             (*arm)->on_network() ? "every computer of this network"
                                  : "this computer alone (--network: on others too)");
  {
    const workshop::ArmPublisher teller(session, **arm, [&hand] { return hand.busy(); });
    session.run(options.seconds > 0 ? options.seconds : kForGood, progress());
  }
  const Status recorded =
      options.record.empty()
          ? fine()
          : recording.finish(session,
                             options.seconds > 0 && interrupted());  // Ctrl-C is its usual end
  const sim::Outcome outcome = session.outcome();
  if (options.json)
    fmt::print("{}\n",
               json_line(nlohmann::json({{"finished", options.seconds <= 0 || !interrupted()},
                                         {"ticks", outcome.ticks},
                                         {"seconds", outcome.seconds},
                                         {"missed", outcome.timing.missed},
                                         {"removed_mm3", 1e9 * outcome.ledger.removed},
                                         {"peak_force_N", outcome.peak_force},
                                         {"left_aside", (*arm)->ignored_goals()}})));
  else
    fmt::print("{:.1f} s: removed {:.3f} mm3, peak force {:.2f} N; {} goals or commands ignored\n",
               outcome.seconds, 1e9 * outcome.ledger.removed, outcome.peak_force,
               (*arm)->ignored_goals());
  return recorded;
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  options->seconds = 0;
  auto* command = app.add_subcommand("arm",
                                     "act as a CRTK robot arm that other programs move and watch "
                                     "(ROS 2 names; ROS itself is not needed)");
  command->add_option("volume", options->work.volume.source,
                      "a case or a scan (default: temporal-bone)");
  command->add_option("--name", options->arm.name, "name of the arm, in ROS form")
      ->capture_default_str();
  command
      ->add_option("--domain", options->arm.domain,
                   "DDS domain (default: ROS_DOMAIN_ID, otherwise 0)")
      ->check(CLI::Range(0, 232));
  command->add_flag("--network", options->arm.network,
                    "programs on other computers may drive and watch it too: DDS has no password");
  command
      ->add_option("--seconds", options->seconds,
                   "end after this many seconds (default: at Ctrl-C)")
      ->check(CLI::Range(0.1, 1e6));
  command->add_option("--record", options->record, "F.mcap: record the session");
  add_force(*command, options->force);
  add_setting_option(*command, "burr_mm", options->work.burr_mm,
                     "diameter of the burr (default: that of the case, otherwise 5)");
  add_setting_option(*command, "rpm", options->work.rpm,
                     "speed of the spindle (default: that of the case, otherwise 40000)");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  add_volume_options(*command, options->work.volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{86, add};

}  // namespace
}  // namespace burr::app

// Makes bones and mills them, and prints a number for each: the hash of the last tick, which stands
// for all of them, and of the bone that is left. Built by every compiler and every kind of build;
// scripts/checks/same_bits.py lets them say their numbers and compares.
//
//     same_bits [--threads N] [--realtime] [--only NAME]     (BURR_SIMD=scalar|avx2|avx512)
//
// A line: NAME TICKS BONE [lost]. `lost`: in real time the machine stood still for so long that the
// watchdog let go of the hand, or was so busy that something was put off; both are inputs like any
// other, and no longer the same session; the recording of it was then simulated again without a
// clock, and came out the same.
#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/hash.h"
#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/importing/import.h"
#include "burr/phantom/build.h"
#include "burr/phantom/phantoms.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/rt/flags.h"
#include "burr/scenario/rack.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/servo.h"
#include "support/folder.h"

namespace {

using namespace burr;
using math::Vec3;
using Bone = std::unique_ptr<volume::Bone>;
NoProgress quiet;

struct Options {
  int threads = 2;
  bool realtime = false;
  std::string only;
};

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "same_bits: {}\n", why);
  std::exit(1);
}
template <class T>
T take(Result<T> result) {
  if (!result) give_up(result.error().text);
  return std::move(*result);
}

// A simulated hand that also commands, each thing at its own tick.
struct CommandAt {
  std::uint64_t tick;
  tick::Command command;
};
class CommandingHand final : public device::Device {
 public:
  CommandingHand(device::HandPath path, const device::ArmSettings& arm,
                 std::vector<CommandAt> commands)
      : hand_(std::move(path), arm), commands_(std::move(commands)) {}
  void tell(tick::Servo& servo) { servo_ = &servo; }
  Status open() override { return hand_.open(); }
  void close() override { hand_.close(); }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return hand_.spec(); }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    for (const CommandAt& at : commands_)
      if (at.tick == tick_ && servo_ != nullptr)
        static_cast<void>(servo_->commands().push(at.command));
    ++tick_;
    return hand_.state(dt);
  }
  void write_force(const Vec3& force) BURR_RT override { hand_.write_force(force); }
  void scale_force(double scale) BURR_RT override { hand_.scale_force(scale); }
  [[nodiscard]] bool finished() const BURR_RT override { return hand_.finished(); }

 private:
  device::SimulatedHand hand_;
  std::vector<CommandAt> commands_;
  tick::Servo* servo_ = nullptr;
  std::uint64_t tick_ = 0;
};

struct Plan {
  const char* motion;
  double seconds, burr_mm;
  tool::BurrKind kind = tool::BurrKind::cutting;
  device::ArmSettings arm = {};
  std::vector<CommandAt> commands = {};
  const char* tool = nullptr;  // of the rack; nullptr: the burr
  haptics::Method touch = haptics::Method::constraint;
};

void mill(const char* name, const Plan& plan, const std::function<Bone()>& make,
          const Options& options) {
  const test::Folder folder;
  const std::string file = folder / "s.mcap";
  sim::SessionSettings settings;
  settings.servo.burr.radius = 0.5e-3 * plan.burr_mm;
  settings.servo.burr.kind = plan.kind;
  settings.servo.undo_bricks = 2048;
  settings.servo.touch = plan.touch;
  if (plan.tool != nullptr) {
    const auto tool = take(scenario::built_in_rack().get(plan.tool));
    settings.servo.tools = {{tool.name, tool.tool, tool.cutter}};
    settings.servo.tool = 0;
  }
  settings.realtime = options.realtime;
  settings.threads = options.threads;
  Bone bone = make();
  const auto place = take(surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {}));
  auto path = take(surgeon::motion(plan.motion, place, settings.servo.burr.radius, plan.seconds));
  auto hand = std::make_unique<CommandingHand>(std::move(path), plan.arm, plan.commands);
  CommandingHand& commanding = *hand;
  auto session = take(sim::Session::make(std::move(bone), std::move(hand), settings, quiet));
  commanding.tell(session->servo());

  record::SessionInfo info;
  sim::describe(session->settings(), session->hand().spec(), info);
  info.volume.grid = session->bone().grid();
  info.volume.tissues = session->bone().tissues();
  info.volume.content_hash = session->bone().content_hash();
  record::Recorder recorder(settings.servo.rate_hz, 8192, options.realtime);
  if (Status started = recorder.start(file, info); !started) give_up(started.error().text);
  session->set_recorder(&recorder);
  session->run(plan.seconds, quiet);
  session->set_recorder(nullptr);
  static_cast<void>(take(recorder.finish()));
  tick::TickRow row;
  if (!session->view(row)) give_up("not one tick");

  // whatever happened, it happens again
  auto player = take(record::Player::open(file));
  const auto again = take(sim::replay(*player, make(), quiet));
  if (again.first_different_tick || again.gaps > 0 || again.ticks != row.tick + 1 ||
      again.bone->content_hash() != session->bone().content_hash())
    give_up(fmt::format("{}: does not replay: {}", name, again.difference));
  const sim::Outcome outcome = session->outcome();
  const bool lost =
      (outcome.flags & rt::kFlagWatchdog) != 0 || outcome.most_shed != tick::Shed::none;
  fmt::print("{} {:016x} {:016x}{}\n", name, row.hash, session->bone().content_hash(),
             lost ? " lost" : "");
}

// A scan with noise, made of whole numbers: no two machines disagree about it.
io::Scan noisy_scan() {
  io::Scan scan;
  scan.size = {48, 44, 30};
  scan.spacing_mm = {0.5, 0.5, 0.8};
  scan.axes = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  scan.hounsfield = true;
  scan.format = "made up";
  std::uint64_t noise = 1;
  for (int k = 0; k < scan.size.z(); ++k)
    for (int j = 0; j < scan.size.y(); ++j)
      for (int i = 0; i < scan.size.x(); ++i) {
        noise = base::mix(noise, std::uint64_t{1});
        const int x = i - 24, y = j - 22, z = 2 * (k - 15);
        const bool solid = x * x + y * y + z * z < 340 && !(x * x + (y - 8) * (y - 8) < 20);
        scan.values.push_back(
            static_cast<float>((solid ? 1100 : -200) + static_cast<int>(noise >> 40 & 127) - 64));
      }
  return scan;
}

void all(const Options& options) {
  const auto wanted = [&](const char* name) {
    return options.only.empty() || options.only == name;
  };
  const auto bone_only = [&](const char* name, const Bone& bone) {
    fmt::print("{} {:016x} {:016x}\n", name, 0, bone->content_hash());
  };
  const auto command = [](std::uint64_t tick, tick::CommandKind kind, double value = 0) {
    return CommandAt{tick, {kind, value}};
  };
  using Kind = tick::CommandKind;
  if (wanted("pocket"))
    mill(
        "pocket",
        {.motion = "pocket",
         .seconds = 3,
         .burr_mm = 4,
         .commands = {command(900, Kind::undo), command(1300, Kind::redo),
                      command(1400, Kind::stiffness, 600), command(1500, Kind::burr_radius, 1.7e-3),
                      command(1700, Kind::tool_mode, 1), command(2100, Kind::tool_mode, 0),
                      command(2500, Kind::reset)}},
        [&] {
          return phantom::bone_from_distance(
              phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), {},
              phantom::slab(), 256, options.threads);
        },
        options);
  if (wanted("plunge"))
    mill(
        "plunge",
        {.motion = "plunge",
         .seconds = 2,
         .burr_mm = 3,
         .kind = tool::BurrKind::diamond,
         .arm = {.mass = 0.06, .damping = 5, .stiffness = 200}},
        [&] {
          return phantom::bone_from_distance(phantom::cube_grid(16e-3, 50, {1e-3, 2e-3, 3e-3}), {},
                                             phantom::gyroid(5e-3, 0.6), 256, options.threads,
                                             phantom::kGyroidSteepness);
        },
        options);
  if (wanted("slot"))
    mill(
        "slot", {.motion = "slot", .seconds = 2, .burr_mm = 5},
        [&] { return take(phantom::phantom("temporal-bone", 0.9, quiet, 256, options.threads)); },
        options);
  const auto even = [&] {
    return phantom::bone_from_distance(
        phantom::box_grid(Vec3::Constant(-8e-3), Vec3::Constant(8e-3), 0.25e-3), {},
        phantom::slab(), 256, options.threads);
  };
  if (wanted("saw"))
    mill("saw",
         {.motion = "slot",
          .seconds = 2,
          .burr_mm = 4,
          .commands = {command(1200, Kind::undo), command(1600, Kind::mirror_i, 20)},
          .tool = "sagittal-saw"},
         even, options);
  if (wanted("flame"))
    mill("flame", {.motion = "pocket", .seconds = 2, .burr_mm = 4, .tool = "flame"}, even, options);
  if (wanted("shaft"))
    mill("shaft", {.motion = "plunge", .seconds = 2, .burr_mm = 3, .touch = haptics::Method::shaft},
         even, options);
  if (wanted("touch"))
    mill(
        "touch", {.motion = "touch", .seconds = 2, .burr_mm = 4, .arm = {.stiffness = INFINITY}},
        [&] { return phantom::peers_bone(64, 64, options.threads); }, options);
  for (const auto phantom : phantom::phantom_names()) {
    const std::string name(phantom);
    if (wanted(name.c_str()))
      bone_only(name.c_str(), take(phantom::phantom(phantom, 2 * phantom::default_voxel_mm(phantom),
                                                    quiet, 64, options.threads)));
  }
  if (wanted("scan")) bone_only("scan", take(importing::import_bone(noisy_scan(), {}, quiet)).bone);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--realtime") {
      options.realtime = true;
    } else if (word == "--threads" && i + 1 < argc) {
      options.threads = std::atoi(argv[++i]);
    } else if (word == "--only" && i + 1 < argc) {
      options.only = argv[++i];
    } else {
      give_up("usage: same_bits [--threads N] [--realtime] [--only NAME]");
    }
  }
  all(options);
}

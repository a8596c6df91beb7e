// Touches and mills a ball of bone with a round burr, and with tools of other shapes on the last path,
// and prints for each the hash of the last tick, which stands for all of them, and of the bone that is
// left. Needs burr_core alone, so that it can be built for other processors and for a browser;
// scripts/checks/portable.sh compares the lines.
//
//     portable_bits PATHS            PATHS: tests/bits/portable_paths.txt
//     portable_bits --make >PATHS    the paths; by sin and cos, which differ between C libraries in
//                                    the last bit: that is why they are kept in a file, as
//                                    hexadecimal numbers
//
// The bone is made by plain arithmetic and std::sqrt, which IEEE 754 defines to the last bit. The
// tick uses the functions of math/elementary.h, whose bits have a line of their own.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/math/elementary.h"
#include "burr/tick/servo.h"
#include "burr/tool/shaped_tool.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace {

using namespace burr;
using math::Vec3;

constexpr int kTicks = 3000, kToolTicks = 1500;
constexpr double kBall = 12e-3, kBurr = 2e-3;  // radii  [m]

struct Scene {
  std::string name;
  device::HandPath path;
};

[[noreturn]] void give_up(const char* why, const char* what) {
  std::fprintf(stderr, "portable_bits: %s %s\n", why, what);
  std::exit(1);
}

// Turned against the world, so that the frame counts too; the ball's centre is the world's origin.
volume::Grid tilted_grid() {
  volume::Grid grid;
  grid.size = {112, 112, 112};
  grid.voxel = 0.25e-3;
  grid.frame.q = math::Quat(0.8, 0, 0.6, 0);
  grid.frame.p = grid.frame.q * Vec3(Vec3::Constant(-55.5 * grid.voxel));
  return grid;
}

std::unique_ptr<volume::Bone> ball() {
  const volume::Grid grid = tilted_grid();
  std::vector<volume::Field> field;
  field.reserve(112 * 112 * 112);
  for (int k = 0; k < 112; ++k)
    for (int j = 0; j < 112; ++j)
      for (int i = 0; i < 112; ++i) {
        // half voxels from the centre: whole numbers
        const int x = 2 * i - 111, y = 2 * j - 111, z = 2 * k - 111;
        const double far = 0.5 * std::sqrt(static_cast<double>(x * x + y * y + z * z));
        field.push_back(volume::field_from_depth(48 - far));
      }
  return volume::bone_from_arrays(grid, {}, field, {}, {}, 64);
}

void print_number(double value) { std::printf(" %a", value); }

void make_paths() {
  std::printf(
      "# Written by portable_bits --make. A path: its name and how many points; each point is time "
      "[s], x, y, z [m], pedal.\n");
  for (const char* name : {"touch", "slide", "slot"}) {
    const bool slot = std::strcmp(name, "slot") == 0, touch = std::strcmp(name, "touch") == 0;
    constexpr int kPoints = 61;
    std::printf("path %s %d\n", name, kPoints);
    for (int n = 0; n < kPoints; ++n) {
      const double t = 0.05 * n, since = std::max(0.0, t - 0.4);  // 0.4 s through the air
      const double sunk = slot ? std::min(3e-3, 6e-3 * since) : 0.7e-3;
      const double above = 3e-3 * std::max(0.0, 1 - t / 0.4);
      const double angle = 20e-3 * std::max(0.0, since - (slot ? 0.5 : 0.0)) / (kBall + kBurr);
      const double far = kBall + kBurr - sunk + above;
      print_number(t);
      print_number(far * std::cos(angle));
      print_number(far * 0.8 * std::sin(angle));
      print_number(far * 0.6 * std::sin(angle));
      print_number(touch ? 0 : 1);
      std::printf("\n");
    }
  }
}

std::vector<Scene> read_paths(const char* file) {
  std::FILE* in = std::fopen(file, "r");
  if (in == nullptr) give_up("cannot read", file);
  std::vector<Scene> scenes;
  char line[256];
  std::size_t expected = 0;
  while (std::fgets(line, sizeof line, in) != nullptr) {
    char name[32];
    int count = 0;
    if (line[0] == '#') continue;
    if (std::sscanf(line, "path %31s %d", name, &count) == 2) {
      scenes.push_back({name, {}});
      expected += static_cast<std::size_t>(count);
      continue;
    }
    if (scenes.empty()) give_up("no path begins", file);
    double numbers[5];
    char* at = line;
    for (double& number : numbers) {
      char* const before = at;
      number = std::strtod(before, &at);
      if (at == before) give_up("not five numbers:", line);
    }
    // the burr's axis lies along the surface, so that it cuts best
    scenes.back().path.points.push_back(
        {numbers[0], {{numbers[1], numbers[2], numbers[3]}, {0.6, 0.8, 0, 0}}, numbers[4]});
  }
  std::fclose(in);
  std::size_t read = 0;
  for (const Scene& scene : scenes) read += scene.path.points.size();
  if (scenes.empty() || read != expected) give_up("a line is missing in", file);
  return scenes;
}

// A tool of each drive and of each way to compute a distance, heads of about the burr's size.
std::vector<tool::ShapedTool> tools() {
  using tool::ShapeKind;
  const auto made = [](const char* name, const tool::Shape& head, const tool::Cutter& cutter) {
    tool::ShapedTool one{name, {}, cutter};
    if (!tool::add_part(one.tool, {head, {}, tool::Role::cuts}) ||
        !tool::add_part(one.tool, {{ShapeKind::capsule, 0, 0, 8e-3, 1e-3},
                                   {Vec3(0, 0, 11e-3), math::Quat::Identity()},
                                   tool::Role::rubs}))
      give_up("no body:", name);
    return one;
  };
  using tool::Drive;
  const tool::Cutter turns{.drive = Drive::turning};
  const tool::Cutter strokes{
      .drive = Drive::oscillating, .amplitude_m = 0.5e-3, .cycles_hz = 200, .way = Vec3::UnitY()};
  const tool::Cutter pushed{.drive = Drive::pushed, .way = Vec3::UnitY()};
  return {made("flame", {ShapeKind::vesica, 1.4e-3, 0, 3e-3, 0.4e-3}, turns),
          made("wheel", {ShapeKind::cylinder, 1.8e-3, 0, 0.5e-3, 0.2e-3}, turns),
          made("cone", {ShapeKind::frustum, 0.8e-3, 1.6e-3, 2e-3, 0.2e-3}, turns),
          made("trephine", {ShapeKind::tube, 2e-3, 1.4e-3, 2e-3, 0.3e-3}, turns),
          made("saw", {ShapeKind::box, 0.3e-3, 2e-3, 2e-3, 0.1e-3}, strokes),
          made("chisel", {ShapeKind::wedge, 0.8e-3, 2e-3, 3e-3, 0.2e-3}, pushed),
          made("curette", {ShapeKind::half_shell, 1.8e-3, 0.2e-3, 0, 0.3e-3}, pushed)};
}

// number: of the tool; -1: the round burr
void replay(const Scene& scene, int number = -1) {
  const auto bone = ball();
  NoProgress quiet;
  volume::IsoVertices surface(*bone, {}, 1, quiet);
  device::HandPath path = scene.path;
  if (number >= 0)  // a tool stands on the bone, its handle away from it
    for (auto& point : path.points) point.world_from_tool.q = math::Quat(0.8, 0, 0.6, 0);
  device::SimulatedHand hand(path, {});
  if (!hand.open()) give_up("no points:", scene.name.c_str());
  tick::ServoSettings settings;
  settings.burr.radius = kBurr;
  if (number >= 0) {
    settings.tools = tools();
    settings.tool = number;
  }
  tick::Servo servo(*bone, surface, hand, settings);
  const tick::TickRow* row = nullptr;
  int touching = 0;
  for (int n = 0; n < (number < 0 ? kTicks : kToolTicks); ++n) {
    row = &servo.tick(false);
    touching += row->contact.touching ? 1 : 0;
    servo.publish();
    servo.commit_ahead();
    bone->commit_ahead();
    surface.commit_ahead();
  }
  std::printf("%s%s%s %016llx %016llx touching %d removed_mm3 %.6f\n", scene.name.c_str(),
              number < 0 ? "" : "-",
              number < 0 ? "" : settings.tools[static_cast<std::size_t>(number)].name.c_str(),
              static_cast<unsigned long long>(row->hash),
              static_cast<unsigned long long>(bone->content_hash()), touching,
              1e9 * row->ledger.removed);
}

// exp, sin, cos, atan2 and hypot over arguments that plain arithmetic makes.
void print_elementary() {
  std::uint64_t state = 1, hash = 14695981039346656037ULL;
  const auto next = [&state](double far) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return far * (static_cast<double>(state >> 11) * 0x1p-52 - 1);
  };
  const auto add = [&hash](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ULL;
  };
  for (int n = 0; n < 100000; ++n) {
    const double x = next(1), y = next(1), far = next(40);
    add(math::exponential(far));
    add(math::exponential_minus_one(x));
    add(math::sine(far));
    add(math::cosine(far));
    add(math::angle_of(y, x));
    add(math::hypotenuse(x, y));
  }
  std::printf("elementary %016llx\n", static_cast<unsigned long long>(hash));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--make") {
    make_paths();
  } else if (argc == 2) {
    const std::vector<Scene> scenes = read_paths(argv[1]);
    for (const Scene& scene : scenes) replay(scene);
    for (int number = 0; number < static_cast<int>(tools().size()); ++number)
      replay(scenes.back(), number);
    print_elementary();
  } else {
    give_up("usage: portable_bits PATHS, or", "--make");
  }
}

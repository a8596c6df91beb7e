// burr verify bones - real bone, touched and milled. The judge is a reference that looks at every
// voxel edge near the burr and shares no code with the proxy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "burr/surgeon/motion.h"
#include "burr/volume/sample.h"
#include "burr/workshop/open_bone.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"
#include "workbench.h"

namespace burr::app {
namespace {

using math::Vec3;

struct Subject {
  const char *name, *file;
  double spacing_mm;  // for a file that states a wrong one; 0: the file's
  double minutes;
  bool smooth;  // on the scale of a burr; on a rough bone it drops from edge to edge
};
constexpr Subject kSubjects[] = {
    {"temporal bone", "temporal_bone/RT143_512.seg.nrrd", 0, 10, false},
    {"jaw", "jaw_cbct/jaw_cbct_half_0.4mm.nii.gz", 0, 2, false},
    {"tooth", "tooth_microct/tooth.nhdr", 0.1, 2, true},
    {"plastic skull", "skull_phantom/bone_1mm_jpegls", 0, 2, true},
};

constexpr double kNear = 0.3;      // a crossing with a smaller gap may press (disc's width) [voxel]
constexpr double kBurrVoxels = 8;  // radius of the burr                                 [voxel]

// What the field itself says about a burr at c that a hand at x holds.
struct Verdict {
  double overlap = 0;     // deepest crossing inside the ball               [voxel]
  double unbalanced = 0;  // part of the spring that no contact can support [voxel]
};

// Finds every crossing of a voxel edge with the iso-surface near the ball. None may be inside, and
// those at its surface must be able to support the spring (Kuhn and Tucker); solved by Hildreth's
// sweeps.
Verdict judge(const volume::Bone& bone, const Vec3& proxy, const Vec3& hand, double radius) {
  const volume::Grid& grid = bone.grid();
  const Vec3 c = grid.grid_from_world(proxy);
  const double r = radius / grid.voxel;
  Verdict verdict;
  std::vector<Vec3> normals;
  const math::Ijk lo = (c.array() - r - 2).floor().cast<int>(),
                  hi = (c.array() + r + 2).ceil().cast<int>();
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const double here = bone.field(i, j, k) / 65536.0 - 0.5;
        for (int axis = 0; axis < 3; ++axis) {
          const math::Ijk next = math::Ijk(i, j, k) + math::Ijk::Unit(axis);
          const double there = bone.field(next.x(), next.y(), next.z()) / 65536.0 - 0.5;
          if ((here >= 0) == (there >= 0)) continue;
          const Vec3 q = Vec3(i, j, k) + here / (here - there) * Vec3::Unit(axis);
          const Vec3 away = c - q;
          const double gap = away.norm() - r;
          verdict.overlap = std::max(verdict.overlap, -gap);
          if (gap < kNear) normals.push_back(away.normalized());
        }
      }
  const Vec3 spring = c - grid.grid_from_world(hand);
  Vec3 left = spring;
  std::vector<double> bears(normals.size(), 0);
  for (int sweep = 0; sweep < 400; ++sweep)
    for (std::size_t n = 0; n < normals.size(); ++n) {
      const double was = bears[n];
      bears[n] = std::max(0.0, was + left.dot(normals[n]));
      left -= (bears[n] - was) * normals[n];
    }
  verdict.unbalanced = left.norm();
  return verdict;
}

// A hand that presses into the bone and moves over it at random.
device::HandPath wander(const surgeon::WorkPlace& place, double r, double seconds, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> stray(0, 1);
  device::HandPath path;
  const Vec3 u = place.into.unitOrthogonal(), v = place.into.cross(u);
  Vec3 request = Vec3::Zero();  // along u, along v, depth
  for (double t = 0; t <= seconds; t += 0.05) {
    // a random walk with a memory of about a second, a few burrs wide
    request += 0.05 * (-request) + 0.3 * Vec3(stray(random), stray(random), 0.4 * stray(random));
    device::PathPoint point;
    point.t = t;
    const double begun = std::min(1.0, t / 0.5);
    point.world_from_tool.p =
        place.at + r * (1.5 * request.x() * u + 1.5 * request.y() * v) +
        ((0.4 * request.z() + 0.3) * begun * r - (1 - begun) * 3 * r) * place.into;
    point.pedal = 1;
    path.points.push_back(point);
  }
  return path;
}

// A soft hand presses the burr to the bone with some newtons and draws it along at 10 mm/s. The
// force should hardly change; what changes within 1/20 s is noise of the voxels.
struct Noise {
  double mean = 0, rms = 0, step = 0;  // of the force; step: largest change per tick [N]
  std::vector<double> t, force;
};
Noise noise(Workbench& bench, const surgeon::WorkPlace& place, double r) {
  const Vec3 along = place.into.unitOrthogonal();
  const Vec3 above = place.at - 2 * r * place.into, deep = place.at + 5e-3 * place.into;
  device::HandPath path = path_through({{0, above},
                                        {0.5, deep},
                                        {0.8, deep},
                                        {1.2, deep + 4e-3 * along},
                                        {1.4, above + 4e-3 * along}});
  const auto rows = bench.work(path, {.mass = 0.1, .damping = 10, .stiffness = 200}, false);
  Noise out;
  for (const auto& row : rows)
    if (row.t >= 0.8 && row.t <= 1.2) {
      out.t.push_back(row.t);
      out.force.push_back(row.force.norm());
    }
  constexpr std::size_t kHalf = 25;  // half width of the running mean  [ticks]
  int count = 0;
  for (std::size_t n = 0; n < out.force.size(); ++n) {
    out.mean += out.force[n] / static_cast<double>(out.force.size());
    if (n > 0) out.step = std::max(out.step, std::abs(out.force[n] - out.force[n - 1]));
    if (n < kHalf || n + kHalf >= out.force.size()) continue;
    double around = 0;
    for (std::size_t k = n - kHalf; k <= n + kHalf; ++k) around += out.force[k];
    out.rms += std::pow(out.force[n] - around / (2 * kHalf + 1), 2);
    ++count;
  }
  out.rms = std::sqrt(out.rms / std::max(1, count));
  return out;
}

void bones(const Verify& verify, VerifyReport::Part& part) {
  Series series{"real_bones", {"bone", "tick", "overlap_voxel", "unbalanced_share"}, {}};
  Axes strokes{"a stroke without cutting", "time [s]", "force [N]", {}};
  Table strengths{
      "The stroke: the force, its noise (variations faster than a twentieth of a second), and its "
      "largest step from one tick to the next. On smooth bone the force must be steady. On rough "
      "bone a burr drops from edge to edge, and the table gives the size of these steps.",
      {"bone", "surface", "force [N]", "noise [%]", "step [N]"},
      {}};
  for (const Subject& subject : kSubjects) {
    const std::filesystem::path file = std::filesystem::path(verify.data) / subject.file;
    if (verify.data.empty() || !std::filesystem::exists(file)) {
      part.cannot(fmt::format("{}: {}", subject.name,
                              verify.data.empty() ? "give --data DIR, where the real bones lie"
                                                  : file.string() + " is not there"));
      continue;
    }
    if (verify.quick && subject.minutes > 5) continue;
    if (interrupted()) return;
    scenario::BoneRecipe options;
    options.source = file.string();
    options.spacing_mm = math::Vec3::Constant(subject.spacing_mm);
    auto opened = workshop::open_bone(options, progress());
    if (!opened) {
      part.cannot(fmt::format("{}: {}", subject.name, in_options(opened.error()).text));
      continue;
    }
    const double h = opened->bone->grid().voxel, r = kBurrVoxels * h;
    auto place = surgeon::find_work_place(*opened->bone, r, {}, {});
    if (!place) {
      part.cannot(fmt::format("{}: {}", subject.name, in_options(place.error()).text));
      continue;
    }
    WorkSettings settings;
    settings.radius = r;
    settings.spindle = 8.4 / r;
    Workbench bench(std::move(opened->bone), settings);
    const Noise stroke = noise(bench, *place, r);
    strokes.lines.push_back({subject.name, stroke.t, stroke.force});
    strengths.rows.push_back({subject.name, subject.smooth ? "smooth" : "rough",
                              fmt::format("{:.2f}", stroke.mean),
                              fmt::format("{:.2f}", 100 * stroke.rms / stroke.mean),
                              fmt::format("{:.4f}", stroke.step)});
    if (subject.smooth) {
      part.at_least(fmt::format("{}.stroke", subject.name), 0.3, stroke.mean, "N");
      part.at_most(fmt::format("{}.noise", subject.name), 0.01, stroke.rms / stroke.mean,
                   "of the force");
      part.at_most(fmt::format("{}.noise_step", subject.name), 0.02, stroke.step, "N");
    }
    const double minutes = verify.quick ? 0.05 : subject.minutes;
    int tick = 0, fell = 0, silent = 0, judged = 0, touched = 0, lagged = 0;
    double overlap = 0;
    std::vector<double> shares;
    Vec3 last = Vec3::Zero();
    bench.watch = [&](const haptics::Touch& touch, const Vec3& hand) {
      ++tick;
      const Vec3 force = touch.depth * touch.normal;
      const bool outlier = (force - last).norm() > 0.05 * h;
      last = force;
      touched += touch.touching ? 1 : 0;
      const volume::Grid& grid = bench.bone().grid();
      fell += volume::sample(bench.bone(), grid.grid_from_world(touch.proxy)) >= volume::kIsoShare;
      if (!touch.touching && (touch.proxy - hand).norm() > 0.05 * h && !touch.lagging) ++silent;
      lagged += touch.lagging ? 1 : 0;
      if ((tick % 50 != 0 && !outlier) || touch.lagging || !touch.touching) return;
      const Verdict verdict = judge(bench.bone(), touch.proxy, hand, r);
      ++judged;
      overlap = std::max(overlap, verdict.overlap);
      const double depth = (touch.proxy - hand).norm() / h;
      shares.push_back(verdict.unbalanced / std::max(depth, 0.5));
      series.rows.push_back({static_cast<double>(&subject - kSubjects), static_cast<double>(tick),
                             verdict.overlap, shares.back()});
    };
    device::ArmSettings arm{.mass = 0.1, .damping = 10, .stiffness = 500};
    (void)bench.work(wander(*place, r, 60 * minutes, static_cast<unsigned>(verify.seed_or(7))), arm,
                     true);
    std::sort(shares.begin(), shares.end());
    const std::string which = subject.name;
    part.at_most(which + ".fallen_through", 0, fell, "ticks");
    part.at_most(which + ".silent", 0, silent, "ticks");
    part.at_most(which + ".overlap", 0.05, overlap, "voxel");
    part.at_most(
        which + ".unbalanced_p99", 0.1,
        shares.empty()
            ? 1
            : shares[static_cast<std::size_t>(0.99 * static_cast<double>(shares.size() - 1))],
        "of the spring");
    part.at_least(which + ".judged", verify.quick ? 20 : 1000, judged, "ticks");
    part.at_most(which + ".lagging", 0.01 * tick, lagged, "ticks");
  }
  part.series.push_back(std::move(series));
  if (!strengths.rows.empty()) part.table(std::move(strengths));
  if (!strokes.lines.empty())
    part.plot(
        {"A soft hand draws the burr over the bone at 10 mm/s, nothing is cut. The force follows "
         "the bone's shape; what flickers faster than a twentieth of a second is noise.",
         1,
         {strokes}});
}

const VerifyPart part{70, "bones", "Real bone",
                      "A hand moves over real bones and mills them. In every 50th tick, and "
                      "whenever the force steps, every crossing of a voxel edge near the burr is "
                      "checked: none may be inside the ball, and the contact forces must be able "
                      "to balance the spring. The proxy's centre is never in bone.",
                      bones};

}  // namespace
}  // namespace burr::app

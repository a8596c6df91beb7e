// bench/volume/brick_layout_bench.cpp - which brick size, and which order inside a brick, is best
// for bone?
//
// One thread, one field: a bumpy shell like a skull, 512^3 voxels of 16 bits. Six ways to store it:
// dense without bricks; a table and a pool of bricks of 8^3 or 16^3, x fastest or in z-order
// inside. Each is timed on the typical work of burr:
//   walk      trilinear value and central-difference gradient at 64 points of a burr that moves
//             along the surface, 0.1 voxel per tick (50 mm/s at 0.5 mm)
//   surface   the same at random points of the surface: nothing is in the cache
//   carve     lowers the field in a ball of 31 voxels at the surface; whole bricks are copied and
//             written back, as Bone::write_brick() must do
//   patch     copies 18^3 voxels around a block, as the mesher does
// The answer and the figures are in bench/results/brick_layout.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "burr/volume/bone.h"

namespace {

using burr::math::Vec3;
using Field = burr::volume::Field;

constexpr int kEdge = 512;

// Depth below the surface of a bumpy shell  [voxel].
double depth(double i, double j, double k) {
  const Vec3 p = Vec3(i, j, k) - Vec3::Constant(0.5 * kEdge);
  const double bumps = 6 * std::sin(0.07 * p.x()) * std::sin(0.05 * p.y()) * std::sin(0.06 * p.z());
  return 8 - std::abs(p.norm() - 215 - bumps);
}

// ---- ways to store: at() reads one voxel; block() returns a brick to write; both as fast as
// possible

struct Dense {
  static constexpr int kBrick = 0;
  std::vector<Field> voxel = std::vector<Field>(std::size_t{kEdge} * kEdge * kEdge);

  static std::size_t index(int i, int j, int k) {
    return static_cast<std::size_t>(i) +
           kEdge * (static_cast<std::size_t>(j) + kEdge * static_cast<std::size_t>(k));
  }
  [[nodiscard]] Field at(int i, int j, int k) const { return voxel[index(i, j, k)]; }
  void put(int i, int j, int k, Field f) { voxel[index(i, j, k)] = f; }
  void finish() {}
  [[nodiscard]] double mebibytes() const { return static_cast<double>(voxel.size()) * 2 / 1048576; }
};

// Spreads 3 bits of a coordinate: bit n goes to bit 3 n.
constexpr unsigned spread(unsigned v) {
  return (v & 1U) | (v & 2U) << 2U | (v & 4U) << 4U | (v & 8U) << 6U;
}

template <int Log, bool ZOrder>
struct Bricks {
  static constexpr int kBrick = 1 << Log, kMask = kBrick - 1, kAcross = kEdge >> Log;
  static constexpr std::size_t kVoxels = std::size_t{1} << (3 * Log);
  std::vector<std::int32_t> table =
      std::vector<std::int32_t>(std::size_t{kAcross} * kAcross * kAcross, 0);
  std::vector<Field> pool = std::vector<Field>(kVoxels);  // slot 0: air

  static std::size_t brick(int i, int j, int k) {
    return static_cast<std::size_t>((i >> Log) + kAcross * ((j >> Log) + kAcross * (k >> Log)));
  }
  static std::size_t inside(int i, int j, int k) {
    if constexpr (ZOrder) {
      static constexpr auto kSpread = [] {
        std::array<std::uint16_t, kBrick> s{};
        for (unsigned v = 0; v < kBrick; ++v) s[v] = static_cast<std::uint16_t>(spread(v));
        return s;
      }();
      const auto x = static_cast<std::size_t>(i & kMask), y = static_cast<std::size_t>(j & kMask),
                 z = static_cast<std::size_t>(k & kMask);
      return static_cast<std::size_t>(kSpread[x]) | static_cast<std::size_t>(kSpread[y]) << 1U |
             static_cast<std::size_t>(kSpread[z]) << 2U;
    } else {
      return static_cast<std::size_t>((i & kMask) | (j & kMask) << Log | (k & kMask) << (2 * Log));
    }
  }
  [[nodiscard]] Field at(int i, int j, int k) const {
    const auto slot = static_cast<std::size_t>(table[brick(i, j, k)]);
    return pool[slot * kVoxels + inside(i, j, k)];
  }
  void put(int i, int j, int k, Field f) {
    std::int32_t& slot = table[brick(i, j, k)];
    if (slot == 0) {
      if (f == 0) return;
      slot = static_cast<std::int32_t>(pool.size() / kVoxels);
      pool.resize(pool.size() + kVoxels);
    }
    pool[static_cast<std::size_t>(slot) * kVoxels + inside(i, j, k)] = f;
  }
  void finish() { pool.shrink_to_fit(); }
  [[nodiscard]] double mebibytes() const {
    return static_cast<double>(pool.size() * sizeof(Field) + table.size() * 4) / 1048576;
  }
};

using Bricks8 = Bricks<3, false>;
using Bricks8Z = Bricks<3, true>;
using Bricks16 = Bricks<4, false>;
using Bricks16Z = Bricks<4, true>;

// Made once for each layout, and only one is kept: the dense one alone takes 256 MiB.
template <class Layout>
Layout& bone() {
  static std::unique_ptr<Layout> made;
  if (!made) {
    made = std::make_unique<Layout>();
    for (int k = 0; k < kEdge; ++k)
      for (int j = 0; j < kEdge; ++j)
        for (int i = 0; i < kEdge; ++i) {
          const double r = (Vec3(i, j, k) - Vec3::Constant(0.5 * kEdge)).norm();
          if (r < 195 || r > 235) continue;
          made->put(i, j, k, burr::volume::field_from_depth(depth(i, j, k)));
        }
    made->finish();
  }
  return *made;
}

template <class Layout>
double sample(const Layout& bone, const Vec3& p) {
  const int i = static_cast<int>(p.x()), j = static_cast<int>(p.y()), k = static_cast<int>(p.z());
  const double x = p.x() - i, y = p.y() - j, z = p.z() - k;
  double value = 0;
  for (int c = 0; c < 8; ++c) {
    const int a = c & 1, b = c >> 1 & 1, d = c >> 2;
    value += (a != 0 ? x : 1 - x) * (b != 0 ? y : 1 - y) * (d != 0 ? z : 1 - z) *
             bone.at(i + a, j + b, k + d);
  }
  return value;
}

// Value and central-difference gradient: 7 trilinear samples.
template <class Layout>
double look(const Layout& bone, const Vec3& p) {
  double sum = sample(bone, p);
  for (int a = 0; a < 3; ++a)
    sum += sample(bone, p + Vec3::Unit(a)) - sample(bone, p - Vec3::Unit(a));
  return sum;
}

Vec3 on_the_outside(const Vec3& direction) {
  const Vec3 u = direction.normalized(), centre = Vec3::Constant(0.5 * kEdge);
  double lo = 200, hi = 240;  // bisection between inside and air
  for (int n = 0; n < 30; ++n) {
    const double mid = 0.5 * (lo + hi);
    const Vec3 p = centre + mid * u;
    (mid < 215 || depth(p.x(), p.y(), p.z()) > 0 ? lo : hi) = mid;
  }
  return centre + lo * u;
}

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random));
}

// The same places for every layout, computed beforehand.
const std::vector<Vec3>& places() {
  static const std::vector<Vec3> all = [] {
    std::mt19937_64 random(2);
    std::vector<Vec3> points;
    for (int n = 0; n < 100'000; ++n) points.push_back(on_the_outside(random_direction(random)));
    return points;
  }();
  return all;
}

template <class Layout>
void walk(benchmark::State& state) {
  const Layout& field = bone<Layout>();
  std::mt19937_64 random(1);
  std::vector<Vec3> burr;  // points on a ball of 6 voxels
  for (int n = 0; n < 64; ++n) burr.push_back(6 * random_direction(random).normalized());
  double sum = 0;
  std::size_t samples = 0;
  std::vector<Vec3> path;  // 16 strokes of 200 ticks
  for (int stroke = 0; stroke < 16; ++stroke) {
    const Vec3 at = random_direction(random).normalized();
    const Vec3 along = at.cross(random_direction(random)).normalized();
    for (int tick = 0; tick < 200; ++tick)
      path.push_back(on_the_outside(at + (0.1 / 215 * tick) * along));
  }
  for (auto _ : state) {
    for (const Vec3& tip : path) {
      for (const Vec3& point : burr) sum += look(field, tip + point);
      samples += burr.size();
    }
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<std::int64_t>(samples));
  state.counters["MiB"] = field.mebibytes();
}

template <class Layout>
void surface(benchmark::State& state) {
  const Layout& field = bone<Layout>();
  const std::vector<Vec3>& points = places();
  double sum = 0;
  std::size_t n = 0, samples = 0;
  for (auto _ : state) {
    for (int tick = 0; tick < 64; ++tick, ++samples, n = (n + 1) % points.size())
      sum += look(field, points[n]);
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<std::int64_t>(samples));
}

// Lowers all voxels of a ball a little. Bricks are copied, changed and written back as a whole,
// because readers must see whole bricks; the dense field is changed in place.
template <class Layout>
void carve(benchmark::State& state) {
  Layout& field = bone<Layout>();
  constexpr double kBurr = 31;
  std::size_t voxels = 0, n = 0;
  for (auto _ : state) {
    // 28 of 31 voxels out of the bone: a burr in light contact
    const Vec3& tip = places()[n++ % places().size()];
    const Vec3 out = (tip - Vec3::Constant(0.5 * kEdge)).normalized();
    const Vec3 centre = tip + (kBurr - 3) * out;
    std::array<int, 3> lo{}, hi{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double c = centre[static_cast<Eigen::Index>(a)];
      lo[a] = std::max(0, static_cast<int>(c - kBurr - 2));
      hi[a] = std::min(kEdge - 1, static_cast<int>(c + kBurr + 2));
    }
    const auto lower = [&](Field f, int i, int j, int k) {
      const double floor = 32768 - (kBurr - (Vec3(i, j, k) - centre).norm()) * 16384;
      const double kept = std::clamp(floor, 0.0, 65535.0);
      return f > kept ? static_cast<Field>(f - 0.01 * (f - kept)) : f;
    };
    if constexpr (Layout::kBrick == 0) {
      for (int k = lo[2]; k <= hi[2]; ++k)
        for (int j = lo[1]; j <= hi[1]; ++j)
          for (int i = lo[0]; i <= hi[0]; ++i) {
            Field& f = field.voxel[Layout::index(i, j, k)];
            if (f != 0) f = lower(f, i, j, k);
          }
    } else {
      constexpr int kB = Layout::kBrick;
      alignas(64) static thread_local std::array<Field, Layout::kVoxels> copy;
      for (int bk = lo[2] / kB; bk <= hi[2] / kB; ++bk)
        for (int bj = lo[1] / kB; bj <= hi[1] / kB; ++bj)
          for (int bi = lo[0] / kB; bi <= hi[0] / kB; ++bi) {
            const std::int32_t slot = field.table[Layout::brick(bi * kB, bj * kB, bk * kB)];
            if (slot == 0) continue;
            Field* shared = &field.pool[static_cast<std::size_t>(slot) * Layout::kVoxels];
            std::memcpy(copy.data(), shared, sizeof copy);
            for (int k = 0; k < kB; ++k)
              for (int j = 0; j < kB; ++j)
                for (int i = 0; i < kB; ++i) {
                  Field& f = copy[Layout::inside(i, j, k)];
                  if (f != 0) f = lower(f, bi * kB + i, bj * kB + j, bk * kB + k);
                }
            std::memcpy(shared, copy.data(), sizeof copy);
            voxels += Layout::kVoxels;
          }
    }
  }
  state.counters["KiB_written"] =
      benchmark::Counter(static_cast<double>(voxels) / 512, benchmark::Counter::kAvgIterations);
}

template <class Layout>
void patch(benchmark::State& state) {
  const Layout& field = bone<Layout>();
  std::vector<Field> apron(18 * 18 * 18);
  std::size_t n = 0;
  for (auto _ : state) {
    const Vec3& tip = places()[n++ % places().size()];
    const int i0 = (static_cast<int>(tip.x()) & ~15) - 1,
              j0 = (static_cast<int>(tip.y()) & ~15) - 1,
              k0 = (static_cast<int>(tip.z()) & ~15) - 1;
    Field* to = apron.data();
    for (int k = 0; k < 18; ++k)
      for (int j = 0; j < 18; ++j)
        for (int i = 0; i < 18; ++i) *to++ = field.at(i0 + i, j0 + j, k0 + k);
    benchmark::DoNotOptimize(apron.data());
    benchmark::ClobberMemory();
  }
}

#define ASK(Layout)                                          \
  BENCHMARK(walk<Layout>)->Unit(benchmark::kMillisecond);    \
  BENCHMARK(surface<Layout>)->Unit(benchmark::kMicrosecond); \
  BENCHMARK(patch<Layout>)->Unit(benchmark::kMicrosecond);   \
  BENCHMARK(carve<Layout>)->Unit(benchmark::kMicrosecond);

ASK(Dense)
ASK(Bricks8)
ASK(Bricks8Z)
ASK(Bricks16)
ASK(Bricks16Z)

}  // namespace

BENCHMARK_MAIN();

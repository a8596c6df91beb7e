#include "law_trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "burr/base/hash.h"
#include "burr/haptics/safety/stability.h"
#include "burr/rt/clock.h"
#include "burr/tick/law_call.h"
#include "burr/workshop/law_file.h"
#include "pressing.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

using Law = std::shared_ptr<workshop::LawFile>;
using Random = std::mt19937_64;

constexpr int kRandom = 1'000'000, kTwice = 100'000, kTimed = 100'000, kTimedRuns = 5;
constexpr double kSeconds = 10;  // that a hand presses

// Opened before (in check()), so that it opens now too.
Law opened(const LawTrial& trial) {
  auto law = workshop::LawFile::open(trial.file, trial.settings);
  if (!law || !(*law)->begin()) return nullptr;
  return *law;
}

// As burr fills it: with the spring that is set.
burr_law_out_v1 answer_to(const burr_law_in_v1& in) {
  burr_law_out_v1 out = {};
  out.size = sizeof out;
  out.version = 1;
  for (int axis = 0; axis < 3; ++axis) out.force[axis] = in.stiffness * in.depth * in.normal[axis];
  out.energy_j = BURR_LAW_AS_BURR;
  return out;
}

double between(Random& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}

void unit(Random& random, double* to) {
  std::normal_distribution<double> any(0, 1);
  double length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    to[axis] = any(random);
    length += to[axis] * to[axis];
  }
  for (int axis = 0; axis < 3; ++axis) to[axis] /= std::sqrt(length);
}

// As a session could give it.
burr_law_in_v1 likely(Random& random) {
  burr_law_in_v1 in = {};
  in.size = sizeof in;
  in.version = 1;
  in.dt = 1e-3;
  for (double& place : in.hand) place = between(random, -0.2, 0.2);
  std::copy(in.hand, in.hand + 3, in.proxy);
  std::normal_distribution<double> speed(0, 0.1);
  for (double& v : in.velocity) v = speed(random);
  unit(random, in.axis);
  in.radius = between(random, 0.3e-3, 3.5e-3);
  in.spin_rad_s = between(random, -1, 1) < 0 ? 0 : between(random, -8e3, 8e3);
  in.stiffness = between(random, 100, 5000);
  in.damping = between(random, 0, 5);
  if (random() % 4 == 0) return in;
  in.touching = 1;
  unit(random, in.normal);
  in.depth = between(random, 0, 5e-3);
  for (int axis = 0; axis < 3; ++axis) in.proxy[axis] += in.depth * in.normal[axis];
  in.hu = between(random, -1024, 3000);
  in.price_j_m3 = between(random, 1e7, 5e9);
  in.tissue = static_cast<std::uint16_t>(1 + random() % 255);
  return in;
}

// The numbers of an input, one after the other.
std::vector<double*> numbers(burr_law_in_v1& in) {
  std::vector<double*> all = {&in.dt,        &in.depth,   &in.radius, &in.spin_rad_s,
                              &in.stiffness, &in.damping, &in.hu,     &in.price_j_m3};
  for (double* vector : {in.hand, in.proxy, in.normal, in.velocity, in.axis})
    for (int axis = 0; axis < 3; ++axis) all.push_back(vector + axis);
  return all;
}

// Inputs that burr never gives. The law may refuse them or answer as it likes; it must come back.
nlohmann::json with_no_numbers(const LawTrial& trial) {
  const Law law = opened(trial);
  Random random(trial.seed);
  int asked = 0, refused = 0, believed = 0;
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(),
                        1e300,
                        -1e300,
                        1e-310};
  burr_law_in_v1 model = {};
  const std::size_t count = numbers(model).size();
  for (const double value : bad)
    for (std::size_t which = 0; which <= count; ++which) {
      burr_law_in_v1 in = likely(random);
      const std::vector<double*> all = numbers(in);
      for (std::size_t n = 0; n < count; ++n)
        if (which == count || n == which) *all[n] = value;
      burr_law_out_v1 out = answer_to(in);
      ++asked;
      if (law->answer(in, out) != 0)
        ++refused;
      else
        believed += tick::possible(out) ? 1 : 0;
    }
  return {{"asked", asked}, {"refused", refused}, {"possible", believed}};
}

nlohmann::json with_random_inputs(const LawTrial& trial) {
  const Law law = opened(trial);
  Random random(trial.seed);
  int refused = 0, impossible = 0;
  double most = 0;
  for (int n = 0; n < kRandom; ++n) {
    const burr_law_in_v1 in = likely(random);
    burr_law_out_v1 out = answer_to(in);
    if (law->answer(in, out) != 0)
      ++refused;
    else if (!tick::possible(out))
      ++impossible;
    else
      most = std::max(most, std::hypot(out.force[0], out.force[1], out.force[2]));
  }
  return {{"asked", kRandom}, {"refused", refused}, {"impossible", impossible}, {"most_n", most}};
}

std::uint64_t answers_of(workshop::LawFile& law, std::uint64_t seed) {
  Random random(seed);
  std::uint64_t hash = 0;
  for (int n = 0; n < kTwice; ++n) {
    const burr_law_in_v1 in = likely(random);
    burr_law_out_v1 out = answer_to(in);
    hash = base::mix(hash, static_cast<std::uint64_t>(law.answer(in, out)));
    for (const double number :
         {out.force[0], out.force[1], out.force[2], out.energy_j, out.torque_nm})
      hash = base::mix(hash, number);
  }
  return hash;
}

// A second state of one copy shows what states share; a second copy, what a copy knows of the time or the machine.
nlohmann::json twice(const LawTrial& trial) {
  const Law one = opened(trial), other = opened(trial);
  const std::uint64_t first = answers_of(*one, trial.seed);
  const bool begun = one->begin().ok();
  const std::uint64_t anew = answers_of(*one, trial.seed);
  const std::uint64_t copy = answers_of(*other, trial.seed);
  return {{"same_state", begun && anew == first}, {"same_copy", copy == first}};
}

// The least time of each call in several runs of the same calls is the law's own work: what else the computer did in the
// meantime differs from run to run.
nlohmann::json by_the_clock(const LawTrial& trial) {
  const Law law = opened(trial);
  std::vector<std::int64_t> took(kTimed, std::numeric_limits<std::int64_t>::max());
  for (int run = 0; run < kTimedRuns && law->begin(); ++run) {
    Random random(trial.seed);
    for (std::int64_t& least : took) {
      const burr_law_in_v1 in = likely(random);
      burr_law_out_v1 out = answer_to(in);
      const std::int64_t before = rt::thread_cpu_ns();
      static_cast<void>(law->answer(in, out));
      least = std::min(least, rt::thread_cpu_ns() - before);
    }
  }
  std::sort(took.begin(), took.end());
  const auto at = [&took](double share) {
    return 1e-3 * static_cast<double>(
                      took[static_cast<std::size_t>(share * static_cast<double>(kTimed - 1))]);
  };
  return {{"p50_us", at(0.5)}, {"p99_us", at(0.99)}, {"max_us", at(1)}};
}

// A hand of 60 g on the PHANToM Omni's 45 g swings against a flat wall, along one axis.
nlohmann::json against_a_wall(const LawTrial& trial) {
  const Law law = opened(trial);
  bool off = false;
  const haptics::Controller controller = [&](const haptics::Sensed& sensed) {
    burr_law_in_v1 in = {};
    in.size = sizeof in;
    in.version = 1;
    in.dt = sensed.dt;
    in.hand[2] = sensed.place;
    in.proxy[2] = std::max(0.0, sensed.place);
    in.velocity[2] = sensed.velocity;
    in.axis[2] = 1;
    in.radius = 2e-3;
    in.stiffness = 1000;
    in.damping = 0.5;
    if (sensed.place < 0) {
      in.normal[2] = 1;
      in.depth = -sensed.place;
      in.touching = in.tissue = 1;
      in.price_j_m3 = 1e9;
    }
    burr_law_out_v1 out = answer_to(in);
    if (off || law->answer(in, out) != 0 || !tick::possible(out)) {
      off = true;
      return 0.0;
    }
    return out.force[2];
  };
  haptics::AxisSettings axis;
  axis.arm_mass = 0.06;
  axis.arm_damping = 5;
  axis.arm_stiffness = 200;
  axis.push = 0.5;
  axis.velocity_filter_hz = 100;
  const haptics::Swung swung = haptics::swing(axis, controller);
  return {{"stable", swung.stable(1e-6)}, {"least_j", swung.least_work_in}, {"off", off}};
}

nlohmann::json in_closed_loops(const LawTrial& trial) {
  using tick::ToolMode;
  const phantom::Depth flat = phantom::slab(), groove = phantom::groove(M_PI / 4);
  const Pressing kAll[] = {
      {.name = "touch", .bone = flat},
      {.name = "removing", .bone = flat, .mode = ToolMode::cut, .drag = 0},
      {.name = "groove_small_burr", .bone = groove, .radius = 1e-3},
      {.name = "groove_large_burr", .bone = groove, .radius = 3e-3},
      {.name = "stiff_hand", .bone = flat, .arm = {.mass = 0.3, .damping = 40, .stiffness = 3000}},
  };
  nlohmann::json loops = nlohmann::json::array();
  for (Pressing one : kAll) {
    one.law = opened(trial);
    const Lasting out = last(one, kSeconds);
    loops.push_back({{"name", one.name},
                     {"least_j", out.least},
                     {"end_j", out.energy},
                     {"force_n", out.force},
                     {"off", out.law_off || !out.ok}});
  }
  return loops;
}

}  // namespace

std::string try_law(const LawTrial& trial, LawStage& stage) {
  stage = 0;
  auto law = workshop::LawFile::open(trial.file, trial.settings);
  if (!law) return nlohmann::json({{"error", in_options(law.error()).text}}).dump();
  if (const Status begun = (*law)->begin(); !begun)
    return nlohmann::json({{"error", in_options(begun.error()).text}}).dump();
  nlohmann::json out;
  out["sha256"] = (*law)->about().sha256;
  stage = 1;
  out["no_numbers"] = with_no_numbers(trial);
  stage = 2;
  out["random"] = with_random_inputs(trial);
  stage = 3;
  out["twice"] = twice(trial);
  stage = 4;
  out["time"] = by_the_clock(trial);
  stage = 5;
  out["wall"] = against_a_wall(trial);
  out["loops"] = in_closed_loops(trial);
  return out.dump();
}

}  // namespace burr::app

// The sound of the drill: where its lines are, which part is louder, and that nothing clicks.
#include "burr/sound/synth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "burr/tool/spindle.h"
#include "sound/ear.h"
#include "support/rt_guard.h"

namespace burr::sound {
namespace {

using test::made;
using test::rad_s;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// After the lags have ended: 0.5 s, then `seconds` of samples to measure.
std::vector<float> steady(const SoundState& heard, double seconds = 65536 / test::kRate,
                          const SynthSettings& settings = {}) {
  Synth synth(settings);
  synth.update(heard);
  static_cast<void>(made(synth, 0.5));
  return made(synth, seconds);
}

SoundState turning(double rpm) { return {.spindle_rad_s = rad_s(rpm)}; }

// A burr that mills, with everything on.
SoundState milling(double mm3_s = 5) {
  SoundState heard = turning(40'000);
  heard.cutting_nm = 3e-3;
  heard.removal_m3_s = 1e-9 * mm3_s;
  heard.hardness_j_m3 = 1e9;
  heard.touching = true;
  return heard;
}

TEST(Synth, TheSpindleIsHeardOnceATurn) {
  for (const double rpm : {5'000.0, 12'345.0, 40'000.0, 80'000.0, 200'000.0})
    for (const double way : {1.0, -1.0})
      EXPECT_NEAR(test::peak_hz(steady(turning(way * rpm))), rpm / 60, 0.01 * rpm / 60)
          << way * rpm;
}

TEST(Synth, ItIsHeardOnceATurnThroughTheCuttingToo) {
  for (const double rpm : {20'000.0, 40'000.0, 80'000.0}) {
    SoundState heard = milling(20);
    heard.spindle_rad_s = rad_s(rpm);
    heard.irrigated = true;
    EXPECT_NEAR(test::peak_hz(steady(heard)), rpm / 60, 0.01 * rpm / 60) << rpm;
  }
}

// The motor's droop from its formula: K (w_set - w) = torque.
TEST(Synth, UnderLoadTheSpindleIsLowerByWhatTheMotorGivesWay) {
  tool::Spindle spindle;
  spindle.full_speed = rad_s(40'000);
  const double torque = 0.5 * spindle.motor.torque;
  for (int tick = 0; tick < 2'000; ++tick) spindle.step(1, torque, 1e-3);
  // half its torque costs half of its droop, and a little friction
  const double expected = 40'000 / 60.0 * (1 - 0.5 * spindle.motor.droop);
  SoundState heard = turning(0);
  heard.spindle_rad_s = spindle.speed();
  heard.cutting_nm = torque;
  EXPECT_NEAR(test::peak_hz(steady(heard)), expected, 0.01 * expected);
}

TEST(Synth, ATurnHasItsMultiplesAndItsTeeth) {
  SoundState heard = turning(30'000);
  heard.teeth = 7;
  const std::vector<float> samples = steady(heard);
  const std::vector<double> power = test::spectrum(samples);
  const double bin = test::kRate / static_cast<double>(samples.size());
  const auto around = [&](double hz) {
    double most = 0;
    for (double at = hz - 4 * bin; at <= hz + 4 * bin; at += bin)
      most = std::max(most, power[static_cast<std::size_t>(std::lround(at / bin))]);
    return most;
  };
  const double first = around(500);
  for (const int n : {2, 3, 4}) {
    EXPECT_GT(around(500 * n), 1e-4 * first) << n;
    EXPECT_LT(around(500 * n), first) << n;
  }
  EXPECT_GT(around(3'500), 1e-3 * first) << "seven teeth";
  EXPECT_LT(around(3'250), 1e-6 * first) << "nothing between";
  EXPECT_LT(around(3'000), 1e-6 * first) << "nor at six";
}

TEST(Synth, NothingIsHeardFoldedDownFromAboveHalfTheRate) {
  // 400 000 rpm: the third multiple is at 20 kHz; the fourth would be at 26.7, its alias at 21.3;
  // eight teeth at 53.3 kHz, their alias at 5.3
  const std::vector<float> samples = steady(turning(400'000));
  const std::vector<double> power = test::spectrum(samples);
  const double bin = test::kRate / static_cast<double>(samples.size());
  double first = 0, elsewhere = 0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    const double hz = static_cast<double>(k) * bin;
    const bool line = std::abs(std::remainder(hz, 400'000 / 60.0)) < 50 * bin;  // with its side
                                                                                // lobes
    double& most = line ? first : elsewhere;
    most = std::max(most, power[k]);
  }
  EXPECT_LT(elsewhere, 1e-7 * first);
}

TEST(Synth, TheMoreBoneTheLouder) {
  double before = 0;
  for (const double mm3_s : {0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0}) {
    SoundState heard = milling(mm3_s);
    const double now = test::rms(steady(heard));
    EXPECT_GT(now, 1.01 * before) << mm3_s;
    before = now;
  }
}

TEST(Synth, CuttingIsAsLoudAsItsFormulaSays) {
  // the noise alone: the gain restores what the band takes from white noise, for every tissue
  for (const double hardness : {0.02e9, 0.1e9, 1e9, 10e9}) {
    SoundState heard;
    heard.removal_m3_s = 5e-9;
    heard.hardness_j_m3 = hardness;
    const double expected = SynthSettings{}.cutting * std::sqrt(0.5);
    EXPECT_NEAR(test::rms(steady(heard, 4)), expected, 0.06 * expected) << hardness;
  }
}

// The power of the noise, in pieces of a twelfth of a stroke.
TEST(Synth, ASawBitesTwiceAStroke) {
  constexpr double kStrokes = 200;  // a second: 240 samples each
  const auto swell = [&](bool strokes) {
    SoundState heard = milling();
    heard.spindle_rad_s = 2 * M_PI * kStrokes;
    heard.cutting_nm = 0;
    heard.teeth = 0;
    heard.strokes = strokes;
    SynthSettings noise_only;
    noise_only.spindle = noise_only.knock = 0;
    const std::vector<float> samples = steady(heard, 4, noise_only);
    std::vector<double> power(12, 0);
    for (std::size_t n = 0; n < samples.size(); ++n)
      power[n % 240 / 20] += static_cast<double>(samples[n]) * static_cast<double>(samples[n]);
    return power;
  };
  const std::vector<double> saw = swell(true), burr = swell(false);
  const auto most = [](const std::vector<double>& of) {
    return *std::max_element(of.begin(), of.end());
  };
  const auto least = [](const std::vector<double>& of) {
    return *std::min_element(of.begin(), of.end());
  };
  EXPECT_GT(most(saw), 5 * least(saw));
  EXPECT_LT(most(burr), 1.5 * least(burr));
  // twice: half a stroke later it is the same again
  for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(saw[n], saw[n + 6], 0.25 * most(saw)) << n;
  double sum_saw = 0, sum_burr = 0;
  for (const double one : saw) sum_saw += one;
  for (const double one : burr) sum_burr += one;
  EXPECT_NEAR(sum_saw, sum_burr, 0.1 * sum_burr) << "as loud as a burr that removes as much";
}

TEST(Synth, EveryBlowKnocks) {
  SoundState heard;
  heard.touching = true;
  Synth synth;
  synth.update(heard);
  static_cast<void>(made(synth, 1));
  for (int blow = 0; blow < 3; ++blow) {
    heard.struck = true;
    synth.update(heard);
    EXPECT_GT(test::largest(made(synth, 0.1)), 0.3 * SynthSettings{}.knock);
    synth.update(heard);
    static_cast<void>(made(synth, 0.6));
    heard.struck = false;
    synth.update(heard);
    EXPECT_EQ(test::largest(made(synth, 0.1)), 0) << "one knock a blow";
  }
}

TEST(Synth, HarderTissueSoundsHigher) {
  double before = 0;
  for (const double hardness : {0.02e9, 0.1e9, 0.5e9, 1e9, 2e9, 10e9}) {
    SoundState heard;  // of the cutting alone: the lines of the spindle do not depend on it
    heard.removal_m3_s = 5e-9;
    heard.hardness_j_m3 = hardness;
    const double now = test::centroid_hz(steady(heard));
    EXPECT_GT(now, 1.1 * before) << hardness;
    before = now;
    EXPECT_NEAR(test::peak_hz(steady(heard)), cutting_hz(hardness), 0.8 * cutting_hz(hardness));
  }
}

TEST(Synth, LoadMakesTheTeethLouder) {
  const auto teeth = [](double torque) {
    SoundState heard = turning(40'000);
    heard.cutting_nm = torque;
    const std::vector<float> samples = steady(heard);
    const std::vector<double> power = test::spectrum(samples);
    const double at = 8 * 40'000 / 60.0 / test::kRate * static_cast<double>(samples.size());
    return power[static_cast<std::size_t>(std::lround(at))];
  };
  const double idle = teeth(0), loaded = teeth(3e-3), more = teeth(30e-3);
  EXPECT_GT(loaded, 1.5 * idle);
  EXPECT_GT(more, 1.2 * loaded);
}

TEST(Synth, CoolantHisses) {
  SoundState heard;
  heard.irrigated = true;
  const std::vector<float> samples = steady(heard);
  EXPECT_NEAR(test::rms(samples), SynthSettings{}.coolant, 0.1 * SynthSettings{}.coolant);
  EXPECT_GT(test::centroid_hz(samples), 4'000);
}

// Number of beeps in ten seconds; before each, silence of at least half the shortest gap.
int beeps(double to_spare) {
  SoundState heard;
  heard.to_spare = to_spare;
  const std::vector<float> samples = steady(heard, 10);
  int count = 0;
  int quiet = 1'000'000;
  for (const float x : samples) {
    if (std::abs(x) > 1e-3F) {
      if (quiet > 0.02 * test::kRate) ++count;
      quiet = 0;
    } else {
      ++quiet;
    }
  }
  return count;
}

TEST(Synth, TheNearerTheFasterTheWarning) {
  const SynthSettings usual;
  EXPECT_EQ(beeps(kInfinity), 0);
  EXPECT_EQ(beeps(usual.warn_from + 1e-6), 0);
  int before = 0;
  for (const double mm : {4.9, 4.0, 3.0, 2.0, 1.0, 0.6}) {
    const int now = beeps(1e-3 * mm);
    EXPECT_GT(now, before) << mm;
    EXPECT_NEAR(now, 10 / beep_every(usual, 1e-3 * mm), 1.01) << mm;
    before = now;
  }
  // one tone at the end: never silent
  SoundState heard;
  for (const double to_spare : {0.5e-3, 0.0, -1e-3, -kInfinity}) {
    heard.to_spare = to_spare;
    const std::vector<float> samples = steady(heard);
    EXPECT_NEAR(test::peak_hz(samples), usual.warn_hz, 2) << to_spare;
    EXPECT_NEAR(test::rms(samples), usual.warning * std::sqrt(0.5), 1e-3) << to_spare;
  }
  // in the structure: an octave lower, as loud
  heard.injured = true;
  const std::vector<float> samples = steady(heard);
  EXPECT_NEAR(test::peak_hz(samples), 0.5 * usual.warn_hz, 2);
  EXPECT_NEAR(test::rms(samples), usual.warning * std::sqrt(0.5), 1e-3);
}

TEST(Synth, WhoTremblesAtTheBorderIsNotWarnedInAHurry) {
  Synth synth;
  SoundState heard;
  std::vector<float> all;
  for (int n = 0; n < 1'000; ++n) {  // ten seconds, in and out every 10 ms
    heard.to_spare = 5e-3 + (n % 2 == 0 ? 1e-5 : -1e-5);
    synth.update(heard);
    const std::vector<float> some = made(synth, 0.01);
    all.insert(all.end(), some.begin(), some.end());
  }
  // beeps of 60 ms every 0.8 s, in and out: loud for at most that share of the time
  double loud = 0;
  for (const float x : all) loud += std::abs(x) > 1e-3F ? 1 : 0;
  EXPECT_GT(loud, 0);
  EXPECT_LT(loud, 0.1 * static_cast<double>(all.size()));
}

TEST(Synth, AContactKnocksOnceAndNotWhileItRattles) {
  SoundState heard;
  Synth synth;
  synth.update(heard);
  static_cast<void>(made(synth, 0.2));
  heard.touching = true;
  synth.update(heard);
  const std::vector<float> knock = made(synth, 0.1);
  EXPECT_GT(test::largest(knock), 0.3 * SynthSettings{}.knock);
  EXPECT_LT(std::abs(knock[3]), 0.1 * test::largest(knock)) << "it begins softly";
  static_cast<void>(made(synth, 0.5));
  EXPECT_EQ(test::largest(made(synth, 0.5)), 0) << "and is over";

  // in and out every millisecond
  Synth rattled;
  std::vector<float> all;
  for (int n = 0; n < 500; ++n) {
    heard.touching = n % 2 == 0;
    rattled.update(heard);
    const std::vector<float> some = made(rattled, 1e-3);
    all.insert(all.end(), some.begin(), some.end());
  }
  EXPECT_LT(test::largest(test::end_of(all, all.size() / 2)), 1e-4) << "one knock, long over";
}

// A parameter that jumps must not click: from before the jump to half a second after it, the sound
// bends no more sharply than it does before or after by itself.
TEST(Synth, NothingClicksWhateverLeaps) {
  const SoundState quiet;
  const SoundState busy = [] {
    SoundState heard = milling(20);
    heard.irrigated = true;
    heard.to_spare = 0;
    return heard;
  }();
  struct Leap {
    const char* what;
    SoundState from, to;
  };
  std::vector<Leap> leaps = {{"all on", quiet, busy}, {"all off", busy, quiet}};
  const auto leap = [&leaps](const char* what, auto change) {
    SoundState from = turning(40'000), to = from;
    change(to);
    leaps.push_back({what, from, to});
    leaps.push_back({what, to, from});
  };
  leap("stop", [](SoundState& h) { h.spindle_rad_s = 0; });
  leap("backwards", [](SoundState& h) { h.spindle_rad_s *= -1; });
  leap("half speed", [](SoundState& h) { h.spindle_rad_s /= 2; });
  leap("teeth", [](SoundState& h) { h.teeth = 12; });
  leap("no teeth", [](SoundState& h) { h.teeth = 0; });
  leap("load", [](SoundState& h) { h.cutting_nm = 30e-3; });
  leap("contact", [](SoundState& h) { h.touching = true; });
  leap("warning", [](SoundState& h) { h.to_spare = 0; });
  leap("injury", [](SoundState& h) {
    h.to_spare = -1e-3;
    h.injured = true;
  });
  leap("beeps", [](SoundState& h) { h.to_spare = 2e-3; });
  leaps.push_back({"contact", quiet, {.touching = true}});
  leaps.push_back({"first beep", quiet, {.to_spare = 2e-3}});
  for (const Leap& one : leaps)
    for (std::size_t later = 0; later < 8; ++later) {  // at any phase of its oscillators
      Synth synth;
      synth.update(one.from);
      static_cast<void>(made(synth, 0.5 + static_cast<double>(7 * later) / test::kRate));
      std::vector<float> all = made(synth, 0.5);
      double bends = test::sharpest(all);
      synth.update(one.to);
      const std::vector<float> after = made(synth, 0.5);
      all.insert(all.end(), after.begin(), after.end());
      bends = std::max(bends, test::sharpest(test::end_of(after, after.size() / 2)));
      // a sound of a short moment bends like its own line at its loudest
      const auto line = [&bends](double loud, double hz) {
        bends = std::max(bends, loud * std::pow(2 * M_PI * hz / test::kRate, 2));
      };
      if (one.to.touching) line(SynthSettings{}.knock, cutting_hz(1e9) / 3);
      if (std::isfinite(one.to.to_spare)) line(SynthSettings{}.warning, SynthSettings{}.warn_hz);
      EXPECT_LT(test::sharpest(all), 1.3 * bends) << one.what << ", " << later;
    }
  // noise bends by chance: with cutting and coolant alone, fifty jumps of each
  for (const bool coolant : {false, true}) {
    Synth synth;
    SoundState heard, none;
    heard.removal_m3_s = coolant ? 0 : 20e-9;
    heard.hardness_j_m3 = 1e9;
    heard.irrigated = coolant;
    synth.update(heard);
    static_cast<void>(made(synth, 1));
    const double bends = test::sharpest(made(synth, 10));
    double leapt = 0;
    for (int n = 0; n < 50; ++n) {
      synth.update(n % 2 == 0 ? none : heard);
      leapt = std::max(leapt, test::sharpest(made(synth, 0.2)));
    }
    EXPECT_LT(leapt, 1.1 * bends) << coolant;
  }
}

TEST(Synth, LouderAndQuieterDoNotClick) {
  Synth synth;
  synth.update(milling(0));
  static_cast<void>(made(synth, 0.5));
  const double bends = test::sharpest(made(synth, 1));
  for (const double loud : {0.0, 1.0, 0.1, 1.0}) {
    synth.loudness(loud);
    EXPECT_LT(test::sharpest(made(synth, 0.3)), 1.05 * bends) << loud;
  }
}

// A click contains all frequencies: measures what a change of loudness or speed puts above 16 kHz,
// where neither has a line.
TEST(Synth, NothingIsHeardWhereNothingIs) {
  const auto beyond = [](const std::vector<float>& samples) {
    const std::vector<double> power = test::spectrum(samples);
    double high = 0, all = 0;
    for (std::size_t k = 0; k < power.size(); ++k) {
      all += power[k];
      if (static_cast<double>(k) * test::kRate > 16e3 * static_cast<double>(samples.size()))
        high += power[k];
    }
    return 10 * std::log10(high / all);  // [dB]
  };
  SoundState heard = turning(40'000);
  heard.teeth = 0;
  for (const bool speed : {false, true}) {
    Synth synth;
    synth.update(heard);
    static_cast<void>(made(synth, 0.5));
    std::vector<float> samples;
    for (int n = 0; n < 8; ++n) {
      heard.spindle_rad_s = test::rad_s(speed && n % 2 == 0 ? 20'000 : 40'000);
      synth.update(heard);
      synth.loudness(!speed && n % 2 == 0 ? 0 : 1);
      const std::vector<float> some = made(synth, 0.2);
      samples.insert(samples.end(), some.begin(), some.end());
    }
    EXPECT_LT(beyond(samples), -120) << speed;
  }
}

TEST(Synth, WithNothingToBeHeardItIsSilentExactly) {
  Synth synth;
  const auto silent = [&synth](double seconds) {
    bool zeros = true;
    for (const float x : made(synth, seconds)) zeros &= x == 0;
    return zeros;
  };
  EXPECT_TRUE(silent(1)) << "at the start";
  synth.update({});
  EXPECT_TRUE(silent(1)) << "nothing";
  SoundState busy = milling();
  busy.irrigated = true;
  busy.to_spare = 1e-3;
  synth.update(busy);
  EXPECT_FALSE(silent(1));
  synth.update({});
  static_cast<void>(made(synth, 3));
  EXPECT_TRUE(silent(1)) << "again";
  synth.update(busy);
  synth.loudness(0);
  static_cast<void>(made(synth, 3));
  EXPECT_TRUE(silent(1)) << "off";
}

TEST(Synth, TheSameWordsAreTheSameSamples) {
  const auto some = [](std::size_t block) {
    Synth synth;
    std::vector<float> all;
    for (int n = 0; n < 20; ++n) {
      SoundState heard = milling(n);
      heard.to_spare = 1e-3 * n / 4;
      synth.update(heard);
      for (std::size_t left = 960; left > 0;) {
        std::vector<float> part(std::min(block, left));
        synth.make(part);
        all.insert(all.end(), part.begin(), part.end());
        left -= part.size();
      }
    }
    return all;
  };
  EXPECT_EQ(some(960), some(960));
  EXPECT_EQ(some(960), some(17)) << "however many are asked for at once";
}

TEST(Synth, NeverLouderThanFullScaleAndNeverNotANumberWhateverItIsTold) {
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
  std::printf("BURR_SEED=%llu\n", static_cast<unsigned long long>(seed));
  std::mt19937_64 random(seed);
  SynthSettings loud;
  loud.spindle = loud.tooth = loud.cutting = loud.knock = loud.coolant = loud.warning = 1;
  Synth synth(loud);
  const std::vector<double> odd = {0,     1,      -1,    kInfinity, -kInfinity, std::nan(""),
                                   1e300, 1e-300, 4'000, 1e-9,      1e9,        -1e-3};
  const auto any = [&] { return odd[random() % odd.size()]; };
  for (int n = 0; n < 2'000; ++n) {
    SoundState heard;
    heard.spindle_rad_s = any();
    heard.teeth = static_cast<int>(random());
    heard.cutting_nm = any();
    heard.removal_m3_s = any();
    heard.hardness_j_m3 = any();
    heard.touching = random() % 2 == 0;
    heard.irrigated = random() % 2 == 0;
    heard.to_spare = any();
    synth.update(heard);
    synth.loudness(any());
    std::vector<float> samples(random() % 700);
    synth.make(samples);
    for (const float x : samples) ASSERT_LE(std::abs(x), 1.0F);  // false for a NaN
  }
}

TEST(Synth, OddSettingsAreHeldToWhatCanBe) {
  const double nan = std::nan("");
  SynthSettings odd;
  odd.rate_hz = nan;
  odd.spindle = 1e9;
  odd.half_speed_hz = odd.half_removal = odd.half_torque = 0;
  odd.warn_from = -1;
  odd.beep_fast = odd.beep_slow = odd.beep = 0;
  odd.warn_hz = kInfinity;
  Synth synth(odd);
  SoundState heard = milling();
  heard.to_spare = 0.1e-3;
  synth.update(heard);
  for (const float x : made(synth, 1)) ASSERT_LE(std::abs(x), 1.0F);
}

TEST(Synth, WhatIsLoudIsBentAndWhatIsNotIsLeftAlone) {
  // the warning alone is a sine: a quiet one keeps its shape, a loud one is compressed, none
  // reaches 1
  for (const double loud : {0.1, 0.7, 1.0}) {
    SynthSettings settings;
    settings.warning = loud;
    SoundState heard;
    heard.to_spare = 0;
    const std::vector<float> samples = steady(heard, 65536 / test::kRate, settings);
    const std::vector<double> power = test::spectrum(samples);
    const double third = 3 * settings.warn_hz / test::kRate * static_cast<double>(samples.size());
    const double share = power[static_cast<std::size_t>(std::lround(third))] /
                         *std::max_element(power.begin(), power.end());
    if (loud > 0.7) {
      EXPECT_GT(share, 1e-5);
      EXPECT_LT(test::largest(samples), 0.9);
    } else {
      EXPECT_LT(share, 1e-9) << loud;
      EXPECT_NEAR(test::largest(samples), loud, 1e-3);
    }
  }
}

TEST(Synth, TakesNoMemoryAndNoLock) {
  Synth synth;
  std::vector<float> samples(512);
  SoundState heard = milling();
  heard.irrigated = true;
  heard.to_spare = 1e-3;
  const test::RtGuard guard;
  for (int n = 0; n < 200; ++n) {
    heard.touching = n % 20 < 10;
    heard.teeth = n % 12;
    synth.update(heard);
    synth.loudness(n % 3 == 0 ? 0 : 1);
    synth.make(samples);
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

}  // namespace
}  // namespace burr::sound

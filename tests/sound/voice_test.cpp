// The door between the thread that sets the sound and the one that plays it, and the loudspeaker
// behind it.
#include "burr/sound/voice.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "sound/ear.h"
#include "support/rt_guard.h"

namespace burr::sound {
namespace {

SoundState turning(double rpm) { return {.spindle_rad_s = test::rad_s(rpm)}; }

// `seconds` of sound in blocks as a device asks for them; heard: set before each block, or nullptr.
std::vector<float> played(Voice& voice, double seconds, const SoundState* heard) {
  std::vector<float> all, block(512);
  while (static_cast<double>(all.size()) < seconds * test::kRate) {
    if (heard != nullptr) voice.update(*heard);
    voice.make(block);
    all.insert(all.end(), block.begin(), block.end());
  }
  return all;
}

TEST(Voice, IsSilentUntilItIsToldSomething) {
  Voice voice;
  EXPECT_EQ(test::largest(played(voice, 1, nullptr)), 0);
}

TEST(Voice, FadesWhenNobodySpeaksAndComesBack) {
  Voice voice;
  const SoundState heard = turning(40'000);
  const double loud = test::rms(test::end_of(played(voice, 1, &heard), 9'600));
  EXPECT_GT(loud, 0.05);
  // 0.2 s without update() change nothing
  EXPECT_NEAR(test::rms(test::end_of(played(voice, 0.19, nullptr), 1'000)), loud, 0.1 * loud);
  const std::vector<float> fading = played(voice, 1, nullptr);
  EXPECT_EQ(test::largest(test::end_of(fading, 9'600)), 0) << "silent";
  const std::vector<float> again = played(voice, 1, &heard);
  EXPECT_NEAR(test::rms(test::end_of(again, 9'600)), loud, 0.02 * loud);
  // and neither clicks
  const double bends = test::sharpest(test::end_of(again, 9'600));
  EXPECT_LT(test::sharpest(fading), 1.05 * bends);
  EXPECT_LT(test::sharpest(again), 1.05 * bends);
}

TEST(Voice, TwoToolsAreHeardBesideEachOther) {
  Voice voice;
  const SoundState first = turning(40'000);
  voice.update_second(turning(30'000));
  const std::vector<float> both = played(voice, 3, &first);
  EXPECT_LE(test::largest(both), 1);
  const std::vector<float> end = test::end_of(both, 96'000);
  const std::vector<double> power = test::spectrum(end);
  const auto at = [&](double hz) {
    return power[static_cast<std::size_t>(std::lround(hz * 96'000 / test::kRate))];
  };
  EXPECT_GT(at(2000.0 / 3), 1e3 * at(580)) << "the first";
  EXPECT_GT(at(500), 1e3 * at(580)) << "the second";
  // and both fall silent when nobody speaks
  EXPECT_EQ(test::largest(test::end_of(played(voice, 1, nullptr), 9'600)), 0);
}

TEST(Voice, OffIsSilentAndOnIsBack) {
  Voice voice;
  const SoundState heard = turning(40'000);
  const double loud = test::rms(test::end_of(played(voice, 1, &heard), 9'600));
  voice.on(false);
  EXPECT_FALSE(voice.is_on());
  EXPECT_EQ(test::largest(test::end_of(played(voice, 1, &heard), 9'600)), 0);
  voice.on(true);
  EXPECT_NEAR(test::rms(test::end_of(played(voice, 1, &heard), 9'600)), loud, 0.02 * loud);
  voice.loudness(0.5);
  EXPECT_NEAR(test::rms(test::end_of(played(voice, 1, &heard), 9'600)), 0.5 * loud, 0.02 * loud);
}

TEST(Voice, TakesNoMemoryAndNoLock) {
  Voice voice;
  std::vector<float> block(512);
  const test::RtGuard guard;
  for (int n = 0; n < 100; ++n) {
    voice.update(turning(1'000.0 * n));
    voice.on(n % 7 != 0);
    voice.make(block);
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(guard.locks(), 0);
}

// One thread calls hear(), another plays, a third presses the key: ThreadSanitizer watches. The
// sound is never a mixture of two settings, which would be heard as a third speed.
TEST(Voice, ThreeThreadsAtOnce) {
  Voice voice;
  std::atomic<bool> done = false;
  std::thread feeder([&] {
    for (int n = 0; !done; ++n) {
      SoundState heard = turning(40'000);
      heard.touching = n % 2 == 0;
      heard.cutting_nm = n % 3 == 0 ? 1e-3 : 0;
      voice.update(heard);
      std::this_thread::yield();
    }
  });
  std::thread key([&] {
    while (!done) {
      voice.loudness(0.9);
      voice.on(true);
      std::this_thread::yield();
    }
  });
  std::vector<float> all, block(512);
  for (int n = 0; n < 400; ++n) {
    voice.make(block);
    all.insert(all.end(), block.begin(), block.end());
    std::this_thread::yield();
  }
  done = true;
  feeder.join();
  key.join();
  // if the machine let the feeding thread run at all
  if (test::largest(all) > 0) {
    EXPECT_NEAR(test::peak_hz(test::end_of(all, 65'536)), 666.7, 7);
  }
}

}  // namespace
}  // namespace burr::sound

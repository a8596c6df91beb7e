// The whole path of sound without a loudspeaker: SDL's own drivers, which play nothing or write to
// a file.
#include "burr/sound/speaker.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "sound/ear.h"
#include "support/folder.h"

namespace burr::sound {
namespace {

using namespace std::chrono_literals;

// An environment variable, set while this object lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

// Plays until the device has taken this many more samples; false: it never does.
bool speak(Speaker& speaker, const SoundState& heard, double seconds) {
  const std::uint64_t until = speaker.made() + static_cast<std::uint64_t>(seconds * test::kRate);
  const auto given_up = std::chrono::steady_clock::now() + 120s;
  while (speaker.made() < until) {
    if (std::chrono::steady_clock::now() > given_up) return false;
    speaker.voice().update(heard);
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

TEST(Speaker, PlaysToNobody) {
  const Variable driver("SDL_AUDIODRIVER", "dummy");
  const SoundState heard = {.spindle_rad_s = test::rad_s(40'000)};
  for (int round = 0; round < 2; ++round) {  // and opens it again
    auto speaker = Speaker::open();
    ASSERT_TRUE(speaker) << speaker.error().text;
    EXPECT_EQ((*speaker)->driver(), "dummy");
    EXPECT_TRUE(speak(**speaker, heard, 0.3));
  }
}

TEST(Speaker, WhatComesOutIsWhatWasSaid) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.raw";
  {
    const Variable driver("SDL_AUDIODRIVER", "disk"), where("SDL_DISKAUDIOFILE", file);
    auto speaker = Speaker::open();
    ASSERT_TRUE(speaker) << speaker.error().text;
    EXPECT_EQ((*speaker)->driver(), "disk");
    ASSERT_TRUE(speak(**speaker, {.spindle_rad_s = test::rad_s(30'000)}, 2));
  }
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  std::vector<float> samples(bytes.size() / sizeof(float));
  std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(float));
  ASSERT_GE(samples.size(), 65'536U + 24'000U);
  const std::span<const float> last = std::span<const float>(samples).subspan(24'000, 65'536);
  EXPECT_NEAR(test::peak_hz(last), 500, 5);
  EXPECT_NEAR(test::rms(last), 0.08, 0.03);
  EXPECT_LE(test::largest(samples), 1);
}

TEST(Speaker, WithoutADeviceItSaysSoInOneSentence) {
  const Variable driver("SDL_AUDIODRIVER", "no-such-driver");
  const auto speaker = Speaker::open();
  ASSERT_FALSE(speaker);
  EXPECT_NE(speaker.error().text.find("no sound: "), std::string::npos) << speaker.error().text;
  EXPECT_NE(speaker.error().text.find("check the system's sound settings"), std::string::npos);
  EXPECT_EQ(speaker.error().text.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace burr::sound

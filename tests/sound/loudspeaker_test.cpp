// The key and the loudness of the window's sound, and that the window works without a sound device.
#include "window/mill/loudspeaker.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace burr::app {
namespace {

struct Driver {
  explicit Driver(const char* name) { ::setenv("SDL_AUDIODRIVER", name, 1); }
  ~Driver() { ::unsetenv("SDL_AUDIODRIVER"); }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
};

TEST(Loudspeaker, ObeysItsKeys) {
  const Driver driver("dummy");
  Loudspeaker loudspeaker({}, {});
  EXPECT_EQ(loudspeaker.trouble(), "");
  loudspeaker.update({});
  EXPECT_TRUE(loudspeaker.is_on());
  loudspeaker.toggle();
  EXPECT_FALSE(loudspeaker.is_on());
  loudspeaker.update({});
  loudspeaker.toggle();
  EXPECT_TRUE(loudspeaker.is_on());
  EXPECT_EQ(loudspeaker.louder(1), 0) << "it is the loudest already";
  EXPECT_EQ(loudspeaker.louder(-1), -3);
  EXPECT_EQ(loudspeaker.louder(-100), -48);
  EXPECT_EQ(loudspeaker.louder(2), -42);
}

TEST(Loudspeaker, WithoutADeviceItIsSilentAndTriesAgainWhenAsked) {
  Driver none("no-such-driver");
  Loudspeaker loudspeaker({}, {});
  EXPECT_NE(loudspeaker.trouble(), "");
  loudspeaker.update({});
  loudspeaker.toggle();
  EXPECT_FALSE(loudspeaker.is_on());
  EXPECT_NE(loudspeaker.trouble(), "");
  EXPECT_EQ(loudspeaker.louder(-1), -3);
  const Driver there("dummy");
  loudspeaker.toggle();
  EXPECT_TRUE(loudspeaker.is_on());
  EXPECT_EQ(loudspeaker.trouble(), "");
}

// The loudest sample since the last call: SDL's disk driver appends raw floats.
float loudest_since(const std::filesystem::path& file, std::streamoff& from) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(from);
  float most = 0;
  for (float x = 0; in.read(reinterpret_cast<char*>(&x), sizeof x); from += sizeof x)
    most = std::max(most, std::abs(x));
  return most;
}

TEST(Loudspeaker, WarnsFromTheRimOfTheBurrThatIsThereNow) {
  const Driver driver("disk");
  const test::Folder folder;
  const std::filesystem::path file = folder / "s.raw";
  ::setenv("SDL_DISKAUDIOFILE", file.c_str(), 1);
  tick::TickRow row;
  // a session that practises warns below 1 mm only
  for (const double limit : {std::numeric_limits<double>::infinity(), 1e-3}) {
    row.tool.radius = 6e-3;
    Loudspeaker loudspeaker(
        {}, [](const math::Vec3&) { return 6.01e-3; }, limit);
    ASSERT_EQ(loudspeaker.trouble(), "");
    std::streamoff heard = 0;
    const auto sounds = [&] {
      float most = 0;
      for (int n = 0; n < 80; ++n) {  // of 10 ms each
        loudspeaker.update(row);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        // samples that were under way at the time of the request do not count
        const float now = loudest_since(file, heard);
        if (n >= 20) most = std::max(most, now);
      }
      return most;
    };
    EXPECT_GT(sounds(), 1e-3F) << "a hundredth of a millimetre from what is to be spared";
    row.tool.radius = 4.5e-3;
    if (limit > 1e-3)
      EXPECT_GT(sounds(), 1e-3F) << "1.5 mm from it";
    else
      EXPECT_LT(sounds(), 1e-6F) << "1.5 mm from it";
    row.tool.radius = 0.5e-3;
    EXPECT_LT(sounds(), 1e-6F) << "a smaller burr is 5.5 mm away from it";
  }
  ::unsetenv("SDL_DISKAUDIOFILE");
}

}  // namespace
}  // namespace burr::app

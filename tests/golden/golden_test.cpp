// Every view and effect against the picture somebody once looked at and found right. Formula bones
// only, drawn by the processor. A graphics card rounds otherwise and is left out, unless
// BURR_GOLDEN_ANY_GPU=1.
//
// A request to change them: BURR_GOLDEN_WRITE=1 test_golden, look at tests/golden/*.png, commit.
#include <gtest/gtest.h>
#include <sys/wait.h>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "render/gpu.h"
#include "support/folder.h"
#include "support/test_places.h"

namespace burr {
namespace {

namespace fs = std::filesystem;

// ---- how different two pictures look

struct Seen {
  int width = 0, height = 0;
  std::vector<std::array<double, 3>> lab;
};

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

// CIE 1976 L*a*b* of an sRGB pixel under D65 (CIE 15:2004, 8.2.1)
std::array<double, 3> lab_of(const unsigned char* rgb) {
  const double r = linear(rgb[0] / 255.0), g = linear(rgb[1] / 255.0), b = linear(rgb[2] / 255.0);
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505),
               y = f(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// As from an arm's length: each pixel with its neighbours, so that an edge may move by a part of
// one.
std::optional<Seen> look_at(const fs::path& path) {
  int width = 0, height = 0, channels = 0;
  unsigned char* rgb = stbi_load(path.c_str(), &width, &height, &channels, 3);
  if (rgb == nullptr) return std::nullopt;
  std::vector<std::array<double, 3>> sharp(static_cast<std::size_t>(width) *
                                           static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < sharp.size(); ++i) sharp[i] = lab_of(rgb + 3 * i);
  stbi_image_free(rgb);
  Seen seen{width, height, sharp};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::array<double, 3> sum{};
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) {
          const int at = std::clamp(y + v, 0, height - 1) * width + std::clamp(x + u, 0, width - 1);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += sharp[static_cast<std::size_t>(at)][c] / 9;
        }
      seen.lab[static_cast<std::size_t>(y * width + x)] = sum;
    }
  return seen;
}

struct Difference {
  double mean = 0;     // dE*ab; 2.3 is what an eye just notices (Mahy et al. 1994)
  double noticed = 0;  // share of pixels that differ by more than that
};

Difference between(const Seen& a, const Seen& b) {
  Difference d;
  for (std::size_t i = 0; i < a.lab.size(); ++i) {
    const double e =
        std::hypot(a.lab[i][0] - b.lab[i][0], a.lab[i][1] - b.lab[i][1], a.lab[i][2] - b.lab[i][2]);
    d.mean += e / static_cast<double>(a.lab.size());
    d.noticed += e > 2.3 ? 1 / static_cast<double>(a.lab.size()) : 0;
  }
  return d;
}

// ---- pictures, as the program leaves them

struct Shot {
  const char* name;
  const char* of;     // see kSessions
  const char* words;  // behind `burr replay RECORDING --picture FILE`
};
std::ostream& operator<<(std::ostream& out, const Shot& shot) { return out << shot.name; }

struct Session {
  const char* name;
  const char* words;  // behind `burr mill`
};
constexpr Session kSessions[] = {
    {"mastoid", "phantom:temporal-bone --voxel-mm 0.5 --motion pocket --burr-mm 5 --seconds 8"},
    {"wet",
     "phantom:temporal-bone --voxel-mm 0.5 --motion pocket --burr-mm 5 --seconds 4 --heat "
     "--irrigation"},
    {"pedicle", "phantom:spine --voxel-mm 0.6 --motion plunge --burr-mm 4 --seconds 20"},
    {"tooth", "phantom:tooth --voxel-mm 0.2 --motion touch --burr-mm 1 --seconds 1"},
    {"jaw", "phantom:jaw --voxel-mm 0.8 --motion touch --burr-mm 5 --seconds 1"},
    {"spine", "phantom:spine --voxel-mm 0.6 --motion touch --burr-mm 4 --seconds 1"},
    {"skull", "phantom:skull --voxel-mm 1.2 --motion touch --burr-mm 6 --seconds 1"},
};

constexpr Shot kShots[] = {
    {"work", "mastoid", ""},
    {"close", "mastoid", "--height-mm 12"},
    {"whole", "mastoid", "--view whole"},
    {"microscope", "mastoid", "--view microscope"},
    {"endoscope", "mastoid", "--view endoscope"},
    {"axial", "mastoid", "--view axial"},
    {"coronal", "mastoid", "--view coronal"},
    {"sagittal", "mastoid", "--view sagittal"},
    {"cut_open", "mastoid", "--clip axial"},
    {"without_labels", "mastoid", "--view sagittal --no-labels"},
    {"see_through", "mastoid", "--see-through 65"},
    {"dust", "mastoid", "--effects --height-mm 20"},
    {"wet", "wet", "--effects --height-mm 20"},
    {"blood", "pedicle", "--effects --view microscope"},
    {"side_by_side", "mastoid", "--stereo side-by-side"},
    {"anaglyph", "mastoid", "--stereo anaglyph"},
    {"interleaved", "mastoid", "--stereo interleaved"},
    {"before", "mastoid", "--at 0"},
    {"tooth", "tooth", "--view whole"},
    {"tooth_cut_open", "tooth", "--view whole --clip coronal"},
    {"jaw", "jaw", "--view whole"},
    {"spine", "spine", "--view whole"},
    {"skull", "skull", "--view whole"},
};

class Golden : public testing::TestWithParam<Shot> {
 protected:
  static fs::path folder() {
    static const test::Folder one;
    return one.path();
  }
  static int run(const std::string& words) {
    const int left = std::system(
        (test::build_dir() + "/burr --quiet " + words + " --picture-size 240,150 > /dev/null")
            .c_str());
    return WIFEXITED(left) ? WEXITSTATUS(left) : -1;
  }
  static fs::path recording(const std::string& of) { return folder() / (of + ".mcap"); }
  static void record(const std::string& of) {
    if (fs::exists(recording(of))) return;
    for (const Session& session : kSessions)
      if (session.name == of) {
        ASSERT_EQ(run("mill " + (session.words + (" --record " + recording(of).string()))), 0);
      }
  }
};

TEST_P(Golden, LooksAsItDid) {
  BURR_NEEDS_GPU(gpu);
  if (!gpu.software() && std::getenv("BURR_GOLDEN_ANY_GPU") == nullptr)
    GTEST_SKIP() << gpu.gpu() << " rounds otherwise than llvmpipe; BURR_GOLDEN_ANY_GPU=1 compares";
  const Shot& shot = GetParam();
  const std::string name = std::string(shot.name) + ".png";
  const fs::path golden = fs::path(test::source_dir()) / "tests/golden" / name;
  ASSERT_NO_FATAL_FAILURE(record(shot.of));
  const fs::path made = folder() / name;
  ASSERT_EQ(run("replay " + recording(shot.of).string() + " --picture " + made.string() + " " +
                shot.words),
            0);
  if (std::getenv("BURR_GOLDEN_WRITE") != nullptr)
    fs::copy_file(made, golden, fs::copy_options::overwrite_existing);

  const auto now = look_at(made), then = look_at(golden);
  ASSERT_TRUE(now) << "no picture was left";
  ASSERT_TRUE(then) << golden.string() << " is missing";
  ASSERT_EQ(now->width, then->width);
  ASSERT_EQ(now->height, then->height);
  const Difference d = between(*now, *then);
  const bool same = d.mean < 0.3 && d.noticed < 0.004;
  const fs::path kept = fs::path(test::build_dir()) / ("golden_" + name);
  if (!same) fs::copy_file(made, kept, fs::copy_options::overwrite_existing);
  if (!gpu.software())
    std::printf("%s: %.3f on average, %.3f %% noticeably\n", shot.name, d.mean, 100 * d.noticed);
  EXPECT_TRUE(same) << "differs by " << d.mean << " on average, " << 100 * d.noticed
                    << " % noticeably; compare " << kept.string() << " with " << golden.string();
}

INSTANTIATE_TEST_SUITE_P(Of, Golden, testing::ValuesIn(kShots),
                         [](const auto& shot) { return std::string(shot.param.name); });

}  // namespace
}  // namespace burr

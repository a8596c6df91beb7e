// Films on disk: ffprobe reads back the count, size and length that burr printed before the work.
#include "shared/film_file.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "support/folder.h"
#include "support/test_places.h"
#include "window/parts/film_job.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

struct Ended {
  int code = -1;
  std::string said;  // on both streams
};
Ended run(const std::string& command) {
  Ended out;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return out;
  std::array<char, 4096> some = {};
  for (std::size_t got = 0; (got = std::fread(some.data(), 1, some.size(), pipe)) > 0;)
    out.said.append(some.data(), got);
  const int left = ::pclose(pipe);
  out.code = WIFEXITED(left) ? WEXITSTATUS(left) : -1;
  return out;
}

const std::string kBurr = test::build_dir() + "/burr --quiet ";

// "h264,160,100,1.000000,5": codec, width, height, duration, pictures counted by decoding them
std::string probed(const fs::path& film) {
  std::string said = run("ffprobe -v error -count_frames -select_streams v -show_entries "
                         "stream=codec_name,width,height,duration,nb_read_frames -of csv=p=0 " +
                         film.string())
                         .said;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  return said;
}

// One second of a slot in a block, recorded once for all.
class FilmFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    own() = std::make_unique<test::Folder>();
    const Ended made = run(kBurr +
                           "mill phantom:block --voxel-mm 1 --motion slot --burr-mm 5 --seconds 1 "
                           "--record " +
                           recording());
    ASSERT_EQ(made.code, 0) << made.said;
  }
  static void TearDownTestSuite() { own().reset(); }
  static std::unique_ptr<test::Folder>& own() {
    static std::unique_ptr<test::Folder> folder;
    return folder;
  }
  static const fs::path& folder() { return own()->path(); }
  static std::string recording() { return (folder() / "s.mcap").string(); }
  static std::string film() { return (folder() / "s.mp4").string(); }
  static Ended filmed(const std::string& options, const std::string& before = "") {
    return run(before + kBurr + "replay " + recording() + " --fps 10 --film " + film() + " " +
               options);
  }
  // neither a film nor a piece of one
  static bool nothing_left() {
    for (const auto& entry : fs::directory_iterator(folder()))
      if (entry.path() != recording() && !fs::is_directory(entry.path())) return false;
    return true;
  }
  void TearDown() override { fs::remove(film()); }
};

TEST_F(FilmFiles, HaveThePicturesTheSizeAndTheLengthThatWereSaidBefore) {
  const Ended whole = filmed("--picture-size 160,100");
  ASSERT_EQ(whole.code, 0) << whole.said;
  EXPECT_NE(whole.said.find("1.0 s, 10 pictures of 160 x 100 pixels, 10 a second, about 0.1 MB"),
            std::string::npos)
      << whole.said;
  EXPECT_EQ(probed(film()), "h264,160,100,1.000000,10");
  // for a player that guesses nothing
  const std::string colours = run("ffprobe -v error -select_streams v -show_entries "
                                  "stream=pix_fmt,color_space -of csv=p=0 " +
                                  film())
                                  .said;
  EXPECT_EQ(colours, "yuv420p,bt709\n");

  const Ended part = filmed("--picture-size 96,64 --from 0.3 --until 0.7");
  ASSERT_EQ(part.code, 0) << part.said;
  EXPECT_NE(part.said.find("0.4 s, 4 pictures of 96 x 64 pixels"), std::string::npos) << part.said;
  EXPECT_EQ(probed(film()), "h264,96,64,0.400000,4") << "the older film was replaced";
}

TEST_F(FilmFiles, ShowThePartThatWasAskedFor) {
  // the first picture of the part is that of the command for pictures
  const fs::path pictures = folder() / "pictures";
  ASSERT_EQ(run(kBurr + "replay " + recording() + " --fps 10 --picture-size 96,64 --film " +
                pictures.string())
                .code,
            0);
  const fs::path part = folder() / "part";
  ASSERT_EQ(run(kBurr + "replay " + recording() +
                " --fps 10 --picture-size 96,64 --from 0.5 --until 0.8 --film " + part.string())
                .code,
            0);
  const auto bytes = [](const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  for (int n = 1; n <= 3; ++n)
    EXPECT_TRUE(bytes(part / fmt::format("frame_{:06d}.png", n)) ==
                bytes(pictures / fmt::format("frame_{:06d}.png", n + 5)))
        << n;
  EXPECT_FALSE(fs::exists(part / "frame_000004.png"));
}

TEST_F(FilmFiles, SayInOneSentenceWhyThereIsNone) {
  const auto refused = [](const Ended& ended, int code, const std::string& words) {
    EXPECT_EQ(ended.code, code) << ended.said;
    EXPECT_NE(ended.said.find(words), std::string::npos) << ended.said;
    EXPECT_TRUE(nothing_left());
  };
  refused(filmed("", "PATH=/nowhere "), 74, "needs the program ffmpeg, which is not installed");
  refused(filmed("--picture-size 161,100"), 2, "use 162,100");
  refused(filmed("--from 0.8 --until 0.2"), 2, "a film must end after it begins");
  // an ffmpeg that cannot do it
  const fs::path other = folder() / "other";
  fs::create_directories(other);
  std::ofstream(other / "ffmpeg") << "#!/bin/sh\necho 'Unknown encoder libx264' >&2\nexit 1\n";
  fs::permissions(other / "ffmpeg", fs::perms::owner_all);
  const Ended ended = filmed("--picture-size 160,100", "PATH=" + other.string() + ":$PATH ");
  EXPECT_EQ(ended.code, 74) << ended.said;
  EXPECT_NE(ended.said.find("ffmpeg made no film: Unknown encoder libx264"), std::string::npos)
      << ended.said;
  EXPECT_TRUE(nothing_left());
  std::ofstream(film()) << "my own notes";
  const Ended kept = filmed("");
  EXPECT_EQ(kept.code, 2) << kept.said;
  EXPECT_NE(kept.said.find("is not a .mp4 file"), std::string::npos) << kept.said;
}

TEST_F(FilmFiles, LeaveNothingWhenStopped) {
  // Ctrl-C as soon as it films: the pixels of a large picture take a while. --foreground: timeout
  // then sends one signal; a second one ends burr at once, as a second Ctrl-C does
  const Ended stopped =
      run("timeout --foreground --signal=INT 2 " + test::build_dir() + "/burr --percent replay " +
          recording() + " --fps 200 --picture-size 1920,1080 --film " + film());
  EXPECT_NE(stopped.said.find("filming 0 %"), std::string::npos) << stopped.said;
  EXPECT_NE(stopped.said.find("stopped; no film was written"), std::string::npos) << stopped.said;
  EXPECT_TRUE(nothing_left());
}

TEST(FilmPlan, CountsPicturesAndBytes) {
  FilmPlan plan{.from = 2, .until = 12, .fps = 25, .size = {1920, 1080}};
  EXPECT_EQ(plan.frames(), 250);
  EXPECT_DOUBLE_EQ(plan.moment(25), 3);
  EXPECT_NEAR(plan.bytes(), 250 * 1920 * 1080 * 0.25 / 8, 1);
  plan.one_file = false;
  EXPECT_NEAR(plan.bytes(), 250 * 1920 * 1080 * 5.0 / 8, 1);
  plan.until = 2.001;
  EXPECT_EQ(plan.frames(), 1);
  plan = {.from = 0.3, .until = 0.7, .fps = 10};
  EXPECT_EQ(plan.frames(), 4) << "0.7 - 0.3 is less than 0.4 in doubles";
  EXPECT_EQ(in_megabytes(40), "0.1 MB");
  EXPECT_EQ(in_megabytes(3.24e6), "3.2 MB");
  EXPECT_EQ(in_megabytes(123.4e6), "123 MB");
  EXPECT_EQ(in_megabytes(1.44e9), "1.4 GB");
}

}  // namespace
}  // namespace burr::app

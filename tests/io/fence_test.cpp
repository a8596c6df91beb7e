// The real fence: a reader that crashes, hangs, uses up memory, tries to reach files, the network
// and other programs, or reports false results (naughty/naughty_reader.cpp), called through
// io::read_scan like any other. Each case ends in its own sentence, and nothing else happens.
#include "burr/io/sandbox/fence.h"

#include <dirent.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

#include "burr/io/read/read_scan.h"
#include "burr/io/sandbox/fence_walls.h"
#include "io/folder_of_test.h"
#include "support/data.h"
#include "support/test_places.h"

namespace burr::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::size_t open_files() {
  std::size_t n = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (folder != nullptr && ::readdir(folder) != nullptr) ++n;
  if (folder != nullptr) ::closedir(folder);
  return n;
}

class Fence : public test::FolderTest {
 protected:
  Fence() { ::setenv("BURR_READ", (test::build_dir() + "/naughty_reader").c_str(), 1); }
  ~Fence() override { ::unsetenv("BURR_READ"); }

  // Reads a file that tells the reader to do `todo`.
  Result<Scan> ask(const std::string& todo, const ReadOptions& options = {}) {
    std::ofstream(path("todo.txt")) << todo;
    NoProgress progress;
    return read_scan(path("todo.txt"), options, progress);
  }
  // The sentence of the refusal, which names the file.
  std::string said(const std::string& todo, const ReadOptions& options = {}) {
    const auto start = Clock::now();
    auto scan = ask(todo, options);
    EXPECT_LT(seconds_since(start), 60) << "hangs";
    if (scan) return "(a scan)";
    EXPECT_EQ(scan.error().trouble, Trouble::data) << todo;
    EXPECT_EQ(scan.error().text.find('\n'), std::string::npos) << scan.error().text;
    return scan.error().text;
  }
};

testing::AssertionResult has(const std::string& text, const std::string& words) {
  if (text.find(words) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << words << "\" is not in \"" << text << "\"";
}
#define EXPECT_SAYS(sentence, words) EXPECT_TRUE(has(sentence, words))

TEST_F(Fence, LetsThroughWhatIsRead) {
  const auto scan = ask("behave");
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->format, "naughty");
  EXPECT_EQ(scan->values, Voxels<float>(8, 1.0F));
  EXPECT_SAYS(said("threads"), "threads work");
}

TEST_F(Fence, ACrashIsASentence) {
  for (const char* how : {"crash", "abort", "divide", "leave"})
    EXPECT_SAYS(said(how), "todo.txt: reading it crashed");
}

TEST_F(Fence, AnEndlessLoopIsASentence) {
  ReadOptions options;
  options.seconds = 1;
  EXPECT_SAYS(said("loop", options), "took more than 1 s of processor time");
  EXPECT_SAYS(said("sleep", options), "made no progress for 1 s");
}

TEST_F(Fence, HungerIsASentence) {
  if (!fence_state().memory_limit) GTEST_SKIP() << "no limit of memory in a sanitized build";
  ReadOptions options;
  options.memory_mb = 512;
  EXPECT_SAYS(said("eat", options), "more memory than allowed");
  EXPECT_SAYS(said("eat_quietly", options), "no more memory");
  // pages that were touched, by all children so far: far less than was requested
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  EXPECT_LT(usage.ru_maxrss, 700 * 1024) << "KiB";
}

TEST_F(Fence, LentMemoryHasTheSameLimit) {
  ReadOptions options;
  options.memory_mb = 512;
  EXPECT_SAYS(said("eat_voxels", options), "more memory than allowed");
}

TEST_F(Fence, OpensFewFiles) { EXPECT_SAYS(said("open_many"), "few files"); }

TEST_F(Fence, OpensNothingOutsideItsFile) {
  if (fence_state().landlock == 0) GTEST_SKIP() << "needs a kernel with Landlock";
  std::ofstream(path("beside.txt")) << "secret";
  const std::string outside = folder.string() + "-outside";
  std::ofstream(outside) << "secret";
  EXPECT_SAYS(said("open " + path("todo.txt")), "it worked");
  EXPECT_SAYS(said("open /etc/passwd"), "refused");
  EXPECT_SAYS(said("open " + path("beside.txt")), "refused");
  EXPECT_SAYS(said("open " + outside), "refused");
  EXPECT_SAYS(said("open /proc/self/environ"), "refused");
  EXPECT_SAYS(said("list /"), "refused");
  // a header may name a file beside it, and no other
  const auto header = [&](const std::string& other) {
    std::ofstream(path("x.mhd")) << "open " << other;
    NoProgress progress;
    return read_scan(path("x.mhd"), {}, progress).error().text;
  };
  EXPECT_SAYS(header(path("beside.txt")), "it worked");
  EXPECT_SAYS(header(outside), "refused");
  EXPECT_SAYS(header("/etc/passwd"), "refused");
  // a link that the user names is followed; one inside the folder is not
  std::filesystem::create_symlink("/etc/passwd", folder / "link.txt");
  EXPECT_SAYS(header(path("link.txt")), "refused");
  std::filesystem::remove(outside);
}

TEST_F(Fence, ReachesNobody) {
  if (!fence_state().seccomp) GTEST_SKIP() << "needs a kernel with seccomp";
  for (const std::string what :
       {"socket", "run", "fork", "trace", "kill", "raise_limit", "write /dev/null"})
    EXPECT_SAYS(said(what), "tried something that no reader needs") << what;
  EXPECT_SAYS(said("write " + path("new")), "tried something that no reader needs");
  EXPECT_SAYS(said("unlink " + path("todo.txt")), "tried something that no reader needs");
  EXPECT_SAYS(said("rename " + path("new")), "tried something that no reader needs");
  EXPECT_SAYS(said("code"), "refused");
  EXPECT_EQ(files(), 1) << "nothing was written";
}

TEST_F(Fence, BelievesNoLie) {
  for (const char* lie :
       {"lie_size", "lie_negative", "lie_axes", "lie_spacing", "lie_values", "lie_label",
        "lie_both", "lie_letter", "lie_nothing", "lie_short", "lie_kind", "lie_back"})
    EXPECT_SAYS(said(lie), "todo.txt: the reader sent an invalid answer") << lie;
  const auto scan = ask("lie_words");
  ASSERT_TRUE(scan.ok());
  EXPECT_EQ(scan->notices.at(0), " [2Jgone  ") << "steers no terminal";
}

TEST_F(Fence, LeavesNothingBehind) {
  (void)ask("behave");
  const std::size_t before = open_files();
  for (const char* what : {"behave", "crash", "lie_size", "lie_short"}) (void)ask(what);
  EXPECT_EQ(open_files(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

// Records the reports, and can be told to cancel.
class Listener final : public Progress {
 public:
  void report(double fraction, std::string_view stage) override {
    last = fraction;
    heard = std::string(stage);
    if (stop_when_heard) stop = true;
  }
  [[nodiscard]] bool cancelled() const override { return stop; }
  double last = -1;
  std::string heard;
  bool stop_when_heard = false;
  std::atomic<bool> stop{false};
};

TEST_F(Fence, ProgressComesThrough) {
  std::ofstream(path("todo.txt")) << "work";
  Listener progress;
  ASSERT_TRUE(read_scan(path("todo.txt"), {}, progress).ok());
  EXPECT_EQ(progress.heard, "working");
  EXPECT_EQ(progress.last, 1.0);
}

TEST_F(Fence, CancellingEndsTheReader) {
  std::ofstream(path("todo.txt")) << "work_on";
  Listener progress;
  progress.stop_when_heard = true;
  const auto scan = read_scan(path("todo.txt"), {}, progress);
  ASSERT_FALSE(scan.ok());
  EXPECT_EQ(scan.error().trouble, Trouble::interrupted);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "the reader still lives";
}

class Teller final : public Progress {
 public:
  explicit Teller(int to) : to_(to) {}
  void report(double /*fraction*/, std::string_view /*stage*/) override {
    EXPECT_EQ(::write(to_, "x", 1), 1);
  }
  [[nodiscard]] bool cancelled() const override { return false; }

 private:
  int to_;
};

TEST_F(Fence, TheReaderDiesWithItsCaller) {
  std::ofstream(path("todo.txt")) << "work_on";
  int ends[2] = {};
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t caller = ::fork();
  if (caller == 0) {
    Teller progress(ends[1]);
    (void)read_scan(path("todo.txt"), {}, progress);
    ::_exit(0);
  }
  ::close(ends[1]);
  char heard = 0;
  ASSERT_EQ(::read(ends[0], &heard, 1), 1) << "the reader reads";
  // its only child, according to the kernel
  std::ifstream children("/proc/" + std::to_string(caller) + "/task/" + std::to_string(caller) +
                         "/children");
  pid_t reader = 0;
  children >> reader;
  ::kill(caller, SIGKILL);
  ::waitpid(caller, nullptr, 0);
  ::close(ends[0]);
  if (reader == 0) GTEST_SKIP() << "needs /proc/PID/task/PID/children";
  const auto start = Clock::now();
  bool alive = true;
  while (alive && seconds_since(start) < 20) {
    std::ifstream status("/proc/" + std::to_string(reader) + "/stat");
    std::string number, name, state;
    status >> number >> name >> state;
    alive = !state.empty() && state != "Z" && state != "X";
    if (alive) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(alive);
}

TEST_F(Fence, ServesManyThreadsAtOnce) {
  std::ofstream(path("todo.txt")) << "behave";
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      for (int n = 0; n < 5; ++n) {
        NoProgress progress;
        if (read_scan(path("todo.txt"), {}, progress).ok()) ++good;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 40);
}

TEST_F(Fence, WithoutItsReaderNothingIsRead) {
  ::setenv("BURR_READ", path("nothing").c_str(), 1);
  const auto none = ask("behave");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().trouble, Trouble::io);
  EXPECT_SAYS(none.error().text, "install burr again");
  EXPECT_SAYS(fence_words(), "install burr again");
  ::setenv("BURR_READ", "/bin/true", 1);
  EXPECT_FALSE(ask("behave").ok()) << "another program is no reader";
}

TEST(FenceHere, SaysHowHighItIs) {
  const FenceState state = fence_state();
  EXPECT_TRUE(std::filesystem::exists(state.reader)) << state.reader;
  EXPECT_SAYS(fence_words(state), "in a separate process");
}

TEST_F(Fence, StartedByHandTheReaderSaysSo) {
  EXPECT_SAYS(output_of("'" + test::build_dir() + "/burr-read' </dev/null"),
              "do not start it by hand");
}

}  // namespace
}  // namespace burr::io

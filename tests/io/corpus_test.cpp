// Every file of the corpus is described or refused with one sentence. Nothing crashes or hangs, or
// allocates what a false header claims, and none of the files needs the fence, which is for
// problems that nobody has foreseen. A second reader must see the same in each file.
//
// Where our result differs from that of the corpus or of the second reader, docs/develop/corpus.md
// says why, in tables that are read here. A difference that is not in them makes the test fail, and
// so does a row for a difference that no longer exists.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"
#include "support/data.h"
#include "support/test_places.h"

namespace burr::io {
namespace {

constexpr int kHangs = 100;  // [s] of wall time; the limit itself is in processor time

struct Outcome {
  int code = -1;       // exit code of the program; -1: killed
  int signal = 0;      // signal that killed it
  double seconds = 0;  // processor time, with the reader behind the fence
  double peak_mb = 0;  // largest memory of either process
  std::string said;    // both outputs
};

// Runs the program on one path, without limits of this test: the fence has its own.
Outcome info(const std::string& path) {
  int pipe_ends[2] = {};
  if (::pipe2(pipe_ends, O_CLOEXEC) != 0) return {};
  const std::string program = test::build_dir() + "/burr";
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(kHangs);
    ::dup2(pipe_ends[1], STDOUT_FILENO);
    ::dup2(pipe_ends[1], STDERR_FILENO);
    ::execl(program.c_str(), "burr", "--quiet", "info", path.c_str(), "--json", nullptr);
    ::_exit(127);
  }
  ::close(pipe_ends[1]);
  Outcome outcome;
  char part[4096];
  for (ssize_t n = 0; (n = ::read(pipe_ends[0], part, sizeof part)) > 0;)
    outcome.said.append(part, static_cast<std::size_t>(n));
  ::close(pipe_ends[0]);
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  outcome.seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  outcome.peak_mb = static_cast<double>(used.ru_maxrss) / 1024;
  return outcome;
}

// Processor time that a file may take: 10 s, and 1 us for each voxel of the bone that is made of it. A scan
// of nothing but noise, resampled upright, is bone with a surface in every brick.
double most_seconds(const std::string& said) {
  static const std::regex kBone("bone of ([0-9]+) x ([0-9]+) x ([0-9]+) voxels");
  std::smatch size;
  double voxels = std::regex_search(said, size, kBone) ? 1 : 0;
  for (std::size_t n = 1; n < size.size(); ++n) voxels *= std::stod(size[n]);
  return 10 + 1e-6 * voxels;
}

// Calls work(n) for 0..count-1 on two threads.
template <class Work>
void on_two_threads(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t n = next++; n < count; n = next++) work(n);
  };
  std::thread second(take);
  take();
  second.join();
}

std::filesystem::path corpus() { return test::data_dir() / "corpus"; }

struct Entry {
  std::string path, expect;
};

// Single files, and the slices of a series as their folder.
std::vector<Entry> entries() {
  std::vector<Entry> all;
  std::set<std::string> folders;
  std::ifstream manifest(corpus() / "manifest.tsv");
  std::string line;
  std::getline(manifest, line);
  while (std::getline(manifest, line)) {
    std::vector<std::string> fields;
    std::istringstream split(line);
    for (std::string field; std::getline(split, field, '\t');) fields.push_back(field);
    if (fields.size() < 5) continue;
    std::string path = fields[0];
    if (path.rfind("dicom_series", 0) == 0 || path.find("/series_") != std::string::npos) {
      path = path.substr(0, path.rfind('/'));
      if (!folders.insert(path).second) continue;
    }
    all.push_back({path, fields[4]});
  }
  return all;
}

// Reads a table of docs/develop/corpus.md under a heading; for each path in the first column its
// whole row. "| `a`, `b` | ... | why |"
std::map<std::string, std::string> listed_under(const std::string& heading) {
  std::map<std::string, std::string> rows;
  std::ifstream page(std::filesystem::path(test::source_dir()) / "docs" / "develop" / "corpus.md");
  bool there = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind('#', 0) == 0) there = line.find(heading) != std::string::npos;
    if (!there || line.rfind("| `", 0) != 0) continue;
    const std::string files = line.substr(0, line.find(" |", 2));
    for (std::size_t at = files.find('`'); at != std::string::npos; at = files.find('`', at)) {
      const std::size_t end = files.find('`', at + 1);
      rows[files.substr(at + 1, end - at - 1)] = line;
      at = end + 1;
    }
  }
  return rows;
}

// The last column: the reason.
std::string reason(const std::string& row) {
  const std::size_t end = row.rfind(" |"), begin = row.rfind("| ", end - 1);
  return row.substr(begin + 2, end - begin - 2);
}

// True for sentences of the fence: the readers themselves did not find the problem.
bool said_by_the_fence(const std::string& text) {
  const std::array<const char*, 7> words = {"reading it crashed",     "processor time",
                                            "made no progress",       "memory than allowed",
                                            "no reader needs",        "sent an invalid answer",
                                            "was ended by the system"};
  return std::any_of(words.begin(), words.end(),
                     [&](const char* part) { return text.find(part) != std::string::npos; });
}

TEST(Corpus, EveryFileIsReadOrRefusedWithASentence) {
  BURR_NEEDS_DATA("corpus/manifest.tsv");
  const std::vector<Entry> all = entries();
  ASSERT_GT(all.size(), 400U);
  std::vector<Outcome> outcomes(all.size());
  on_two_threads(all.size(),
                 [&](std::size_t n) { outcomes[n] = info((corpus() / all[n].path).string()); });

  const auto listed = listed_under("Where burr judges otherwise");
  std::set<std::string> found;
  int loaded = 0, refused = 0;
  double longest = 0, largest = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const auto& [path, expect] = all[n];
    const Outcome& outcome = outcomes[n];
    SCOPED_TRACE(path + " (" + expect + ")");
    ASSERT_EQ(outcome.signal, 0) << outcome.said;
    EXPECT_LT(outcome.seconds, most_seconds(outcome.said));
    EXPECT_LT(outcome.peak_mb, 2048);
    longest = std::max(longest, outcome.seconds);
    largest = std::max(largest, outcome.peak_mb);
    const bool read = outcome.code == 0;
    if (!read) {
      EXPECT_EQ(outcome.code, 65) << outcome.said;
      EXPECT_EQ(outcome.said.rfind("burr: ", 0), 0U) << outcome.said;
      EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
      EXPECT_EQ(outcome.said.find("unexpected"), std::string::npos) << outcome.said;
      EXPECT_FALSE(said_by_the_fence(outcome.said)) << outcome.said;
    }
    ++(read ? loaded : refused);
    const bool free_choice = expect.find(" or ") != std::string::npos ||
                             expect.find(" if ") != std::string::npos ||
                             expect.find(';') != std::string::npos;
    const bool must_load = expect.rfind("load", 0) == 0,
               must_refuse = expect.rfind("reject", 0) == 0;
    const bool differs = !free_choice && (read ? must_refuse : must_load);
    if (differs) found.insert(path);
    const auto row = listed.find(path);
    std::printf("%-9s %-8s %-60s %s\n", differs ? "disagree" : "agree", read ? "loads" : "refuses",
                path.c_str(), differs && row != listed.end() ? reason(row->second).c_str() : "");
    EXPECT_EQ(differs, row != listed.end())
        << (differs
                ? "docs/develop/corpus.md does not say why burr judges otherwise: " + outcome.said
                : "docs/develop/corpus.md calls it a difference, and it is none");
  }
  for (const auto& [path, row] : listed) EXPECT_EQ(found.count(path), 1U) << row;
  std::printf("%d loaded, %d refused; %zu judged otherwise; at most %.2f s and %.0f MB\n", loaded,
              refused, found.size(), longest, largest);
  EXPECT_GT(loaded, 150);
  EXPECT_GT(refused, 100);
}

// What a reader of any kind found in a file.
struct Seen {
  std::vector<int> size;
  std::vector<math::Vec3> corners;  // of the box of voxel centres, LPS mm, sorted
  double low = 0, high = 0;
};

std::vector<math::Vec3> corners(const std::vector<int>& size, const math::Mat3& step,
                                const math::Vec3& origin) {
  std::vector<math::Vec3> all;
  for (int n = 0; n < 8; ++n) {
    math::Vec3 ijk;
    for (int a = 0; a < 3; ++a)
      ijk[a] = (n >> a & 1) != 0 ? size[static_cast<std::size_t>(a)] - 1 : 0;
    all.push_back(origin + step * ijk);
  }
  std::sort(all.begin(), all.end(), [](const math::Vec3& p, const math::Vec3& q) {
    for (int a = 0; a < 3; ++a)
      if (std::abs(p[a] - q[a]) > 2e-3) return p[a] < q[a];
    return false;
  });
  return all;
}

Seen seen(const Scan& scan) {
  Seen out;
  for (int a = 0; a < 3; ++a) out.size.push_back(scan.size[a]);
  out.corners = corners(out.size, scan.axes * scan.spacing_mm.asDiagonal(), scan.origin_mm);
  if (scan.values.empty()) {
    const auto [low, high] = std::minmax_element(scan.labels.begin(), scan.labels.end());
    out.low = *low, out.high = *high;
  } else {
    const auto [low, high] = std::minmax_element(scan.values.begin(), scan.values.end());
    out.low = *low, out.high = *high;
  }
  return out;
}

Seen seen(const nlohmann::json& found) {
  Seen out;
  out.size = found["size"].get<std::vector<int>>();
  math::Mat3 step;
  math::Vec3 origin;
  for (int a = 0; a < 3; ++a) {
    origin[a] = found["origin"][static_cast<std::size_t>(a)].get<double>();
    for (int b = 0; b < 3; ++b)
      step(b, a) =
          found["step"][static_cast<std::size_t>(a)][static_cast<std::size_t>(b)].get<double>();
  }
  out.corners = corners(out.size, step, origin);
  out.low = found["low"].get<double>();
  out.high = found["high"].get<double>();
  return out;
}

// Empty: there is no difference.
std::string difference(const Scan& scan, const nlohmann::json& found) {
  Seen own = seen(scan), other = seen(found);
  if (found["reader"] == "dcm2niix") {  // changes the order of a stack's axes; compare the corners
    std::sort(own.size.begin(), own.size.end());
    std::sort(other.size.begin(), other.size.end());
  }
  std::ostringstream text;
  if (own.size != other.size)
    text << " size " << own.size[0] << " " << own.size[1] << " " << own.size[2] << " against "
         << other.size[0] << " " << other.size[1] << " " << other.size[2];
  double farthest = 0, longest = 1;
  for (std::size_t n = 0; n < 8; ++n) {
    farthest = std::max(farthest, (own.corners[n] - other.corners[n]).norm());
    longest = std::max(longest, own.corners[n].norm());
  }
  // the other readers print six digits
  if (!(farthest < 2e-3 + 2e-5 * longest)) text << " a corner lies " << farthest << " mm apart";
  // we replace values below the scanner's range, outside its view, by air
  const double floor = scan.format == "DICOM" && scan.hounsfield ? -1024.0 : other.low;
  const double low = std::max(other.low, floor), high = std::max(other.high, floor);
  const double close = 1e-5 * std::max({1.0, std::abs(low), std::abs(high)});
  if (!(std::abs(own.low - low) <= close)) text << " lowest " << own.low << " against " << low;
  if (!(std::abs(own.high - high) <= close)) text << " highest " << own.high << " against " << high;
  return text.str();
}

using CorpusAgainst = test::FolderTest;

TEST_F(CorpusAgainst, ASecondReaderSeesTheSame) {
  BURR_NEEDS_DATA("corpus/manifest.tsv");
  const std::vector<Entry> all = entries();
  std::vector<Result<Scan>> scans(all.size(), error("not read"));
  on_two_threads(all.size(), [&](std::size_t n) {
    NoProgress progress;
    scans[n] = read_scan(corpus() / all[n].path, {}, progress);
  });
  std::map<std::string, const Scan*> loaded;
  {
    std::ofstream list(path("list"));
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (!scans[n].ok()) {
        EXPECT_FALSE(said_by_the_fence(scans[n].error().text)) << scans[n].error().text;
        continue;
      }
      loaded[all[n].path] = &*scans[n];
      list << all[n].path << "\n";
    }
  }
  EXPECT_GT(loaded.size(), 150U);
#if defined(BURR_SANITIZED)
  return;  // that it is read without a fault is all that this build adds
#endif
  for (const char* program : {"teem-unu --version", "nifti_tool -ver", "gdcminfo --version",
                              "dcm2niix -h", "python3 --version"})
    if (output_of(program).find("not found") != std::string::npos)
      GTEST_SKIP() << "needs " << program;

  const std::string script = test::source_dir() + "/tests/io/second_readers.py";
  std::istringstream answers(
      output_of("python3 '" + script + "' '" + corpus().string() + "' < '" + path("list") + "'"));
  const auto listed = listed_under("Where a second reader sees something else");
  std::set<std::string> found;
  std::size_t compared = 0, answered = 0;
  for (std::string line; std::getline(answers, line);) {
    const auto other = nlohmann::json::parse(line, nullptr, false);
    ASSERT_FALSE(other.is_discarded()) << line;
    ++answered;
    const std::string name = other["path"];
    const std::string what = other.contains("refuses")
                                 ? " the other refuses: " + other["refuses"].get<std::string>()
                                 : difference(*loaded.at(name), other);
    ++compared;
    const auto row = listed.find(name);
    if (!what.empty()) found.insert(name);
    std::printf("%-9s %-60s%s\n", what.empty() ? "same" : "different", name.c_str(), what.c_str());
    EXPECT_EQ(what.empty(), row == listed.end())
        << name << ":" << (what.empty() ? " docs/develop/corpus.md calls it different" : what);
  }
  EXPECT_EQ(answered, loaded.size());
  for (const auto& [name, row] : listed) EXPECT_EQ(found.count(name), 1U) << row;
  std::printf("%zu compared, %zu of them different\n", compared, found.size());
}

// No name, id or date of a patient may come out of a file: the values of those DICOM fields are
// searched in all of burr's output about the files.
TEST(Corpus, NoPatientComesOutOfADicomFile) {
  BURR_NEEDS_DATA("skull_phantom/bone_1mm_jpegls");
  const auto data = test::data_dir();
  const std::vector<std::filesystem::path> sources = {
      data / "skull_phantom" / "std_5mm_jpegll",
      data / "skull_phantom" / "junk_in_same_study",
      data / "corpus" / "dicom" / "pydicom" / "CT_small.dcm",
      data / "corpus" / "dicom" / "pydicom" / "MR_small.dcm",
      data / "corpus" / "derived" / "dicom" / "ok.dcm",
      data / "corpus" / "derived" / "dicom" / "pixeldata_missing.dcm",
      data / "corpus" / "derived" / "dicom" / "trunc_in_header.dcm"};
  // Patient's Name, ID, Birth Date; Study Date, Accession Number, Institution, physicians; UIDs
  const std::vector<std::array<unsigned, 2>> tags = {
      {0x10, 0x10}, {0x10, 0x20}, {0x10, 0x30}, {0x08, 0x20}, {0x08, 0x50},
      {0x08, 0x80}, {0x08, 0x90}, {0x20, 0x0D}, {0x20, 0x0E}, {0x08, 0x1030}};
  int looked_for = 0;
  for (const auto& source : sources) {
    std::vector<std::filesystem::path> files = {source};
    if (std::filesystem::is_directory(source)) {
      files.clear();
      for (const auto& file : std::filesystem::directory_iterator(source))
        files.push_back(file.path());
    }
    const Outcome outcome = info(source.string());
    ASSERT_EQ(outcome.signal, 0);
    EXPECT_EQ(outcome.said.find(source.parent_path().string()), std::string::npos)
        << "a path: " << outcome.said;
    for (const auto& file : files) {
      std::ifstream stream(file, std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
      for (const auto& [group, element] : tags) {
        const std::string mark = {static_cast<char>(group & 0xFF), static_cast<char>(group >> 8),
                                  static_cast<char>(element & 0xFF),
                                  static_cast<char>(element >> 8)};
        const std::size_t at = bytes.find(mark);
        if (at == std::string::npos || at + 8 > bytes.size() || bytes[at + 4] < 'A' ||
            bytes[at + 4] > 'Z')
          continue;
        const auto length =
            static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 6]) |
                                     static_cast<unsigned char>(bytes[at + 7]) << 8);
        std::string value = bytes.substr(at + 8, length);
        while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.pop_back();
        if (value.size() < 4) continue;
        ++looked_for;
        EXPECT_EQ(outcome.said.find(value), std::string::npos) << file << ": " << value;
      }
    }
  }
  EXPECT_GT(looked_for, 50);
}

}  // namespace
}  // namespace burr::io

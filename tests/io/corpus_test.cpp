// Every file of the corpus through `burr info`, each in a process of its own with little memory and
// little time: it is described or refused with one sentence; nothing crashes, hangs or takes what a
// header lies about. Where we judge otherwise than the corpus does: docs/corpus.md.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/data.h"

namespace burr::io {
namespace {

struct Outcome {
  int code = -1;     // of the program; -1: killed
  int signal = 0;    // that killed it
  std::string said;  // both outputs
};

// Runs the program on one path, with 1.5 GiB of address space and 20 s of processor time.
Outcome info(const std::string& path) {
  int pipe_ends[2] = {};
  if (::pipe(pipe_ends) != 0) return {};
  const std::string program = std::string(BURR_BUILD_DIR) + "/burr";
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit memory{std::size_t{1536} << 20, std::size_t{1536} << 20}, time{20, 20};
    ::setrlimit(RLIMIT_AS, &memory);
    ::setrlimit(RLIMIT_CPU, &time);
    ::dup2(pipe_ends[1], STDOUT_FILENO);
    ::dup2(pipe_ends[1], STDERR_FILENO);
    ::close(pipe_ends[0]);
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
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

struct Entry {
  std::string path, expect;
};

// Files one by one; the slices of a series as their folder.
std::vector<Entry> entries() {
  std::vector<Entry> all;
  std::set<std::string> folders;
  std::ifstream manifest(test::data_dir() / "corpus" / "manifest.tsv");
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

// Ours is the other judgement, and docs/corpus.md says why.
bool we_differ(const std::string& path) {
  static const std::set<std::string> named = {
      "dicom/fo_dicom/GH195.dcm",
      "dicom/fo_dicom/GH538-jpeg1.dcm",
      "dicom/fo_dicom/GH538-jpeg14sv1.dcm",
      "dicom/fo_dicom/GH626.dcm",
      "nifti/nifti_rs/resources/minimal2.hdr",
      "nifti/nifti_rs/resources/minimal2.img.gz",
      "nifti/nifti_rs/resources/minimal_extended_hdr.nii",
      "nifti/nifti_rs/resources/rgb/4D.nii",
      "nifti/nifti_rs/resources/rgb/3D.nii",
      "nifti/nifti_rs/resources/rgba/4D.nii",
      "nifti/nifti_rs/resources/complex/complex32.nii",
      "nifti/nifti_rs/resources/complex/complex64.nii",
      "nifti/nibabel/example_nifti2.nii.gz",
      "nifti/nifti_test_data/ATestReferenceImageForReadingAndWriting.nii.gz",
      "nrrd/pynrrd/BallBinary30x30x30_byteskip_minus_five.nhdr",
      "nrrd/pynrrd/test1d_ascii.nrrd",
      "nrrd/pynrrd/test2d_ascii.nrrd",
      "nrrd/pynrrd/test_customFields.nrrd",
      "nrrd/pynrrd/test_simple4d_raw.nrrd",
      "metaimage/metaimageformat_jl/test/example.raw",
      "dicom_series/dicom2nifti/failing/slicecount/001"};
  return named.count(path) != 0;
}

TEST(Corpus, EveryFileIsReadOrRefusedWithASentence) {
  BURR_NEEDS_DATA("corpus/manifest.tsv");
  const std::vector<Entry> all = entries();
  ASSERT_GT(all.size(), 400U);
  std::vector<Outcome> outcomes(all.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t n = next++; n < all.size(); n = next++)
      outcomes[n] = info((test::data_dir() / "corpus" / all[n].path).string());
  };
  std::thread second(work);
  work();
  second.join();

  int loaded = 0, refused = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const auto& [path, expect] = all[n];
    const Outcome& outcome = outcomes[n];
    SCOPED_TRACE(path + " (" + expect + ")");
    ASSERT_EQ(outcome.signal, 0) << outcome.said;
    const bool read = outcome.code == 0;
    if (!read) {
      EXPECT_TRUE(outcome.code == 65 || outcome.code == 74) << outcome.code << " " << outcome.said;
      EXPECT_EQ(outcome.said.rfind("burr: ", 0), 0U) << outcome.said;
      EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
      EXPECT_EQ(outcome.said.find("unexpected"), std::string::npos) << outcome.said;
      EXPECT_EQ(outcome.said.find("not enough memory"), std::string::npos) << outcome.said;
    }
    ++(read ? loaded : refused);
    const bool free_choice = expect.find(" or ") != std::string::npos ||
                             expect.find(" if ") != std::string::npos ||
                             expect.find(';') != std::string::npos;
    if (free_choice || we_differ(path)) continue;
    const bool must_load = expect.rfind("load", 0) == 0,
               must_refuse = expect.rfind("reject", 0) == 0;
    EXPECT_TRUE(read || !must_load) << outcome.said;
    EXPECT_FALSE(read && must_refuse) << outcome.said;
  }
  EXPECT_GT(loaded, 150);
  EXPECT_GT(refused, 100);
}

// A name, an id or a date of a patient must not come out of a file through us: what the DICOM files
// hold in those fields is looked for in all that burr says about them.
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

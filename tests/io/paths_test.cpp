// Nothing outside the given folder is opened, and nothing but regular files: by the readers
// themselves, without the fence, so that it also holds on a kernel without Landlock.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <set>

#include "burr/io/read/read_scan.h"
#include "burr/io/read/readers.h"
#include "io/folder_of_test.h"
#include "support/data.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

// Half of the voxels; the readers must never see the bytes of what lies outside.
const std::string kInside = "abcd", kOutside = "wxyz";

class Paths : public test::FolderTest {
 protected:
  Paths() {
    ::alarm(120);  // opening a pipe that nobody writes to would wait for ever
    fs::create_directory(folder / "in");
    write("outside.raw", kOutside + kOutside);
    write("in/inside.raw", kInside + kInside);
    fs::create_directory(folder / "elsewhere");
    write("elsewhere/inside.raw", kOutside + kOutside);
    fs::create_symlink(folder / "outside.raw", folder / "in/link.raw");
    fs::create_directory(folder / "in/folder.raw");
    EXPECT_EQ(::mkfifo(path("in/pipe.raw").c_str(), 0600), 0);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    path("in/socket.raw").copy(place.sun_path, sizeof place.sun_path - 1);
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    ::close(socket);
  }
  ~Paths() override { ::alarm(0); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  // Empty: the file was read.
  [[nodiscard]] std::string refusal(const std::string& name) const {
    NoProgress progress;
    const auto bare = read_unfenced(path(name), {}, progress);
    const auto fenced = read_scan(path(name), {}, progress);
    EXPECT_EQ(bare.ok(), fenced.ok()) << name;
    return bare.ok() ? "" : bare.error().text;
  }
  [[nodiscard]] std::string with_data_file(const std::string& named, const char* end) const {
    if (std::string(end) == ".nhdr")
      write("in/x.nhdr",
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
            "data file: " +
                named + "\n");
    else
      write("in/x.mhd",
            "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
            "ElementDataFile = " +
                named + "\n");
    const std::string name = std::string("in/x") + end;
    NoProgress progress;
    if (const auto scan = read_unfenced(path(name), {}, progress); scan.ok()) {
      EXPECT_EQ(std::set<float>(scan->values.begin(), scan->values.end()),
                (std::set<float>{'a', 'b', 'c', 'd'}))
          << named;
    }
    return refusal(name);
  }
};

TEST_F(Paths, ADataFileLiesBesideItsHeader) {
  for (const char* end : {".nhdr", ".mhd"}) {
    SCOPED_TRACE(end);
    EXPECT_EQ(with_data_file("inside.raw", end), "");
    EXPECT_EQ(with_data_file("./inside.raw", end), "");
    for (const std::string& bad :
         {std::string("../outside.raw"), path("outside.raw"),
          std::string("folder.raw/../../outside.raw"), std::string("/dev/zero"), std::string(".."),
          std::string("link.raw"), std::string("folder.raw"), std::string("pipe.raw"),
          std::string("socket.raw"), std::string("nothing.raw"), std::string("..\\outside.raw")})
      EXPECT_NE(with_data_file(bad, end), "") << bad;
    // of a name that leads elsewhere the last part counts: the file beside the header is read, not the other one
    for (const std::string& moved : {path("in/inside.raw"), path("elsewhere/inside.raw"),
                                     std::string("../elsewhere/inside.raw")})
      EXPECT_EQ(with_data_file(moved, end), "") << moved;
  }
}

TEST_F(Paths, PatternsAndListsStayInTheFolder) {
  write("in/s1.raw", kInside), write("in/s2.raw", kInside);
  for (const char* out : {"s1.raw", "s2.raw", "t1.raw", "t2.raw"}) write(out, kOutside);
  EXPECT_EQ(with_data_file("s%d.raw 1 2 1", ".nhdr"), "");
  EXPECT_EQ(with_data_file("LIST\ns1.raw\ns2.raw", ".nhdr"), "");
  // read are those beside the header
  EXPECT_EQ(with_data_file("../s%d.raw 1 2 1", ".nhdr"), "");
  EXPECT_EQ(with_data_file("LIST\n../s1.raw\n../s2.raw", ".nhdr"), "");
  for (const char* bad :
       {"../t%d.raw 1 2 1", "%s.raw 1 2 1", "s%n.raw 1 2 1", "s%d%d.raw 1 2 1",
        "LIST\n../t1.raw\n../t2.raw", "LIST\ns1.raw\nlink.raw", "LIST\npipe.raw\npipe.raw"})
    EXPECT_NE(with_data_file(bad, ".nhdr"), "") << bad;
  EXPECT_NE(with_data_file("s%d.raw 1 2 1", ".mhd"), "");
  EXPECT_NE(with_data_file("LIST\ns1.raw\ns2.raw", ".mhd"), "");
}

TEST_F(Paths, TheOtherHalfOfANiftiPairIsNoLink) {
  BURR_NEEDS_DATA("corpus/nifti/nifti_rs/resources/minimal.hdr");
  const auto source = test::data_dir() / "corpus/nifti/nifti_rs/resources";
  fs::copy_file(source / "minimal.hdr", folder / "in/x.hdr");
  fs::copy_file(source / "minimal.img", folder / "in/x.img");
  EXPECT_EQ(refusal("in/x.hdr"), "");
  EXPECT_EQ(refusal("in/x.img"), "");
  fs::rename(folder / "in/x.img", folder / "x.img");
  fs::create_symlink(folder / "x.img", folder / "in/x.img");
  EXPECT_NE(refusal("in/x.hdr"), "");
  EXPECT_EQ(::unlink(path("in/x.img").c_str()), 0);
  EXPECT_EQ(::mkfifo(path("in/x.img").c_str(), 0600), 0);
  EXPECT_NE(refusal("in/x.hdr"), "");
  EXPECT_NE(refusal("in/x.img"), "");
}

TEST_F(Paths, AFolderOfSlicesEndsAtItsEdge) {
  BURR_NEEDS_DATA("corpus/derived/dicom/series_ok_reversed_names/01.dcm");
  const auto source = test::data_dir() / "corpus/derived/dicom/series_ok_reversed_names";
  fs::create_directory(folder / "study");
  for (int n = 1; n <= 8; ++n) {
    const std::string name = "0" + std::to_string(n) + ".dcm";
    fs::copy_file(source / name, folder / name);
    fs::create_symlink(folder / name, folder / "study" / name);
  }
  fs::create_directory_symlink(folder, folder / "study" / "up");
  EXPECT_EQ(::mkfifo(path("study/pipe.dcm").c_str(), 0600), 0);
  EXPECT_NE(refusal("study").find("links that lead out"), std::string::npos) << refusal("study");
  // what is inside counts; a notice says what was left out
  for (int n = 1; n <= 4; ++n) {
    const std::string name = "0" + std::to_string(n) + ".dcm";
    fs::remove(folder / "study" / name);
    fs::copy_file(source / name, folder / "study" / name);
  }
  fs::create_symlink(folder / "study/01.dcm", folder / "study/again.dcm");
  NoProgress progress;
  const auto scan = read_unfenced(path("study"), {}, progress);
  ASSERT_TRUE(scan.ok()) << scan.error().text;
  EXPECT_EQ(scan->size.z(), 4);
  EXPECT_NE(scan->notices.at(0).find("5 links lead out"), std::string::npos) << scan->notices.at(0);
}

TEST_F(Paths, OnlyPlainFilesAreOpened) {
  for (const char* odd : {"in/pipe.raw", "in/socket.raw", "../../dev/zero"})
    EXPECT_NE(refusal(odd), "") << odd;
  NoProgress progress;
  for (const char* device : {"/dev/zero", "/dev/null", "/dev/random"})
    EXPECT_FALSE(read_unfenced(device, {}, progress).ok()) << device;
  // a link that the user names is followed
  write("in/x.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\nabcdefgh");
  fs::create_symlink(folder / "in/x.nrrd", folder / "x.nrrd");
  EXPECT_EQ(refusal("x.nrrd"), "");
}

// A header may claim anything: without the bytes for it, no memory is allocated.
TEST_F(Paths, AHeaderThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  const std::string sizes = "20000 20000 5\n";
  write("in/a.nrrd", "NRRD0004\ntype: double\ndimension: 3\nsizes: " + sizes +
                         "encoding: raw\nendian: little\n\nabcdefgh");
  write("in/b.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " + sizes + "encoding: gzip\n\n\x1f\x8b\x08");
  write("in/c.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " + sizes + "encoding: bzip2\n\nBZh9");
  write("in/d.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " + sizes + "encoding: ascii\n\n1 2 3");
  write("in/e.mha", "ObjectType = Image\nNDims = 3\nDimSize = " + sizes +
                        "ElementType = MET_DOUBLE\nElementDataFile = LOCAL\nabcdefgh");
  write("in/f.mha", "ObjectType = Image\nNDims = 3\nDimSize = " + sizes +
                        "ElementType = MET_DOUBLE\nCompressedData = True\nElementDataFile = "
                        "LOCAL\nabcdefgh");
  for (const char* name :
       {"in/a.nrrd", "in/b.nrrd", "in/c.nrrd", "in/d.nrrd", "in/e.mha", "in/f.mha"}) {
    const std::string text = refusal(name);
    EXPECT_NE(text.find("cut off or its header is wrong"), std::string::npos)
        << name << ": " << text;
  }
}

}  // namespace
}  // namespace burr::io

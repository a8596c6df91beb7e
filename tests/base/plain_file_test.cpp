// Names that are no files: refused with one sentence, and without waiting.
#include "burr/base/plain_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "burr/base/new_file.h"
#include "burr/base/text_file.h"
#include "support/folder.h"

namespace burr::base {
namespace {

namespace fs = std::filesystem;

class PlainFile : public testing::Test {
 protected:
  PlainFile() {
    ::alarm(60);  // opening a pipe that nobody writes to would wait for ever
    EXPECT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    fs::create_directory(path("folder"));
    fs::create_symlink("/dev/null", path("device"));
    fs::create_symlink(path("pipe"), path("link"));
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    path("socket").copy(place.sun_path, sizeof place.sun_path - 1);
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    ::close(socket);
    std::ofstream(path("file")) << "text";
    fs::create_symlink(path("file"), path("link_to_file"));
  }
  ~PlainFile() override { ::alarm(0); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  const test::Folder own_;
  const fs::path folder_ = own_.path();
};

TEST_F(PlainFile, WhatIsNoFileIsNamedAndNotOpened) {
  for (const auto& [name, is] : {std::pair<std::string, std::string>("pipe", "is a pipe"),
                                 {"link", "is a pipe"},
                                 {"folder", "is a folder"},
                                 {"device", "is a device"},
                                 {"socket", "is a socket"}}) {
    const std::string says = name + ": " + is + ", not a file; give the name of a file";
    const Status plain = check_plain_file(path(name), name);
    ASSERT_FALSE(plain.ok()) << name;
    EXPECT_EQ(plain.error().text, says);
    EXPECT_EQ(plain.error().trouble, Trouble::io);
    const auto opened = open_plain_file(path(name), name);
    ASSERT_FALSE(opened.ok()) << name;
    EXPECT_EQ(opened.error().text, says);
    const auto text = text_of_file(path(name), 1000, "a test");
    ASSERT_FALSE(text.ok()) << name;
    EXPECT_EQ(text.error().text, says);
    const auto written = NewFile::create(path(name));
    ASSERT_FALSE(written.ok()) << name;
    EXPECT_NE(written.error().text.find(is), std::string::npos) << written.error().text;
  }
}

TEST_F(PlainFile, AFileIsRead) {
  for (const char* name : {"file", "link_to_file"}) {
    EXPECT_TRUE(check_plain_file(path(name)).ok());
    const auto file = open_plain_file(path(name));
    ASSERT_TRUE(file.ok()) << file.error().text;
    const auto bytes = bytes_of(*file, 1000, name);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(*bytes, "text");
  }
  EXPECT_TRUE(check_plain_file(path("none")).ok());
  EXPECT_FALSE(open_plain_file(path("none")).ok());
}

}  // namespace
}  // namespace burr::base

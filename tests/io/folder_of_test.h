// tests/io/folder_of_test.h - a folder for each test, removed afterwards.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include "support/folder.h"

namespace burr::test {

class FolderTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder),
                         std::filesystem::directory_iterator());
  }
  static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // the output of a command; "" if it cannot be run
  static std::string output_of(const std::string& command) {
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    std::string text;
    char part[4096];
    for (std::size_t n = 0; pipe != nullptr && (n = std::fread(part, 1, sizeof part, pipe)) > 0;)
      text.append(part, n);
    if (pipe != nullptr) ::pclose(pipe);
    return text;
  }

 private:
  Folder own_;

 protected:
  const std::filesystem::path folder = own_.path();
};

}  // namespace burr::test

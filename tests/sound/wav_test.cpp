// A .wav file read back byte by byte, without a library.
#include "burr/sound/wav.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

namespace burr::sound {
namespace {

std::vector<unsigned char> bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

unsigned number(const std::vector<unsigned char>& bytes, std::size_t at, std::size_t size) {
  unsigned value = 0;
  for (std::size_t n = size; n-- > 0;) value = 256 * value + bytes.at(at + n);
  return value;
}

TEST(Wav, SaysWhatItHolds) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.wav";
  {
    auto wav = WavFile::create(file, 48'000);
    ASSERT_TRUE(wav) << wav.error().text;
    const std::vector<float> first = {0, 0.5F, -0.5F};
    const std::vector<float> second = {1, -1, 7, -7, std::numeric_limits<float>::quiet_NaN()};
    wav->write(first);
    wav->write(second);
    EXPECT_EQ(wav->samples(), 8U);
    EXPECT_FALSE(std::filesystem::exists(file)) << "not before it is whole";
    const Status written = wav->put_in_place();
    ASSERT_TRUE(written) << written.error().text;
  }
  const std::vector<unsigned char> bytes = bytes_of(file);
  std::filesystem::remove(file);
  ASSERT_EQ(bytes.size(), 44U + 16U);
  EXPECT_EQ(std::memcmp(bytes.data(), "RIFF", 4), 0);
  EXPECT_EQ(number(bytes, 4, 4), bytes.size() - 8);
  EXPECT_EQ(std::memcmp(bytes.data() + 8, "WAVEfmt ", 8), 0);
  EXPECT_EQ(number(bytes, 16, 4), 16U);
  EXPECT_EQ(number(bytes, 20, 2), 1U);
  EXPECT_EQ(number(bytes, 22, 2), 1U);
  EXPECT_EQ(number(bytes, 24, 4), 48'000U);
  EXPECT_EQ(number(bytes, 28, 4), 96'000U);
  EXPECT_EQ(number(bytes, 32, 2), 2U);
  EXPECT_EQ(number(bytes, 34, 2), 16U);
  EXPECT_EQ(std::memcmp(bytes.data() + 36, "data", 4), 0);
  EXPECT_EQ(number(bytes, 40, 4), 16U);
  const int expected[] = {0, 16'384, -16'384, 32'767, -32'767, 32'767, -32'767, 0};
  for (std::size_t n = 0; n < 8; ++n)
    EXPECT_EQ(static_cast<std::int16_t>(number(bytes, 44 + 2 * n, 2)), expected[n]) << n;
}

TEST(Wav, WhatIsNotPutInPlaceLeavesNothing) {
  const burr::test::Folder folder;
  const std::string file = folder / "s.wav";
  {
    auto wav = WavFile::create(file, 48'000);
    ASSERT_TRUE(wav);
    wav->write(std::vector<float>(1'000, 0.1F));
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  const auto nowhere = WavFile::create("/no/such/folder/s.wav", 48'000);
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().text.find("/no/such/folder"), std::string::npos);
}

}  // namespace
}  // namespace burr::sound

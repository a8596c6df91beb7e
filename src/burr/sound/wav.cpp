#include "burr/sound/wav.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

namespace burr::sound {
namespace {

constexpr std::size_t kHeader = 44;

// little-endian, whatever this machine is
void put(std::array<char, kHeader>& header, std::size_t at, std::size_t bytes,
         std::uint64_t value) {
  for (std::size_t n = 0; n < bytes; ++n) header[at + n] = static_cast<char>(value >> (8 * n));
}

}  // namespace

Result<WavFile> WavFile::create(const std::string& path, int rate_hz) {
  auto file = base::NewFile::create(path);
  if (!file) return file.error();
  WavFile wav(path, std::move(*file), rate_hz);
  const std::array<char, kHeader> empty = {};
  wav.file_.write(empty.data(), empty.size());
  return wav;
}

WavFile::WavFile(std::string path, base::NewFile file, int rate_hz)
    : path_(std::move(path)), file_(std::move(file)), rate_hz_(rate_hz) {}

void WavFile::write(std::span<const float> samples) {
  samples_ += samples.size();
  if (samples_ > kMostSamples) return;  // reported at the end
  std::vector<char> bytes(2 * samples.size());
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const float held = std::isnan(samples[n]) ? 0.0F : std::clamp(samples[n], -1.0F, 1.0F);
    const auto value = static_cast<std::uint16_t>(std::lround(32767 * held));
    bytes[2 * n] = static_cast<char>(value & 0xff);
    bytes[2 * n + 1] = static_cast<char>(value >> 8);
  }
  file_.write(bytes.data(), bytes.size());
}

Status WavFile::put_in_place() {
  if (samples_ > kMostSamples)
    return error(Trouble::io, path_ + ": a .wav file holds at most 4 GiB; export a shorter part");
  std::array<char, kHeader> header = {};
  std::memcpy(header.data(), "RIFF", 4);
  put(header, 4, 4, kHeader - 8 + 2 * samples_);
  std::memcpy(header.data() + 8, "WAVEfmt ", 8);
  put(header, 16, 4, 16);  // size of this part
  put(header, 20, 2, 1);   // uncompressed
  put(header, 22, 2, 1);   // one channel
  const auto rate = static_cast<std::uint64_t>(rate_hz_);
  put(header, 24, 4, rate);
  put(header, 28, 4, 2 * rate);  // bytes a second
  put(header, 32, 2, 2);         // bytes of a sample
  put(header, 34, 2, 16);        // bits of a sample
  std::memcpy(header.data() + 36, "data", 4);
  put(header, 40, 4, 2 * samples_);
  file_.write_at(0, header.data(), header.size());
  return file_.put_in_place();
}

}  // namespace burr::sound

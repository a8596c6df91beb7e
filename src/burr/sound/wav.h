// sound/wav.h - writes samples into a .wav file: one channel, 16 bits, uncompressed.
//
//     auto file = WavFile::create("s.wav", 48'000);
//     file->write(samples);  ...
//     return file->put_in_place();
//
// The file appears complete or not at all (base/new_file.h). Format: RIFF/WAVE, PCM ("Multimedia
// Programming Interface and Data Specifications 1.0", IBM and Microsoft 1991). Samples outside
// -1..1 are clipped; one that is not finite becomes 0.
// Thread: one. Errors: the file cannot be written, or is longer than its format allows (12 h at 48
// kHz).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "burr/base/new_file.h"
#include "burr/base/result.h"

namespace burr::sound {

class WavFile {
 public:
  [[nodiscard]] static Result<WavFile> create(const std::string& path, int rate_hz);

  static constexpr std::uint64_t kMostSamples = (0xffffffffULL - 44) / 2;

  void write(std::span<const float> samples);
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  // Completes the file; nothing may be written afterwards.
  [[nodiscard]] Status put_in_place();

 private:
  WavFile(std::string path, base::NewFile file, int rate_hz);

  std::string path_;
  base::NewFile file_;
  int rate_hz_;
  std::uint64_t samples_ = 0;
};

}  // namespace burr::sound

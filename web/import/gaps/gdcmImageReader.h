// In place of GDCM, which unpacks compressed DICOM on a desktop and which Debian does not have for WebAssembly. It reads the small
// file that io/read/dicom_pixels.cpp makes, and unpacks its pictures by web/import/unpack.h. Its code: gdcm_web.cpp.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace gdcm {

struct PixelFormat {
  unsigned allocated = 0, stored = 0;
  int is_signed = 0;
  [[nodiscard]] unsigned GetBitsAllocated() const { return allocated; }
  [[nodiscard]] unsigned GetSamplesPerPixel() const { return 1; }
  [[nodiscard]] int GetPixelRepresentation() const { return is_signed; }
  [[nodiscard]] int GetBitsStored() const { return static_cast<int>(stored); }
};
struct Image {
  PixelFormat format;
  std::vector<char> bytes;
  [[nodiscard]] PixelFormat GetPixelFormat() const { return format; }
  [[nodiscard]] unsigned long GetBufferLength() const { return bytes.size(); }
  bool GetBuffer(char* to) const;
};
class ImageReader {
 public:
  void SetStream(std::istream& stream) { stream_ = &stream; }
  // A transfer syntax that a page does not unpack ends the reader's worker with a sentence that names it.
  bool Read();
  [[nodiscard]] const Image& GetImage() const { return image_; }

 private:
  std::istream* stream_ = nullptr;
  Image image_;
};

}  // namespace gdcm

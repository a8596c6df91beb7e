#include "burr/io/read/png.h"

#include <fmt/core.h>
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <string>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/grey_picture.h"

namespace burr::io {
namespace {

constexpr png_uint_32 kLongestSide = 32768;

// libpng reports an error by a jump back to the last setjmp; in between nothing may be constructed
// that has a destructor. So each step is one function without such objects, and what they share
// lies in the members.
class Decoder {
 public:
  explicit Decoder(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &failed, &warned);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) return;
    png_set_user_limits(png_, kLongestSide, kLongestSide);
    png_set_read_fn(png_, this, &take);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Reads up to the pixels, which are then red, green, blue and opaqueness. False: see why().
  bool head() {
    if (!begin()) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    const bool clear = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
    if (kind_ == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if (kind_ == PNG_COLOR_TYPE_GRAY && bits < 8) png_set_expand_gray_1_2_4_to_8(png_);
    if (clear) png_set_tRNS_to_alpha(png_);
    if ((kind_ & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png_);
    if ((kind_ & PNG_COLOR_MASK_ALPHA) == 0 && !clear) png_set_filler(png_, 0xFF, PNG_FILLER_AFTER);
    return ready();
  }
  // The same with the numbers as they are stored: of 8 or 16 bits, smaller ones a byte each. Colours of
  // a palette are put in.
  bool head_as_stored() {
    if (!begin()) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (kind_ == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if (kind_ == PNG_COLOR_TYPE_GRAY && bits < 8) png_set_packing(png_);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    return ready();
  }
  bool begin() {
    if (info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    kind_ = png_get_color_type(png_, info_);
    width = png_get_image_width(png_, info_);
    height = png_get_image_height(png_, info_);
    bits = png_get_bit_depth(png_, info_);
    stored = static_cast<std::uint64_t>(png_get_rowbytes(png_, info_)) * height;
    return true;
  }
  bool ready() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    row_bytes = png_get_rowbytes(png_, info_);
    channels = png_get_channels(png_, info_);
    return true;
  }
  bool body(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    return true;
  }
  [[nodiscard]] const char* why() const { return why_; }

  png_uint_32 width = 0, height = 0;
  int bits = 0;
  std::uint64_t stored = 0;  // bytes of the unpacked pixels, as stored
  std::size_t row_bytes = 0;
  int channels = 0;

 private:
  [[noreturn]] static void failed(png_structp png, png_const_charp words) {
    auto* self = static_cast<Decoder*>(png_get_error_ptr(png));
    std::strncpy(self->why_, words, sizeof self->why_ - 1);
    png_longjmp(png, 1);
  }
  static void warned(png_structp, png_const_charp) {}
  static void take(png_structp png, png_bytep to, png_size_t n) {
    auto* self = static_cast<Decoder*>(png_get_io_ptr(png));
    if (n > self->bytes_.size() - self->at_) png_error(png, "it is cut off");
    std::memcpy(to, self->bytes_.data() + self->at_, n);
    self->at_ += n;
  }

  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
  int kind_ = 0;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char why_[80] = "there is not enough memory";
};

Error damaged(const std::string& file, const Decoder& decoder) {
  return error(fmt::format("{}: is a damaged PNG picture ({}); copy it again", file,
                           base::printable(decoder.why())));
}

constexpr std::size_t kLargest = std::size_t{1} << 28;  // of a file [byte]

// Error: the pixels are more than the file can hold.
Status check_size(const Decoder& decoder, std::size_t bytes, const std::string& file) {
  if (decoder.stored <= std::uint64_t{bytes} * kMostGzip) return fine();
  return error(
      fmt::format("{}: its {} bytes cannot hold a picture of {} x {} pixels; the file is "
                  "cut off or damaged, copy it again",
                  file, bytes, decoder.width, decoder.height));
}

// All rows, one after the other. False: see why().
bool decode(Decoder& decoder, std::vector<std::uint8_t>& to) {
  to.resize(decoder.row_bytes * decoder.height);
  std::vector<png_bytep> rows(decoder.height);
  for (std::size_t j = 0; j < rows.size(); ++j) rows[j] = to.data() + j * decoder.row_bytes;
  return decoder.body(rows.data());
}

}  // namespace

Result<Picture> read_png(const std::filesystem::path& path) {
  const std::string file = short_name(path);
  auto bytes = first_bytes(path, kLargest, false);
  if (!bytes) return bytes.error();
  Decoder decoder(*bytes);
  if (!decoder.head()) return damaged(file, decoder);
  if (decoder.bits > 8)
    return error(
        fmt::format("{}: has {} bits a channel, and burr reads 8; save the pictures with "
                    "8 bits",
                    file, decoder.bits));
  if (Status status = check_size(decoder, bytes->size(), file); !status) return status.error();
  Picture picture;
  picture.width = static_cast<int>(decoder.width);
  picture.height = static_cast<int>(decoder.height);
  if (decoder.row_bytes != std::size_t{4} * decoder.width || !decode(decoder, picture.rgba))
    return damaged(file, decoder);
  return picture;
}

Result<GreyPicture> read_grey_png(const std::filesystem::path& path) {
  const std::string file = short_name(path);
  auto bytes = first_bytes(path, kLargest, false);
  if (!bytes) return bytes.error();
  Decoder decoder(*bytes);
  if (!decoder.head_as_stored()) return damaged(file, decoder);
  if (Status status = check_size(decoder, bytes->size(), file); !status) return status.error();
  GreyPicture picture;
  picture.width = static_cast<int>(decoder.width);
  picture.height = static_cast<int>(decoder.height);
  picture.bits = decoder.bits;
  picture.type = decoder.bits == 16 ? SampleType::u16 : SampleType::u8;
  if (decoder.row_bytes != std::size_t{decoder.width} * static_cast<std::size_t>(decoder.channels) *
                               io::bytes_of(picture.type) ||
      !decode(decoder, picture.samples))
    return damaged(file, decoder);
  if (Status status = keep_grey(picture, decoder.channels, file); !status) return status.error();
  return picture;
}

}  // namespace burr::io

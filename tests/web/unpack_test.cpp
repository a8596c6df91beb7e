// The page's unpacking of compressed DICOM against GDCM, which packs here: its own of run lengths and lossless JPEG, and CharLS
// and OpenJPEG as the page calls them (PageCodecs).
#include "web/import/unpack.h"

#include <gtest/gtest.h>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <gdcmImage.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmJPEG2000Codec.h>
#include <gdcmJPEGLSCodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "web/page_codecs.h"

namespace burr::web {
namespace {

using gdcm::TransferSyntax;

struct Picture {
  unsigned columns, rows, bits;
  std::vector<std::uint16_t> values;
};

// Slopes, edges, flat parts and noise, as a slice of a scan has them; kind 0: all flat, 1: all noise.
Picture made(unsigned columns, unsigned rows, unsigned bits, int kind, std::mt19937& random) {
  Picture picture{columns, rows, bits, {}};
  const unsigned most = (1U << bits) - 1;
  for (unsigned y = 0; y < rows; ++y)
    for (unsigned x = 0; x < columns; ++x) {
      const double far = std::hypot(x - 0.4 * columns, y - 0.6 * rows);
      double value = kind == 0 ? 0.3 : 0.2 + 0.2 * std::sin(0.1 * x) + (far < 0.3 * rows ? 0.5 : 0);
      if (kind == 2 && x % 17 < 9) value = 0.1;
      if (kind == 2) value += 1e-4 * static_cast<double>(random() % 100);
      if (kind == 1) value = static_cast<double>(random() % 65536) / 65536;
      picture.values.push_back(static_cast<std::uint16_t>(std::min<double>(most, value * most)));
    }
  return picture;
}

// Packed by GDCM; empty: it cannot.
Bytes packed(const Picture& picture, TransferSyntax::TSType syntax,
             gdcm::ImageCodec* codec = nullptr) {
  gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(2);
  image->SetDimension(0, picture.columns);
  image->SetDimension(1, picture.rows);
  const unsigned allocated = picture.bits <= 8 ? 8 : 16;
  image->SetPixelFormat(gdcm::PixelFormat(1, static_cast<std::uint16_t>(allocated),
                                          static_cast<std::uint16_t>(picture.bits),
                                          static_cast<std::uint16_t>(picture.bits - 1), 0));
  image->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image->SetTransferSyntax(TransferSyntax::ExplicitVRLittleEndian);
  std::vector<char> plain;
  for (const std::uint16_t value : picture.values) {
    plain.push_back(static_cast<char>(value & 255));
    if (allocated == 16) plain.push_back(static_cast<char>(value >> 8));
  }
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetByteValue(plain.data(), static_cast<std::uint32_t>(plain.size()));
  image->SetDataElement(pixels);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(syntax);
  if (codec != nullptr) change.SetUserCodec(codec);
  change.SetInput(*image);
  if (!change.Change()) return {};
  const gdcm::SequenceOfFragments* parts =
      change.GetOutput().GetDataElement().GetSequenceOfFragments();
  Bytes bytes;
  for (std::size_t n = 0; parts != nullptr && n < parts->GetNumberOfFragments(); ++n) {
    const gdcm::ByteValue* one = parts->GetFragment(n).GetByteValue();
    bytes.insert(bytes.end(), one->GetPointer(), one->GetPointer() + one->GetLength());
  }
  return bytes;
}

bool unpack(TransferSyntax::TSType syntax, const Bytes& bytes, const Picture& picture,
            Unpacked& to) {
  to.columns = static_cast<int>(picture.columns);
  to.rows = static_cast<int>(picture.rows);
  if (syntax == TransferSyntax::RLELossless)
    return unpack_rle(bytes, picture.bits <= 8 ? 1 : 2, to);
  return unpack_jpeg_lossless(bytes, to);
}

Asked asked(TransferSyntax::TSType syntax, const Bytes& bytes, const Picture& picture) {
  const bool ls =
      syntax == TransferSyntax::JPEGLSLossless || syntax == TransferSyntax::JPEGLSNearLossless;
  return {ls ? Codec::jpeg_ls : Codec::jpeg_2000, picture.columns, picture.rows, bytes};
}

int farthest(const Picture& picture, const std::vector<std::int32_t>& back) {
  int most = picture.values.size() == back.size() ? 0 : 1 << 20;
  for (std::size_t n = 0; n < picture.values.size() && most < 1 << 20; ++n)
    most = std::max(most, std::abs(back[n] - int{picture.values[n]}));
  return most;
}

using Syntaxes = std::vector<TransferSyntax::TSType>;
const Syntaxes kOwn = {TransferSyntax::RLELossless, TransferSyntax::JPEGLosslessProcess14_1};
const Syntaxes kOfOthers = {TransferSyntax::JPEGLSLossless, TransferSyntax::JPEG2000Lossless};

struct Case {
  Picture picture;
  TransferSyntax::TSType syntax;
  Bytes bytes;
  [[nodiscard]] std::string about() const {
    return std::string(TransferSyntax::GetTSString(syntax)) + " " +
           std::to_string(picture.columns) + " x " + std::to_string(picture.rows) + ", " +
           std::to_string(picture.bits) + " bits";
  }
};

// Pictures of many sizes, with all depths of bits.
std::vector<Case> lossless_cases(const Syntaxes& syntaxes) {
  std::mt19937 random(1);
  constexpr unsigned kSizes[][2] = {{1, 1}, {7, 3}, {64, 64}, {65, 33}, {200, 131}, {512, 300}};
  std::vector<Case> cases;
  for (const auto& [columns, rows] : kSizes)
    for (const unsigned bits : {8U, 10U, 12U, 16U})
      for (int kind = 0; kind < 3; ++kind)
        for (const auto syntax : syntaxes) {
          // GDCM itself ends the program for some sizes
          if (syntax == TransferSyntax::JPEG2000Lossless && rows < 32) continue;
          if (syntax == TransferSyntax::RLELossless && columns % 8 != 0) continue;
          Case one{made(columns, rows, bits, kind, random), syntax, {}};
          one.bytes = packed(one.picture, syntax);
          // GDCM packs no pictures of some few pixels
          if (!one.bytes.empty()) cases.push_back(std::move(one));
        }
  return cases;
}

Bytes share_of(const Bytes& whole, double share) {
  return {whole.begin(),
          whole.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(whole.size()))};
}

// Some bytes are others: anywhere, or near the beginning.
Bytes damaged(const Bytes& whole, int n, std::mt19937& random) {
  Bytes bytes = whole;
  const std::size_t near = n % 2 == 0 ? bytes.size() : std::min<std::size_t>(120, bytes.size());
  for (int k = 0; k < 1 + n % 5; ++k) bytes[random() % near] = static_cast<std::uint8_t>(random());
  return bytes;
}

constexpr double kShares[] = {0.0, 0.01, 0.2, 0.5, 0.9};

class Unpack : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::Trace::DebugOff();
  }
};

class PageCodecs : public Unpack {
 protected:
  void SetUp() override {
    if (site_of_page() == nullptr) GTEST_SKIP() << "scripts/checks/page.sh runs this with a site";
  }
};

TEST_F(Unpack, LosslessPicturesAreWhatWasPacked) {
  const std::vector<Case> cases = lossless_cases(kOwn);
  EXPECT_GT(cases.size(), 80U);
  for (const Case& one : cases) {
    Unpacked back;
    ASSERT_TRUE(unpack(one.syntax, one.bytes, one.picture, back)) << one.about();
    EXPECT_EQ(farthest(one.picture, back.values), 0) << one.about();
  }
}

TEST_F(PageCodecs, LosslessPicturesAreWhatWasPacked) {
  const std::vector<Case> cases = lossless_cases(kOfOthers);
  EXPECT_GT(cases.size(), 100U);
  std::vector<Asked> all;
  all.reserve(cases.size());
  for (const Case& one : cases) all.push_back(asked(one.syntax, one.bytes, one.picture));
  const std::vector<Answer> answers = ask_page(all);
  for (std::size_t n = 0; n < cases.size(); ++n) {
    ASSERT_TRUE(answers[n].good) << cases[n].about();
    EXPECT_EQ(farthest(cases[n].picture, answers[n].values()), 0) << cases[n].about();
  }
}

TEST_F(PageCodecs, LossyPicturesAreNearWhatWasPacked) {
  std::mt19937 random(2);
  for (const unsigned bits : {8U, 12U, 16U}) {
    const Picture picture = made(200, 131, bits, 2, random);
    gdcm::JPEGLSCodec near;
    near.SetLossless(false);
    near.SetLossyError(3);
    const Bytes one = packed(picture, TransferSyntax::JPEGLSNearLossless, &near);
    ASSERT_FALSE(one.empty());
    gdcm::JPEG2000Codec waves;
    waves.SetReversible(false);
    waves.SetRate(0, 4);
    const Bytes other = packed(picture, TransferSyntax::JPEG2000, &waves);
    ASSERT_FALSE(other.empty());
    const std::vector<Answer> back =
        ask_page({asked(TransferSyntax::JPEGLSNearLossless, one, picture),
                  asked(TransferSyntax::JPEG2000, other, picture)});
    ASSERT_TRUE(back[0].good && back[1].good);
    EXPECT_LE(farthest(picture, back[0].values()), 3) << bits;
    EXPECT_GT(farthest(picture, back[0].values()), 0) << bits;
    EXPECT_LE(farthest(picture, back[1].values()), 1 << (bits - 4)) << bits;
  }
}

// What is cut off is refused; what is damaged is refused or gives a picture of the right size.
TEST_F(Unpack, DamagedPicturesDoNoHarm) {
  std::mt19937 random(3);
  const Picture picture = made(90, 70, 12, 2, random);
  for (const auto syntax : kOwn) {
    const Bytes whole = packed(picture, syntax);
    ASSERT_FALSE(whole.empty());
    Unpacked back;
    for (const double share : kShares)
      EXPECT_FALSE(unpack(syntax, share_of(whole, share), picture, back))
          << TransferSyntax::GetTSString(syntax) << " " << share;
    Picture other = picture;
    other.columns = 91;
    if (syntax != TransferSyntax::RLELossless) {
      EXPECT_FALSE(unpack(syntax, whole, other, back));
    }
    for (int n = 0; n < 400; ++n)
      if (unpack(syntax, damaged(whole, n, random), picture, back)) {
        EXPECT_EQ(back.values.size(), picture.values.size());
      }
  }
}

// The same, and what comes after damage is read as if nothing had been.
TEST_F(PageCodecs, DamagedPicturesDoNoHarm) {
  std::mt19937 random(3);
  const Picture picture = made(90, 70, 12, 2, random);
  for (const auto syntax : kOfOthers) {
    const Bytes whole = packed(picture, syntax);
    ASSERT_FALSE(whole.empty());
    std::vector<Asked> all;
    for (const double share : kShares)
      all.push_back(asked(syntax, share_of(whole, share), picture));
    Picture other = picture;
    other.columns = 91;
    all.push_back(asked(syntax, whole, other));
    const std::size_t refused = all.size();
    for (int n = 0; n < 400; ++n) all.push_back(asked(syntax, damaged(whole, n, random), picture));
    all.push_back(asked(syntax, whole, picture));
    const std::vector<Answer> answers = ask_page(all);
    for (std::size_t n = 0; n < answers.size(); ++n) {
      if (n < refused) {
        EXPECT_FALSE(answers[n].good) << TransferSyntax::GetTSString(syntax) << " " << n;
      }
      if (answers[n].good) {
        EXPECT_EQ(answers[n].values().size(), picture.values.size());
      }
    }
    EXPECT_EQ(farthest(picture, answers.back().values()), 0);
  }
}

}  // namespace
}  // namespace burr::web

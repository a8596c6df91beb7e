// Scans of two values alone, as label maps that people write in HU: a ball of 10 voxels radius in air.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "burr/importing/import.h"
#include "burr/io/read/read_scan.h"
#include "io/folder_of_test.h"

namespace burr::importing {
namespace {

constexpr int kEdge = 30;
constexpr double kVoxelMm = 0.5, kRadius = 10;

class TwoValues : public test::FolderTest {
 protected:
  Result<io::Scan> scan_of(int air, int bone) const {
    std::ofstream file(path("ball.nrrd"), std::ios::binary);
    file << "NRRD0004\ntype: int16\ndimension: 3\nsizes: 30 30 30\nspacings: 0.5 0.5 0.5\n"
            "endian: little\nencoding: raw\n\n";
    constexpr double kMiddle = 14.5;
    for (int k = 0; k < kEdge; ++k)
      for (int j = 0; j < kEdge; ++j)
        for (int i = 0; i < kEdge; ++i) {
          const bool inside = std::hypot(i - kMiddle, j - kMiddle, k - kMiddle) < kRadius;
          const auto value = static_cast<unsigned>(inside ? bone : air);
          file << static_cast<char>(value & 0xFF) << static_cast<char>(value >> 8 & 0xFF);
        }
    file.close();
    NoProgress progress;
    return io::read_scan(path("ball.nrrd"), {}, progress);
  }
};

TEST_F(TwoValues, GiveTheBoneOfTheUpperOne) {
  const double true_mm3 = 4.0 / 3 * M_PI * std::pow(kRadius * kVoxelMm, 3);
  for (const auto& [air, bone] :
       {std::pair{-1000, 1200}, {-1024, 3000}, {-1, 255}, {0, 1000}, {-3024, 700}, {-200, 1500}}) {
    SCOPED_TRACE(std::to_string(air) + " and " + std::to_string(bone));
    const auto scan = scan_of(air, bone);
    ASSERT_TRUE(scan.ok()) << scan.error().text;
    NoProgress progress;
    const auto made = import_bone(*scan, {}, progress);
    ASSERT_TRUE(made.ok()) << made.error().text;
    EXPECT_NEAR(made->summary.solid_mm3, true_mm3, 0.1 * true_mm3);
  }
}

}  // namespace
}  // namespace burr::importing

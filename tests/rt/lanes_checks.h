// tests/rt/lanes_checks.h - rt/lanes.h, as compiled for each instruction set, on random numbers.
#pragma once

namespace burr::test {

// What gave other bits than one number at a time, or nullptr.
namespace scalar {
const char* lanes_differ(unsigned seed);
}
namespace avx2 {
const char* lanes_differ(unsigned seed);
}
namespace avx512 {
const char* lanes_differ(unsigned seed);
}

}  // namespace burr::test

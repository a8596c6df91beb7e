// The readings that a fake device gave, each with the force that came next.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace burr::test {

struct Answer {
  std::array<double, 3> told{}, force{};
};

class Answers {
 public:
  void tell(const double* place) { told_ = {place[0], place[1], place[2]}; }
  void take(const double* force) {
    if (wanted_ && kept_.size() < kMost) kept_.push_back({told_, {force[0], force[1], force[2]}});
  }
  // All answers since the last call; recording starts with the first call.
  [[nodiscard]] std::vector<Answer> look() {
    wanted_ = true;
    return std::exchange(kept_, {});
  }

 private:
  static constexpr std::size_t kMost = 1 << 14;
  std::array<double, 3> told_{};
  std::vector<Answer> kept_;
  bool wanted_ = false;
};

}  // namespace burr::test

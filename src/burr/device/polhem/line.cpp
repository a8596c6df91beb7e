#include "burr/device/polhem/line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace burr::device::polhem {
namespace {

constexpr double kMostNewton = 32;                    // the field holds 16 bits of millinewtons
constexpr int kForce = 2;                             // the command for three forces
constexpr double kFarthestMm = 1000, kMostTurn = 20;  // largest values of a valid reading [mm],
                                                      // [rad]

}  // namespace

Line force_line(const math::Vec3& force) BURR_RT {
  Line line;
  line.fill(' ');
  char* at = line.data();
  char* const end = line.data() + kLine - 1;
  const auto put = [&](int value) {
    if (at != line.data()) ++at;  // a space
    at = std::to_chars(at, end, value).ptr;
  };
  for (int axis = 0; axis < 3; ++axis)
    put(std::isfinite(force[axis]) ? static_cast<int>(std::lround(
                                         1e3 * std::clamp(force[axis], -kMostNewton, kMostNewton)))
                                   : 0);
  put(kForce);
  for (int attribute = 0; attribute < 3; ++attribute) put(0);
  line[kLine - 1] = '\n';
  return line;
}

bool read_line(std::string_view line, State& state) BURR_RT {
  double number[7] = {};
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto skip = [&] {
    while (at != end && (*at == ' ' || *at == '\r')) ++at;
  };
  for (double& one : number) {
    skip();
    const auto [next, bad] = std::from_chars(at, end, one);
    if (bad != std::errc() || !std::isfinite(one) || (next != end && *next != ' ')) return false;
    at = next;
  }
  skip();
  int info = 0;
  const auto [next, bad] = std::from_chars(at, end, info);
  if (bad != std::errc()) return false;
  at = next;
  skip();
  if (at != end) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(number[axis]) > kFarthestMm) return false;
  for (int turn = 3; turn < 7; ++turn)
    if (std::abs(number[turn]) > kMostTurn) return false;
  state = {{1e-3 * number[0], 1e-3 * number[1], 1e-3 * number[2]},
           number[3],
           number[4],
           number[5],
           number[6],
           info};
  return true;
}

bool Lines::take(std::size_t came, State& state, int& nonsense) BURR_RT {
  used_ += came;
  bool found = false;
  const char* const end = bytes_.data() + used_;
  const char* begin = bytes_.data();
  for (const char* stop = std::find(begin, end, '\n'); stop != end;
       stop = std::find(begin, end, '\n')) {
    const std::string_view line(begin, static_cast<std::size_t>(stop - begin));
    begin = stop + 1;
    if (line.find_first_not_of(" \r") == std::string_view::npos) continue;  // padding of a line
    if (read_line(line, state))
      found = true;
    else
      ++nonsense;
  }
  used_ = static_cast<std::size_t>(end - begin);
  std::memmove(bytes_.data(), begin, used_);
  if (used_ == bytes_.size()) {  // no newline in the whole buffer: not lines of an arm
    used_ = 0;
    ++nonsense;
  }
  return found;
}

}  // namespace burr::device::polhem

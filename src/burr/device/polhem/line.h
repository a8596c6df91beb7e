// device/polhem/line.h - the lines that a Polhem exchanges over its serial port: text of 64 bytes
// that ends with a newline; it sends one line for each of ours.
//
//     to it:    force x y z [mN], command 2, three attributes; the arm computes the currents itself
//     from it:  position x y z [mm], angles tA lambda tD tE [rad], a number for its
//               state; in the published firmwares 1: the calibration button was pressed, else 0
//
// Source: uhaptikfabriken.h 0.2 of forsslund/haptikfabrikenapi (pc_to_hid_message,
// position_hid_to_pc_message, setForce). Thread: any. Memory: none. Frame: the arm's own.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "burr/math/vec3.h"
#include "burr/rt/rt.h"

namespace burr::device::polhem {

inline constexpr std::size_t kLine = 64;
using Line = std::array<char, kLine>;

// force: [N]. A force that is not finite becomes zero; each component is limited to what its field
// holds.
[[nodiscard]] Line force_line(const math::Vec3& force) BURR_RT;

struct State {
  math::Vec3 place = math::Vec3::Zero();  // [m]
  double tA = 0, lambda = 0;              // of the arm: about z, and about y against its turn [rad]
  double tD = 0, tE = 0;                  // of the wrist: about x, then y [rad]
  int info = 0;
};

// False: not a line of an arm, or impossible numbers; `state` is then unchanged.
[[nodiscard]] bool read_line(std::string_view line, State& state) BURR_RT;

// Collects whole lines from a stream that comes in pieces.
class Lines {
 public:
  // Buffer for the next bytes.
  [[nodiscard]] char* room() BURR_RT { return bytes_.data() + used_; }
  [[nodiscard]] std::size_t left() const BURR_RT { return bytes_.size() - used_; }
  // came: number of bytes that have been written to room(). Puts the newest valid line into
  // `state`, and counts the lines that are not valid in `nonsense`. False: no valid line.
  [[nodiscard]] bool take(std::size_t came, State& state, int& nonsense) BURR_RT;
  void clear() BURR_RT { used_ = 0; }

 private:
  std::array<char, 16 * kLine> bytes_{};
  std::size_t used_ = 0;
};

}  // namespace burr::device::polhem

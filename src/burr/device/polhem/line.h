// device/polhem/line.h - the lines that a Polhem speaks over its serial port: text of 64 bytes, the
// last one a newline, one of its own for each of ours.
//
//     ours:  force x y z [mN], command 2, three attributes; the arm turns it into currents itself
//     its:   place x y z [mm], angles tA lambda tD tE [rad], a number of its state
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

// force: [N]; what is no number is none, and no component passes what the field holds.
[[nodiscard]] Line force_line(const math::Vec3& force) BURR_RT;

struct State {
  math::Vec3 place = math::Vec3::Zero();  // [m]
  double tA = 0, lambda = 0;              // of the arm: about z, and about y against its turn [rad]
  double tD = 0, tE = 0;                  // of the wrist: about x, then y [rad]
  int info = 0;
};

// False: no line of an arm, or numbers that cannot be; `state` is left alone then.
[[nodiscard]] bool read_line(std::string_view line, State& state) BURR_RT;

// Whole lines out of a stream that comes in pieces.
class Lines {
 public:
  // Room for what comes next.
  [[nodiscard]] char* room() BURR_RT { return bytes_.data() + used_; }
  [[nodiscard]] std::size_t left() const BURR_RT { return bytes_.size() - used_; }
  // So much has come: the newest whole line that is one, in `state`; lines that are none are
  // counted.
  [[nodiscard]] bool take(std::size_t came, State& state, int& nonsense) BURR_RT;
  void clear() BURR_RT { used_ = 0; }

 private:
  std::array<char, 16 * kLine> bytes_{};
  std::size_t used_ = 0;
};

}  // namespace burr::device::polhem

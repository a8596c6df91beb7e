// Input from a Polhem's serial port: any bytes in pieces of any length. One byte gives the length
// of the next piece.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "burr/device/polhem/line.h"
#include "support.h"

namespace {

using namespace burr;
using device::polhem::State;

void look_at(const State& state) {
  fuzz::must(state.place.cwiseAbs().maxCoeff() <= 1, "an arm's end is within a metre");
  for (const double turn : {state.tA, state.lambda, state.tD, state.tE})
    fuzz::must(std::abs(turn) <= 20, "an arm turns a few times at most");
}

// Checks a line for the arm: three forces, a command, three attributes, and nothing that the arm
// would read as more.
void look_at(const device::polhem::Line& line) {
  fuzz::must(line.back() == '\n' && std::count(line.begin(), line.end(), '\n') == 1,
             "a line of ours is one line");
  const char* at = line.data();
  for (int n = 0; n < 7; ++n) {
    while (*at == ' ') ++at;
    int value = 0;
    const auto [next, bad] = std::from_chars(at, line.data() + line.size(), value);
    fuzz::must(bad == std::errc() && std::abs(value) <= 32'000, "a field holds 16 bits");
    at = next;
  }
  while (*at == ' ') ++at;
  fuzz::must(*at == '\n', "and no more");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  State state;
  if (device::polhem::read_line(fuzz::text_of({data, size}), state)) look_at(state);

  fuzz::Pieces in({data, size});
  device::polhem::Lines lines;
  int nonsense = 0;
  while (!in.empty()) {
    const std::size_t wanted = 1 + std::size_t{in.byte()} * 5;
    fuzz::must(lines.left() > 0, "there is room for what comes next");
    const fuzz::Bytes piece = in.take(std::min(wanted, lines.left()));
    std::copy(piece.begin(), piece.end(), lines.room());
    const int before = nonsense;
    if (lines.take(piece.size(), state, nonsense)) look_at(state);
    fuzz::must(nonsense >= before, "nonsense is counted");
  }
  const double huge = std::ldexp(state.place.x() - 0.5, static_cast<int>(size % 2000) - 900);
  look_at(device::polhem::force_line(
      {huge, state.place.y() * 1e3, state.tA / (state.lambda - state.tD)}));
  return 0;
}

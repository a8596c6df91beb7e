// The path of a hand (CSV), and the hand that follows it.
#include "burr/device/hand_path.h"
#include "burr/surgeon/motion.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const auto path = surgeon::read_path(fuzz::as_file("a.csv", {data, size}));
  fuzz::look_at_error(path);
  if (!path) return 0;
  fuzz::must(std::isfinite(path->duration()) && path->duration() >= 0, "a path has a duration");
  std::size_t hint = 0;
  for (int n = 0; n <= 20; ++n) {
    const auto point = device::at(*path, path->duration() * n / 20, hint);
    fuzz::must(point.world_from_tool.p.allFinite(), "the hand is somewhere");
    fuzz::must(std::abs(point.world_from_tool.q.norm() - 1) < 1e-6, "the hand is turned somehow");
    fuzz::must(point.pedal >= 0 && point.pedal <= 1, "the pedal is from 0 to 1");
  }
  return 0;
}

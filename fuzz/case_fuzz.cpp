// A case (TOML).
#include "burr/scenario/case.h"

#include "burr/volume/tissue.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const auto work = scenario::parse_case(fuzz::text_of({data, size}), "a.toml");
  fuzz::look_at_error(work);
  if (!work) return 0;
  fuzz::must(work->phantom.empty() != work->volume.empty(), "a case has one bone");
  fuzz::must(work->burr.radius > 0 && work->full_speed >= 0, "a case has a burr that turns");
  if (work->into) fuzz::must(std::abs(work->into->norm() - 1) < 1e-9, "the way in has length one");
  fuzz::look_at_error(scenario::check_tissues(*work, volume::TissueTable{}));
  return 0;
}

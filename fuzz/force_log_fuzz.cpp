// A force log (CSV), and the constants that are fitted to it.
#include "burr/fit/force_log.h"

#include <cmath>

#include "burr/fit/laws.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const auto log = fit::parse_force_log(fuzz::text_of({data, size}), "a.csv");
  fuzz::look_at_error(log);
  if (!log) return 0;
  for (const fit::ForceRow& row : log->rows)
    fuzz::must(row.radius > 0 && row.material < log->materials.size(), "a row one can work with");
  for (const fit::MaterialFit& fit : fit::fit_laws(*log))
    for (const fit::Fitted& one : fit.constants)
      fuzz::must(std::isfinite(one.value) && std::isfinite(one.half) && one.half >= 0,
                 "a constant is a number");
  return 0;
}

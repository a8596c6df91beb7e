// apps/burr/verify/one_sphere.h - times of touch beside programs that touch with one sphere, as they were
// measured: bench/results/one_sphere.csv. Lines of fields without quotes; the first line names them.
#pragma once

namespace burr::app {

[[nodiscard]] const char* one_sphere_csv();

}  // namespace burr::app

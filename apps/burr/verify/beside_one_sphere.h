// apps/burr/verify/beside_one_sphere.h - the tables of `burr verify shapes` that set tools of several parts beside programs
// that touch with spheres.
//
// Thread: main.
#pragma once

#include "verify_report.h"

namespace burr::app {

// Of a program that touches with spheres alone none of these scenes can be asked, so its cells stay empty.
// ticks: of each tool at the thin plate.
void beside_one_sphere(VerifyReport::Part& part, int ticks);

}  // namespace burr::app

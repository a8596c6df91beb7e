#include "beside_one_sphere.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "one_sphere.h"

namespace burr::app {
namespace {

// The largest figure of a check, over the voxels.
double worst_of(const VerifyReport::Part& part, const std::string& check) {
  double worst = 0;
  for (const Check& one : part.checks)
    if (one.name.find("." + check + ".") != std::string::npos)
      worst = std::max(worst, one.measured);
  return worst;
}

}  // namespace

void beside_one_sphere(VerifyReport::Part& part, int ticks) {
  Table errors;
  errors.caption =
      "Largest error of burr in these scenes, beside programs that touch with spheres. Neither has "
      "such "
      "tools, and neither has published how far its one sphere is off.";
  errors.head = {"", "CHAI3D", "FIVRS on AMBF", "burr"};
  const auto row = [&errors](const std::string& what, const std::string& ours) {
    errors.rows.push_back({what, "", "", ours});
  };
  errors.rows.push_back({"what touches", "one sphere, 3 unknowns",
                         "eight such spheres, each by itself; the worst counts",
                         "up to six parts of ten kinds together, 6 unknowns"});
  errors.rows.push_back({"torque of a contact", "none", "none", "yes"});
  const auto micrometres = [&part](const char* check) {
    return fmt::format("{:.2f} um", 1e6 * worst_of(part, check));
  };
  row("cylinder lying on a plane, 0.5 N",
      fmt::format("{:.4f} N", worst_of(part, "cylinder-on-plane.force-error")));
  row("shaft on a rim, place", micrometres("lever-on-rim.place-by-torque"));
  row("disc turned in a slot, place of its rim", micrometres("disc-in-slot.place-of-rim"));
  row("peg turned in a hole, place of its rim", micrometres("peg-in-hole.place-of-rim"));
  row("the same, the two forces of its couple",
      fmt::format("{:.1f} %", 100 * worst_of(part, "peg-in-hole.forces-of-couple")));
  row("burr in a canal whose shaft leans on the rim, place",
      micrometres("burr-in-canal.place-of-rim"));
  double wrong = 0;
  for (const char* name : {"blade", "chisel", "flame", "wheel"})
    wrong += worst_of(part, fmt::format("thin-plate-{}.ticks-on-the-wrong-side", name));
  row("ticks on the wrong side of a plate of 0.6 mm, four tools",
      fmt::format("{:.0f} of {}", wrong, 4 * ticks));
  part.table(std::move(errors));

  Table times;
  times.caption =
      "Time of one tick of touch [us], measured elsewhere (bench/results/tool.md and tick.md say "
      "where "
      "and how). Neither program has published times; CHAI3D was run once by us.";
  std::istringstream csv(one_sphere_csv());
  for (std::string line; std::getline(csv, line);) {
    std::vector<std::string> cells;
    std::istringstream fields(line);
    for (std::string cell; std::getline(fields, cell, ',');) cells.push_back(cell);
    if (cells.empty()) continue;
    if (times.head.empty())
      times.head = std::move(cells);
    else
      times.rows.push_back(std::move(cells));
  }
  part.table(std::move(times));
}

}  // namespace burr::app

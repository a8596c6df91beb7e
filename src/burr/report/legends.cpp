#include <fmt/format.h>

#include <cmath>

#include "burr/report/report_colours.h"
#include "burr/report/report_pictures.h"
#include "burr/words/words.h"

namespace burr::report {

using words::Word;
using words::word;

namespace {

using render::Colour;

std::string hex_of(const Colour& colour) {
  const auto part = [&](std::size_t n) {
    return static_cast<int>(std::lround(255 * static_cast<double>(colour[n])));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

}  // namespace

Legend sides_legend() {
  return {{word(Word::report_legend_cut), hex_of(kCutColour)},
          {word(Word::report_legend_missed), hex_of(kLeftColour)},
          {word(Word::report_legend_excess), hex_of(kBareColour)}};
}
Legend spots_legend() {
  return {{word(Word::report_legend_good), hex_of(kGoodColour)},
          {word(Word::report_legend_left), hex_of(kLeftColour)},
          {word(Word::report_legend_bare), hex_of(kBareColour)}};
}

}  // namespace burr::report

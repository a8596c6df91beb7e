#include "burr/io/read/picture_scale.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "burr/io/read/text.h"

namespace burr::io {
namespace {

// The length of a unit in mm; 0: it is no length, as "pixel".
double unit_mm(std::string_view text) {
  const std::string name = lower(trimmed(text));
  constexpr std::pair<std::string_view, double> kUnits[] = {{"mm", 1},
                                                            {"millimeter", 1},
                                                            {"cm", 10},
                                                            {"m", 1000},
                                                            {"meter", 1000},
                                                            {"um", 1e-3},
                                                            {"\xC2\xB5m", 1e-3},
                                                            {"\xCE\xBCm", 1e-3},
                                                            {"\xB5m", 1e-3},
                                                            {"\\u00b5m", 1e-3},
                                                            {"micron", 1e-3},
                                                            {"microns", 1e-3},
                                                            {"micrometer", 1e-3},
                                                            {"nm", 1e-6},
                                                            {"nanometer", 1e-6},
                                                            {"inch", 25.4},
                                                            {"in", 25.4}};
  for (const auto& [unit, mm] : kUnits)
    if (name == unit) return mm;
  return 0;
}

bool possible(double mm) { return std::isfinite(mm) && mm > 1e-7 && mm < 1e4; }

std::int64_t count_in(const std::string& text) {
  constexpr std::int64_t kMost = 1'000'000;
  std::int64_t n = 0;
  return to_number(text, n) && n >= 1 && n <= kMost ? n : 0;
}

PictureScale by_imagej(const TiffWords& words) {
  std::map<std::string, std::string> lines;
  const std::string_view all = words.description;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find('\n', at), all.size());
    const std::string_view line = all.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = line.find('=');
    if (equals != std::string_view::npos)
      lines[std::string(trimmed(line.substr(0, equals)))] = trimmed(line.substr(equals + 1));
  }
  PictureScale scale;
  scale.by = "ImageJ";
  const auto real = [&](const char* key, double otherwise) {
    double value = 0;
    return to_number(lines[key], value) && std::isfinite(value) ? value : otherwise;
  };
  const double unit = unit_mm(lines["unit"]);
  const auto unit_of = [&](const char* key) {
    return lines[key].empty() ? unit : unit_mm(lines[key]);
  };
  const double x = unit / words.per_unit_x, y = unit_of("yunit") / words.per_unit_y,
               z = unit_of("zunit") * std::abs(real("spacing", 0));
  if (possible(x) && possible(y)) scale.voxel_mm = {x, y, possible(z) ? z : 0};
  // a straight line from stored numbers to values; ImageJ writes signed numbers so
  if (lines["cf"] == "0" && real("c1", 0) != 0) {
    scale.slope = real("c1", 1);
    scale.intercept = real("c0", 0);
  }
  if (const std::int64_t n = count_in(lines["channels"]); n > 0) scale.channels = n;
  if (const std::int64_t n = count_in(lines["frames"]); n > 0) scale.times = n;
  scale.slices = count_in(lines["slices"]);
  // pages without "slices" are one after the other: times, if there are channels, else slices
  if (scale.slices == 0 && scale.volumes() == 1) scale.slices = count_in(lines["images"]);
  if (scale.slices == 0) scale.slices = 1;
  return scale;
}

// The value of an attribute of OME's element Pixels; empty: it has none.
std::string attribute(std::string_view xml, const char* name) {
  const std::size_t element = xml.find("<Pixels");
  if (element == std::string_view::npos) return {};
  const std::string_view inside = xml.substr(element, xml.find('>', element) - element);
  const std::string before = std::string(" ") + name + "=\"";
  const std::size_t at = inside.find(before);
  if (at == std::string_view::npos) return {};
  const std::size_t from = at + before.size();
  return std::string(inside.substr(from, inside.find('"', from) - from));
}

PictureScale by_ome(const TiffWords& words) {
  const std::string_view xml = words.description;
  PictureScale scale;
  scale.by = "OME";
  constexpr const char* kAxes[] = {"X", "Y", "Z"};
  for (int a = 0; a < 3; ++a) {
    const std::string name = std::string("PhysicalSize") + kAxes[a];
    const std::string unit = attribute(xml, (name + "Unit").c_str());
    double value = 0;
    if (!to_number(attribute(xml, name.c_str()), value)) continue;
    const double mm = value * (unit.empty() ? 1e-3 : unit_mm(unit));
    if (possible(mm)) scale.voxel_mm[a] = mm;
  }
  if (scale.voxel_mm.x() == 0 || scale.voxel_mm.y() == 0) scale.voxel_mm.setZero();
  if (const std::int64_t n = count_in(attribute(xml, "SizeC")); n > 0) scale.channels = n;
  if (const std::int64_t n = count_in(attribute(xml, "SizeT")); n > 0) scale.times = n;
  scale.slices = std::max<std::int64_t>(1, count_in(attribute(xml, "SizeZ")));
  const std::string order = lower(attribute(xml, "DimensionOrder"));
  if (order.size() == 5 && order.starts_with("xy") && order.find('z') < 5 && order.find('c') < 5 &&
      order.find('t') < 5)
    scale.order = order.substr(2);
  return scale;
}

}  // namespace

std::int64_t PictureScale::page_of(std::int64_t volume, std::int64_t slice) const {
  std::int64_t page = 0, step = 1;
  for (const char axis : order) {
    page += step * (axis == 'c' ? volume % channels : axis == 'z' ? slice : volume / channels);
    step *= axis == 'c' ? channels : axis == 'z' ? slices : times;
  }
  return page;
}

PictureScale picture_scale(const TiffWords& words) {
  if (words.description.starts_with("ImageJ=")) return by_imagej(words);
  if (words.description.find("<OME") != std::string::npos) return by_ome(words);
  return {};
}

}  // namespace burr::io

#include "burr/io/read/modality.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"

namespace burr::io {
namespace {

// SOP classes of pictures (PS3.4 B.5), below their common root.
constexpr std::pair<std::string_view, const char*> kClasses[] = {
    {"2", "CT"},  {"4", "MR"},         {"128", "PT"}, {"128.1", "PT"}, {"130", "PT"},
    {"20", "NM"}, {"481.2", "RTDOSE"}, {"3.1", "US"}, {"6.1", "US"},   {"6.2", "US"},
    {"3", "US"},  {"6", "US"},         {"5", "NM"}};

// The modality that a class of pictures has; empty: another class.
std::string of_class(const std::string& sop_class) {
  constexpr std::string_view kRoot = "1.2.840.10008.5.1.4.1.1.";
  if (!sop_class.starts_with(kRoot)) return {};
  const std::string_view rest = std::string_view(sop_class).substr(kRoot.size());
  for (const auto& [number, modality] : kClasses)
    if (rest == number) return modality;
  // enhanced and later kinds of CT and MR
  for (const char* kind : {"2.", "4."})
    if (rest.starts_with(kind)) return kind[0] == '2' ? "CT" : "MR";
  return {};
}

// Why bone is not the bright part of such a picture, and what to do, as the end of a sentence; empty: it is.
std::string why_no_bone(const std::string& modality) {
  if (by_rays(modality)) return {};
  if (modality == "MR")
    return "is a picture by magnetic resonance (MR): bone is dark in it, so a level of grey values "
           "gives flesh; segment the bone first (for example in 3D Slicer) and give burr the "
           "segmentation";
  const char* shows = "another kind of picture than CT";
  if (modality == "PT" || modality == "NM" || modality == "ST")
    shows = "how much of a tracer lies where, not where bone is";
  if (modality == "RTDOSE") shows = "a dose of radiation, not the body";
  if (modality == "US" || modality == "IVUS")
    shows = "ultrasound, in which bone hides what lies behind it";
  return fmt::format(
      "is of modality {} and shows {}; give burr the CT, or a segmentation of the bone",
      base::printable(modality, 16), shows);
}

}  // namespace

std::string modality_of(const std::string& stated, const std::string& sop_class) {
  return stated.empty() ? of_class(sop_class) : stated;
}

bool by_rays(const std::string& modality) {
  static constexpr std::string_view kByRays[] = {"CT", "",   "OT", "XA", "RF", "DX",
                                                 "CR", "PX", "IO", "SC", "MG", "RTIMAGE"};
  return std::find(std::begin(kByRays), std::end(kByRays), modality) != std::end(kByRays);
}

void take_modality(const std::string& stated, const std::string& sop_class, const std::string& file,
                   Scan& scan) {
  scan.modality = modality_of(stated, sop_class);
  const std::string other = of_class(sop_class);
  if (!stated.empty() && !other.empty() && other != stated && by_rays(stated) != by_rays(other)) {
    scan.ask(
        Ask::doubt,
        fmt::format("{}: contradicts itself: it is {} by its Modality, but {} by its SOP Class",
                    file, base::printable(stated, 16), other));
    return;
  }
  if (const std::string why = why_no_bone(scan.modality); !why.empty())
    scan.ask(Ask::doubt, fmt::format("{}: {}", file, why));
}

}  // namespace burr::io

#include "burr/io/read/dicom_syntaxes.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/dicom_facts.h"

namespace burr::io {
namespace {

constexpr std::string_view kStandard = "1.2.840.10008.1.2";

// Of the standard, and not read.
constexpr std::pair<std::string_view, const char*> kNotRead[] = {
    {".4.94", "JPIP, a reference to a server that holds them"},
    {".4.95", "JPIP, a reference to a server that holds them"},
    {".4.100", "MPEG-2 video"},
    {".4.101", "MPEG-2 video"},
    {".4.102", "MPEG-4 video"},
    {".4.103", "MPEG-4 video"},
    {".4.104", "MPEG-4 video"},
    {".4.105", "MPEG-4 video"},
    {".4.106", "MPEG-4 video"},
    {".4.107", "HEVC video"},
    {".4.108", "HEVC video"},
    {".4.110", "JPEG XL"},
    {".4.111", "JPEG XL"},
    {".4.112", "JPEG XL"},
    {".4.204", "JPIP, a reference to a server that holds them"},
    {".4.205", "JPIP, a reference to a server that holds them"},
    {".6.1", "MIME"},
    {".6.2", "XML"},
    {".7.1", "SMPTE video"},
    {".7.2", "SMPTE video"},
    {".7.3", "SMPTE audio"},
};

// The maker of a private transfer syntax, by the root of its number.
constexpr std::pair<std::string_view, const char*> kMakers[] = {
    {"1.2.840.113619.", "GE"},           {"1.3.46.670589.", "Philips"},
    {"1.3.12.2.1107.", "Siemens"},       {"1.2.392.200036.9116.", "Canon"},
    {"1.2.392.200036.9107.", "Hitachi"}, {"1.2.392.200036.9125.", "Fujifilm"},
    {"1.2.840.113564.", "Carestream"},   {"1.2.124.113532.", "Agfa"},
    {"1.2.840.113708.", "Merge"},        {"1.2.840.10008.1.20", "Papyrus 3"},
};

// As the end of a number: ".4.94" of "1.2.840.10008.1.2.4.94", and of "1.2.840.10008.1.2.4.94.1".
bool is_of(std::string_view rest, std::string_view part) {
  return rest == part || (rest.starts_with(part) && rest.substr(part.size()).starts_with("."));
}

}  // namespace

std::string why_not_read(std::string_view syntax) {
  if (syntax.empty() || syntax == kGePrivate) return {};
  if (syntax == kStandard || syntax.starts_with(std::string(kStandard) + ".")) {
    const std::string_view rest = syntax.substr(kStandard.size());
    const auto* const found = std::find_if(std::begin(kNotRead), std::end(kNotRead),
                                           [&](const auto& one) { return is_of(rest, one.first); });
    if (found == std::end(kNotRead)) return {};
    return fmt::format("its pixels are stored as {}, which burr does not read ({})", found->second,
                       base::printable(syntax));
  }
  const auto* const maker =
      std::find_if(std::begin(kMakers), std::end(kMakers),
                   [&](const auto& one) { return syntax.starts_with(one.first); });
  return fmt::format(
      "is DICOM of a transfer syntax that burr does not read: {}{}", base::printable(syntax),
      maker != std::end(kMakers) ? fmt::format(", private to {}", maker->second) : "");
}

bool is_high_throughput(std::string_view syntax) {
  constexpr std::string_view kAll[] = {"1.2.840.10008.1.2.4.201", "1.2.840.10008.1.2.4.202",
                                       "1.2.840.10008.1.2.4.203"};
  return std::find(std::begin(kAll), std::end(kAll), syntax) != std::end(kAll);
}

}  // namespace burr::io

// Haptic devices: those that burr itself would find, tried in a process of its own.
#include <fmt/format.h>

#include <algorithm>

#include "burr/device/forcedimension/dhd.h"
#include "burr/device/openhaptics/hd.h"
#include "burr/workshop/device_book.h"
#include "burr/workshop/hand_device.h"
#include "doctor/doctor_checks.h"
#include "doctor/run_in_process.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

constexpr const char* kGroup = "haptic devices";

// "+text" or "-text": what was found, or why not.
std::string of_library(const std::string& kind) {
  if (kind == "touch") {
    const auto hd = device::openhaptics::load();
    return hd ? "+" + (*hd)->file : "-" + in_options(hd.error()).text;
  }
  if (kind == "force-dimension") {
    const auto dhd = device::forcedimension::load();
    if (!dhd) return "-" + in_options(dhd.error()).text;
    const std::string& version = (*dhd)->version;
    return "+" + (*dhd)->file + (version.empty() ? "" : " " + version);
  }
  return "+";
}

std::string of_device(const std::string& kind) {
  workshop::HandRequest request;
  request.device = kind;
  auto device = workshop::make_hand(request);
  if (!device) return "-" + in_options(device.error()).text;
  const Status opened = (*device)->open();
  if (!opened) return "-" + in_options(opened.error()).text;
  const device::DeviceSpec spec = (*device)->spec();
  const std::string trouble = in_options((*device)->trouble());
  (*device)->close();
  const std::string words =
      fmt::format("{}: {:.1f} N, {:.0f} Hz{}{}", workshop::id_of(spec), spec.peak_force,
                  spec.native_rate, spec.software.empty() ? "" : "; ", spec.software);
  return trouble.empty() ? "+" + words : fmt::format("!{}. {}", words, trouble);
}

// Splits a sentence of burr into the reason and the advice, which its semicolon separates.
void split(const std::string& sentence, Finding& finding) {
  const std::size_t cut = sentence.find("; ");
  finding.value = sentence.substr(0, cut);
  finding.todo = cut == std::string::npos ? "see docs/use/devices.md" : sentence.substr(cut + 2);
}

}  // namespace

std::vector<Finding> look_at_devices(const System& system) {
  std::vector<Finding> findings;
  for (const workshop::HandKind& kind : workshop::hand_kinds()) {
    Finding finding{kGroup, kind.name, Health::absent, "", ""};
    const std::string name = kind.name;
    const std::string if_owned =
        fmt::format(", if you have one (docs/use/devices/{}.md)", kind.page);
    const ProcessResult library =
        run_in_process([&name] { return of_library(name); }, system.maker_timeout);
    if (!library.ended) {
      finding.health = Health::trouble;
      finding.value = "its library was loaded, then " + library.words;
      finding.todo =
          fmt::format("install it anew as its maker says (docs/use/devices/{}.md)", kind.page);
    } else if (library.words.starts_with('-')) {
      split(library.words.substr(1), finding);
      finding.todo += if_owned;
    } else {
      const ProcessResult there =
          run_in_process([&name] { return of_device(name); }, system.maker_timeout);
      if (!there.ended) {
        finding.health = Health::trouble;
        finding.value = "it was opened, then " + there.words;
        finding.todo =
            fmt::format("try the maker's own test program; docs/use/devices/{}.md", kind.page);
      } else if (there.words.starts_with('+')) {
        finding.health = Health::good;
        finding.value = there.words.substr(1);
        finding.todo = fmt::format("burr devices test {}", kind.name);
      } else {
        split(there.words.substr(1), finding);
        if (there.words.starts_with('!'))
          finding.health = Health::trouble;
        else
          finding.todo += if_owned;
      }
      const std::string file = library.words.substr(1);
      if (!file.empty()) finding.value = fmt::format("{} is there; {}", file, finding.value);
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace burr::app

// USB devices, by their makers' numbers: whether they are plugged in, and whether this user may
// open them.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <system_error>

#include "doctor/doctor_checks.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGroup = "USB";

constexpr const char* kTouchVendor = "2988";

struct Known {
  const char* vendor;
  const char* product;  // "": any
  const char* what;
  bool any_end;  // only the first two digits of the product count
};
constexpr Known kKnown[] = {
    {"1451", "", "Force Dimension", false},
    {"0403", "cb48", "Novint Falcon", false},
    {"16c0", "04", "Polhem, WoodenHaptics", true},
    {kTouchVendor, "", "3D Systems Touch", false},
};

std::string line_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

const Known* known(const std::string& vendor, const std::string& product) {
  for (const Known& one : kKnown) {
    const std::string wanted = one.product;
    if (vendor == one.vendor &&
        (wanted.empty() || (one.any_end ? product.starts_with(wanted) : product == wanted)))
      return &one;
  }
  return nullptr;
}

std::string in_small_letters(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return text;
}

// By its maker's number or, as that of the newer model is not published, by its maker's name.
bool is_touch(const fs::path& device) {
  if (line_of(device / "idVendor") == kTouchVendor) return true;
  const std::string maker = in_small_letters(line_of(device / "manufacturer"));
  return maker.find("3d systems") != std::string::npos ||
         maker.find("geomagic") != std::string::npos || maker.find("sensable") != std::string::npos;
}

// Whether an interface of the device is of this class of USB, in hexadecimal.
bool has_class(const fs::path& device, const std::string& wanted) {
  std::error_code nobody_asks;
  for (const auto& entry : fs::directory_iterator(device, nobody_asks))
    if (line_of(entry.path() / "bInterfaceClass") == wanted) return true;
  return false;
}

// A Touch has been sold in two forms, which look alike and need different steps (docs/use/devices/touch.md).
void tell_which_touch(const fs::path& device, bool any_hidraw, bool any_tty, Finding& finding) {
  constexpr const char* kHid = "03";
  const bool hid = any_hidraw || has_class(device, kHid);
  if (hid == any_tty) return;  // both, or neither: not to be told
  finding.what = hid ? "3D Systems Touch HID" : "3D Systems Touch USB";
  if (finding.health != Health::good) return;
  if (hid && !any_hidraw) {
    finding.health = Health::trouble;
    finding.value = "plugged in, but the kernel made no hidraw node for it";
    finding.todo = "unplug it and plug it in again; then: sudo modprobe usbhid";
    return;
  }
  finding.todo =
      hid ? "it has no ttyACM, so the maker's ListCOMPortHapticDevices shows nothing; take the "
            "driver of November 2023 or later (docs/use/devices/touch.md)"
          : "the older model, out of sale: its node is a ttyACM (docs/use/devices/touch.md)";
}

bool may_use(const System& system, const fs::path& node) {
  if (system.may_use) return system.may_use(node);
  return access(node.c_str(), R_OK | W_OK) == 0;
}

// Pads with zeros: "3" becomes "003".
std::string three(const std::string& number) {
  return number.size() < 3 ? std::string(3 - number.size(), '0') + number : number;
}

// Serial lines and raw HID nodes of a device.
std::vector<fs::path> nodes_below(const System& system, const fs::path& device) {
  std::vector<fs::path> nodes;
  std::error_code nobody_asks;
  for (auto it = fs::recursive_directory_iterator(
           device, fs::directory_options::skip_permission_denied, nobody_asks);
       it != fs::recursive_directory_iterator(); it.increment(nobody_asks)) {
    const std::string name = it->path().filename().string();
    const std::string above = it->path().parent_path().filename().string();
    if ((above == "tty" && name.starts_with("ttyACM")) ||
        (above == "hidraw" && name.starts_with("hidraw")))
      nodes.push_back(system.root / "dev" / name);
    if (nodes.size() > 16) break;
  }
  return nodes;
}

}  // namespace

std::string udev_rules() {
  std::string rules =
      "# Haptic devices for whoever sits at the computer; as `burr doctor --print-rule` prints "
      "it.\n";
  for (const Known& one : kKnown) {
    const std::string product =
        *one.product == '\0'
            ? ""
            : fmt::format(", ATTRS{{idProduct}}==\"{}{}\"", one.product, one.any_end ? "*" : "");
    rules += fmt::format("# {}\n", one.what);
    for (const char* subsystem : {"usb", "tty", "hidraw"})
      rules += fmt::format(
          "SUBSYSTEM==\"{}\", ATTRS{{idVendor}}==\"{}\"{}, MODE=\"0660\", TAG+=\"uaccess\"\n",
          subsystem, one.vendor, product);
  }
  return rules;
}

fs::path udev_file(const System& system) { return system.root / "etc/udev/rules.d/70-burr.rules"; }

std::vector<Finding> look_at_nodes(const System& system) {
  std::vector<Finding> findings;
  std::error_code nobody_asks;
  for (const auto& entry :
       fs::directory_iterator(system.root / "sys/bus/usb/devices", nobody_asks)) {
    const fs::path device = entry.path();
    const Known* one = known(line_of(device / "idVendor"), line_of(device / "idProduct"));
    const bool touch = is_touch(device);
    if (one == nullptr && !touch) continue;
    std::vector<fs::path> nodes = {system.root / "dev/bus/usb" / three(line_of(device / "busnum")) /
                                   three(line_of(device / "devnum"))};
    for (fs::path& more : nodes_below(system, device)) nodes.push_back(std::move(more));
    Finding finding{kGroup, one != nullptr ? one->what : "3D Systems Touch", Health::good, "", ""};
    std::string closed;
    bool any_hidraw = false, any_tty = false;
    for (const fs::path& node : nodes) {
      const std::string shown = "/" + node.lexically_relative(system.root).string();
      finding.value += (finding.value.empty() ? "" : ", ") + shown;
      any_hidraw = any_hidraw || node.filename().string().starts_with("hidraw");
      any_tty = any_tty || node.filename().string().starts_with("ttyACM");
      if (!may_use(system, node)) closed += (closed.empty() ? "" : ", ") + shown;
    }
    if (!closed.empty()) {
      finding.health = Health::trouble;
      finding.value = "plugged in, but you may not open " + closed;
      // the package of Debian brings the rule as well
      finding.todo =
          one == nullptr  // its maker's number is not known, so burr's rule does not name it
              ? "the installer of 3D Systems' driver writes a rule that allows it; run it, then "
                "unplug the device and plug it in again"
              : fs::exists(udev_file(system), nobody_asks) ||
                        fs::exists(system.root / "usr/lib/udev/rules.d/70-burr.rules", nobody_asks)
                    ? "the rule exists: unplug the device and plug it in again, at the "
                      "computer itself, not over ssh"
                    : "burr doctor --fix writes the rule that allows it";
    }
    if (touch) tell_which_touch(device, any_hidraw, any_tty, finding);
    findings.push_back(std::move(finding));
  }
  if (findings.empty())
    findings.push_back({kGroup, "haptic devices", Health::absent,
                        "no Force Dimension, Falcon, Polhem or Touch is plugged in", ""});
  std::sort(findings.begin(), findings.end(),
            [](const Finding& a, const Finding& b) { return a.what < b.what; });
  return findings;
}

}  // namespace burr::app

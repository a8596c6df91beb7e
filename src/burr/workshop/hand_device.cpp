#include "burr/workshop/hand_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "burr/device/crtk/leader.h"
#include "burr/device/forcedimension/omega.h"
#include "burr/device/haply/inverse.h"
#include "burr/device/openhaptics/touch.h"
#include "burr/device/polhem/polhem.h"

namespace burr::workshop {
namespace {

constexpr double kUsualRate = 1000;  // [Hz]

}  // namespace

const std::vector<HandKind>& hand_kinds() {
  static const std::vector<HandKind> all = {
      {"touch", "3D Systems Touch (Omni), Touch X (Desktop), Premium", "touch"},
      {"force-dimension", "Force Dimension omega, delta, sigma, lambda; Novint Falcon",
       "force_dimension"},
      {"haply", "Haply Inverse3, Inverse3x, Minverse with VerseGrip", "haply"},
      {"polhem", "Haptikfabriken's Polhem, and WoodenHaptics with its serial electronics",
       "polhem"},
      {"crtk", "robot arms that speak CRTK: dVRK's leaders, lab devices behind a node", "crtk"},
  };
  return all;
}

bool is_hand_kind(std::string_view device) {
  const std::string_view kind = device.substr(0, device.find(':'));
  const auto& all = hand_kinds();
  return std::any_of(all.begin(), all.end(), [&](const HandKind& one) { return kind == one.name; });
}

std::string kinds_known() {
  std::vector<std::string> known;
  for (const HandKind& one : hand_kinds()) known.emplace_back(one.name);
  return fmt::format("{}", fmt::join(known, ", "));
}

NamesThere names_there(const HandKind& kind) {
  const std::string name = kind.name;
  NamesThere there;
  const auto add = [&](const std::string& which) { there.names.push_back(name + ":" + which); };
  if (name == "touch") {
    there.note =
        "If there are several, each has the name from its setup program: touch:NAME. The library "
        "cannot list them.";
  } else if (name == "force-dimension") {
    if (const auto plugged = device::forcedimension::Omega::list_devices()) {
      for (const int serial : plugged->serials) add(std::to_string(serial));
      if (!plugged->serials.empty() && plugged->nameless > 0)
        there.note = fmt::format(
            "{} more without a readable serial number; another program may have them open.",
            plugged->nameless);
    }
  } else if (name == "haply") {
    if (const auto known = device::haply::list_devices({})) {
      for (const device::haply::DeviceId& arm : known->arms) add(arm.id);
      if (known->grips.size() > 1)
        there.note = fmt::format("Grips found: {}. haply:ARM+GRIP chooses the grip for an arm.",
                                 fmt::join(known->grips, ", "));
    }
  } else if (name == "polhem") {
    for (const device::polhem::Port& port :
         device::polhem::ports_of_arms(device::polhem::PolhemSettings{}.system))
      add(port.path);
  } else if (name == "crtk") {
    if (const auto arms = device::crtk::list_arms())
      for (const std::string& arm : *arms) add(arm);
  }
  if (there.names.empty()) there.names.push_back(name);
  return there;
}

Result<std::unique_ptr<device::Device>> make_hand(const HandRequest& request) {
  const std::string& name = request.device;
  const std::string kind = name.substr(0, name.find(':'));
  const std::string which = kind.size() < name.size() ? name.substr(kind.size() + 1) : "";
  if (kind == "touch") {
    device::openhaptics::TouchSettings settings;
    settings.name = which;
    return std::unique_ptr<device::Device>(
        std::make_unique<device::openhaptics::Touch>(std::move(settings)));
  }
  if (kind == "force-dimension") {
    device::forcedimension::OmegaSettings settings;
    settings.home_allowed = request.home;
    settings.is_homed = request.is_homed;
    if (!which.empty()) {
      const auto [end, trouble] =
          std::from_chars(which.data(), which.data() + which.size(), settings.serial);
      if (trouble != std::errc() || end != which.data() + which.size() || settings.serial < 0)
        return error(Trouble::usage,
                     fmt::format("`device` {}: after the colon comes a serial number", name));
    }
    return std::unique_ptr<device::Device>(std::make_unique<device::WireDevice>(
        std::make_unique<device::forcedimension::Omega>(std::move(settings))));
  }
  if (kind == "haply") {
    device::haply::InverseSettings settings;
    const std::size_t plus = which.find('+');
    settings.id = which.substr(0, plus);
    if (plus != std::string::npos) settings.grip = which.substr(plus + 1);
    return std::unique_ptr<device::Device>(std::make_unique<device::WireDevice>(
        std::make_unique<device::haply::Inverse>(std::move(settings))));
  }
  if (kind == "polhem") {
    device::polhem::PolhemSettings settings;
    settings.port = which;
    return std::unique_ptr<device::Device>(std::make_unique<device::WireDevice>(
        std::make_unique<device::polhem::Polhem>(std::move(settings))));
  }
  if (kind == "crtk") {
    device::crtk::LeaderSettings settings;
    settings.arm = which;
    settings.home_allowed = request.home;
    settings.takes_torque = [](const std::string& arm) {
      device::DeviceSpec named;
      named.name = device::crtk::kArmName;
      named.serial = arm;
      return DeviceBook::read(users_book()).of(id_of(named)).takes_torque_nm;
    };
    return std::unique_ptr<device::Device>(std::make_unique<device::WireDevice>(
        std::make_unique<device::crtk::Leader>(std::move(settings))));
  }
  return error(Trouble::usage,
               fmt::format("`device` {}: burr does not know this device; use one of: {}", name,
                           kinds_known()));
}

Result<OpenedHand> open_hand(const HandRequest& request, const math::Pose& start,
                             const math::Quat& world_from_view) {
  auto device = make_hand(request);
  if (!device) return device.error();
  OpenedHand laid;
  laid.hand = std::make_unique<device::MappedHand>(std::move(*device), start, world_from_view);
  Status opened = laid.hand->open();
  if (!opened) return opened.error();
  const DeviceBook book = DeviceBook::read(users_book());
  laid.notices = book.troubles();
  laid.id = id_of(laid.hand->spec());
  laid.preferences = book.of(laid.id);
  DevicePreferences preferences = laid.preferences;
  if (request.scale) preferences.mapping.scale = *request.scale;
  preferences.mapping.dead_man = preferences.mapping.dead_man || request.dead_man;
  const Status set = laid.hand->set(preferences.mapping);
  if (!set) return set.error();
  const double peak = laid.hand->spec().peak_force;
  laid.max_force = preferences.max_force_n > 0 ? std::min(peak, preferences.max_force_n) : peak;
  laid.vibration = preferences.vibration;
  laid.torque = preferences.torque;
  return laid;
}

double tick_rate(const device::DeviceSpec& spec) {
  if (!(spec.native_rate > 0)) return kUsualRate;
  return std::clamp(spec.native_rate / std::max(1.0, std::round(spec.native_rate / kUsualRate)),
                    500.0, 10'000.0);
}

}  // namespace burr::workshop

// device/forcedimension/omega.h - Force Dimension's omega, delta, sigma and lambda, and the Falcon
// through the same library: three or six sensed degrees of freedom, three actuated.
//
//     Session::make(bone, std::make_unique<WireDevice>(std::make_unique<Omega>(settings)), ...)
//
// Writing a force waits for one frame of the device, at 1 to 4 kHz; this sets the pace of the wire.
// The library's frame is x to the user, y right, z up. Ours, which is used on this side, is x
// right, y up, z to the user. The tool's handle lies along its +z: towards the user at zero
// rotation. A gripper acts as the pedal: squeezed is full. It counts only after it has been seen
// open.
//
// The arm never moves by itself unless home_allowed is set, and then only before the first session;
// an arm that loses its home position later reports that. The maker's own protections (velocity,
// watchdog, hand detection) stay on. When one of them switches the force off, that is reported, and
// burr sends no force until it is on again.
// Thread: as Wire. Several devices at once: one Omega each.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "burr/device/forcedimension/dhd.h"
#include "burr/device/wire.h"

namespace burr::device::forcedimension {

struct OmegaSettings {
  std::string dhd_file = {};  // empty: BURR_FORCEDIMENSION, or the one candidates() finds
  int index = 0;              // among the devices plugged in, from 0
  int serial = -1;            // of the wanted device, whatever its index; -1: any
  bool home_allowed = false;  // the arm may move by itself to find its home position
  bool is_homed = false;      // the user says so, where the library cannot tell (no libdrd)
  double rate = 1000;         // of the ticks; 500..4000 [Hz]
  Link::Now now = &rt::monotonic_ns;
};

// The devices that are plugged in.
struct DeviceList {
  std::vector<int> serials;  // of those that can be opened and have one
  int nameless = 0;          // number of devices without a serial number
};

class Omega final : public Wire {
 public:
  // Opens and closes each device; nothing moves and no force is sent.
  [[nodiscard]] static Result<DeviceList> list_devices(const OmegaSettings& settings = {});

  explicit Omega(OmegaSettings settings = {}) : settings_(std::move(settings)) {}
  ~Omega() override { disconnect(); }

  [[nodiscard]] Result<DeviceSpec> connect() override;
  [[nodiscard]] Read read(HandState& hand) BURR_RT override;
  void write_torque(const math::Vec3& torque) BURR_RT override { torque_ = torque; }
  [[nodiscard]] bool write(const math::Vec3& force) BURR_RT override;
  void disconnect() override;
  [[nodiscard]] std::string why() const override;
  [[nodiscard]] unsigned why_revision() const BURR_RT override { return why_revision_; }

 private:
  [[nodiscard]] Status find();
  [[nodiscard]] int open(int index, const char*& why) const;
  [[nodiscard]] Status home();
  [[nodiscard]] Status prepare(const DeviceSpec& spec);
  [[nodiscard]] DeviceSpec describe() const;
  void watch() const;
  [[nodiscard]] int serial_of(int id) const;
  void release_force(int id);

  [[nodiscard]] bool tolerate(const char*& trouble) BURR_RT;
  void note(const char*& what, const char* words) BURR_RT;
  [[nodiscard]] bool read_status() BURR_RT;
  void read_gripper(HandState& hand) BURR_RT;

  OmegaSettings settings_;
  const Dhd* dhd_ = nullptr;
  int id_ = -1;  // of the device in the library; -1: none is open
  int serial_ = -1;
  bool was_ready_ = false;
  std::string name_ = "the Force Dimension device";
  bool wrist_ = false;
  double peak_ = 0, peak_torque_ = 0;
  math::Vec3 torque_ = math::Vec3::Zero();

  // used only on the wire's thread
  char to_ = 0;
  const char *read_trouble_ = nullptr, *write_trouble_ = nullptr, *status_trouble_ = nullptr;
  int errors_ = 0;  // failed reads in a row
  unsigned why_revision_ = 0;
  bool off_ = false;
  bool seen_power_ = false, seen_connected_ = false, seen_force_ = false;
  std::int64_t looked_ns_ = INT64_MIN;
  int (*gripper_)(double*, char) = nullptr;
  double open_ = 0;  // the widest opening seen [rad or m]
  bool armed_ = false;
};

}  // namespace burr::device::forcedimension

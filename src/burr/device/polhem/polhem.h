// device/polhem/polhem.h - Haptikfabriken's Polhem, and WoodenHaptics with its electronics, over a
// serial port.
//
// The arm answers each of our lines with one of its own. Its frame: x to the user, y right, z up;
// ours is x right, y up, z to the user. The stylus lies along the x axis of its wrist, away from
// the arm. The rotation of the stylus about itself and its button come over a separate radio, which
// burr does not read: the tool does not turn about its handle, and a pedal mills. Two
// firmwares that the maker published stop the motors when no line comes: firmware/main.cpp of
// haptikfabrikenapi, for the older HID boards, after 0.5 s, and polhem_teensy.ino (2020, serial)
// after 100 ms. The firmware of the arms of 2021 is not published, so a guardian (guardian.h) sends
// "no force" to every arm if burr dies. Thread: as Wire. Memory: none after connect().
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "burr/device/guardian.h"
#include "burr/device/polhem/line.h"
#include "burr/device/silence.h"
#include "burr/device/wire.h"

namespace burr::device::polhem {

struct PolhemSettings {
  std::string port = {};     // /dev/ttyACM0; empty: the first port of an arm
  std::string system = "/";  // folder that contains sys and dev
};

class Polhem final : public Wire {
 public:
  explicit Polhem(PolhemSettings settings = {});
  ~Polhem() override;

  [[nodiscard]] Result<DeviceSpec> connect() override;
  [[nodiscard]] Read read(HandState& hand) BURR_RT override;
  [[nodiscard]] bool write(const math::Vec3& force) BURR_RT override;
  void disconnect() override;
  [[nodiscard]] std::string why() const override;
  [[nodiscard]] unsigned why_revision() const BURR_RT override { return why_revision_; }

 private:
  void note(const char* words) BURR_RT;
  enum class Received { state, nothing, gone };
  [[nodiscard]] Received receive(int longest_ms) BURR_RT;
  void note_late_answer(std::int64_t now) BURR_RT;
  [[nodiscard]] bool send(const math::Vec3& force) BURR_RT;  // false: the port is gone

  PolhemSettings settings_;
  std::unique_ptr<Guardian> guardian_;
  int port_ = -1;
  std::string name_ = "the Polhem";
  Lines lines_;
  State state_;
  Line out_{};
  std::size_t unsent_bytes_ = 0;  // bytes of out_ that the port has not taken yet
  bool awaits_answer_ = false;
  std::int64_t sent_ns_ = 0, answered_ns_ = 0;
  Silence silence_;
  std::int64_t last_beat_ns_ = 0;  // last beat to the guardian
  bool answers_late_ = false;      // answers are late: no force is sent until they have come
  bool zero_was_sent_ = false;     // "no force" was sent when the answers became late
  std::int64_t late_since_ns_ = 0;
  math::Vec3 last_place_ = math::Vec3::Zero(), velocity_ = math::Vec3::Zero();
  int invalid_lines_ = 0;
  const char* trouble_ = nullptr;
  unsigned why_revision_ = 0;
};

// The serial ports of arms, recognized by their USB ids (16c0:04xx): path, such as /dev/ttyACM0,
// and serial number; sorted.
struct Port {
  std::string path, serial;
};
[[nodiscard]] std::vector<Port> ports_of_arms(const std::string& system);

}  // namespace burr::device::polhem

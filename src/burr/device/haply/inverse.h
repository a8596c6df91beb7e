// device/haply/inverse.h - Haply's Inverse3, Inverse3x and Minverse with a VerseGrip, through the
// maker's Inverse Service on this computer.
//
// Each of our messages is answered by one state, and there is never more than one under way. The
// device does only what we ask for in each message, so it releases the force by itself when burr
// stops. Its frame: x right, y forward, z up; ours is x right, y up, z to the user. The grip points
// along its +y, so the tool's handle, our +z, is its -y. Without a grip the tool stands upright.
// Button a mills, b lifts. The service knows two spellings of a force, depending on its version; a
// force too small to be felt shows which one it obeys. An arm that is in use before our first
// message belongs to another program and is left alone, because two forces on one arm add up. Other
// events of the service (haply/events.h) are shown as texts; an emergency brake removes the force
// until it is released.
// Thread: as Wire (device/wire.h). Memory: allocated on the wire's thread, one message at a time;
// none in the tick.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/device/wire.h"

namespace burr::device::haply {

struct InverseSettings {
  std::string host = {};  // empty: HAPLY_WS_HOST, else 127.0.0.1
  int port = 0;           // 0: HAPLY_WS_PORT, else 10001, then 10000
  std::string id = {};    // of the arm; empty: the first
  std::string grip = {};  // id of the grip held with the arm; empty: the first
  int events_port = 0;    // 0: HAPLY_EVENTS_PORT, else 10020
};

// Lists every arm and every grip that the service knows; sends nothing to any of them.
struct DeviceId {
  std::string id, type;
};
struct DeviceList {
  std::vector<DeviceId> arms;
  std::vector<std::string> grips;
};
[[nodiscard]] Result<DeviceList> list_devices(const InverseSettings& settings);

class Inverse final : public Wire {
 public:
  explicit Inverse(InverseSettings settings = {});
  ~Inverse() override;

  [[nodiscard]] Result<DeviceSpec> connect() override;
  [[nodiscard]] Read read(HandState& hand) BURR_RT override;
  [[nodiscard]] bool write(const math::Vec3& force) BURR_RT override;
  void disconnect() override;
  [[nodiscard]] std::string why() const override;
  [[nodiscard]] unsigned why_revision() const BURR_RT override { return why_revision_; }

 private:
  friend Result<DeviceList> list_devices(const InverseSettings&);
  struct Connection;
  [[nodiscard]] Status reach();
  [[nodiscard]] Status read_first_state();
  [[nodiscard]] Status find_force_key();
  void note(const char* words) BURR_RT;

  InverseSettings settings_;
  std::string host_;
  int port_ = 0;
  std::unique_ptr<Connection> connection_;
  bool braked_ = false;  // state of the brake at the last connection
  std::string name_ = "the Inverse3";
  const char* trouble_ = nullptr;
  unsigned why_revision_ = 0;
};

}  // namespace burr::device::haply

// device/openhaptics/touch.h - 3D Systems' Touch, Touch X and Premium: six sensed degrees of
// freedom, three actuated; the device of Eriksson's thesis.
//
// The library calls us a thousand times a second: a reading, the tick's force, the next reading.
// Its frame is ours: x right, y up, z to the user; the stylus' own z runs along it, away from the
// tip. When it is unplugged or reports a fault, the hand is lost; a new attempt is made twice a
// second.
// Thread: as Device; the callback on the library's own thread. Two devices: one Touch each, by the
// names given in Touch Setup.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "burr/device/linked.h"
#include "burr/device/openhaptics/hd.h"
#include "burr/rt/thread.h"

namespace burr::device::openhaptics {

struct TouchSettings {
  std::string hd_file = {};  // empty: BURR_OPENHAPTICS, or the one the system finds
  std::string name = {};     // as in Touch Setup; empty: the default device
  LinkSettings link = {};
  Link::Now now = &rt::monotonic_ns;
};

class Touch final : public LinkedDevice {
 public:
  explicit Touch(TouchSettings settings = {});
  ~Touch() override { close(); }

  Status open() override;
  void close() override;
  [[nodiscard]] std::string trouble() const override;

 private:
  Result<DeviceSpec> start();
  void end();
  [[nodiscard]] DeviceSpec describe() const;
  [[nodiscard]] int pushes() const;
  [[nodiscard]] std::string versions() const;
  void calibrate() BURR_RT;
  void note(Code code) BURR_RT;
  [[nodiscard]] bool read(HandState& hand) BURR_RT;
  void exchange() BURR_RT;
  static unsigned tick(void* self);
  void keep();

  TouchSettings settings_;
  const Hd* hd_ = nullptr;
  Handle handle_ = kNoDevice;
  unsigned long loop_ = 0;
  std::unique_ptr<rt::Thread> watch_thread_;
  std::atomic<bool> stop_ = false;
  std::string found_;  // why it could not be opened again
  mutable std::mutex trouble_mutex_;

  // shared between the callback and the other threads
  std::atomic<Code> trouble_ = kNoError;  // of the previous frame
  std::atomic<int> bad_frames_ = 0;       // in a row
  std::atomic<Code> calibration_ = kCalibrationOk;
  std::atomic<std::int64_t> called_ns_ = 0;  // time of the last call
  // used only in the callback
  std::uint64_t frames_ = 0;
  int warm_frames_ = 0;
  double peak_ = 0, peak_torque_ = 0;  // [N], [N m]
  bool turns_ = false;                 // the device can give torque
};

}  // namespace burr::device::openhaptics

// device/crtk/reach.h - how far the bus of CRTK arms reaches: this computer alone, unless somebody asked for its
// network. For use of this room only.
//
// DDS has no password: whoever reaches the bus may move an arm and read a session. So Cyclone DDS is told to use
// the loopback interface and no multicast; and as it still binds what it hears with to every address, the kernel
// drops there what does not come from 127.0.0.0/8.
// Thread: any; takes a lock.
#pragma once

#include <dds/dds.h>

#include <memory>

#include "burr/base/result.h"

namespace burr::device::crtk {

enum class Reach { this_computer, network };

// network: asked for by a setting. Else by the environment, as ROS 2 has it: ROS_AUTOMATIC_DISCOVERY_RANGE is
// SUBNET or SYSTEM_DEFAULT, ROS_LOCALHOST_ONLY is 0, or CYCLONEDDS_URI says how the network is used.
[[nodiscard]] Reach reach_asked(bool network);

// A share in a DDS domain of this process; the last one closes it.
class Domain {
 public:
  // Error: it is open in this process with another reach, or DDS cannot be opened.
  [[nodiscard]] static Result<std::shared_ptr<Domain>> join(int number, Reach reach);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  [[nodiscard]] Reach reach() const { return reach_; }
  // After a participant was made in it. Error: the kernel does not keep others out.
  [[nodiscard]] Status keep_others_out() const;

 private:
  Domain(int number, Reach reach, dds_entity_t entity)
      : number_(number), reach_(reach), entity_(entity) {}
  int number_;
  Reach reach_;
  dds_entity_t entity_;  // 0: it is Cyclone's own
};

}  // namespace burr::device::crtk

// guidance/injury.h - notices that a turning burr is in a structure that must be spared.
//
// Pure: from what the page knows at a picture to whether there is a new injury. Thread: main. SI.
#pragma once

#include <string>

namespace burr::guidance {

class InjuryWatch {
 public:
  // name: the nearest structure; distance: from the burr's surface to it, below 0 inside; known to half
  // a voxel. True: an injury begins. It is over when the burr is out of the structure again.
  [[nodiscard]] bool look(const std::string& name, double distance, bool turning, double voxel) {
    if (distance > 0) hurt_.clear();
    is_in_ = turning && distance < -0.5 * voxel;
    if (!is_in_ || hurt_ == name) return false;
    hurt_ = name;
    return true;
  }
  // No structure is near.
  void nothing_near() {
    hurt_.clear();
    is_in_ = false;
  }
  [[nodiscard]] bool is_in() const { return is_in_; }  // now

 private:
  std::string hurt_;
  bool is_in_ = false;
};

}  // namespace burr::guidance

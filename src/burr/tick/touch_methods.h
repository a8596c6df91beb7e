// tick/touch_methods.h - all touch methods for one bone, of which one is in use; it may be changed
// between two ticks. A tool that is no round burr has a method of its own (six/tool_touch.h), whichever
// of them is chosen for the burr.
//
// The method "triangles" touches the triangles that a renderer would have: those of the patches
// around the burr as they were at the last frame. Every 33rd tick the triangles of changed bone are
// removed, and the new ones come one tick later.
//
// Thread: servo. Memory: allocated at construction. Cost: that of the method; a frame of triangles
// takes some milliseconds.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "burr/haptics/baselines/triangles.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/six/shaft_touch.h"
#include "burr/haptics/six/tool_touch.h"
#include "burr/haptics/touch_method.h"
#include "burr/surface/mesher.h"
#include "burr/tool/shaped_tool.h"

namespace burr::tick {

class TouchMethods {
 public:
  static constexpr std::uint64_t kFrame = 33;  // ticks

  // tools: that the session may take, outlives this; nullptr: none. number: of the first, -1: the burr.
  // mesher: take_mesher() of another of this bone; nullptr: none
  TouchMethods(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
               haptics::Method first, const std::vector<tool::ShapedTool>* tools = nullptr,
               int number = -1, std::unique_ptr<surface::Mesher> mesher = {});
  // For the next of this bone: to look for the borders of tissues takes milliseconds. This one must
  // not be used any more.
  [[nodiscard]] std::unique_ptr<surface::Mesher> take_mesher() { return std::move(mesher_); }

  [[nodiscard]] haptics::TouchMethod& now() BURR_RT {
    return number_ < 0 ? *all_[index(method_)] : *tool_;
  }
  // nullptr: a burr is in the hand.
  [[nodiscard]] haptics::ToolTouch* tool() BURR_RT { return number_ < 0 ? nullptr : tool_.get(); }
  [[nodiscard]] haptics::Method method() const BURR_RT { return method_; }
  // Ours, whichever is in use: it alone can say whether a place is free.
  [[nodiscard]] haptics::Proxy& constraint() BURR_RT { return *constraint_; }

  // False: the burr stands deep in bone where the method before left it, and has to come out first.
  [[nodiscard]] bool choose(haptics::Method method) BURR_RT;
  // Takes another tool, or the burr (-1), at the place where the tool is. False: it is not free there.
  [[nodiscard]] bool take(int number) BURR_RT;
  // Fewer moves of the proxies in a tick take less time.
  void set_max_moves(int moves) BURR_RT;
  // For a device that can turn the hand: L of its springs (haptics/safety/coupling.h)  [m]
  void couple(double lever) BURR_RT;
  // False: the one in use does not fit there, and nothing changed.
  [[nodiscard]] bool set_radius(double radius) BURR_RT;
  // Shows the triangles of this tick to the method that needs them.
  void show(std::uint64_t tick) BURR_RT;

 private:
  [[nodiscard]] bool can_begin(const math::Vec3& at) BURR_RT;
  [[nodiscard]] math::Vec3 nowhere() const BURR_RT;  // world, far from all bone
  [[nodiscard]] static std::size_t index(haptics::Method method) {
    return static_cast<std::size_t>(method);
  }
  const volume::IsoVertices& surface_;
  const volume::Bone& bone_;
  double radius_;  // [m]
  haptics::Method method_;
  std::array<std::unique_ptr<haptics::TouchMethod>, haptics::kMethods> all_;
  haptics::Proxy* constraint_ = nullptr;
  haptics::ShaftTouch* shaft_ = nullptr;
  const std::vector<tool::ShapedTool>* tools_;
  int number_;
  std::unique_ptr<haptics::ToolTouch> tool_;  // none: the session has no tools
  haptics::TriangleProxy* triangles_ = nullptr;
  std::unique_ptr<surface::Mesher> mesher_;
  surface::Patch patch_;
  std::uint64_t shown_ = 0;  // revision of the surface in the triangles
};

}  // namespace burr::tick

// tick/touch_methods.h - all ways of touching one bone, one of them in use; which one may change
// between two ticks.
//
// The triangles of the method of that name are those a renderer would have: of the patches about
// the burr as they were at the last frame: every 33rd tick those of a bone that changed are taken
// away, and the new ones come a tick later.
//
// Thread: servo. Memory: taken at construction. Cost: the method's own; a frame of triangles some
// milliseconds.
#pragma once

#include <array>
#include <memory>

#include "burr/haptics/baselines/triangles.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/touch_method.h"
#include "burr/surface/mesher.h"

namespace burr::tick {

class TouchMethods {
 public:
  static constexpr std::uint64_t kFrame = 33;  // ticks

  TouchMethods(const volume::IsoVertices& surface, const haptics::ProxySettings& settings,
               haptics::Method first);

  [[nodiscard]] haptics::TouchMethod& now() BURR_RT { return *all_[index(method_)]; }
  [[nodiscard]] haptics::Method method() const BURR_RT { return method_; }
  // Ours, whichever is in use: it alone can say whether a place is free.
  [[nodiscard]] haptics::Proxy& constraint() BURR_RT { return *constraint_; }

  // False: the burr stands deep in bone where the method before left it, and has to come out first.
  [[nodiscard]] bool choose(haptics::Method method) BURR_RT;
  // False: the one in use does not fit there, and nothing changed.
  [[nodiscard]] bool set_radius(double radius) BURR_RT;
  // Shows the triangles of this tick to the method that needs them.
  void show(std::uint64_t tick) BURR_RT;

 private:
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
  haptics::TriangleProxy* triangles_ = nullptr;
  surface::Mesher mesher_;
  surface::Patch patch_;
  std::uint64_t shown_ = 0;  // revision of the surface in the triangles
};

}  // namespace burr::tick

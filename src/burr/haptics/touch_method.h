// haptics/touch_method.h - the interface of a method of touch: it turns the hand's position into a
// place of the burr. burr's own method is `constraint` (proxy.h). Those in baselines/ are taken
// from the literature, with their faults, and are compared with it on the same bone and the same
// hand.
//
// Thread: servo. Frame: world in arguments and results. Memory: allocated at construction; step()
// allocates nothing.
#pragma once

#include <memory>

#include "burr/haptics/method.h"
#include "burr/haptics/tool_contact.h"
#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/volume/iso_vertices.h"

namespace burr::haptics {

struct ProxySettings {
  double radius = 1.5e-3;  // of the burr head                                              [m]
  double friction_static = 0.0;  // sticks up to this; >= friction_kinetic [-]
  double friction_kinetic = 0.0;
  // Friction counts the load of all contacts, but not more than so many times the spring's length:
  // between two nearly parallel walls a rigid burr would press without bound; 0: no limit.
  double wedge = 2;
  // The stretch between hand and burr may change in a tick by the hand's own move and so much more;
  // 0: no limit. A burr that slips off a rough place would otherwise leap within one tick, which
  // no tool that has mass can do.                                                     [m/tick]
  double slip = 0;
  // Friction holds tools of several parts too (six/six_friction.h): a shaft, the tools of the rack.
  bool parts_rub = true;
  double tool_close = 1e-7;  // as `close`, of tools of several parts                      [m]
  bool planes =
      true;  // the tools of the rack also touch the planes of the discs (six/row_kernel.h)
  int max_moves = 12;   // per tick; a faster hand is caught up with later
  double close = 0.02;  // a move shorter than this ends the search                      [voxel]
  double push_out_speed = 5e-3;  // speed at which bone that grew pushes the burr out  [voxel/tick]
  bool smooth = true;  // force from the smooth surface (while cutting: from a soft layer), not
                       // from the discs' facets
};

// Where the proxy came to rest in this tick. World frame.
struct Touch {
  math::Vec3 proxy = math::Vec3::Zero();       // centre of the burr head, never in bone [m]
  math::Vec3 tangential = math::Vec3::Zero();  // how friction holds it back, along the surface [m]
  math::Vec3 normal = math::Vec3::Zero();      // unit, from the hand to the smooth surface
  double depth = 0;     // between those two                                       [m]
  double pressing = 0;  // sum of the contacts' spring lengths; > depth in a wedge [m]
  int active = 0;
  int candidates = 0;
  bool touching = false;
  bool lagging = false;  // did not catch up with the hand within max_moves
  bool stuck = false;    // friction holds it
  // The spring still follows a slip (ProxySettings::slip): the hand feels it, but it presses on no
  // bone, so nothing is cut.
  bool slipping = false;
  bool overflow = false;  // more candidates than the list holds
};

class SixProxy;
struct SixTouch;

class TouchMethod {
 public:
  TouchMethod() = default;
  TouchMethod(const TouchMethod&) = delete;
  TouchMethod& operator=(const TouchMethod&) = delete;
  virtual ~TouchMethod() = default;

  // Puts the burr somewhere: at the start, after a clutch, a lost device, or a change of method.
  virtual void place(const math::Vec3& p) BURR_RT = 0;
  // One tick. hand: world [m].
  [[nodiscard]] virtual Touch step(const math::Vec3& hand) BURR_RT = 0;
  // The same with the hand's direction, for methods in which more than a ball touches.
  [[nodiscard]] virtual Touch step_pose(const math::Pose& hand) BURR_RT { return step(hand.p); }
  // The proxy of all its parts, if they touch: then two tools may be solved together
  // (six/two_tools.h), and felt() takes the place of step_pose(). nullptr: it has none at present.
  [[nodiscard]] virtual SixProxy* six() BURR_RT { return nullptr; }
  // Where six() is wanted: with the hand, unless what the hand holds was grabbed beside it.
  [[nodiscard]] virtual math::Pose goal(const math::Pose& hand) const BURR_RT { return hand; }
  // What was felt in this tick, of a method that has six().
  [[nodiscard]] virtual Touch felt(const SixTouch& six, const math::Pose& hand) BURR_RT;
  // Of the last tick; nullptr: a ball alone touches, and Touch says all.
  [[nodiscard]] virtual const ToolContact* parts() const BURR_RT { return nullptr; }
  // The method's centre of the burr. World [m].
  [[nodiscard]] virtual const math::Vec3& position() const BURR_RT = 0;
  virtual void set_friction(double mu_static, double mu_kinetic) BURR_RT = 0;
  // False: it does not fit at its place, and nothing changes.
  [[nodiscard]] virtual bool set_radius(double radius) BURR_RT = 0;
};

// All methods use the radius and the friction of the settings. A triangle proxy must be given its
// triangles (baselines/triangles.h).
[[nodiscard]] std::unique_ptr<TouchMethod> make_method(Method method,
                                                       const volume::IsoVertices& surface,
                                                       const ProxySettings& settings,
                                                       const math::Vec3& hand);

}  // namespace burr::haptics

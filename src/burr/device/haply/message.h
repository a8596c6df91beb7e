// device/haply/message.h - what Haply's Inverse Service and a client say to each other, as JSON.
//
// From the maker's published pages of service 3.1 to 3.5. Whatever is absent keeps its last value:
// the service leaves out what has not changed. Frame: the service's, x right, y forward, z up;
// metres, newtons. Thread: any. Errors: a text that is no such message is told, never believed in
// part.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::device::haply {

// What is known of one device and the grip that goes with it.
struct State {
  math::Vec3 place = math::Vec3::Zero(), velocity = math::Vec3::Zero();
  math::Vec3 force = math::Vec3::Zero();  // that the service says it gives
  math::Quat grip = math::Quat::Identity();
  unsigned buttons = 0;  // a, b, c: bits 0, 1, 2
  bool calibrated = true, ready = true, powered = true;
  bool in_use = false;  // some session commands it, perhaps our own
  bool grip_there = false, grip_awake = true;
  std::string grip_id;
  double battery = 1;  // of the grip, 0..1
};

struct Found {
  std::string id, type;  // "049D", "inverse3"
  std::string firmware;  // "7.4", where it is told
  bool left_handed = false;
};

// Every arm in the service's first message. false: no message of the service.
[[nodiscard]] bool read_found(std::string_view text, std::vector<Found>& found);
// The ids of the grips in it, of whatever kind.
[[nodiscard]] std::vector<std::string> grips_in(std::string_view text);

enum class Read { state, gone, nonsense };
// The arm `id` and a grip of a message, over what was known; grip: its id, empty: the first that is
// connected. gone: the message is good, but that arm is no longer in it; nonsense: known is as it
// was.
[[nodiscard]] Read read_state(std::string_view text, const std::string& id, const std::string& grip,
                              State& known);

// What the service tells on its channel of events, as far as it matters to a hand.
enum class Told {
  nothing,
  connected,
  disconnected,
  battery_low,
  battery_critical,
  sleeps,
  busy,
  connection_loop,
  calibration_failed,
  brake,
  brake_released,
  stalled,
  unstable,
  stage,    // of its safety has changed
  trouble,  // of a kind that is not known, which the service calls critical or worse
};
struct Event {
  Told what = Told::nothing;
  std::string device;  // its id; empty: not told
};
// false: no event.
[[nodiscard]] bool read_event(std::string_view text, Event& event);

// The version of "GET /version", as 305 for 3.5; 0: not told.
[[nodiscard]] int read_version(std::string_view text);

// An arm's id as it stands in a message.
[[nodiscard]] std::string as_json(const std::string& id);

// What carries the numbers of a force: "vector" since 3.5, "values" before.
[[nodiscard]] constexpr const char* key_of_force(int version) {
  return version >= 305 ? "vector" : "values";
}
// One message that asks for a force; it is answered by one state. `text` keeps its memory.
void write_force(const std::string& json_id, const char* key, const math::Vec3& force,
                 std::string& text);
// The first message of a session: who we are, and no force.
[[nodiscard]] std::string greeting(const std::string& json_id, const char* key);

}  // namespace burr::device::haply

// device/haply/message.h - the JSON messages between Haply's Inverse Service and a client.
//
// Source: the maker's published pages of service 3.1 to 3.5. The service leaves out what has not
// changed, so an absent value keeps its last one. Frame: the service's, x right, y forward, z up;
// metres, newtons. Thread: any. Errors: a text that is not such a message is reported; no part of
// it is used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::device::haply {

// The known state of one arm and of its grip.
struct State {
  math::Vec3 place = math::Vec3::Zero(), velocity = math::Vec3::Zero();
  math::Vec3 force = math::Vec3::Zero();  // force that the service says it gives
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
  std::string firmware;  // "7.4", where reported
  bool left_handed = false;
};

// Reads every arm out of the service's first message. False: not a message of the service.
[[nodiscard]] bool read_found(std::string_view text, std::vector<Found>& found);
// The ids of the grips in a message, of every kind.
[[nodiscard]] std::vector<std::string> grips_in(std::string_view text);

enum class Read { state, gone, nonsense };
// Updates `known` with the arm `id` and its grip from a message. grip: id of the grip; empty: the
// first that is connected. gone: the message is good, but does not contain that arm; nonsense: not
// such a message, `known` is unchanged.
[[nodiscard]] Read read_state(std::string_view text, const std::string& id, const std::string& grip,
                              State& known);

// The events of the service that matter to a hand.
enum class EventKind {
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
  stage,    // the stage of its safety has changed
  trouble,  // of an unknown kind, which the service calls critical or worse
};
struct Event {
  EventKind what = EventKind::nothing;
  std::string device;  // its id; empty: not in the message
};
// False: not an event.
[[nodiscard]] bool read_event(std::string_view text, Event& event);

// The version in the answer to "GET /version", as 305 for 3.5; 0: not found.
[[nodiscard]] int read_version(std::string_view text);

// An arm's id as a JSON string.
[[nodiscard]] std::string as_json(const std::string& id);

// The key of a force's numbers: "vector" since 3.5, "values" before.
[[nodiscard]] constexpr const char* key_of_force(int version) {
  return version >= 305 ? "vector" : "values";
}
// Writes one message that requests a force; the service answers it with one state. `text` keeps its
// memory.
void write_force(const std::string& json_id, const char* key, const math::Vec3& force,
                 std::string& text);
// The first message of a session: it names this program, asks that nothing stands between it and the arm (pipeline.h;
// a service before 3.5 does not know that), and requests no force. The answer tells the configuration.
[[nodiscard]] std::string greeting(const std::string& json_id, const char* key, bool configure);

}  // namespace burr::device::haply

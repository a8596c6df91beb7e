// Messages of Haply's service: its first message, a series of states, its version, events. Each
// line is one message and is given to all readers.
#include "burr/device/haply/message.h"

#include <nlohmann/json.hpp>

#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  namespace haply = device::haply;
  fuzz::Pieces in({data, size});
  haply::State known;
  while (!in.empty()) {
    const std::string_view text = in.line();
    std::vector<haply::Found> arms;
    if (haply::read_found(text, arms))
      for (const haply::Found& arm : arms) {
        std::string message;
        haply::write_force(haply::as_json(arm.id), "vector", {1, 2, 3}, message);
        fuzz::must(
            !arm.id.empty() && nlohmann::json::accept(message) &&
                nlohmann::json::accept(haply::greeting(haply::as_json(arm.id), "vector", true)),
            "an arm can be spoken to by its id");
      }
    const std::vector<std::string> grips = haply::grips_in(text);
    const haply::State before = known;
    const haply::Read read =
        haply::read_state(text, "049D", text.size() % 2 == 0 ? "" : "GRIP", known);
    fuzz::must(read == haply::Read::state ||
                   (known.place == before.place && known.buttons == before.buttons &&
                    known.grip_there == before.grip_there),
               "what is no state changes nothing");
    fuzz::must(known.place.allFinite() && known.velocity.allFinite() && known.force.allFinite() &&
                   std::isfinite(known.battery),
               "a state has numbers");
    fuzz::must(std::abs(known.grip.norm() - 1) < 1e-9, "a grip is turned somehow");
    fuzz::must(known.buttons < 8 && (known.grip_there || known.buttons == 0),
               "only a grip that is there holds buttons");
    const int version = haply::read_version(text);
    fuzz::must(version >= 0 && version < 101'000, "a version has two short numbers");
    haply::Event event;
    if (!haply::read_event(text, event))
      fuzz::must(event.what == haply::EventKind::nothing && event.device.empty(),
                 "no event, no news");
  }
  return 0;
}

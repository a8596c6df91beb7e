// The description of a session (JSON) in a recording, and the settings that a replay takes from it.
#include "burr/record/session_info.h"

#include "burr/sim/session_words.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const auto info = record::session_from_json(fuzz::text_of({data, size}), "a.mcap");
  fuzz::look_at_error(info);
  if (!info) return 0;
  fuzz::look_at(info->volume.tissues);
  // what was read can be written, and is the same when it is read again
  const std::string again = record::to_json(*info);
  const auto twice = record::session_from_json(again, "a.mcap");
  fuzz::must(twice.ok() && record::to_json(*twice) == again, "JSON comes back the same");
  fuzz::look_at_error(sim::settings_of(*info, "a.mcap"));
  return 0;
}

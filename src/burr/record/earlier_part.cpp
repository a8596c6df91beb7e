#include "burr/record/earlier_part.h"

#include <fmt/core.h>

#include <cstddef>

#include "burr/record/copy_records.h"
#include "burr/record/tool_json.h"

namespace burr::record {
Status goes_on(const SessionInfo& was, const SessionInfo& is) {
  if (was.rate_hz != is.rate_hz)
    return error(Trouble::usage, fmt::format("it had {:g} ticks a second and would have {:g} now",
                                             was.rate_hz, is.rate_hz));
  if (was.second.has_value() != is.second.has_value())
    return error(Trouble::usage, was.second ? "it had a second hand and has none now"
                                            : "it had no second hand and has one now");
  const bool same_tools = tools_to_json(was.tools) == tools_to_json(is.tools);
  const bool same_second =
      !was.second || tools_to_json(was.second->tools) == tools_to_json(is.second->tools);
  if (!same_tools || !same_second) return error(Trouble::usage, "its tools are not those of now");
  return fine();
}

Status copy_earlier_part(const McapReader& from, McapWriter& to) {
  for (std::size_t i = 0; i < from.attachments().size(); ++i)  // the bone
    if (Status whole = from.check_attachment(i); !whole.ok()) return whole;
  if (Status begun = copy_beginning(from, to, kAccountName); !begun.ok()) return begun;
  for (std::size_t i = 0; i < from.chunks().size(); ++i)
    if (Status copied = copy_chunk(from, i, to); !copied.ok()) return copied;
  return fine();
}

}  // namespace burr::record

#include "burr/record/earlier_part.h"

#include <fmt/core.h>

#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/tool_json.h"

namespace burr::record {
namespace {

Status copy_head(const McapReader& from, McapWriter& to) {
  for (const mcap::Schema& schema : from.schemas())
    if (Status added = to.add(schema); !added.ok()) return added;
  for (const mcap::Channel& channel : from.channels())
    if (Status added = to.add(channel); !added.ok()) return added;
  for (std::size_t i = 0; i < from.metadata().size(); ++i) {
    if (from.metadata()[i].name == kAccountName) continue;
    const auto pairs = from.read_metadata(i);
    if (!pairs) continue;  // a note on the format: a reader does without
    if (Status added = to.add_metadata(from.metadata()[i].name, *pairs); !added.ok()) return added;
  }
  for (std::size_t i = 0; i < from.attachments().size(); ++i) {
    const mcap::AttachmentAt& at = from.attachments()[i];
    const auto data = from.read_attachment(i);
    if (!data) return data.error();  // the bone
    if (Status added = to.add_attachment(at.name, at.media_type, *data); !added.ok()) return added;
  }
  return fine();
}

}  // namespace

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
  if (Status head = copy_head(from, to); !head.ok()) return head;
  for (std::size_t i = 0; i < from.chunks().size(); ++i) {
    const auto chunk = from.read_chunk(i);
    const auto packed = from.read_packed(i);
    if (!chunk || !packed) continue;  // damaged: lost before, and the ticks show the gap
    mcap::MessageIndexes indexes;
    for (const McapMessage& message : chunk->messages)
      indexes[message.channel].emplace_back(message.time_ns, message.offset);
    if (Status added = to.add_chunk(from.chunks()[i], chunk->crc, *packed, indexes); !added.ok())
      return added;
  }
  return fine();
}

}  // namespace burr::record

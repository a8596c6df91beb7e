// Pen: a session that is continued, in the recording that it has.
#include <utility>

#include "burr/record/course.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/pen.h"

namespace burr::record {

Result<std::unique_ptr<Pen>> Pen::go_on(std::unique_ptr<McapWriter>& writer,
                                        const SessionInfo& info, const Rings& rings,
                                        const EarlierPart& earlier) {
  std::unique_ptr<Pen> pen(new Pen(std::move(writer), rings, info.rate_hz));
  Status begun = pen->copy_earlier(earlier);
  if (begun) {
    pen->take_up(info, earlier);
    begun = pen->writer_->close_chunk();
  }
  if (begun) return pen;
  writer = std::move(pen->writer_);  // with its lock, until the caller has removed the file
  return begun.error();
}

// Its records, and the channels that it has; those of today that it lacks are added.
Status Pen::copy_earlier(const EarlierPart& earlier) {
  const auto from = McapReader::open(earlier.file, McapReader::Trust::nothing);
  if (!from) return from.error();
  if (Status copied = copy_earlier_part(**from, *writer_); !copied.ok()) return copied;
  Topics had;
  for (const mcap::Schema& schema : (*from)->schemas()) had.schemas[schema.name] = schema.id;
  for (const Topic& topic : kTopics)
    if (const auto channels = (*from)->channels_of(topic.name); !channels.empty())
      had.channels[topic.name] = *channels.begin();
  const auto ids = add_topics(had);
  if (!ids) return ids.error();
  name_channels(*ids);
  return fine();
}

// Ticks, ledger, bone and account go on from the earlier part; then the description of the new one.
void Pen::take_up(const SessionInfo& asked, const EarlierPart& earlier) {
  first_tick_ = end_tick_ = keyframe_tick_ = earlier.ticks;
  hand_ = CountedOn(earlier.hand);
  second_hand_ = CountedOn(earlier.second);
  mirror_ = earlier.bricks;
  batch_ = earlier.batch;
  changed_since_keyframe_ = !mirror_.empty();
  account_ = before_ = earlier.account;
  sums_ = earlier.sums;
  written_ticks_.store(account_.ticks);
  SessionInfo info = asked;
  info.first_tick = first_tick_;
  info.goes_on_with = earlier.sha1;
  put(session_channel_, first_tick_, as_bytes(to_json(info)));
  put(course_channel_, first_tick_,
      as_bytes(to_json(CourseEvent{.tick = first_tick_, .kind = CourseKind::continued})));
  ++account_.events;
  put_event("continued");
}

}  // namespace burr::record

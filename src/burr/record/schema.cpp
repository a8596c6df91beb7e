#include "burr/record/schema.h"

#include <string>

#include "burr/record/course.h"
#include "burr/record/schema_parts.h"
#include "burr/record/view.h"

namespace burr::record {
namespace {

constexpr const char* kEventSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Event",
 "description": "What happened to the recording itself.",
 "type": "object",
 "properties": {
  "event": {"enum": ["dropped", "finished", "stopped"],
             "description": "stopped: the session was ended before its time, by a signal"},
  "tick": {"type": "integer", "description": "last tick written"},
  "dropped_ticks": {"type": "integer", "description": "rows lost so far because the ring was full"},
  "dropped_wishes": {"type": "integer"},
  "dropped_bricks": {"type": "integer"},
  "dropped_notes": {"type": "integer", "description": "messages of /view and /course"}
 }
})";

}  // namespace

std::string schema_data(std::string_view schema_name) {
  if (schema_name == kSession.schema_name) return session_schema();
  if (schema_name == kCommands.schema_name) return command_schema();
  if (schema_name == kEvents.schema_name) return kEventSchema;
  if (schema_name == kViews.schema_name) return view_schema();
  if (schema_name == kCourse.schema_name) return course_schema();
  if (schema_name == kChanges.schema_name) return brick_schema();
  return tick_schema();
}

}  // namespace burr::record

// record/schema_parts.h - the schemas of those channels that have no header of their own; schema_data() in schema.h
// chooses. For use of this room only. Thread: any; functions without state.
#pragma once

#include <string>

namespace burr::record {

[[nodiscard]] std::string session_schema();  // session_schema.cpp
[[nodiscard]] std::string tick_schema();     // tick_columns.cpp
[[nodiscard]] std::string command_schema();  // command_json.cpp
[[nodiscard]] std::string brick_schema();    // bricks.cpp

}  // namespace burr::record

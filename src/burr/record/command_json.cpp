// record/command_json.cpp - commands as messages of /wishes: their names, their JSON Schema, JSON and back. The part
// "commands" of schema.h.
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

#include "burr/record/schema.h"
#include "burr/record/schema_parts.h"
#include "burr/record/session_info.h"

namespace burr::record {
namespace {

using nlohmann::json;

constexpr const char* kCommandSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Wish",
 "description": "A command that the servo took at the start of a tick.",
 "type": "object",
 "properties": {
  "tick": {"type": "integer"},
  "kind": {"enum": ["spindle_speed", "burr_radius", "stiffness", "user_force", "tool_mode", "undo", "redo", "reset", "friction", "load", "touch_method", "removal_law", "irrigation", "mirror_i", "mirror_j", "mirror_k", "mirror_off", "burr_kind", "tool", "move_piece", "lift_piece", "shift_piece", "let_go", "leave_piece", "take_splinter"]},
  "value": {"type": ["number", "string"], "description": "spindle_speed rad/s; burr_radius m; stiffness N/m; user_force N; tool_mode 0 cut, 1 add, 2 touch, 3 back to the original, 4 smooth; friction scale; touch_method 0 constraint, 1 thesis, 2 thesis-literal, 3 voxel-springs, 4 samples, 5 triangles, 6 penalty, 7 shaft; removal_law 0 energy, 1 thesis, 2 chips; irrigation 0 off, 1 on; mirror_i, mirror_j, mirror_k place of the plane along that axis of the grid, voxels; burr_kind 0 cutting, 1 diamond; tool number in tools, -1 the round burr; move_piece and lift_piece number of the piece, 0 the first that was moved; \"nan\", \"inf\", \"-inf\" as strings"},
  "piece": {"type": "object", "description": "of move_piece, lift_piece and shift_piece", "properties": {
   "seed": {"type": "array", "items": {"type": "integer"}, "description": "a voxel of the piece where it came free"},
   "by_m": {"type": "array", "items": {"type": "number"}, "description": "from where it came free, not from where it lay: after a turn about its centre, LPS [m]"},
   "turn_xyzw": {"type": "array", "items": {"type": "number"}, "description": "the turn, a unit quaternion"},
   "writes": {"type": "integer", "description": "how often the bone had been written when the move was prepared; another number: refused"},
   "bricks": {"type": "string", "description": "hexadecimal, hash of the bricks after the move"},
   "body": {"type": "string", "description": "of lift_piece: hexadecimal, hash of the distances to the piece's surface and of where it lay"},
   "lifted": {"type": "boolean", "description": "of move_piece: the piece was lifted before; absent: it was not"},
   "specks": {"type": "boolean", "description": "what lay loose in the pores of the piece went with it; absent: it stayed"}
  }}
 }
})";

const char* command_name(tick::CommandKind kind) {
  switch (kind) {
    case tick::CommandKind::spindle_speed:
      return "spindle_speed";
    case tick::CommandKind::burr_radius:
      return "burr_radius";
    case tick::CommandKind::stiffness:
      return "stiffness";
    case tick::CommandKind::user_force:
      return "user_force";
    case tick::CommandKind::tool_mode:
      return "tool_mode";
    case tick::CommandKind::undo:
      return "undo";
    case tick::CommandKind::redo:
      return "redo";
    case tick::CommandKind::reset:
      return "reset";
    case tick::CommandKind::friction:
      return "friction";
    case tick::CommandKind::shed:
      return "load";
    case tick::CommandKind::touch_method:
      return "touch_method";
    case tick::CommandKind::removal_law:
      return "removal_law";
    case tick::CommandKind::irrigation:
      return "irrigation";
    case tick::CommandKind::mirror_i:
      return "mirror_i";
    case tick::CommandKind::mirror_j:
      return "mirror_j";
    case tick::CommandKind::mirror_k:
      return "mirror_k";
    case tick::CommandKind::mirror_off:
      return "mirror_off";
    case tick::CommandKind::burr_kind:
      return "burr_kind";
    case tick::CommandKind::tool:
      return "tool";
    case tick::CommandKind::move_piece:
      return "move_piece";
    case tick::CommandKind::lift_piece:
      return "lift_piece";
    case tick::CommandKind::shift_piece:
      return "shift_piece";
    case tick::CommandKind::let_go:
      return "let_go";
    case tick::CommandKind::leave_piece:
      return "leave_piece";
    case tick::CommandKind::take_splinter:
      return "take_splinter";
  }
  return "";
}

bool tells_of_piece(tick::CommandKind kind) {
  return kind == tick::CommandKind::move_piece || kind == tick::CommandKind::lift_piece ||
         kind == tick::CommandKind::shift_piece || kind == tick::CommandKind::take_splinter;
}

}  // namespace

std::string command_schema() { return kCommandSchema; }

std::string to_json(const tick::CommandRow& row) {
  json object = {
      {"tick", row.tick}, {"kind", command_name(row.command.kind)}, {"value", row.command.value}};
  if (std::isnan(row.command.value)) object["value"] = "nan";
  if (std::isinf(row.command.value)) object["value"] = row.command.value > 0 ? "inf" : "-inf";
  if (tells_of_piece(row.command.kind)) {
    const edit::PieceMove& move = row.command.move;
    object["piece"] = {{"seed", move.seed},
                       {"by_m", move.by},
                       {"turn_xyzw", move.turn},
                       {"writes", move.writes},
                       {"bricks", hex(move.bricks)}};
    if (move.body != 0) object["piece"]["body"] = hex(move.body);
    if (move.lifted) object["piece"]["lifted"] = true;
    if (move.specks) object["piece"]["specks"] = true;
  }
  return object.dump();
}

namespace {

template <class T, std::size_t N>
bool numbers_from(const json& object, const char* name, std::array<T, N>& to) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array() || found->size() != N) return false;
  constexpr double kMost = std::is_integral_v<T> ? 2147483647.0 : 1e300;
  for (std::size_t n = 0; n < N; ++n) {
    const json& one = (*found)[n];
    if (!one.is_number() || !(std::abs(one.get<double>()) <= kMost)) return false;
    to[n] = one.get<T>();
  }
  return true;
}

bool hash_from(const json& object, const char* name, std::uint64_t& to) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_string()) return false;
  const std::string text = found->get<std::string>();
  if (text.size() < 3 || text.compare(0, 2, "0x") != 0) return false;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + 2, end, to, 16);
  return read.ec == std::errc() && read.ptr == end;
}

bool move_from_json(const json& object, double number, edit::PieceMove& move) {
  constexpr double kMostPieces = 65536;
  const auto piece = object.find("piece");
  if (piece == object.end() || !piece->is_object() || !(number >= 0 && number < kMostPieces))
    return false;
  const auto writes = piece->find("writes");
  if (writes == piece->end() || !writes->is_number_unsigned() ||
      !hash_from(*piece, "bricks", move.bricks))
    return false;
  if (piece->contains("body") && !hash_from(*piece, "body", move.body)) return false;
  for (const auto& [name, flag] : {std::pair{"lifted", &move.lifted}, {"specks", &move.specks}}) {
    const auto found = piece->find(name);
    if (found == piece->end()) continue;
    if (!found->is_boolean()) return false;
    *flag = found->get<bool>();
  }
  move.piece = static_cast<std::uint32_t>(number);
  move.writes = writes->get<std::uint64_t>();
  return numbers_from(*piece, "seed", move.seed) && numbers_from(*piece, "by_m", move.by) &&
         numbers_from(*piece, "turn_xyzw", move.turn);
}

}  // namespace

bool command_from_json(std::string_view text, tick::CommandRow& row) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return false;
  const auto tick = object.find("tick"), kind = object.find("kind"), value = object.find("value");
  if (tick == object.end() || !tick->is_number_unsigned() || kind == object.end() ||
      !kind->is_string() || value == object.end())
    return false;
  row.tick = tick->get<std::uint64_t>();
  if (value->is_number()) {
    row.command.value = value->get<double>();
  } else {
    const double infinity = std::numeric_limits<double>::infinity();
    if (*value == "nan")
      row.command.value = std::numeric_limits<double>::quiet_NaN();
    else if (*value == "inf" || *value == "-inf")
      row.command.value = *value == "inf" ? infinity : -infinity;
    else
      return false;
  }
  for (unsigned k = 0; k < 256; ++k) {
    const auto known = static_cast<tick::CommandKind>(k);
    const std::string_view name = command_name(known);
    if (name.empty()) break;
    if (*kind == name) {
      row.command.kind = known;
      row.command.move = {};
      return !tells_of_piece(known) || move_from_json(object, row.command.value, row.command.move);
    }
  }
  return false;
}

}  // namespace burr::record

#include "burr/tick/orders.h"

#include <algorithm>
#include <cmath>

#include "burr/rt/flags.h"
#include "burr/tick/mirror_plane.h"

namespace burr::tick {
namespace {

constexpr int kCommandsPerTick = 8;
constexpr double kFastest = 1e5;  // spindle, either way  [rad/s]
constexpr int kFewMoves = 4;      // of the proxy, when even touch must do with less

}  // namespace

void Orders::take(std::uint64_t tick, std::uint32_t& flags) BURR_RT {
  const auto take = [&](const Command& command) BURR_RT {
    parts_.outbox.note(CommandRow{tick, command});
    if (std::isfinite(command.value)) obey(command, flags);
  };
  if (shed_requested_ != parts_.controls.shed)
    take({CommandKind::shed, static_cast<double>(shed_requested_)});
  Command command;
  for (int taken = 0; taken < kCommandsPerTick && commands_.pop(command);) {
    take(command);
    if (command.kind != CommandKind::shed)
      ++taken;  // the servo's own, from a recording: beside the eight
  }
}

void Orders::obey(const Command& command, std::uint32_t& flags) BURR_RT {
  const double value = command.value;
  switch (command.kind) {
    case CommandKind::spindle_speed:
      parts_.cutting.spindle().full_speed = std::clamp(value, -kFastest, kFastest);
      break;
    case CommandKind::burr_radius:
      set_radius(value);
      break;
    case CommandKind::burr_kind:
      settings_.burr.kind = value > 0 ? tool::BurrKind::diamond : tool::BurrKind::cutting;
      break;
    case CommandKind::stiffness:
      set_stiffness(value);
      break;
    case CommandKind::user_force:
      parts_.hand.set_user_force(value);
      break;
    case CommandKind::tool_mode:
      set_mode(value);
      break;
    case CommandKind::friction:
      settings_.friction_scale = std::clamp(value, 0.0, 4.0);
      break;
    case CommandKind::shed:
      set_shed(value);
      break;
    case CommandKind::touch_method:
      set_method(value, flags);
      break;
    case CommandKind::removal_law:
      set_law(value);
      break;
    case CommandKind::tool:
      take_tool(value, flags);
      break;
    case CommandKind::irrigation:
      parts_.controls.irrigated = value > 0;
      break;
    case CommandKind::mirror_i:
    case CommandKind::mirror_j:
    case CommandKind::mirror_k:
    case CommandKind::mirror_off:
      parts_.controls.mirror = mirror_of(command, grid_.size).value_or(parts_.controls.mirror);
      break;
    case CommandKind::undo:
    case CommandKind::redo:
    case CommandKind::reset:
    case CommandKind::leave_piece:
      begin_restore(command.kind);
      break;
    case CommandKind::move_piece:
    case CommandKind::lift_piece:
    case CommandKind::let_go:
    case CommandKind::shift_piece:
    case CommandKind::take_splinter:
      obey_on_piece(command, flags);
      break;
  }
}

void Orders::obey_on_piece(const Command& command, std::uint32_t& flags) BURR_RT {
  if (command.kind == CommandKind::let_go)
    parts_.piece.let_go();
  else if (command.kind == CommandKind::shift_piece)
    shift_piece(command.move);
  else if (command.kind == CommandKind::take_splinter)
    parts_.restore.take_splinter(command, flags);
  else
    parts_.restore.begin_move(command, flags);
}

// Refused where the larger head has no room.
void Orders::set_stiffness(double stiffness) BURR_RT {
  const haptics::Coupling springs =
      haptics::coupling_of(parts_.hand.spec(), stiffness, settings_.rate_hz);
  settings_.force.stiffness = springs.stiffness;
  // k_r stays, so L changes
  if (!parts_.hand.turned() || springs.lever <= 0) return;
  parts_.touch_by.couple(springs.lever);
  parts_.piece.couple(HeldPiece::kFirst, springs.lever);
}

void Orders::set_radius(double radius) BURR_RT {
  if (radius < 2 * grid_.voxel || radius > 0.5 * tool::kLargestDiameter + 1e-12) return;
  if (settings_.tool >= 0 || !parts_.touch_by.set_radius(radius)) return;
  settings_.burr.radius = radius;
  parts_.outbox.note_radius(radius);
}

void Orders::set_mode(double mode) BURR_RT {
  if (mode >= 0 && mode < kToolModes)
    settings_.mode = static_cast<ToolMode>(static_cast<int>(mode));
}

void Orders::set_law(double law) BURR_RT {
  if (law >= 0 && law < edit::kLaws)
    settings_.removal.law = static_cast<edit::RemovalLaw>(static_cast<int>(law));
}

void Orders::set_shed(double shed) BURR_RT {
  if (shed < 0 || shed >= kShedSteps) return;
  parts_.controls.shed = shed_requested_ = static_cast<Shed>(static_cast<int>(shed));
  const int moves =
      parts_.controls.shed == Shed::touch ? kFewMoves : haptics::ProxySettings{}.max_moves;
  parts_.touch_by.set_max_moves(moves);
  parts_.piece.set_max_moves(moves);
}

// The tool may stand in bone, where ours cannot begin: then the force fades, and touch begins again
// in free air.
void Orders::set_method(double method, std::uint32_t& flags) BURR_RT {
  if (method < 0 || method >= haptics::kMethods) return;
  settings_.touch = static_cast<haptics::Method>(static_cast<int>(method));
  if (!parts_.touch_by.choose(settings_.touch)) parts_.hand.release(rt::kFlagWaiting, flags);
  parts_.hand.use(parts_.touch_by.now(), parts_.touch_by.tool());
}

// A tool of any shape begins in free air: where the one before stood, it may stand in bone.
void Orders::take_tool(double number, std::uint32_t& flags) BURR_RT {
  const int is = static_cast<int>(std::clamp(number, -2.0, 1e6));
  if (is < -1 || is >= static_cast<int>(settings_.tools.size()) || is == settings_.tool) return;
  settings_.tool = is;
  if (!parts_.touch_by.take(is)) parts_.hand.release(rt::kFlagWaiting, flags);
  parts_.hand.use(parts_.touch_by.now(), parts_.touch_by.tool());
  parts_.cutting.take_tool();
}

// A command may come from a file that says anything.
void Orders::shift_piece(const edit::PieceMove& move) BURR_RT {
  constexpr double kFarthest = 1e3;  // as for a hand: a scan keeps the origin of its scanner  [m]
  math::Pose goal;
  double square = 0;
  for (const double part : move.turn) square += part * part;
  if (!(std::abs(square - 1) < 1e-6)) return;
  goal.q = math::Quat(move.turn[3], move.turn[0], move.turn[1], move.turn[2]);
  for (int axis = 0; axis < 3; ++axis) {
    goal.p[axis] = move.by[static_cast<std::size_t>(axis)];
    if (!(std::abs(goal.p[axis]) < kFarthest)) return;
  }
  parts_.piece.shift(goal);
}

void Orders::begin_restore(CommandKind kind) BURR_RT {
  if (parts_.restore.begin(kind) && kind == CommandKind::reset) parts_.outbox.start_heat_over();
}

}  // namespace burr::tick

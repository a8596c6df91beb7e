#include "burr/sim/replay.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <utility>

#include "burr/device/replayed_hand.h"
#include "burr/record/chain.h"
#include "burr/rt/flags.h"
#include "burr/sim/session_words.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/servo.h"

namespace burr::sim {
namespace {

// The first thing that differs between two rows of the same tick.
std::string difference(const tick::TickRow& was, const tick::TickRow& is) {
  if (was.law.force != is.law.force || was.law.energy != is.law.energy ||
      was.law.torque != is.law.torque || was.law.state != is.law.state)
    return fmt::format(
        "another answer of the own law: ({:.6g}, {:.6g}, {:.6g}) N instead of ({:.6g}, {:.6g}, "
        "{:.6g}) N",
        is.law.force.x(), is.law.force.y(), is.law.force.z(), was.law.force.x(), was.law.force.y(),
        was.law.force.z());
  if (was.contact.force != is.contact.force)
    return fmt::format("force ({:.6g}, {:.6g}, {:.6g}) N instead of ({:.6g}, {:.6g}, {:.6g}) N",
                       is.contact.force.x(), is.contact.force.y(), is.contact.force.z(),
                       was.contact.force.x(), was.contact.force.y(), was.contact.force.z());
  if (was.contact.torque != is.contact.torque)
    return fmt::format("torque of {:.6g} N m instead of {:.6g} N m", is.contact.torque.norm(),
                       was.contact.torque.norm());
  if (was.contact.proxy != is.contact.proxy) return "another position of the burr";
  if (was.piece.p != is.piece.p || was.piece.turn != is.piece.turn)
    return "another place of the lifted piece";
  if (was.contact.flags != is.contact.flags)
    return fmt::format("flags {:#x} instead of {:#x}", is.contact.flags, was.contact.flags);
  if (was.ledger.removed != is.ledger.removed)
    return fmt::format("removed {:.9g} mm3 instead of {:.9g} mm3", 1e9 * is.ledger.removed,
                       1e9 * was.ledger.removed);
  return "another hash, from an earlier part of the tick or the ledger";
}

// The values in the file with the hashes beside them; the simulated hashes are compared besides.
struct Chains {
  record::Chain first, second;
  [[nodiscard]] bool add(const record::Step& step) {
    return first.add(step.row, false) && (!step.second || second.add(*step.second, false));
  }
};

// The undone volume is not part of the hash; older recordings do not hold it.
bool same_undone(const tick::TickRow& was, const tick::TickRow& is) {
  return was.ledger.undone == 0 || was.ledger.undone == is.ledger.undone;
}

// The bricks of a move, made again. What the servo of the recording refused it refuses now.
std::optional<edit::PieceStore::NewBricks> lay_ready(const edit::PieceStore& pieces,
                                                     const volume::Bone& bone,
                                                     const tick::Command& command,
                                                     tick::Servo& servo) {
  const edit::PieceMove& move = command.move;
  if (servo.writes_done() != move.writes) return std::nullopt;
  auto made = command.kind == tick::CommandKind::lift_piece ? pieces.prepare_lift(bone, move)
                                                            : pieces.prepare(bone, move);
  if (!made) return std::nullopt;
  std::optional<edit::PieceStore::NewBricks> ready = std::move(*made);
  if (!servo.lay_ready(*ready->bricks)) return std::nullopt;
  return ready;
}

// The same of a splinter.
std::shared_ptr<const edit::MovedBricks> lay_splinter(const edit::PieceStore& pieces,
                                                      const volume::Bone& bone,
                                                      const tick::Command& command,
                                                      tick::Servo& servo) {
  if (servo.writes_done() != command.move.writes) return nullptr;
  auto made = pieces.prepare_splinter(bone, command.move);
  return made && servo.lay_ready(**made) ? *made : nullptr;
}

// The second hand of the recording.
struct OtherHand {
  device::ReplayedHand device;
  tick::SecondHand hand;

  OtherHand(const RecordedSecond& recorded, tick::Servo& servo)
      : device(recorded.device), hand(servo.shared(), device, recorded.settings) {}
  // nullptr: none took part.
  static Result<std::unique_ptr<OtherHand>> of(const record::Player& player, tick::Servo& servo) {
    if (!player.info().second) return std::unique_ptr<OtherHand>();
    const auto recorded = second_of(player.info(), player.path());
    if (!recorded) return recorded.error();
    auto other = std::make_unique<OtherHand>(*recorded, servo);
    servo.set_second(&other->hand);
    return other;
  }
};

}  // namespace

Result<ReplayOutcome> replay(record::Player& player, std::unique_ptr<volume::Bone> bone,
                             Progress& progress, RowLog* log, tick::OwnLaw* law) {
  auto recorded = settings_of(player.info(), player.path());
  if (!recorded) return recorded.error();
  if (const Status same = check_law(player.info(), law, player.path()); !same) return same.error();
  tick::RecordedLaw answers;
  recorded->settings.servo.law = law;
  if (law != nullptr) {
    if (const Status begun = law->begin(); !begun) return begun.error();
  } else if (!law_of(player.info()).kind.empty()) {
    recorded->settings.servo.law = &answers;
  }
  volume::IsoVertices surface(*bone, recorded->settings.surface, 2, progress);
  device::ReplayedHand hand(recorded->device);
  tick::Servo servo(*bone, surface, hand, recorded->settings.servo);
  if (log != nullptr && log->crossed() != nullptr)
    servo.set_brick_watch(&log->crossed()->written());
  auto other = OtherHand::of(player, servo);
  if (!other) return other.error();

  ReplayOutcome outcome;
  edit::PieceStore& pieces = outcome.pieces;
  std::optional<edit::PieceStore::NewBricks> under_way;  // lives until the servo has written it
  record::StepCursor steps = player.steps();
  Chains chains;
  record::BrickCursor bricks = player.bricks();
  record::Step step;
  tick::BrickRow brick;
  bool has_brick = bricks.next(brick);
  while (!outcome.first_different_tick && steps.next(step)) {
    const bool whole = *other == nullptr || step.second;
    if (step.gap || step.row.tick != outcome.ticks || !whole) {
      ++outcome.gaps;
      outcome.difference = fmt::format(
          "ticks before {} are missing in the file{}; the ticks after them cannot be compared",
          step.row.tick + (whole ? 0 : 1), whole ? "" : ", of the second hand");
      break;
    }
    std::optional<edit::PieceStore::NewBricks> moving;
    std::shared_ptr<const edit::MovedBricks> splinter;  // of this tick
    for (const tick::Command& command : step.commands) {
      const bool moves = command.kind == tick::CommandKind::move_piece ||
                         command.kind == tick::CommandKind::lift_piece;
      if (moves && !moving) moving = lay_ready(pieces, *bone, command, servo);
      if (command.kind == tick::CommandKind::take_splinter && !splinter)
        splinter = lay_splinter(pieces, *bone, command, servo);
      servo.commands().push(command);
    }
    hand.set(step.row.hand);
    if (*other) (*other)->device.set(step.second->hand);
    answers.set(step.row.law);
    const tick::TickRow& row = servo.tick((step.row.contact.flags & rt::kFlagWatchdog) != 0);
    servo.publish();
    if (log != nullptr) log->note(row);
    if (moving && servo.move_state() != tick::MoveState::refused) {
      pieces.accept(*moving);
      under_way = std::move(moving);
    }
    ++outcome.ticks;
    const bool unchanged = chains.add(step) && same_undone(step.row, row);
    const bool same_tool = !player.tool_is_recorded() || row.tool == step.row.tool;
    if (!unchanged) {
      outcome.first_different_tick = row.tick;
      outcome.difference =
          "the values in the file do not give the hash beside them, so somebody changed them";
    } else if (row.hash != step.row.hash || !same_tool) {
      outcome.first_different_tick = row.tick;
      outcome.difference = same_tool ? difference(step.row, row) : "another tool";
    } else if (*other && (*other)->hand.row().hash != step.second->hash) {
      outcome.first_different_tick = row.tick;
      outcome.difference = "second hand: " + difference(*step.second, (*other)->hand.row());
    }
    for (; has_brick && !outcome.first_different_tick && brick.tick <= row.tick;
         has_brick = bricks.next(brick)) {
      if (brick.tick != row.tick) continue;
      if (brick.brick < 0 || brick.brick >= bone->brick_count())
        return error(
            fmt::format("{}: changes brick {}, which this bone does not have; give the right bone "
                        "with `volume`",
                        player.path(), brick.brick));
      const volume::Field* field = bone->brick_field(brick.brick);
      ++outcome.bricks;
      if (field == nullptr || std::memcmp(field, &brick.field, sizeof brick.field) != 0) {
        outcome.first_different_tick = row.tick;
        outcome.difference = fmt::format("brick {} holds other values", brick.brick);
      }
    }
    if (outcome.ticks % 1024 == 0) {
      if (progress.cancelled()) return error(Trouble::interrupted, "the replay was stopped");
      progress.report(static_cast<double>(outcome.ticks) /
                          static_cast<double>(std::max<std::uint64_t>(player.end_tick(), 1)),
                      "replaying");
    }
  }
  progress.report(1, "replaying");
  outcome.bone = std::move(bone);
  return outcome;
}

}  // namespace burr::sim

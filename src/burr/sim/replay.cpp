#include "burr/sim/replay.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "burr/device/replayed_hand.h"
#include "burr/record/chain.h"
#include "burr/record/counted_on.h"
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
  static Result<std::unique_ptr<OtherHand>> of(const record::SessionInfo& info,
                                               const std::string& file, tick::Servo& servo) {
    if (!info.second) return std::unique_ptr<OtherHand>();
    const auto recorded = second_of(info, file);
    if (!recorded) return recorded.error();
    auto other = std::make_unique<OtherHand>(*recorded, servo);
    servo.set_second(&other->hand);
    return other;
  }
};

// The servo of one part of a session, on the bone as that part began with it. A session that was never
// continued has one part.
struct Part {
  volume::IsoVertices surface;
  device::ReplayedHand hand;
  tick::RecordedLaw answers;
  tick::Servo servo;
  std::unique_ptr<OtherHand> other;
  record::CountedOn counted, second_counted;  // what its servo says, as the file says it

  Part(volume::Bone& bone, Recorded& recorded, const record::SessionInfo& info, tick::OwnLaw* law,
       Progress& progress)
      : surface(bone, recorded.settings.surface, 2, progress),
        hand(recorded.device),
        servo(bone, surface, hand,
              with_law(recorded.settings.servo, law != nullptr              ? law
                                                : law_of(info).kind.empty() ? nullptr
                                                                            : &answers)) {}
  static Result<std::unique_ptr<Part>> of(const record::SessionInfo& info, const std::string& file,
                                          volume::Bone& bone, RowLog* log, tick::OwnLaw* law,
                                          Progress& progress) {
    auto recorded = settings_of(info, file);
    if (!recorded) return recorded.error();
    if (const Status same = check_law(info, law, file); !same) return same.error();
    if (law != nullptr)
      if (const Status begun = law->begin(); !begun) return begun.error();
    auto part = std::make_unique<Part>(bone, *recorded, info, law, progress);
    if (log != nullptr && log->crossed() != nullptr)
      part->servo.set_brick_watch(&log->crossed()->written());
    auto other = OtherHand::of(info, file, part->servo);
    if (!other) return other.error();
    part->other = std::move(*other);
    return part;
  }

 private:
  static tick::ServoSettings with_law(tick::ServoSettings settings, tick::OwnLaw* law) {
    settings.law = law;
    return settings;
  }
};

class Replay {
 public:
  Replay(record::Player& player, std::unique_ptr<volume::Bone> bone, Progress& progress,
         RowLog* log, tick::OwnLaw* law)
      : player_(player), bone_(std::move(bone)), progress_(progress), log_(log), law_(law) {}

  Result<ReplayOutcome> run();

 private:
  [[nodiscard]] Status begin(const record::SessionInfo& info);
  [[nodiscard]] Status reach(std::uint64_t tick);
  [[nodiscard]] Status take_recorded_bone(std::uint64_t tick);
  [[nodiscard]] bool gap(const record::Step& step);
  void step(const record::Step& step);
  void compare(const record::Step& step, const tick::TickRow& row, const tick::TickRow* second);
  [[nodiscard]] Status compare_bricks(std::uint64_t tick);
  void differ(std::uint64_t tick, std::string how) {
    outcome_.first_different_tick = tick;
    outcome_.difference = std::move(how);
  }

  record::Player& player_;
  std::unique_ptr<volume::Bone> bone_;
  Progress& progress_;
  RowLog* log_;
  tick::OwnLaw* law_;
  std::unique_ptr<Part> part_;
  std::size_t next_part_ = 0;  // in player_.continued()
  ReplayOutcome outcome_;
  Chains chains_;
  record::PartEnd hand_, second_hand_;                    // after all ticks so far
  std::optional<edit::PieceStore::NewBricks> under_way_;  // lives until the servo has written it
  std::optional<record::BrickCursor> bricks_;
  tick::BrickRow brick_;
  bool has_brick_ = false;
};

Status Replay::begin(const record::SessionInfo& info) {
  auto part = Part::of(info, player_.path(), *bone_, log_, law_, progress_);
  if (!part) return part.error();
  if (part_) {
    (*part)->counted = record::CountedOn(hand_);
    (*part)->second_counted = record::CountedOn(second_hand_);
    outcome_.pieces.none_is_out();
    under_way_.reset();
  }
  part_ = std::move(*part);
  return fine();
}

// A part of the session that begins with this tick: another servo, on the bone as it is now.
Status Replay::reach(std::uint64_t tick) {
  const auto& parts = player_.continued();
  if (next_part_ >= parts.size() || parts[next_part_].first_tick != tick) return fine();
  const record::SessionInfo& info = parts[next_part_++];
  if (bone_->content_hash() != info.volume.content_hash)
    if (const Status taken = take_recorded_bone(tick - 1); !taken) return taken;
  if (bone_->content_hash() != info.volume.content_hash) {
    differ(tick, "the session was continued with another bone");
    return fine();
  }
  return begin(info);
}

// A part that was killed recorded its last changes of the bone less far than its ticks. The next part
// began with the bone that the file holds: what this part wrote is taken back, then done as recorded.
Status Replay::take_recorded_bone(std::uint64_t tick) {
  for (volume::BrickIndex brick = 0; brick < bone_->brick_count(); ++brick) {
    const edit::KeptBrick* kept = part_->servo.undo_store().original_of(brick);
    if (kept == nullptr) continue;
    bone_->write_brick(brick, kept->field);
    const math::Ijk first = bone_->brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const math::Ijk at = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (bone_->grid().contains(at)) bone_->set_tissue(at.x(), at.y(), at.z(), kept->tissue[v]);
    }
  }
  auto again = record::Player::open(player_.path());
  if (!again) return again.error();
  return (*again)->bone_at(static_cast<double>(tick) / player_.info().rate_hz, *bone_);
}

bool Replay::gap(const record::Step& step) {
  const bool whole = part_->other == nullptr || step.second;
  if (step.row.tick == outcome_.ticks && whole) return false;
  ++outcome_.gaps;
  outcome_.difference = fmt::format(
      "ticks before {} are missing in the file{}; the ticks after them cannot be compared",
      step.row.tick + (whole ? 0 : 1), whole ? "" : ", of the second hand");
  return true;
}

void Replay::step(const record::Step& step) {
  tick::Servo& servo = part_->servo;
  std::optional<edit::PieceStore::NewBricks> moving;
  std::shared_ptr<const edit::MovedBricks> splinter;  // of this tick
  for (const tick::Command& command : step.commands) {
    const bool moves = command.kind == tick::CommandKind::move_piece ||
                       command.kind == tick::CommandKind::lift_piece;
    if (moves && !moving) moving = lay_ready(outcome_.pieces, *bone_, command, servo);
    if (command.kind == tick::CommandKind::take_splinter && !splinter)
      splinter = lay_splinter(outcome_.pieces, *bone_, command, servo);
    servo.commands().push(command);
  }
  part_->hand.set(step.row.hand);
  if (part_->other) part_->other->device.set(step.second->hand);
  part_->answers.set(step.row.law);
  tick::TickRow row = servo.tick((step.row.contact.flags & rt::kFlagWatchdog) != 0);
  servo.publish();
  if (moving && servo.move_state() != tick::MoveState::refused) {
    outcome_.pieces.accept(*moving);
    under_way_ = std::move(moving);
  }
  part_->counted.change(row);
  if (log_ != nullptr) log_->note(row);
  ++outcome_.ticks;
  hand_ = {outcome_.ticks, row.ledger, row.hash};
  std::optional<tick::TickRow> second;
  if (part_->other) {
    second = part_->other->hand.row();
    part_->second_counted.change(*second);
    second_hand_ = {outcome_.ticks, second->ledger, second->hash};
  }
  compare(step, row, second ? &*second : nullptr);
}

// second: of the other hand; nullptr: there is none.
void Replay::compare(const record::Step& step, const tick::TickRow& row,
                     const tick::TickRow* second) {
  if (!chains_.add(step) || !same_undone(step.row, row))
    return differ(
        row.tick,
        "the values in the file do not give the hash beside them, so somebody changed them");
  const bool same_tool = !player_.tool_is_recorded() || row.tool == step.row.tool;
  if (row.hash != step.row.hash || !same_tool)
    return differ(row.tick, same_tool ? difference(step.row, row) : "another tool");
  if (second != nullptr && second->hash != step.second->hash)
    differ(row.tick, "second hand: " + difference(*step.second, *second));
}

Status Replay::compare_bricks(std::uint64_t tick) {
  for (; has_brick_ && !outcome_.first_different_tick && brick_.tick <= tick;
       has_brick_ = bricks_->next(brick_)) {
    if (brick_.tick != tick) continue;
    if (brick_.brick < 0 || brick_.brick >= bone_->brick_count())
      return error(
          fmt::format("{}: changes brick {}, which this bone does not have; give the right bone "
                      "with `volume`",
                      player_.path(), brick_.brick));
    const volume::Field* field = bone_->brick_field(brick_.brick);
    ++outcome_.bricks;
    if (field == nullptr || std::memcmp(field, &brick_.field, sizeof brick_.field) != 0)
      differ(tick, fmt::format("brick {} holds other values", brick_.brick));
  }
  return fine();
}

Result<ReplayOutcome> Replay::run() {
  if (const Status begun = begin(player_.info()); !begun) return begun.error();
  record::StepCursor steps = player_.steps();
  bricks_ = player_.bricks();
  record::Step one;
  has_brick_ = bricks_->next(brick_);
  while (!outcome_.first_different_tick && steps.next(one)) {
    if (const Status there = reach(one.row.tick); !there) return there.error();
    if (outcome_.first_different_tick || gap(one)) break;
    step(one);
    if (const Status same = compare_bricks(one.row.tick); !same) return same.error();
    if (outcome_.ticks % 1024 != 0) continue;
    if (progress_.cancelled()) return error(Trouble::interrupted, "the replay was stopped");
    progress_.report(static_cast<double>(outcome_.ticks) /
                         static_cast<double>(std::max<std::uint64_t>(player_.end_tick(), 1)),
                     "replaying");
  }
  progress_.report(1, "replaying");
  part_.reset();  // before its bone
  outcome_.bone = std::move(bone_);
  return std::move(outcome_);
}

}  // namespace

Result<ReplayOutcome> replay(record::Player& player, std::unique_ptr<volume::Bone> bone,
                             Progress& progress, RowLog* log, tick::OwnLaw* law) {
  return Replay(player, std::move(bone), progress, log, law).run();
}

}  // namespace burr::sim

// tick/restore.h - undo, redo and reset, some ticks long.
//
//     lifting     the tool goes back the way it came, until what returns cannot touch it
//     restoring   bricks are put back, a few a tick
//     settling    their surface is made again; then the tool follows the hand again
//
// Thread: servo. Frame: world. Units: SI. Memory: the way of the tool, 1.5 MiB, at construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burr/edit/bone_writer.h"
#include "burr/edit/undo.h"
#include "burr/math/vec3.h"
#include "burr/rt/rt.h"
#include "burr/tick/command.h"
#include "burr/tick/hand.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

class Restore {
 public:
  Restore(const volume::Bone& bone, const volume::IsoVertices& surface, edit::UndoStore& undo,
          edit::BoneWriter& writer, const ServoSettings& settings, Hand& hand);

  // kind: undo, redo or reset. False: one is in progress already, or there is nothing to put back.
  bool begin(CommandKind kind) BURR_RT;
  [[nodiscard]] bool active() const BURR_RT { return state_ != State::none; }
  // A tick of it, instead of touch.
  void step(std::uint32_t& flags) BURR_RT;

  // Once a tick: where the tool is now, if it is somewhere to come back to.
  void remember_path() BURR_RT;
  // How far the remembered way has come, for a stroke that begins.
  [[nodiscard]] std::uint64_t path_mark() const BURR_RT { return path_end_; }

 private:
  enum class State { none, lifting, restoring, settling };

  [[nodiscard]] const edit::KeptBrick& kept(std::uint64_t number) const BURR_RT;
  [[nodiscard]] bool clear_of_what_returns(const math::Vec3& p) const BURR_RT;
  void lift(std::uint32_t& flags) BURR_RT;
  void put_back() BURR_RT;
  void settle() BURR_RT;

  const volume::Bone& bone_;
  const volume::IsoVertices& surface_;
  edit::UndoStore& undo_;
  edit::BoneWriter& writer_;
  const ServoSettings& settings_;
  Hand& hand_;
  double dt_;

  static constexpr std::size_t kPath = 1 << 16;
  std::vector<math::Vec3> path_;  // a ring
  std::uint64_t path_end_ = 0;
  State state_ = State::none;
  CommandKind kind_ = CommandKind::undo;
  edit::UndoStore::Range range_;
  std::uint64_t restored_ = 0, path_at_ = 0;
  double lift_since_check_ = 0;  // [m]
};

}  // namespace burr::tick

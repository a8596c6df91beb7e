// sim/piece_mover.h - free pieces of bone while a session runs: noticed, taken, put down.
//
//     PieceMover mover(session);              // before the session starts
//     session.start();
//     ... about every picture:
//     for (const auto& news = mover.look(); ...)           // what came free since the last call
//     mover.take();                                        // copies the bone; then list() is whole
//     mover.put(number, by, turn);  mover.state()          // until put or refused
//     mover.lift(piece);                                   // or: out of the bone, into the hand
//     mover.put_down(); or mover.leave();                  // where it is; where it lay
//
// A thread of its own follows the bone twice a second, reads only what changed, and not while bone
// is being cut. The servo never waits for it.
// Thread: all calls on one thread, the one that commands the session; that thread never waits either.
// Memory: 2 B per brick of the grid and 0.9 KiB per brick that is not uniform; a copy of the bone
// while a piece is taken or put down.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "burr/edit/piece_store.h"
#include "burr/math/pose.h"
#include "burr/rt/changed_bits.h"
#include "burr/sim/session.h"
#include "burr/volume/pieces.h"

namespace burr::sim {

class PieceMover {
 public:
  // Registers two watchers of the bone. moved: what was moved before in this bone, in a session that is
  // continued (moved_in() of move_pieces.h).
  explicit PieceMover(Session& session, edit::PieceStore moved = {});
  // Stop the session, or this, first: it reads the bone.
  ~PieceMover();
  PieceMover(const PieceMover&) = delete;
  PieceMover& operator=(const PieceMover&) = delete;

  // A piece that has come free since the last call.
  struct News {
    double volume = 0;      // [m^3]
    bool dust = false;      // so small that it is not offered
    std::size_t count = 1;  // of dust: how many at once
    bool sucked = false;    // no: suction has taken a splinter of this volume
  };
  // Also sends what has been prepared, and notes what became of it. Call it in every picture.
  // piece: of the newest row.
  [[nodiscard]] std::vector<News> look(const tick::PieceRow& piece = {});

  // A tube that draws in, as it is now.
  struct Suction {
    math::Vec3 mouth = math::Vec3::Zero();
    double reach = 0;     // of a splinter's nearest voxel from the mouth  [m]
    double bore = 0;      // half of how thick a splinter may be, across its longest side  [m]
    bool second = false;  // of the second hand
  };
  static constexpr double kSuctionReach = 3e-3;  // beyond the radius of the tube [m]
  // Call it before look(); none: nothing draws in. Within about half a second after the bone rests the tube takes the
  // splinters in its reach, one after the other: those that came free since this object was made. Not while a piece
  // is out of the bone.
  void suck(const std::optional<Suction>& by);
  // How often the thread of this object has looked for a splinter to draw in; any thread. The look that is under way when
  // suck() is called still is for the tube before.
  [[nodiscard]] std::uint64_t looks() const { return looks_.load(); }

  // Asks for the list of pieces that may be moved, with their bones.
  void take();
  // nullptr: not copied yet, or the bone has been written since; take() again.
  [[nodiscard]] std::shared_ptr<const std::vector<edit::PieceStore::Found>> list() const;

  // lifted: the piece is out of the bone. It may also go back by itself, by an undo or reset: then none.
  enum class State : std::uint8_t { none, preparing, sent, put, refused, lifted };
  // Puts the piece down, so much further from where it lies now. False: another is on its way.
  bool put(const edit::PieceStore::Found& piece, const math::Vec3& by, const math::Quat& turn);
  // Lifts the piece out of the bone, so that a hand can hold it. False: another is on its way.
  bool lift(const edit::PieceStore::Found& piece);
  // A piece is out of the bone, or on its way out.
  [[nodiscard]] bool lifts() const { return lifted_.has_value(); }
  // The lifted piece is wanted there, as far as the bone lets it: the pose of its body.
  void shift(const math::Pose& body);
  // Puts the lifted piece down where it is then; the hand lets go of it first. False: none is lifted.
  bool put_down();
  // The lifted piece goes back to where it lay; one that is not out yet stays there. Not while it is being
  // put down, but once that was refused.
  void leave();
  // The bone is being prepared or written: a session that ended now would lose a piece, or a part of one.
  [[nodiscard]] bool busy() const {
    return lifts() || state_ == State::preparing || state_ == State::sent;
  }
  [[nodiscard]] State state() const { return state_; }
  // A lifted piece could not be put down since the last call; it is still lifted.
  [[nodiscard]] bool take_refusal() { return std::exchange(refusal_, false); }
  // Why it was refused, one sentence.
  [[nodiscard]] const std::string& why() const { return why_; }
  // Of the piece that was put down last [m^3].
  [[nodiscard]] double overlap() const { return overlap_; }

  // While the session stands still: the pieces as they were moved.
  [[nodiscard]] const edit::PieceStore& store() const { return store_; }

 private:
  struct Copy {
    std::unique_ptr<volume::Bone> bone;
    std::uint64_t writes = 0;
  };
  struct ToSend {
    edit::PieceMove move;
    edit::PieceStore::NewBricks bricks;
    bool lifts = false;
  };
  struct Lifted {
    std::uint32_t number = 0;
    math::Vec3 centre = math::Vec3::Zero();  // where it came free
    bool seen = false;                       // in a row
    int unseen = 0;                          // looks since it came out
    bool puts_down = false;                  // once the hand has let go and it has come to rest
    int rested = 0;                          // looks
    math::Vec3 last = math::Vec3::Zero();    // place
    std::array<double, 4> last_turn = {};    // x, y, z, w
    bool leaves = false;                     // once it is out
    int left = 0;                            // looks since then
  };
  struct Wanted {
    edit::PieceMove move;
    bool lifts = false;
  };
  // A splinter that suction takes.
  struct Splinter {
    edit::PieceMove move;
    std::shared_ptr<const edit::MovedBricks> bricks;
    bool second = false;
  };
  void run();
  void notice();
  void prepare_splinter(const Suction& by);
  [[nodiscard]] std::optional<News> look_at_splinter(bool may_send);
  [[nodiscard]] Result<Copy> copy();
  void list_pieces();
  void prepare(Wanted wanted);
  void want(const Wanted& wanted);
  void send(Result<ToSend>& ready);
  void see_end();
  void see_lifted(const tick::PieceRow& piece);

  Session& session_;
  volume::PieceFinder finder_;
  rt::ChangedBits& changed_;
  edit::PieceStore store_;
  State state_ = State::none;
  std::string why_;
  double overlap_ = 0;
  bool refusal_ = false;
  std::optional<ToSend> under_way_;
  std::optional<Lifted> lifted_;
  std::optional<Splinter> sucked_;  // sent

  mutable std::mutex mutex_;  // of everything below, and of store_
  std::condition_variable wake_;
  bool stopping_ = false, list_wanted_ = false;
  std::optional<Wanted> move_wanted_;
  bool away_ = false;  // a piece is: what comes and goes in the bone is no news
  std::vector<News> news_;
  std::shared_ptr<const std::vector<edit::PieceStore::Found>> list_;
  std::optional<Result<ToSend>> ready_;
  std::optional<Suction> suction_;
  std::optional<Splinter> splinter_;

  std::atomic<std::uint64_t> looks_ = 0;

  // of the thread
  std::uint64_t seen_ = 0, seen_before_ = 0;  // writes
  std::vector<volume::Piece> known_;
  std::vector<volume::Piece> old_splinters_;  // that lay free at the start
  std::thread thread_;
};

}  // namespace burr::sim

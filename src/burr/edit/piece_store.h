// edit/piece_store.h - the pieces of a session that were moved, each as it came free, and where
// they have lain; prepares the next move.
//
//     PieceStore store;
//     auto found = store.find(bone, p);                      // the free piece at a point
//     move = {found->number, found->seed, by, turn, writes};
//     auto ready = store.prepare(bone, move);                // bricks for the servo
//     ... the servo obeys ...   store.accept(*ready);
//     auto ready = store.prepare_lift(bone, move);           // out of the bone, into a hand
//
// A piece is always resampled from what came free, by the whole move from there: any number of
// moves blurs it once. A whole number of voxels without a turn does not blur it at all.
//
//     take out   every voxel of the piece becomes what it was before the piece was put there
//     put down   trilinear; tissue of the nearest voxel; where other bone is, the larger field
//
// Where a piece lies now is found in the bone itself, so undo, redo and reset need no word to the
// store. A piece that was cut after it was moved is no longer what came free: it must be undone, or
// cut free, to be moved again.
//
// Numbers are doubles in a fixed order of operations: the same build gives the same bits.
// Thread: one at a time; the bone at rest. It takes time in proportion to bone and piece (0.1 s to
// seconds). Frame: world. Units: SI. Memory: each piece, and 3 KiB a brick for each place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "burr/base/result.h"
#include "burr/edit/moved_bricks.h"
#include "burr/edit/piece_move.h"
#include "burr/math/pose.h"
#include "burr/volume/bone.h"
#include "burr/volume/pieces.h"

namespace burr::edit {

inline constexpr double kDust = 5e-9;        // a smaller piece is dust ...         [m^3]
inline constexpr double kDustOfBone = 1e-3;  // ... if it is no more of the largest piece [1]

class PieceStore {
 public:
  // A piece that may be moved.
  struct Found {
    std::uint32_t number = 0;  // for PieceMove::piece
    math::Ijk seed = math::Ijk::Zero();
    double volume = 0;  // as it came free  [m^3]
    math::Vec3 centre =
        math::Vec3::Zero();  // of its voxels where it came free; the move turns about it
    math::Pose now;          // the whole move so far, of a point of the piece where it came free
    std::shared_ptr<const volume::Bone> bone;  // as it came free
  };
  // All pieces but the mother and dust, the largest first: those that were moved and lie where they
  // were put, and those that have come free, kMostFree at most: a scan may have thousands of islands.
  static constexpr std::size_t kMostFree = 16;
  [[nodiscard]] std::vector<Found> list(const volume::Bone& bone) const;
  // The piece whose voxels are nearest to p, at most `within` away [m]. Error: there is none.
  [[nodiscard]] Result<Found> find(const volume::Bone& bone, const math::Vec3& p,
                                   double within = 2e-3) const;

  struct ToAccept;  // what accept() keeps
  struct NewBricks {
    std::shared_ptr<const MovedBricks> bricks;  // does not move in memory
    std::shared_ptr<ToAccept> ready;
  };
  // The bricks of this move on this bone; fills in move.bricks of the result's hash. move.writes is
  // only passed on. Error: there is no such piece, it was cut since, or it would leave the volume.
  [[nodiscard]] Result<NewBricks> prepare(const volume::Bone& bone, const PieceMove& move) const;
  // The bricks of the bone without this piece, and the piece as a body (edit/piece_body.h). The next
  // move of it says `lifted`. Fills in move.bricks and move.body of the result. Errors as prepare(), and
  // a piece that is too thin to be held.
  [[nodiscard]] Result<NewBricks> prepare_lift(const volume::Bone& bone,
                                               const PieceMove& move) const;
  // The bricks of the bone without the splinter (is_dust()) in which the move's seed lies: the command
  // `take_splinter`. Fills in what the bone loses. Error: no splinter lies there any more.
  [[nodiscard]] Result<std::shared_ptr<const MovedBricks>> prepare_splinter(
      const volume::Bone& bone, const PieceMove& move) const;
  // The servo has obeyed. Not of a splinter.
  void accept(const NewBricks& prepared);

  // A piece that was moved, as it lies in `bone`; none: not where this store put it.
  struct Moved {
    std::uint32_t number = 0;
    double volume = 0;  // as it came free [m^3]
    math::Vec3 centre = math::Vec3::Zero();
    math::Pose now;                                 // world, of a point where it came free
    PieceMove move;                                 // the command that put it there
    std::shared_ptr<const volume::Bone> piece;      // alone, at its place
    std::shared_ptr<const volume::Bone> came_free;  // where it came free
  };
  [[nodiscard]] std::vector<Moved> moved(const volume::Bone& bone) const;
  // The bone without the pieces that were moved.
  [[nodiscard]] std::unique_ptr<volume::Bone> without_moved(const volume::Bone& bone) const;
  // A piece that was lifted out of the bone, and is neither where it lay nor where it was put down.
  struct Out {
    std::uint32_t number = 0;
    double volume = 0;  // as it came free [m^3]
    math::Vec3 centre = math::Vec3::Zero();
    std::shared_ptr<const volume::Bone> bone;  // as it came free
  };
  [[nodiscard]] std::optional<Out> out(const volume::Bone& bone) const;
  // A piece that was moved or lifted, wherever it is now; none: there is none of this number.
  [[nodiscard]] std::optional<Out> piece(std::uint32_t number) const;
  // What was lifted last has gone back, and was cut, or bone was put on it: it is not out.
  void none_is_out() { out_.reset(); }
  // The bone as if no piece had been moved: each lies again where it came free, also the one that is out.
  [[nodiscard]] std::unique_ptr<volume::Bone> with_pieces_back(const volume::Bone& bone) const;

  [[nodiscard]] std::size_t size() const { return kept_.size(); }

 private:
  struct Kept;
  struct Place;
  [[nodiscard]] Result<const Place*> look_up(const volume::Bone& bone, const PieceMove& move,
                                             ToAccept& ready) const;
  [[nodiscard]] const Place* place_of(const volume::Bone& bone, const Kept& kept) const;
  [[nodiscard]] std::unique_ptr<volume::Bone> taken_out(const volume::Bone& bone, bool back) const;
  // specks: PieceMove::specks
  [[nodiscard]] std::shared_ptr<Kept> take(const volume::Bone& bone,
                                           const volume::PieceFinder& finder, std::size_t piece,
                                           bool specks) const;

  std::vector<std::shared_ptr<Kept>> kept_;
  std::optional<std::uint32_t> out_;  // lifted last, and not put down
};

// Of the finder's pieces, from 1.
[[nodiscard]] bool is_dust(const volume::Bone& bone, const volume::PieceFinder& finder,
                           std::size_t piece);

// The move as a pose of world points. centre: of the piece where it came free.
[[nodiscard]] math::Pose pose_of(const PieceMove& move, const math::Vec3& centre);

}  // namespace burr::edit

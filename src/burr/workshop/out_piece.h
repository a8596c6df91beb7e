// workshop/out_piece.h - the piece of bone that was out of the bone at a moment of a recording, and where it was.
//
//     OutPieces pieces(player);
//     auto piece = pieces.at(row, t, bone);             // bone: as player.bone_at(t, bone) left it
//     look.put(scene, piece->mesh, piece->by, bone.tissues().tissues.size());
//
// A recording holds the pose of the piece in every tick. Its shape is found from the bone as it was when it was
// lifted (edit/piece_store.h): the first call for a piece reads all commands and looks for the pieces of the bone,
// which takes a second or two. Every later one takes no time.
//
// Thread: that of the player. Frame: world. Units: SI. Memory: each piece once, and its surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "burr/base/result.h"
#include "burr/edit/piece_store.h"
#include "burr/math/pose.h"
#include "burr/record/player.h"
#include "burr/render/scene.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

struct OutPiece {
  std::shared_ptr<const render::CoarseMesh> mesh;  // where it came free; nullptr: none is out
  math::Pose by;                                   // from there
};

class OutPieces {
 public:
  // The player must outlive this object.
  explicit OutPieces(record::Player& player) : player_(player) {}

  // row: the tick at t [s]. The bone is left as player.bone_at(t, bone) leaves it. Error: as that.
  [[nodiscard]] Result<OutPiece> at(const tick::TickRow& row, double t, volume::Bone& bone);

 private:
  struct Order {  // a command that moves or lifts a piece
    std::uint64_t tick = 0;
    bool lifts = false;
    bool anew = false;  // the first one after the session was continued
    edit::PieceMove move;
  };
  struct Shape {
    std::shared_ptr<const render::CoarseMesh> mesh;
    math::Vec3 centre = math::Vec3::Zero();  // where it came free
  };
  void read_orders();
  [[nodiscard]] Status follow(std::uint64_t tick, volume::Bone& bone);

  record::Player& player_;
  edit::PieceStore store_;
  std::optional<std::vector<Order>> orders_;
  std::size_t followed_ = 0;               // of the orders
  std::map<std::uint32_t, Shape> shapes_;  // by the number of the piece
};

}  // namespace burr::workshop

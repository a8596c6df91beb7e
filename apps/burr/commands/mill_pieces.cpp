#include "commands/mill_pieces.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "burr/base/printable.h"
#include "burr/report/piece_words.h"
#include "burr/surgeon/motion.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

constexpr double kLiftTime = 10;  // in which a piece is out of the bone  [s]

Status carry(const Carry& carry, sim::Session& session, edit::PieceStore& store) {
  const double began = session.outcome().seconds;
  const auto lifted = sim::lift_piece(session, store, carry.near, progress());
  if (!lifted) return lifted.error();
  const double rest = kLiftTime - (session.outcome().seconds - began);
  if (rest < 0) return error(Trouble::internal, "the piece was not lifted in time");
  session.run(rest + carry.path.duration() - carry.path.points.front().t, progress());
  if (interrupted()) return error(Trouble::interrupted, "stopped while a piece was carried");
  const auto put = sim::put_down(session, store, *lifted, progress());
  return put ? fine() : Status(put.error());
}

}  // namespace

Status move_pieces(const std::vector<sim::PieceOrder>& orders, sim::Session& session,
                   edit::PieceStore& store) {
  for (const sim::PieceOrder& order : orders) {
    const auto moved = sim::move_piece(session, store, order, progress());
    if (!moved) return moved.error();
  }
  return fine();
}

Result<Carry> read_carry(const std::string& text) {
  const std::size_t colon = text.find(':');
  Carry carry;
  if (colon == std::string::npos || !report::point_of(text.substr(0, colon), carry.near))
    return error(Trouble::usage,
                 fmt::format("--carry-piece {}: give X,Y,Z:FILE.csv (mm), for example "
                             "10,0,5:carry.csv",
                             base::printable(text)));
  carry.file = text.substr(colon + 1);
  auto path = surgeon::read_path(carry.file);
  if (!path) return path.error();
  carry.path = std::move(*path);
  return carry;
}

void carry_on(device::HandPath& path, const Carry& carry) {
  device::PathPoint last = path.points.back();
  last.pedal = 0;
  last.t += 1e-3;
  path.points.push_back(last);
  const double begins = last.t + kLiftTime;
  for (const device::PathPoint& point : carry.path.points) {
    device::PathPoint to = point;
    to.t += begins - carry.path.points.front().t;
    to.world_from_tool.p += last.world_from_tool.p - carry.path.points.front().world_from_tool.p;
    path.points.push_back(to);
  }
}

Status carry_piece(const Carry& way, sim::Session& session, edit::PieceStore& store) {
  const Status carried = carry(way, session, store);
  if (carried.ok()) return carried;
  const auto left = sim::leave_piece(session);
  if (!left) return left.error();
  if (!*left) return carried;
  return error(carried.error().trouble,
               fmt::format("{}; it was put back to where it lay", carried.error().text));
}

}  // namespace burr::app

#include "burr/report/piece_words.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/math/turn.h"

namespace burr::report {
namespace {

using math::Vec3;
constexpr double kDegree = std::numbers::pi / 180;

bool numbers(std::string_view text, Vec3& to) {
  const char *at = text.data(), *end = at + text.size();
  for (int n = 0; n < 3; ++n) {
    const auto read = std::from_chars(at, end, to[n]);
    if (read.ec != std::errc() || !std::isfinite(to[n])) return false;
    at = read.ptr;
    if (n == 2) return at == end;
    if (at == end || *at != ',') return false;
    ++at;
  }
  return false;
}

nlohmann::ordered_json mm(const Vec3& v) { return {1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z()}; }

}  // namespace

Result<sim::PieceOrder> piece_order(const std::string& text) {
  std::array<Vec3, 3> parts = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::string_view rest = text;
  std::size_t count = 0;
  for (bool more = true; more && count < parts.size(); ++count) {
    const std::size_t end = rest.find(':');
    if (!numbers(rest.substr(0, end), parts[count])) {
      count = 0;
      break;
    }
    more = end != std::string_view::npos;
    rest = more ? rest.substr(end + 1) : std::string_view();
  }
  if (count < 2 || !rest.empty())
    return error(Trouble::usage,
                 fmt::format("{}: no move of a piece; give X,Y,Z:DX,DY,DZ, or with a turn "
                             "X,Y,Z:DX,DY,DZ:AX,AY,AZ (mm, mm, degrees), for example 10,0,5:0,0,5",
                             text));
  return sim::PieceOrder{parts[0] * 1e-3, parts[1] * 1e-3, parts[2] * kDegree};
}

bool point_of(const std::string& text, Vec3& point) {
  if (!numbers(text, point)) return false;
  point *= 1e-3;
  return true;
}

std::vector<MovedPiece> moved_pieces(const edit::PieceStore& store, const volume::Bone& bone,
                                     const scenario::CaseLesson* lesson) {
  std::vector<MovedPiece> all;
  const std::vector<edit::PieceStore::Moved> moved = store.moved(bone);
  if (const auto lifted = store.out(bone)) {
    MovedPiece& piece = all.emplace_back();
    piece.number = lifted->number;
    piece.volume = lifted->volume;
    piece.centre = lifted->centre;
    piece.out = true;
  }
  if (moved.empty()) return all;
  const std::unique_ptr<volume::Bone> rest = store.without_moved(bone);
  for (const edit::PieceStore::Moved& one : moved) {
    MovedPiece& piece = all.emplace_back();
    piece.number = one.number;
    piece.volume = one.volume;
    piece.centre = one.now * one.centre;
    piece.by = Vec3(one.move.by[0], one.move.by[1], one.move.by[2]);
    piece.turned = math::rotation_vector(one.now.q).norm();
    piece.fit = metrics::piece_fit(*one.piece, *rest);
    const scenario::PlannedPiece* plan =
        lesson != nullptr ? workshop::plan_of(*lesson, *one.came_free) : nullptr;
    if (plan != nullptr)
      piece.plan = {plan->title.in("en"), plan->by, workshop::off_plan(*plan, piece.by, one.now.q)};
  }
  return all;
}

Result<MovedIn> moved_pieces_of(record::Player& player, volume::Bone& bone,
                                const scenario::CaseLesson* lesson, double at_s) {
  auto store = sim::moved_in(player, bone, at_s);
  if (!store) return store.error();
  const Status there = player.bone_at(at_s < 0 ? player.seconds() : at_s, bone);
  if (!there) return there.error();
  MovedIn out{std::move(*store), {}};
  out.pieces = moved_pieces(out.store, bone, lesson);
  return out;
}

std::string pieces_json(const std::vector<MovedPiece>& pieces) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const MovedPiece& one : pieces) {
    const metrics::PieceFit& fit = one.fit;
    nlohmann::ordered_json row;
    row["piece"] = one.number + 1;
    row["volume_mm3"] = 1e9 * one.volume;
    row["out"] = one.out;
    row["centre_mm"] = mm(one.centre);
    row["moved_mm"] = mm(one.by);
    row["distance_mm"] = 1e3 * one.by.norm();
    row["turned_deg"] = one.turned / kDegree;
    row["facing_mm2"] = 1e6 * fit.facing;
    row["contact_mm2"] = 1e6 * fit.contact;
    if (fit.facing > 0) {
      row["gap_mm"] = 1e3 * fit.gap;
      row["gap_least_mm"] = 1e3 * fit.gap_least;
      row["gap_most_mm"] = 1e3 * fit.gap_most;
    }
    if (fit.has_step) {
      row["step_mm"] = 1e3 * fit.step;
      row["step_most_mm"] = 1e3 * fit.step_most;
    }
    if (one.plan)
      row["plan"] = {{"title", one.plan->title},
                     {"planned_mm", mm(one.plan->by)},
                     {"way_mm", 1e3 * one.plan->off.way},
                     {"off_mm", 1e3 * one.plan->off.off},
                     {"off_deg", one.plan->off.turned_off / kDegree}};
    all.push_back(std::move(row));
  }
  return all.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::vector<std::string> pieces_text(const std::vector<MovedPiece>& pieces) {
  std::vector<std::string> lines;
  for (const MovedPiece& one : pieces) {
    const metrics::PieceFit& fit = one.fit;
    if (one.out) {
      lines.push_back(
          fmt::format("piece {} of {:.1f} mm3: out of the bone, in a hand, when the recording ends",
                      one.number + 1, 1e9 * one.volume));
      continue;
    }
    std::string line =
        fmt::format("piece {} of {:.1f} mm3: moved {:.2f} mm, turned {:.2f} degrees",
                    one.number + 1, 1e9 * one.volume, 1e3 * one.by.norm(), one.turned / kDegree);
    if (fit.facing > 0)
      line += fmt::format("; gap {:.2f} mm ({:.2f} to {:.2f}), contact {:.1f} mm2", 1e3 * fit.gap,
                          1e3 * fit.gap_least, 1e3 * fit.gap_most, 1e6 * fit.contact);
    if (fit.has_step)
      line += fmt::format("; step {:.2f} mm (most {:.2f})", 1e3 * fit.step, 1e3 * fit.step_most);
    if (one.plan)
      line += fmt::format("; {:.2f} mm and {:.2f} degrees off the plan", 1e3 * one.plan->off.off,
                          one.plan->off.turned_off / kDegree);
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace burr::report

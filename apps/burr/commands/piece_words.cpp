#include "commands/piece_words.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/math/turn.h"
#include "burr/metrics/piece_fit.h"
#include "burr/workshop/piece_plan.h"

namespace burr::app {
namespace {

using math::Vec3;

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
                 fmt::format("--move-piece {}: give X,Y,Z:DX,DY,DZ, or with a turn "
                             "X,Y,Z:DX,DY,DZ:AX,AY,AZ (mm, mm, degrees), for example 10,0,5:0,0,5",
                             text));
  constexpr double kRad = std::numbers::pi / 180;
  return sim::PieceOrder{parts[0] * 1e-3, parts[1] * 1e-3, parts[2] * kRad};
}

nlohmann::ordered_json pieces_json(const edit::PieceStore& store, const volume::Bone& bone,
                                   const scenario::Lesson* lesson) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  const std::vector<edit::PieceStore::Moved> moved = store.moved(bone);
  if (moved.empty()) return all;
  const std::unique_ptr<volume::Bone> rest = store.without_moved(bone);
  for (const edit::PieceStore::Moved& one : moved) {
    const Vec3 by(one.move.by[0], one.move.by[1], one.move.by[2]);
    const double turned = math::rotation_vector(one.now.q).norm() * 180 / std::numbers::pi;
    const metrics::PieceFit fit = metrics::piece_fit(*one.piece, *rest);
    nlohmann::ordered_json row;
    row["piece"] = one.number + 1;
    row["volume_mm3"] = 1e9 * one.volume;
    row["centre_mm"] = mm(one.now * one.centre);
    row["moved_mm"] = mm(by);
    row["distance_mm"] = 1e3 * by.norm();
    row["turned_deg"] = turned;
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
    const scenario::PlannedPiece* plan =
        lesson != nullptr ? workshop::plan_of(*lesson, *one.came_free) : nullptr;
    if (plan != nullptr) {
      const workshop::OffPlan off = workshop::off_plan(*plan, by, one.now.q);
      row["plan"] = {{"title", plan->title.in("en")},
                     {"planned_mm", mm(plan->by)},
                     {"way_mm", 1e3 * off.way},
                     {"off_mm", 1e3 * off.off},
                     {"off_deg", off.turned_off * 180 / std::numbers::pi}};
    }
    all.push_back(std::move(row));
  }
  return all;
}

std::vector<std::string> pieces_text(const nlohmann::ordered_json& pieces) {
  std::vector<std::string> lines;
  for (const auto& row : pieces) {
    std::string line =
        fmt::format("piece {} of {:.1f} mm3: moved {:.2f} mm, turned {:.2f} degrees",
                    row["piece"].get<int>(), row["volume_mm3"].get<double>(),
                    row["distance_mm"].get<double>(), row["turned_deg"].get<double>());
    if (row.contains("gap_mm"))
      line += fmt::format("; gap {:.2f} mm ({:.2f} to {:.2f}), contact {:.1f} mm2",
                          row["gap_mm"].get<double>(), row["gap_least_mm"].get<double>(),
                          row["gap_most_mm"].get<double>(), row["contact_mm2"].get<double>());
    if (row.contains("step_mm"))
      line += fmt::format("; step {:.2f} mm (most {:.2f})", row["step_mm"].get<double>(),
                          row["step_most_mm"].get<double>());
    if (row.contains("plan"))
      line +=
          fmt::format("; {:.2f} mm and {:.2f} degrees off the plan",
                      row["plan"]["off_mm"].get<double>(), row["plan"]["off_deg"].get<double>());
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace burr::app

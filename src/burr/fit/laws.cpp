#include "burr/fit/laws.h"

#include <fmt/core.h>

#include <span>

#include "burr/fit/least_squares.h"

namespace burr::fit {
namespace {

bool cuts(const ForceRow& row) {
  return row.normal >= kLeastPush && row.speed > 0 && row.radius > 0 && row.removal > 0;
}

// Fits y to the columns and adds the constants, or the reason why there are none, to the answer.
void tell(MaterialFit& answer, std::vector<const char*> keys,
          std::span<const std::vector<double>> columns, const std::vector<double>& y,
          const char* residual_unit, const char* cure) {
  std::string names;
  for (const char* key : keys) names += (names.empty() ? "" : " and ") + std::string(key);
  const LineFit fit = least_squares(columns, y);
  if (fit.state == LineFit::State::too_few_rows) {
    answer.undetermined.push_back(fmt::format(
        "{}: only {} rows in which material is cut, but {} are needed; give a longer log", names,
        y.size(), columns.size() + 2));
    return;
  }
  if (fit.state == LineFit::State::indistinguishable) {
    answer.undetermined.push_back(
        fmt::format("{}: these constants cannot be separated from this log (condition number "
                    "{:.3g}, at most {:g}); {}",
                    names, fit.condition, kWorstCondition, cure));
    return;
  }
  for (std::size_t n = 0; n < keys.size(); ++n)
    answer.constants.push_back(
        {keys[n], fit.value[n], fit.half[n], y.size(), fit.residual, residual_unit});
}

// F_t = mu_c F_n
void fit_friction(const std::vector<ForceRow>& rows, MaterialFit& answer) {
  std::vector<double> normal, tangential;
  for (const ForceRow& row : rows) {
    if (!row.tangential) continue;
    normal.push_back(row.normal);
    tangential.push_back(*row.tangential);
  }
  if (normal.empty() && !rows.empty()) {
    answer.undetermined.emplace_back(
        "cutting_friction: the log has neither tangential force nor torque");
    return;
  }
  tell(answer, {"cutting_friction"}, std::span(&normal, 1), tangential, "N", "");
}

// P = u MRR. A measured power is preferred to one computed from the tangential force.
void fit_energy(const std::vector<ForceRow>& rows, MaterialFit& answer) {
  bool measured = false;
  for (const ForceRow& row : rows) measured = measured || row.power.has_value();
  std::vector<double> removal, power;
  for (const ForceRow& row : rows) {
    if (measured ? !row.power : !row.tangential) continue;
    removal.push_back(row.removal);
    power.push_back(measured ? *row.power : *row.tangential * row.speed * row.radius);
  }
  if (removal.empty() && !rows.empty()) {
    answer.undetermined.emplace_back(
        "cutting_energy_J_mm3: the log has neither power nor tangential force");
    return;
  }
  tell(answer, {"cutting_energy_J_mm3"}, std::span(&removal, 1), power, "W", "");
}

// F = K_c A + K_e L, once along the motion of the teeth and once normal to the bone
void fit_edges(const std::vector<ForceRow>& rows, MaterialFit& answer) {
  constexpr const char* kCure =
      "chip area and engaged edge length must vary independently: cut at several feeds and depths";
  bool any_edge = false;
  std::vector<double> against[2], along[2], tangential, normal;
  for (const ForceRow& row : rows) {
    if (!row.edge) continue;
    any_edge = true;
    const double chip = row.removal / (row.speed * row.radius);
    against[0].push_back(chip);
    against[1].push_back(*row.edge);
    normal.push_back(row.normal);
    if (!row.tangential) continue;
    along[0].push_back(chip);
    along[1].push_back(*row.edge);
    tangential.push_back(*row.tangential);
  }
  if (!any_edge) return;  // the log has no data for level 2
  tell(answer, {"chip_tangential_N_mm2", "edge_tangential_N_mm"}, along, tangential, "N", kCure);
  tell(answer, {"chip_radial_N_mm2", "edge_radial_N_mm"}, against, normal, "N", kCure);
}

}  // namespace

std::vector<MaterialFit> fit_laws(const ForceLog& log) {
  std::vector<MaterialFit> answers;
  for (std::size_t n = 0; n < log.materials.size(); ++n) {
    MaterialFit& answer = answers.emplace_back();
    answer.material = log.materials[n];
    std::vector<ForceRow> rows;
    for (const ForceRow& row : log.rows) {
      if (row.material != n) continue;
      if (cuts(row))
        rows.push_back(row);
      else
        ++answer.left_out;
    }
    answer.rows = rows.size();
    fit_friction(rows, answer);
    fit_energy(rows, answer);
    fit_edges(rows, answer);
  }
  return answers;
}

}  // namespace burr::fit

#include "commands/mill_result.h"

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/tick/flag_words.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

void print_heat(const sim::Session& session, const thermal::HeatSummary& heat, std::uint64_t lost) {
  const thermal::HeatLedger& ledger = heat.ledger;
  fmt::print(
      "heat: {:.2f} J of the burr's {:.2f} J stayed in the bone; {:.2f} J to the coolant; "
      "warmest now {:.1f} deg C\n",
      ledger.into, ledger.spent, ledger.convected, heat.hottest_c);
  for (std::size_t id = 1; id < heat.tissue.size(); ++id) {
    const thermal::TissueHeat& one = heat.tissue[id];
    if (!one.there) continue;
    fmt::print(
        "  {}: {:.1f} deg C at the most, dose {:.3g} CEM43 min, {:.2f} mm3 above 47 deg C "
        "now\n",
        session.bone_tissues()[static_cast<volume::TissueId>(id)].name, one.ever_c, one.cem43_min,
        1e9 * one.warm_m3);
  }
  if (lost > 0)
    fmt::print(
        "  {} rows of heat were lost because this machine is too slow: the bone was warmer than "
        "shown\n",
        lost);
}

nlohmann::json heat_json(const sim::Session& session, const thermal::HeatSummary& heat,
                         std::uint64_t lost) {
  nlohmann::json tissues = nlohmann::json::array();
  for (std::size_t id = 1; id < heat.tissue.size(); ++id) {
    const thermal::TissueHeat& one = heat.tissue[id];
    if (!one.there) continue;
    tissues.push_back({{"tissue", session.bone_tissues()[static_cast<volume::TissueId>(id)].name},
                       {"now_c", one.now_c},
                       {"ever_c", one.ever_c},
                       {"cem43_min", one.cem43_min},
                       {"warm_mm3", 1e9 * one.warm_m3}});
  }
  return {{"hottest_c", heat.hottest_c},
          {"spent_J", heat.ledger.spent},
          {"into_bone_J", heat.ledger.into},
          {"to_coolant_J", heat.ledger.convected},
          {"rows_lost", lost},
          {"tissues", tissues}};
}

void print(const MillOptions& options, sim::Session& session, const Besides& besides) {
  const sim::Outcome outcome = session.outcome();
  const rt::TickSummary& t = outcome.timing;
  fmt::print(
      "{:.2f} s, {} ticks: removed {:.3f} mm3 of {:.3f} mm3 asked; force {:.2f} N mean in "
      "contact, {:.2f} N peak\n",
      outcome.seconds, outcome.ticks, 1e9 * outcome.ledger.removed, 1e9 * outcome.ledger.asked,
      outcome.mean_force, outcome.peak_force);
  fmt::print("tick {:.1f} us median, {:.1f} p99, {:.1f} p99.9, {:.1f} worst (thread CPU){}\n",
             t.p50_us, t.p99_us, t.p999_us, t.max_us,
             options.realtime
                 ? fmt::format("; {} late, {} missed; {}", t.late, t.missed, outcome.scheduling)
                 : "");
  if (outcome.most_shed != tick::Shed::none)
    fmt::print("put off at times because this machine is too slow: {}\n",
               tick::name(outcome.most_shed));
  if (options.heat) print_heat(session, besides.heat, outcome.heat_rows_lost);
  for (const std::string& line : report::pieces_text(besides.pieces)) fmt::print("{}\n", line);
  for (const std::string& doubt : besides.doubts) fmt::print("noted: {}\n", doubt);
  for (const std::string& sentence : tick::words(tick::worth_telling(outcome.flags)))
    fmt::print("noted: {}\n", sentence);
}

}  // namespace

CommandResult result_of(const MillOptions& options, sim::Session& session,
                        const Recording& recording, const Besides& besides) {
  const sim::Outcome outcome = session.outcome();
  const rt::TickSummary& t = outcome.timing;
  CommandResult findings;
  nlohmann::json &out = findings.result, &times = findings.times;
  out["finished"] = !interrupted();
  out["ticks"] = outcome.ticks;
  out["seconds"] = outcome.seconds;
  out["removed_mm3"] = 1e9 * outcome.ledger.removed;
  out["asked_mm3"] = 1e9 * outcome.ledger.asked;
  out["not_cut_mm3"] = 1e9 * outcome.ledger.not_cut;
  out["owed_mm3"] = 1e9 * outcome.ledger.debt;
  if (!options.move_pieces.empty() || !options.carry_piece.empty()) {
    out["moved_loss_mm3"] = 1e9 * outcome.ledger.moved;
    out["pieces"] = nlohmann::json::parse(report::pieces_json(besides.pieces));
  }
  if (besides.left) {
    out["plane_left"] = besides.left->share;
    out["plane_needs_s"] = besides.left->needs_s;
  }
  out["peak_force_N"] = outcome.peak_force;
  out["mean_force_N"] = outcome.mean_force;
  times["tick_us"] = {{"p50", t.p50_us}, {"p99", t.p99_us}, {"p999", t.p999_us}, {"max", t.max_us}};
  out["rate_hz"] = session.settings().servo.rate_hz;
  out["realtime"] = options.realtime;
  times["late_us"] = {{"p50", t.late_p50_us},
                      {"p99", t.late_p99_us},
                      {"p999", t.late_p999_us},
                      {"max", t.worst_lateness_us}};
  times["late"] = t.late;
  times["missed"] = t.missed;
  times["worst_lateness_us"] = t.worst_lateness_us;
  out["bone_hash"] = record::hex(session.bone().content_hash());
  std::vector<std::string> noted = besides.doubts;
  for (const std::string& sentence : tick::words(tick::worth_telling(outcome.flags)))
    noted.push_back(sentence);
  out["noted"] = noted;
  times["load_ticks"] = outcome.shed_ticks;
  if (options.heat) out["heat"] = heat_json(session, besides.heat, outcome.heat_rows_lost);
  if (options.realtime) times["scheduling"] = outcome.scheduling;
  if (!options.record.empty()) times["recording"] = recording.account();
  return findings;
}

void tell(const MillOptions& options, sim::Session& session, const Besides& besides,
          CommandResult findings, CommandResult* given) {
  if (given != nullptr)
    *given = std::move(findings);
  else if (options.json)
    fmt::print("{}\n", json_line(findings.whole()));
  else
    print(options, session, besides);
}

}  // namespace burr::app

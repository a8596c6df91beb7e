// burr verify scores: are scores right? The bones of the built-in cases, cut by shapes whose right marks are known (burr/proof).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "burr/proof/ask.h"
#include "burr/scenario/case.h"
#include "burr/workshop/other_bone.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"
#include "verify.h"

namespace burr::app {
namespace {

constexpr std::uint32_t kOtherBones = 3;  // of `--bone`, from 1
constexpr std::size_t kQuickBones = 4;    // of each table, the first

// One bone of a case at one voxel size.
struct ScoredRound {
  double voxel_mm = 0;  // 0: the case's
  std::uint32_t bone = 0;
  std::size_t most = 0;  // known bones, the first; 0: all
};

std::vector<ScoredRound> rounds_of(const proof::KnownTable& table, bool quick) {
  if (quick) return {{0, 0, kQuickBones}};
  std::vector<ScoredRound> rounds = {{0, 0, 0}, {table.coarser_mm, 0, 0}};
  const auto work = scenario::read_case(table.case_name);
  if (work && workshop::has_other_bones(*work))
    for (std::uint32_t bone = 1; bone <= kOtherBones; ++bone)
      rounds.push_back({0, bone, table.few});
  return rounds;
}

// The largest deviation of a tolerance that was seen.
struct Worst {
  std::string item;
  double off = 0, tolerance = 0;
  std::string unit;
  void see(const proof::Answer& answer) {
    if (!answer.right || !answer.is || !(answer.tolerance > 0)) return;
    const double now = std::abs(*answer.is - *answer.right);
    if (tolerance > 0 && now / answer.tolerance <= off / tolerance) return;
    *this = {answer.item, now, answer.tolerance, answer.unit};
  }
};

void judge(VerifyReport::Part& part, const std::string& name, const proof::Answer& answer) {
  if (answer.right && answer.is)
    part.near(name, *answer.right, *answer.is, answer.tolerance, answer.unit);
  if (answer.right && !answer.is)
    part.checks.push_back({part.name + "." + name, "a value", 0, answer.unit, false});
  if (answer.must)
    part.checks.push_back({part.name + "." + name + ".verdict", scoring::word_of(*answer.must),
                           answer.verdict == scoring::Verdict::met ? 1.0 : 0.0, "",
                           answer.verdict_holds()});
}

void one_round(VerifyReport::Part& part, const proof::KnownTable& table, const ScoredRound& round,
               Table& found) {
  std::vector<proof::Answer> all;
  auto bone = proof::KnownBone::make(
      {.case_name = table.case_name, .voxel_mm = round.voxel_mm, .bone_number = round.bone},
      progress());
  if (!bone) {
    part.checks.push_back({part.name + "." + table.case_name, bone.error().text, 0, "", false});
    return;
  }
  const double voxel = bone->before().grid().voxel * 1e3;
  const std::string name = fmt::format("{}.{}mm.bone{}", table.case_name, voxel, round.bone);
  std::size_t bones = table.bones.size();
  if (round.most > 0) bones = std::min(bones, round.most);
  Worst worst;
  std::size_t checks = part.checks.size();
  for (std::size_t n = 0; n < bones && !interrupted(); ++n) {
    const auto answers = proof::ask(*bone, table.bones[n], progress());
    if (!answers) {
      part.checks.push_back({part.name + "." + name, answers.error().text, 0, "", false});
      continue;
    }
    for (const proof::Answer& answer : *answers) {
      judge(part, fmt::format("{}.{}.{}", name, n + 1, answer.item), answer);
      worst.see(answer);
      all.push_back(answer);
    }
  }
  checks = part.checks.size() - checks;
  found.rows.push_back(
      {table.case_name, fmt::format("{}", voxel), fmt::format("{}", round.bone),
       fmt::format("{}", bones), fmt::format("{}", checks), worst.item,
       fmt::format("{:.3g} of {:.3g} {}", worst.off, worst.tolerance, worst.unit)});
  // over the whole table every item is met by one bone and unmet by another; coarse voxels cannot judge all items
  if (bones == table.bones.size() && round.voxel_mm <= 0 && !interrupted())
    part.at_most(name + ".items-seen-from-one-side", 0,
                 static_cast<double>(proof::one_sided(bone->rubric(), table, all).size()), "");
}

void name_bones(VerifyReport::Part& part, const proof::KnownTable& table) {
  Table names{fmt::format("Known bones of {}.", table.case_name), {"number", "bone"}, {}};
  for (std::size_t n = 0; n < table.bones.size(); ++n)
    names.rows.push_back({fmt::format("{}", n + 1), table.bones[n].name});
  part.table(std::move(names));
  std::map<std::string, std::string> items;  // by the reason
  for (const proof::LeftOut& one : table.left_out)
    items[one.why] += (items[one.why].empty() ? "" : ", ") + one.item;
  for (const auto& [why, which] : items)
    part.cannot(fmt::format("{}: {}: {}", table.case_name, which, why));
}

void scores(const Verify& verify, VerifyReport::Part& part) {
  Table found{"What was found; the worst deviation is the largest of its tolerance.",
              {"case", "voxel [mm]", "--bone", "known bones", "checks", "worst item", "off by"},
              {}};
  for (const std::string& name : proof::known_cases()) {
    const auto table = proof::known_table(name);
    if (!table) {
      part.checks.push_back({part.name + "." + name, table.error().text, 0, "", false});
      continue;
    }
    name_bones(part, *table);
    for (const ScoredRound& round : rounds_of(*table, verify.quick)) {
      if (interrupted()) return;
      one_round(part, *table, round, found);
    }
    if (!verify.quick && rounds_of(*table, false).size() < 3)
      part.cannot(name + ": it has one bone only, so no other bones of `--bone`");
  }
  part.table(std::move(found));
}

const VerifyPart part{
    85, "scores", "Scores",
    "Does a score say what is so? The bones of the built-in cases are cut by shapes with formulas "
    "of "
    "their own, from which the right value or verdict of an item follows; the rubric of the case "
    "scores them without a recording. Two voxel sizes, and three bones of `--bone`.",
    scores};

}  // namespace
}  // namespace burr::app

#include "commands/case_new.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"
#include "burr/base/toml_text.h"
#include "burr/base/trimmed.h"
#include "burr/math/vec3.h"
#include "burr/scenario/recipe.h"
#include "burr/workshop/label_check.h"
#include "shared/counted.h"

namespace burr::app {
namespace {

constexpr double kSpread = 1.5;  // ranges that are proposed: measured value divided and multiplied

std::optional<std::pair<std::string, math::Vec3>> landmark_of(std::string_view answer) {
  const std::size_t equals = answer.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view name = base::trimmed(answer.substr(0, equals));
  std::string_view rest = answer.substr(equals + 1);
  math::Vec3 at;
  for (Eigen::Index n = 0; n < 3; ++n) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (n == 2)) return std::nullopt;
    const std::string_view number = base::trimmed(rest.substr(0, comma));
    const auto done = std::from_chars(number.data(), number.data() + number.size(), at[n]);
    if (done.ec != std::errc() || done.ptr != number.data() + number.size() ||
        !std::isfinite(at[n]) || std::abs(at[n]) >= 1e4)
      return std::nullopt;
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
  if (name.empty()) return std::nullopt;
  return std::pair{std::string(name), at};
}

std::string head_of(const std::string& source, const CaseAnswers& answers) {
  std::string text =
      "# A case of burr, begun by `burr case new`. docs/use/cases.md lists all fields.\n"
      "# Lines with MISSING are what only a person who knows this bone can say.\n"
      "format = 2\n";
  if (answers.title.empty()) text += "# MISSING: one line that says what is to be done\n";
  text += fmt::format("title = {}\n",
                      base::toml_text(answers.title.empty() ? "No title yet" : answers.title));
  if (scenario::is_phantom(source))
    text += fmt::format("phantom = {}\n", base::toml_text(scenario::phantom_name(source)));
  else
    text += fmt::format("volume = {}  # from the folder of this file\n", base::toml_text(source));
  return text +
         "# description = \"\"\"What the learner reads before the work begins.\"\"\"\n"
         "# approach = [[0, 1, 0]]  # directions from the bone to the surgeon, LPS\n\n"
         "# [work]\n# at_mm = [0, 0, 0]  # where the work begins: a point near the surface, LPS\n"
         "# into = [0, 0, -1]  # the way into the bone\n\n"
         "[burr]\ndiameter_mm = 4\nkind = \"cutting\"\nrpm = 40000\n";
}

std::string structure_of(const volume::Bone& bone, volume::TissueId id, bool spared) {
  const volume::Tissue& tissue = bone.tissues().tissues[id];
  const workshop::LabelFigures f = workshop::label_figures(bone, std::span(&id, 1));
  std::string text = fmt::format("\n[[structure]]\nname = {}\n", base::toml_text(tissue.name));
  if (spared)
    text += fmt::format("intact = \"{}\"\n",
                        tissue.kind == volume::TissueKind::solid ? "solid" : "soft");
  if (f.voxels == 0) return text + "# its label is empty in this volume\noptional = true\n";
  const double mm3 = 1e9 * f.volume, mm = 1e3 * f.inscribed;
  return text + fmt::format(
                    "# measured here: {} mm3, inscribed radius {:.2f} mm, {}, {:.1f} mm long. "
                    "Give the range that is sound:\n"
                    "# volume_mm3 = [{}, {}]\n# inscribed_mm = [{:.2f}, {:.2f}]\n",
                    workshop::figure(mm3, 4), mm,
                    counted(static_cast<std::size_t>(f.pieces), "piece"), 1e3 * f.length,
                    workshop::figure(mm3 / kSpread, 3), workshop::figure(mm3 * kSpread, 3),
                    mm / kSpread, mm * kSpread);
}

std::string landmarks_of(const CaseAnswers& answers) {
  std::string text = "\n# ---- places by name, LPS, mm\n";
  for (const std::string& answer : answers.landmarks)
    if (const auto one = landmark_of(answer))
      text += fmt::format("\n[[landmark]]\nname = {}\nat_mm = [{:g}, {:g}, {:g}]\n",
                          base::toml_text(one->first), one->second.x(), one->second.y(),
                          one->second.z());
  if (answers.landmarks.empty())
    text +=
        "# MISSING\n# [[landmark]]\n# name = \"entry\"\n# at_mm = [0, 0, 0]\n\n"
        "# [[region]]\n# name = \"way in\"\n"
        "# add = [{ shape = \"ball\", at = \"entry\", radius_mm = 5 }]\n";
  return text;
}

std::string steps_of(const CaseAnswers& answers) {
  std::string text = "\n# ---- steps, in their order\n";
  for (std::size_t n = 0; n < answers.steps.size(); ++n)
    text += fmt::format("\n[[step]]\nid = \"step-{}\"\nsay.en = {}\n", n + 1,
                        base::toml_text(answers.steps[n]));
  if (answers.steps.empty())
    text +=
        "# MISSING\n# [[step]]\n# id = \"open\"\n# title.en = \"Open the cortex\"\n"
        "# say.en = \"Open the cortex with long strokes.\"\n# region = \"way in\"\n"
        "# spare = []  # names of structures\n# tool = { kind = \"cutting\", diameter_mm = [4, 6] "
        "}\n# must_precede = []  # ids of steps\n";
  return text;
}

}  // namespace

Status check_label_names(const volume::TissueTable& table) {
  std::map<std::string_view, std::size_t> seen;
  for (std::size_t id = 1; id < table.tissues.size(); ++id) {
    const std::string& name = table.tissues[id].name;
    std::string fault;
    if (name.empty())
      fault = fmt::format("label {} has no name", id);
    else if (const auto [first, fresh] = seen.emplace(name, id); !fresh)
      fault = fmt::format("labels {} and {} are both called \"{}\"", first->second, id,
                          base::printable(name));
    if (!fault.empty())
      return error(Trouble::data,
                   fmt::format("{}, and a case tells labels apart by their names; rename it in the "
                               "program that drew it, or give names with --tissues",
                               fault));
  }
  return fine();
}

bool is_landmark(const std::string& answer) { return landmark_of(answer).has_value(); }

NewCase new_case(const volume::Bone& bone, const std::string& source, const CaseAnswers& answers) {
  NewCase made;
  made.text = head_of(source, answers);
  const auto& table = bone.tissues().tissues;
  const auto spared = [&](const volume::Tissue& tissue) {
    return std::find(answers.spare.begin(), answers.spare.end(), tissue.name) !=
           answers.spare.end();
  };
  made.text += "\n# ---- what must not be cut\n";
  for (std::size_t id = 1; id < table.size(); ++id)
    if (spared(table[id]))
      made.text += fmt::format("[[spare]]\ntissue = {}\n", base::toml_text(table[id].name));
    else if (answers.spare.empty() && table[id].spare)
      made.text += fmt::format("# [[spare]]\n# tissue = {}\n", base::toml_text(table[id].name));
  if (answers.spare.empty()) made.text += "# MISSING: take the # away from what must not be cut\n";
  made.text += "\n# ---- structures: how they stay intact, and what their labels must look like\n";
  for (std::size_t id = 1; id < table.size(); ++id)
    made.text += structure_of(bone, static_cast<volume::TissueId>(id), spared(table[id]));
  made.text += landmarks_of(answers) + steps_of(answers);
  if (answers.title.empty()) made.missing.emplace_back("a title");
  if (answers.spare.empty()) made.missing.emplace_back("which structures must not be cut");
  if (answers.landmarks.empty()) made.missing.emplace_back("landmarks and regions");
  if (answers.steps.empty()) made.missing.emplace_back("steps");
  made.missing.emplace_back("the ranges of volume and inscribed radius that are sound");
  return made;
}

}  // namespace burr::app

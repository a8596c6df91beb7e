#include "burr/workshop/label_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/phantom/phantoms.h"
#include "burr/scenario/open_lesson.h"

namespace burr::workshop {
namespace {

using math::Ijk;
using volume::TissueId;

constexpr double kSpeck = 0.01;  // pieces below this share of the voxels are not counted
constexpr float kFar = 1e9F;     // larger than any squared distance here  [voxel^2]

// The box around a structure with a margin of one voxel, and which of its voxels belong to it.
struct Part {
  Ijk first = Ijk::Zero(), size = Ijk::Zero();
  std::vector<std::uint8_t> in;
  std::size_t count = 0;

  [[nodiscard]] std::size_t at(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] Ijk ijk(std::size_t at) const {
    const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y());
    return {static_cast<int>(at % nx), static_cast<int>(at / nx % ny),
            static_cast<int>(at / nx / ny)};
  }
};

// Calls found(voxel) for every voxel of the tissues.
template <class Found>
void each_voxel(const volume::Bone& bone, const std::array<bool, 256>& wanted, Found&& found) {
  const auto& table = bone.tissues().tissues;
  for (volume::BrickIndex b = 0; b < bone.brick_count(); ++b) {
    const TissueId* tissue = bone.brick_tissue(b);
    if (tissue == nullptr) continue;
    const volume::Field* field = bone.brick_field(b);
    const Ijk first = bone.brick_ijk(b);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (!wanted[tissue[v]]) continue;
      if (table[tissue[v]].kind == volume::TissueKind::solid &&
          (field == nullptr || field[v] < volume::kIso))
        continue;
      const Ijk ijk = first + Ijk(v & 7, (v >> 3) & 7, v >> 6);
      if (bone.grid().contains(ijk)) found(ijk);
    }
  }
}

Part part_of(const volume::Bone& bone, const std::array<bool, 256>& wanted) {
  Part part;
  Ijk lo = Ijk::Constant(std::numeric_limits<int>::max()), hi = -lo;
  each_voxel(bone, wanted, [&](const Ijk& ijk) {
    lo = lo.cwiseMin(ijk);
    hi = hi.cwiseMax(ijk);
    ++part.count;
  });
  if (part.count == 0) return part;
  part.first = lo - Ijk::Ones();
  part.size = hi - lo + Ijk::Constant(3);
  part.in.resize(part.at(0, 0, part.size.z()));
  each_voxel(bone, wanted, [&](const Ijk& ijk) {
    const Ijk p = ijk - part.first;
    part.in[part.at(p.x(), p.y(), p.z())] = 1;
  });
  return part;
}

// Squared distances along one line: the lower envelope of parabolas (Felzenszwalb & Huttenlocher
// 2012).
class Line {
 public:
  void transform(std::vector<float>& values, std::size_t start, std::size_t step, int count) {
    const auto n = static_cast<std::size_t>(count);
    f_.resize(n);
    hull_.assign(n, 0);
    border_.assign(n + 1, 0);
    for (std::size_t q = 0; q < n; ++q) f_[q] = static_cast<double>(values[start + q * step]);
    std::size_t k = 0;
    border_[0] = -std::numeric_limits<double>::infinity();
    border_[1] = std::numeric_limits<double>::infinity();
    for (std::size_t q = 1; q < n; ++q) {
      double s = meeting(q, hull_[k]);
      while (s <= border_[k]) s = meeting(q, hull_[--k]);
      hull_[++k] = q;
      border_[k] = s;
      border_[k + 1] = std::numeric_limits<double>::infinity();
    }
    k = 0;
    for (std::size_t q = 0; q < n; ++q) {
      while (border_[k + 1] < static_cast<double>(q)) ++k;
      const double d = static_cast<double>(q) - static_cast<double>(hull_[k]);
      values[start + q * step] = static_cast<float>(d * d + f_[hull_[k]]);
    }
  }

 private:
  [[nodiscard]] double meeting(std::size_t q, std::size_t p) const {
    const auto a = static_cast<double>(q), b = static_cast<double>(p);
    return (f_[q] + a * a - f_[p] - b * b) / (2 * (a - b));
  }
  std::vector<double> f_, border_;
  std::vector<std::size_t> hull_;
};

// The largest distance from a voxel inside to the nearest one outside, centre to centre  [voxel]
double inscribed_of(const Part& part) {
  std::vector<float> squared(part.in.size());
  for (std::size_t v = 0; v < squared.size(); ++v) squared[v] = part.in[v] != 0 ? kFar : 0;
  Line line;
  const int nx = part.size.x(), ny = part.size.y(), nz = part.size.z();
  const std::size_t dy = part.at(0, 1, 0), dz = part.at(0, 0, 1);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j) line.transform(squared, part.at(0, j, k), 1, nx);
  for (int k = 0; k < nz; ++k)
    for (int i = 0; i < nx; ++i) line.transform(squared, part.at(i, 0, k), dy, ny);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) line.transform(squared, part.at(i, j, 0), dz, nz);
  return std::sqrt(static_cast<double>(*std::max_element(squared.begin(), squared.end())));
}

template <class Do>
void each_neighbour(const Part& part, std::size_t at, Do&& what) {
  const Ijk p = part.ijk(at);
  for (int dk = -1; dk <= 1; ++dk)
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const Ijk q = p + Ijk(di, dj, dk);
        if (q != p && (q.array() >= 0).all() && (q.array() < part.size.array()).all())
          what(part.at(q.x(), q.y(), q.z()));
      }
}

int pieces_of(const Part& part) {
  std::vector<std::uint8_t> left = part.in;
  std::vector<std::size_t> todo;
  int pieces = 0;
  for (std::size_t start = 0; start < left.size(); ++start) {
    if (left[start] == 0) continue;
    std::size_t size = 0;
    left[start] = 0;
    todo.push_back(start);
    while (!todo.empty()) {
      const std::size_t at = todo.back();
      todo.pop_back();
      ++size;
      each_neighbour(part, at, [&](std::size_t next) {
        if (left[next] == 0) return;
        left[next] = 0;
        todo.push_back(next);
      });
    }
    if (static_cast<double>(size) >= kSpeck * static_cast<double>(part.count)) ++pieces;
  }
  return pieces;
}

// The distance of two voxels that lie far apart: from any to the farthest, twice  [voxel]
double length_of(const Part& part) {
  std::size_t from = 0;
  while (part.in[from] == 0) ++from;
  double longest = 0;
  for (int round = 0; round < 3; ++round) {
    const Ijk start = part.ijk(from);
    longest = -1;
    for (std::size_t v = 0; v < part.in.size(); ++v) {
      if (part.in[v] == 0) continue;
      const double far2 = (part.ijk(v) - start).cast<double>().squaredNorm();
      if (far2 > longest) {
        longest = far2;
        from = v;
      }
    }
  }
  return std::sqrt(longest) + 1;
}

std::vector<TissueId> neighbours_of(const Part& part, const volume::Bone& bone,
                                    const std::array<bool, 256>& wanted) {
  std::array<bool, 256> seen{};
  for (std::size_t v = 0; v < part.in.size(); ++v) {
    if (part.in[v] == 0) continue;
    each_neighbour(part, v, [&](std::size_t next) {
      if (part.in[next] != 0) return;
      const Ijk ijk = part.first + part.ijk(next);
      if (bone.grid().contains(ijk)) seen[bone.tissue(ijk.x(), ijk.y(), ijk.z())] = true;
    });
  }
  std::vector<TissueId> found;
  for (std::size_t id = 1; id < seen.size(); ++id)
    if (seen[id] && !wanted[id]) found.push_back(static_cast<TissueId>(id));
  return found;
}

// "its volume is 998 mm3, expected 40 to 200 mm3"
void judge(const char* what, double value, const std::optional<scenario::Range>& range, double unit,
           const char* name, std::vector<std::string>& faults) {
  if (!range || (value >= range->first && value <= range->second)) return;
  faults.push_back(fmt::format("{} {}{}, expected {} to {}{}", what, figure(value / unit, 3), name,
                               figure(range->first / unit, 3), figure(range->second / unit, 3),
                               name));
}

bool meet(const std::vector<TissueId>& neighbours, const std::vector<TissueId>& others) {
  return std::any_of(others.begin(), others.end(), [&](TissueId id) {
    return std::binary_search(neighbours.begin(), neighbours.end(), id);
  });
}

void judge_all(const scenario::Structure& one, const scenario::CaseLesson& lesson,
               const volume::TissueTable& table, LabelFinding& finding) {
  const LabelFigures& f = finding.figures;
  std::vector<std::string>& faults = finding.faults;
  judge("its volume is", f.volume, one.volume, 1e-9, " mm3", faults);
  judge("its inscribed radius is", f.inscribed, one.inscribed, 1e-3, " mm", faults);
  judge("its pieces are", f.pieces, one.pieces, 1, "", faults);
  if (f.length < one.length)
    faults.push_back(fmt::format("it is {} mm long, expected at least {} mm",
                                 figure(1e3 * f.length, 3), figure(1e3 * one.length, 3)));
  for (const std::string& name : one.touches)
    if (const auto others = tissues_of(*lesson.structure(name), table);
        !others.empty() && !meet(f.neighbours, others))
      faults.push_back(fmt::format("it does not touch \"{}\", but must", base::printable(name)));
  for (const std::string& name : one.apart)
    if (meet(f.neighbours, tissues_of(*lesson.structure(name), table)))
      faults.push_back(fmt::format("it touches \"{}\", but must not", base::printable(name)));
}

}  // namespace

std::string figure(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  if (const double unit = std::pow(10, before - digits); unit > 1)
    value = std::round(value / unit) * unit;
  std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - before));
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

LabelFigures label_figures(const volume::Bone& bone, std::span<const TissueId> tissues) {
  std::array<bool, 256> wanted{};
  for (const TissueId id : tissues) wanted[id] = true;
  LabelFigures figures;
  const Part part = part_of(bone, wanted);
  figures.voxels = part.count;
  if (part.count == 0) return figures;
  const double voxel = bone.grid().voxel;
  figures.volume = static_cast<double>(part.count) * voxel * voxel * voxel;
  figures.inscribed = inscribed_of(part) * voxel;
  figures.pieces = pieces_of(part);
  figures.length = length_of(part) * voxel;
  figures.neighbours = neighbours_of(part, bone, wanted);
  return figures;
}

std::vector<TissueId> tissues_of(const scenario::Structure& structure,
                                 const volume::TissueTable& table) {
  std::vector<TissueId> found;
  for (std::size_t id = 1; id < table.tissues.size(); ++id)
    if (std::find(structure.names.begin(), structure.names.end(), table.tissues[id].name) !=
        structure.names.end())
      found.push_back(static_cast<TissueId>(id));
  return found;
}

Result<std::vector<LabelFinding>> check_labels(const scenario::CaseLesson& lesson,
                                               const volume::Bone& bone,
                                               const std::vector<std::string>& accepted,
                                               Progress& progress) {
  for (const std::string& name : accepted)
    if (lesson.structure(name) == nullptr)
      return error(Trouble::usage,
                   fmt::format("`accepted_labels` {}: the case has no such structure",
                               base::printable(name)));
  std::vector<LabelFinding> findings;
  for (const scenario::Structure& one : lesson.structures) {
    progress.report(
        static_cast<double>(findings.size()) / static_cast<double>(lesson.structures.size()),
        "looking at the labels");
    if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
    LabelFinding& finding = findings.emplace_back();
    finding.structure = one.name;
    finding.line = one.line;
    finding.accepted = std::find(accepted.begin(), accepted.end(), one.name) != accepted.end();
    const std::vector<TissueId> ids = tissues_of(one, bone.tissues());
    for (const TissueId id : ids) finding.tissues.push_back(bone.tissues().tissues[id].name);
    finding.figures = label_figures(bone, ids);
    if (finding.figures.voxels == 0) {
      if (!one.optional)
        finding.faults.emplace_back(ids.empty() ? "the bone has no such label"
                                                : "its label is empty");
      continue;
    }
    judge_all(one, lesson, bone.tissues(), finding);
  }
  progress.report(1, "looking at the labels");
  return findings;
}

Status as_expected(const std::vector<LabelFinding>& findings, const std::string& file) {
  std::size_t bad = 0;
  const LabelFinding* first = nullptr;
  for (const LabelFinding& one : findings)
    if (!one.faults.empty() && !one.accepted && bad++ == 0) first = &one;
  if (first == nullptr) return fine();
  return error(
      Trouble::data,
      fmt::format("{}: line {}: {} {} not as the case expects; \"{}\": {}; mend the label, give "
                  "the case another range, or accept it with `accepted_labels` \"{}\"",
                  file, first->line, bad, bad == 1 ? "label is" : "labels are",
                  base::printable(first->structure), first->faults.front(),
                  base::printable(first->structure)));
}

std::vector<scenario::Landmark> landmarks_of(const scenario::Case& work) {
  std::vector<scenario::Landmark> all;
  for (const phantom::Landmark& one : phantom::landmarks(work.phantom))
    all.push_back({one.name, {}, one.points, one.normal, 0});
  return all;
}

Result<scenario::CaseLesson> placed_lesson(const scenario::Case& work) {
  auto read = scenario::lesson_of(work);
  if (!read) return read.error();
  return scenario::place(std::move(*read), landmarks_of(work), work.name + ".toml");
}

}  // namespace burr::workshop

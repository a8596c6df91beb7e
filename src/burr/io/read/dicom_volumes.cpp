// Divides a series into volumes: by size and orientation, then as dicom_divide.h says; and says in a
// line what each of them is.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "burr/base/printable.h"
#include "burr/io/read/dicom_divide.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;

bool has(const std::string& text, const char* part) {
  return lower(text).find(part) != std::string::npos;
}

bool scout(const DicomHeader& h) {
  return has(h.image_type, "localizer") || has(h.description, "scout") ||
         has(h.description, "topogram") || has(h.description, "surview");
}

bool bone_kernel(const std::string& name) {
  const std::string kernel = lower(name);
  // Siemens B60..B80, H60..H70; GE BONE, EDGE; Canon FC30, FC81; Philips D, E, YA, YB
  return kernel.find("bone") != std::string::npos || kernel.find("edge") != std::string::npos ||
         kernel.rfind("b6", 0) == 0 || kernel.rfind("b7", 0) == 0 || kernel.rfind("h6", 0) == 0 ||
         kernel.rfind("h7", 0) == 0 || kernel.rfind("hr6", 0) == 0 || kernel.rfind("br6", 0) == 0 ||
         kernel.rfind("hr7", 0) == 0 || kernel.rfind("br7", 0) == 0 ||
         kernel.rfind("fc3", 0) == 0 || kernel.rfind("fc8", 0) == 0 || kernel == "ya" ||
         kernel == "yb" || kernel == "d" || kernel == "e";
}

bool bone_kernel(const Series& series, const Volume& volume) {
  const DicomHeader& h = series.files[volume.slices.front().file];
  return has(h.description, "bone") || has(h.description, "knochen") ||
         bone_kernel(frame_of(series, volume.slices.front()).phase.kernel);
}

// ---- energies of a spectral scan

// 0: it states none.
double energy_of(const std::vector<Series>& all, const Volume& volume) {
  return std::max(0.0, frame_of(all[volume.series], volume.slices.front()).phase.energy_kev);
}

// Values that are amounts of a material, or its atomic number (PS3.3 C.11.1.1.2).
bool is_map(const DicomHeader& h) {
  constexpr const char* kMaps[] = {"MGML", "Z_EFF", "ED", "EDW", "PCT"};
  return std::any_of(std::begin(kMaps), std::end(kMaps),
                     [&](const char* one) { return h.rescale_type == one; });
}

// The energies of the volumes that are about as long as this one, ascending.
std::vector<double> energies_like(const std::vector<Series>& all,
                                  const std::vector<Volume>& volumes, const Volume& one) {
  std::set<double> found;
  for (const Volume& volume : volumes)
    if (const double kev = energy_of(all, volume);
        kev > 0 && 2 * volume.slices.size() >= one.slices.size())
      found.insert(kev);
  return {found.begin(), found.end()};
}

// Of these the one at which bone looks as in a usual CT of 120 kV.
double usual_energy(const std::vector<double>& energies) {
  constexpr double kUsual = 70;  // [keV]
  return *std::min_element(energies.begin(), energies.end(), [](double a, double b) {
    return std::abs(a - kUsual) < std::abs(b - kUsual);
  });
}

// "40, 70 and 100 keV"
std::string energies_text(const std::vector<double>& energies) {
  std::string list;
  for (std::size_t n = 0; n < energies.size(); ++n)
    list += fmt::format("{}{:g}",
                        n == 0                     ? ""
                        : n + 1 == energies.size() ? " and "
                                                   : ", ",
                        energies[n]);
  return list + " keV";
}

// ---- size and orientation, and the order of slices

std::vector<Slices> kinds_of(const Series& series) {
  struct Kind {
    int rows, columns;
    const DicomFrame* first;
    Slices slices;
  };
  std::vector<Kind> kinds;
  for (std::size_t f = 0; f < series.files.size(); ++f) {
    const DicomHeader& h = series.files[f];
    for (int n = 0; n < h.frame_count; ++n) {
      const DicomFrame& frame = h.frames[static_cast<std::size_t>(n)];
      const auto fits = [&](const Kind& k) {
        return k.rows == h.rows && k.columns == h.columns &&
               (k.first->row - frame.row).norm() < 2e-3 &&
               (k.first->column - frame.column).norm() < 2e-3 &&
               std::abs(k.first->row_gap_mm - frame.row_gap_mm) < 1e-3 * k.first->row_gap_mm &&
               std::abs(k.first->column_gap_mm - frame.column_gap_mm) <
                   1e-3 * k.first->column_gap_mm;
      };
      auto kind = std::find_if(kinds.begin(), kinds.end(), fits);
      if (kind == kinds.end()) kind = kinds.insert(kinds.end(), {h.rows, h.columns, &frame, {}});
      kind->slices.push_back({f, n, 0});
    }
  }
  std::vector<Slices> out;
  for (Kind& kind : kinds) out.push_back(std::move(kind.slices));
  return out;
}

// Sets where each slice lies along the normal. False: all lie at one place.
bool set_places(const Series& series, Slices& slices, Order& order) {
  const DicomFrame& first = frame_of(series, slices.front());
  const Vec3 normal = first.row.cross(first.column);
  const auto all = [&](auto holds) {
    return std::all_of(slices.begin(), slices.end(),
                       [&](const Slice& s) { return holds(frame_of(series, s)); });
  };
  const auto set = [&](Order by, auto value) {
    order = by;
    double low = 1e300, high = -1e300;
    for (Slice& s : slices) {
      s.along_mm = value(s);
      low = std::min(low, s.along_mm);
      high = std::max(high, s.along_mm);
    }
    return slices.size() == 1 || high - low > kSameSlicePlace;
  };
  const bool placed = all([](const DicomFrame& f) { return f.has_position; });
  if (placed && set(Order::positions,
                    [&](const Slice& s) { return normal.dot(frame_of(series, s).position_mm); }))
    return true;
  if (all([](const DicomFrame& f) { return f.has_location; }) &&
      set(Order::locations, [&](const Slice& s) { return frame_of(series, s).location_mm; }))
    return true;
  const DicomHeader& file = series.files[slices.front().file];
  const bool stated_once =
      file.own_positions == 0 && std::all_of(slices.begin(), slices.end(), [&](const Slice& s) {
        return s.file == slices.front().file;
      });
  if (placed && !stated_once) {
    order = Order::positions;
    return false;
  }
  return set(Order::numbers, [&](const Slice& s) {
    const DicomHeader& h = series.files[s.file];
    return (h.frame_count > 1 ? 1e6 : 1.0) * h.instance + s.frame;
  });
}

// Takes out files that are there twice.
std::size_t drop_copies(const Series& series, Slices& slices) {
  std::set<std::string> names;
  for (const DicomHeader& h : series.files) names.insert(h.sop_instance);
  if (names.size() == series.files.size() || names.size() < 2) return 0;
  std::set<std::tuple<std::string, int, int, long, std::uint64_t, double, int>> seen;
  const std::size_t before = slices.size();
  slices.erase(std::remove_if(slices.begin(), slices.end(),
                              [&](const Slice& s) {
                                const DicomHeader& h = series.files[s.file];
                                const DicomPhase& p = frame_of(series, s).phase;
                                return !h.sop_instance.empty() &&
                                       !seen.insert({h.sop_instance, s.frame, h.instance,
                                                     std::lround(s.along_mm / kSameSlicePlace),
                                                     h.pixels_length, p.time_s, p.acquisition})
                                            .second;
                              }),
               slices.end());
  return before - slices.size();
}

double gap_of(const Volume& volume) {
  if (volume.slices.size() < 2 || volume.order == Order::numbers || volume.mixed) return 0;
  std::vector<double> gaps;
  for (std::size_t n = 1; n < volume.slices.size(); ++n)
    gaps.push_back(volume.slices[n].along_mm - volume.slices[n - 1].along_mm);
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2),
                   gaps.end());
  return gaps[gaps.size() / 2];
}

const char* plane_of(const DicomFrame& frame) {
  if (!frame.has_orientation) return "";
  const Vec3 normal = frame.row.cross(frame.column).cwiseAbs();
  constexpr double kStraight = 0.9;  // up to 25 degrees; gantries tilt that far
  return normal.z() > kStraight   ? ", axial"
         : normal.y() > kStraight ? ", coronal"
         : normal.x() > kStraight ? ", sagittal"
                                  : ", oblique";
}

// The volume that a surgeon would mean has the highest value: CT, a stack and no scout, thin
// slices, many of them, a bone kernel.
double worth(const Series& series, const Volume& volume) {
  const DicomHeader& h = series.files[volume.slices.front().file];
  const auto count = static_cast<double>(volume.slices.size());
  const double thickness = thickness_mm(series, volume.slices.front());
  double sum = 0;
  if (h.modality == "CT") sum += 100;
  if (count >= 4) sum += 60;
  if (scout(h) || has(h.image_type, "secondary") || has(h.image_type, "screen")) sum -= 80;
  if (is_map(h)) sum -= 80;
  sum += 12 * std::log2(count + 1);
  sum -= 12 * std::log2(std::clamp(thickness > 0 ? thickness : 5.0, 0.05, 20.0));
  if (bone_kernel(series, volume)) sum += 10;
  return sum;
}

// Of the volumes of one series: the most slices, then the bone kernel, then the first.
bool better(const Series& series, const Volume& a, const Volume& b) {
  if (a.mixed != b.mixed) return b.mixed;
  if (a.slices.size() != b.slices.size()) return a.slices.size() > b.slices.size();
  return bone_kernel(series, a) && !bone_kernel(series, b);
}

}  // namespace

std::vector<Volume> volumes_of(const std::vector<Series>& all) {
  std::vector<Volume> out;
  for (std::size_t index = 0; index < all.size(); ++index) {
    const Series& series = all[index];
    std::vector<Slices> kinds = kinds_of(series);
    // a few pictures of another kind, as scouts, are no volume
    constexpr std::size_t kFew = 4;
    std::size_t few = 0, pictures = 0;
    for (const Slices& kind : kinds) {
      pictures += kind.size();
      if (kind.size() < kFew) few += kind.size();
    }
    const bool leave = few > 0 && few < pictures && 5 * few <= pictures;
    for (Slices& kind : kinds) {
      if (leave && kind.size() < kFew) continue;
      Volume frame;
      frame.series = index;
      frame.left_out = leave ? few : 0;
      if (!set_places(series, kind, frame.order)) {
        frame.no_stack = true;
        frame.slices = std::move(kind);
        out.push_back(std::move(frame));
        continue;
      }
      frame.copies = drop_copies(series, kind);
      for (SliceGroup& group :
           divide_slices(series, std::move(kind), frame.order != Order::numbers)) {
        Volume volume = frame;
        volume.slices = std::move(group.slices);
        volume.part = std::move(group.part);
        volume.mixed = group.mixed;
        volume.same_place = group.same_place;
        out.push_back(std::move(volume));
      }
    }
  }
  return out;
}

double thickness_mm(const Series& series, const Slice& slice) {
  const DicomHeader& h = series.files[slice.file];
  if (h.between_slices_mm > 0) return h.between_slices_mm;
  return frame_of(series, slice).thickness_mm;
}

std::string one_line(const Series& series, const Volume& volume, std::size_t place) {
  const Slice& slice = volume.slices.front();
  const DicomHeader& h = series.files[slice.file];
  const DicomFrame& frame = frame_of(series, slice);
  const double gap = gap_of(volume) > 0 ? gap_of(volume) : thickness_mm(series, slice);
  std::string kernel = frame.phase.kernel.substr(0, frame.phase.kernel.find('\\'));
  if (!kernel.empty()) kernel = ", kernel " + base::printable(trimmed(kernel), 16);
  const double kev = frame.phase.energy_kev;
  return fmt::format("#{}: {} {} pictures {} x {}, {}{}{}{}{}{}{}", place + 1,
                     h.modality.empty() ? "unknown kind," : base::printable(h.modality, 16) + ",",
                     volume.slices.size(), h.columns, h.rows,
                     gap > 0 ? fmt::format("{:.3g} mm", gap) : std::string("thickness unknown"),
                     plane_of(frame), kev > 0 ? fmt::format(", {:g} keV", kev) : "", kernel,
                     volume.part.empty() ? "" : ", " + volume.part, scout(h) ? ", scout" : "",
                     bone_kernel(series, volume) ? ", bone kernel" : "");
}

namespace {

// Of each series the best of those volumes that count, and of these the best; volumes.size(): none.
template <class Counts>
std::size_t best_of(const std::vector<Series>& all, const std::vector<Volume>& volumes,
                    Counts counts) {
  std::map<std::size_t, std::size_t> best;
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    if (!counts(volumes[v])) continue;
    const auto [now, fresh] = best.try_emplace(volumes[v].series, v);
    if (!fresh && better(all[volumes[v].series], volumes[v], volumes[now->second])) now->second = v;
  }
  std::size_t most = volumes.size();
  for (const auto& [series, v] : best)
    if (most == volumes.size() ||
        worth(all[series], volumes[v]) > worth(all[volumes[most].series], volumes[most]))
      most = v;
  return most;
}

std::string list_of(const std::vector<Series>& all, const std::vector<Volume>& volumes) {
  constexpr std::size_t kNamed = 64;  // in a sentence
  std::string list;
  for (std::size_t v = 0; v < std::min(volumes.size(), kNamed); ++v)
    list += (v > 0 ? "; " : "") + one_line(all[volumes[v].series], volumes[v], v);
  if (volumes.size() > kNamed) list += fmt::format("; and {} more", volumes.size() - kNamed);
  return list;
}

// The whole text is the name of an energy, as "70 keV" or "70kev"; 0: it is not.
double named_energy(std::string_view text) {
  const std::string small = lower(trimmed(text));
  if (!small.ends_with("kev")) return 0;
  double value = 0;
  return to_number(small.substr(0, small.size() - 3), value) && value > 0 ? value : 0;
}

// The volume that the options name.
Result<std::size_t> named_volume(const std::vector<Series>& all, const std::vector<Volume>& volumes,
                                 const std::string& name, const std::string& file) {
  if (const double kev = named_energy(name); kev > 0) {
    constexpr double kSame = 0.5;  // [keV]
    const std::size_t best = best_of(
        all, volumes, [&](const Volume& v) { return std::abs(energy_of(all, v) - kev) < kSame; });
    if (best < volumes.size()) return best;
    return error(Trouble::usage,
                 fmt::format("{}: no volume is of {:g} keV (`series`); there are {}", file, kev,
                             list_of(all, volumes)));
  }
  const std::size_t mark = std::min(name.find('#'), name.size());
  const std::string uid = name.substr(0, mark);
  std::int64_t place = 0;
  const bool numbered = mark < name.size();
  const bool good = !numbered || (to_number(name.substr(mark + 1), place) && place >= 1);
  std::set<std::size_t> fits;
  std::vector<std::size_t> members;
  for (std::size_t v = 0; v < volumes.size(); ++v)
    if (all[volumes[v].series].uid.rfind(uid, 0) == 0) {
      fits.insert(volumes[v].series);
      members.push_back(v);
    }
  if (good && numbered && (uid.empty() || fits.size() == 1) &&
      place <= static_cast<std::int64_t>(members.size()))
    return members[static_cast<std::size_t>(place - 1)];
  if (good && !numbered && fits.size() == 1)
    return best_of(all, volumes, [&](const Volume& v) { return v.series == *fits.begin(); });
  return error(Trouble::usage,
               fmt::format("{}: {} series match `series` \"{}\"; there are {}", file,
                           numbered ? 0 : fits.size(), name, list_of(all, volumes)));
}

}  // namespace

Result<std::size_t> choose(const Found& found, const std::vector<Volume>& volumes,
                           const ReadOptions& options, const std::string& file, Scan& scan) {
  const std::vector<Series>& all = found.series;
  if (!options.series.empty()) return named_volume(all, volumes, options.series, file);
  std::size_t best = best_of(all, volumes, [](const Volume&) { return true; });
  std::vector<double> energies;
  if (energy_of(all, volumes[best]) > 0) energies = energies_like(all, volumes, volumes[best]);
  if (energies.size() > 1) {
    const double usual = usual_energy(energies);
    const std::size_t length = volumes[best].slices.size();
    best = best_of(all, volumes, [&](const Volume& v) {
      return energy_of(all, v) == usual && 2 * v.slices.size() >= length;
    });
  }
  const std::string list = list_of(all, volumes);
  if (volumes.size() > all.size())
    scan.notices.push_back(fmt::format(
        "{} volumes found in {} series ({}); #{} was taken (of one series: the most slices, then "
        "the bone kernel), choose with `series`.",
        volumes.size(), all.size(), list, best + 1));
  else if (volumes.size() > 1)
    scan.notices.push_back(
        fmt::format("{} series found ({}); #{} is used, choose another with `series`.", all.size(),
                    list, best + 1));
  if (energies.size() > 1)
    scan.notices.push_back(fmt::format(
        "The scan was computed for {}: {:g} keV was taken; choose another by its name "
        "with `series`, as \"{:g} keV\".",
        energies_text(energies), energy_of(all, volumes[best]),
        energies.front() == energy_of(all, volumes[best]) ? energies.back() : energies.front()));
  return best;
}

}  // namespace burr::io

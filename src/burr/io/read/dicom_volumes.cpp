// Divides a series into volumes. What shares a series but not a volume is told apart by what the
// files state: size and orientation, kernel, energy, phase, acquisition, time; then blocks of slices
// that lie far from each other. Slices of two phases are never mixed.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "burr/base/printable.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

using math::Vec3;
using Slices = std::vector<Slice>;

constexpr double kSamePlace = 1e-3;  // [mm]

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

// ---- what may tell two volumes apart

struct Key {
  double number = 0;
  std::string text;
  bool operator==(const Key&) const = default;
  bool operator<(const Key& other) const {  // not every library of today can compare strings by <=>
    return std::tie(number, text) < std::tie(other.number, other.text);
  }
};

enum class Fact { kernel, kvp, stack, temporal, cardiac, trigger, acquisition, echo, type, time };
constexpr Fact kFacts[] = {Fact::kernel,  Fact::kvp,     Fact::stack,       Fact::temporal,
                           Fact::cardiac, Fact::trigger, Fact::acquisition, Fact::echo,
                           Fact::type,    Fact::time};
constexpr std::size_t kIndices = 8;  // of Dimension Index Values

Key key_of(const DicomPhase& p, Fact fact) {
  switch (fact) {
    case Fact::kernel:
      return {0, p.kernel};
    case Fact::kvp:
      return {p.kvp, ""};
    case Fact::stack:
      return {0, p.stack};
    case Fact::temporal:
      return {static_cast<double>(p.temporal), ""};
    case Fact::cardiac:
      return {p.cardiac_percent, ""};
    case Fact::trigger:
      return {p.trigger_ms, ""};
    case Fact::acquisition:
      return {static_cast<double>(p.acquisition), ""};
    case Fact::echo:
      return {p.echo_ms, ""};
    case Fact::type:
      return {0, p.type};
    case Fact::time:
      return {p.time_s, ""};
  }
  return {};
}

// What a surgeon calls it.
std::string part_name(Fact fact, const Key& key, std::size_t index, std::size_t count) {
  const std::string place = fmt::format("{} of {}", index + 1, count);
  switch (fact) {
    case Fact::kernel:
      return {};  // the list names the kernel of every volume
    case Fact::kvp:
      return fmt::format("{:g} kV", key.number);
    case Fact::stack:
      return "stack " + place;
    case Fact::cardiac:
      return fmt::format("{:g} % of the heartbeat", key.number);
    case Fact::trigger:
      return fmt::format("phase {} ({:g} ms after the trigger)", place, key.number);
    case Fact::acquisition:
      return fmt::format("phase {} (acquisition {:g})", place, key.number);
    case Fact::echo:
      return "echo " + place;
    case Fact::type:
      return "set " + place;
    case Fact::temporal:
    case Fact::time:
      break;
  }
  return "phase " + place;
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + ", " + b;
}

struct Group {
  Slices slices;
  std::string part;
  bool mixed = false;
  std::size_t same_place = 0;
};

// Divides the slices of one size and orientation.
class Divider {
 public:
  explicit Divider(const Series& series) : series_(series) {}

  std::vector<Group> divide(Slices slices, bool ordered_by_place) {
    std::vector<Group> out;
    divide(std::move(slices), "", 0, out);
    if (ordered_by_place) out = blocks(std::move(out));
    return out;
  }

 private:
  using Parts = std::vector<std::pair<Key, Slices>>;

  [[nodiscard]] const DicomPhase& phase(const Slice& s) const { return frame_of(series_, s).phase; }

  static void sort(Slices& slices) {
    std::stable_sort(slices.begin(), slices.end(),
                     [](const Slice& a, const Slice& b) { return a.along_mm < b.along_mm; });
  }
  // of sorted slices
  static std::size_t places(const Slices& slices) {
    std::size_t n = slices.empty() ? 0 : 1;
    double last = slices.empty() ? 0 : slices.front().along_mm;
    for (const Slice& s : slices)
      if (s.along_mm - last > kSamePlace) {
        ++n;
        last = s.along_mm;
      }
    return n;
  }
  // how many slices lie at the fullest place
  static std::size_t deepest(const Slices& slices) {
    std::size_t most = 0, here = 0;
    double last = -1e300;
    for (const Slice& s : slices) {
      if (s.along_mm - last > kSamePlace) {
        here = 0;
        last = s.along_mm;
      }
      most = std::max(most, ++here);
    }
    return most;
  }

  template <class KeyOf>
  static Parts parts_by(const Slices& slices, KeyOf key) {
    std::map<Key, Slices> by;
    for (const Slice& s : slices) by[key(s)].push_back(s);
    return {std::make_move_iterator(by.begin()), std::make_move_iterator(by.end())};
  }
  static std::size_t doubled(const Parts& parts) {
    std::size_t n = 0;
    for (const auto& [key, slices] : parts) n += slices.size() - places(slices);
    return n;
  }
  static std::size_t largest(const Parts& parts) {
    std::size_t n = 0;
    for (const auto& part : parts) n = std::max(n, part.second.size());
    return n;
  }

  // Consecutive parts of one long scan: they share a slice or two where they meet.
  static bool meet_at_their_ends(const Slices& all, const Parts& parts) {
    constexpr double kOwn = 0.7;  // share of its places that a part has for itself
    std::map<long, int> users;    // of a place
    const auto place = [](const Slice& s) { return std::lround(s.along_mm / (10 * kSamePlace)); };
    for (const auto& part : parts) {
      std::set<long> own;
      for (const Slice& s : part.second) own.insert(place(s));
      for (const long at : own) ++users[at];
    }
    const std::size_t most = largest(parts);
    if (most == all.size()) return false;
    for (const auto& part : parts) {
      std::size_t own = 0;
      for (const Slice& s : part.second) own += users[place(s)] == 1 ? 1U : 0U;
      if (static_cast<double>(own) < kOwn * static_cast<double>(part.second.size())) return false;
    }
    return true;
  }

  void divide(Slices slices, const std::string& part, int depth, std::vector<Group>& out) {
    sort(slices);
    const std::size_t there = places(slices), twice = slices.size() - there;
    constexpr int kDeepest = 4;
    if (depth < kDeepest && there > 1) {
      if (twice > 0 ? by_fact(slices, part, depth, out) || by_order(slices, part, out)
                    : by_overlap(slices, part, depth, out))
        return;
    }
    Group group{std::move(slices), part, false, twice};
    // a slice or two may be there twice; more is two volumes that nothing tells apart
    group.mixed = twice > std::max<std::size_t>(2, there / 20);
    if (!group.mixed) keep_one_of_each(group.slices);
    out.push_back(std::move(group));
  }

  void keep_one_of_each(Slices& slices) const {
    std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
      if (std::abs(a.along_mm - b.along_mm) > 0.1 * kSamePlace) return a.along_mm < b.along_mm;
      return series_.files[a.file].instance < series_.files[b.file].instance;
    });
    slices.erase(std::unique(slices.begin(), slices.end(),
                             [](const Slice& a, const Slice& b) {
                               return std::abs(a.along_mm - b.along_mm) < kSamePlace;
                             }),
                 slices.end());
  }

  void take(Parts parts, Fact fact, const std::string& part, int depth, std::vector<Group>& out) {
    for (std::size_t n = 0; n < parts.size(); ++n)
      divide(std::move(parts[n].second),
             joined(part, part_name(fact, parts[n].first, n, parts.size())), depth + 1, out);
  }

  // By the fact that leaves the fewest places with two slices.
  bool by_fact(const Slices& slices, const std::string& part, int depth, std::vector<Group>& out) {
    const std::size_t there = places(slices), twice = slices.size() - there,
                      most = 2 * deepest(slices);
    Parts best;
    Fact best_fact = Fact::time;
    std::size_t least = twice;
    const auto offer = [&](Fact fact, Parts parts) {
      if (parts.size() < 2 || parts.size() > most) return;
      if (static_cast<double>(largest(parts)) < 0.4 * static_cast<double>(there)) return;
      const std::size_t left = doubled(parts);
      if (left >= least) return;
      least = left;
      best = std::move(parts);
      best_fact = fact;
    };
    for (const Fact fact : kFacts)
      offer(fact, parts_by(slices, [&](const Slice& s) { return key_of(phase(s), fact); }));
    for (std::size_t n = 0; n < kIndices && least > 0; ++n)
      offer(Fact::temporal, parts_by(slices, [&](const Slice& s) {
              const auto& index = phase(s).index;
              return Key{n < index.size() ? static_cast<double>(index[n]) : -1.0, ""};
            }));
    if (best.empty()) return false;
    if (meet_at_their_ends(slices, best)) {
      Group group{slices, part, false, twice};
      keep_one_of_each(group.slices);
      out.push_back(std::move(group));
      return true;
    }
    take(std::move(best), best_fact, part, depth, out);
    return true;
  }

  // By an order in which the volumes follow each other, or change from slice to slice.
  bool by_order(const Slices& slices, const std::string& part, std::vector<Group>& out) {
    const auto number = [&](const Slice& s) {
      return 1e6 * series_.files[s.file].instance + s.frame;
    };
    const auto time = [&](const Slice& s) { return phase(s).time_s; };
    const auto trigger = [&](const Slice& s) { return phase(s).trigger_ms; };
    return follow(slices, time, part, out) || follow(slices, trigger, part, out) ||
           follow(slices, number, part, out) || change(slices, trigger, part, out) ||
           change(slices, time, part, out) || change(slices, number, part, out);
  }

  template <class Value>
  [[nodiscard]] static bool stated(const Slices& slices, Value value) {
    return std::all_of(slices.begin(), slices.end(),
                       [&](const Slice& s) { return value(s) > DicomPhase::kUnknown; });
  }

  void put(std::vector<Slices> runs, const std::string& part, std::vector<Group>& out) const {
    for (std::size_t n = 0; n < runs.size(); ++n) {
      sort(runs[n]);
      out.push_back({std::move(runs[n]),
                     joined(part, fmt::format("phase {} of {}", n + 1, runs.size())), false, 0});
    }
  }

  template <class Value>
  bool follow(const Slices& slices, Value value, const std::string& part,
              std::vector<Group>& out) const {
    if (!stated(slices, value)) return false;
    const auto place = [](const Slice& s) { return std::lround(s.along_mm / kSamePlace); };
    Slices sorted = slices;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Slice& a, const Slice& b) { return value(a) < value(b); });
    std::vector<Slices> runs(1);
    std::set<long> here;
    double last = -1e300;
    for (const Slice& s : sorted) {
      const double now = value(s);
      if (here.count(place(s)) != 0) {
        if (now == last) return false;  // the order of these two is not known
        runs.emplace_back();
        here.clear();
      }
      here.insert(place(s));
      runs.back().push_back(s);
      last = now;
    }
    const std::size_t there = places(slices);
    const bool few = runs.size() <= 2 * deepest(slices);
    const bool whole = std::all_of(runs.begin(), runs.end(),
                                   [&](const Slices& run) { return 2 * run.size() >= there; });
    if (!few || !whole) return false;
    put(std::move(runs), part, out);
    return true;
  }

  template <class Value>
  bool change(const Slices& slices, Value value, const std::string& part,
              std::vector<Group>& out) const {
    if (!stated(slices, value)) return false;
    const std::size_t depth = deepest(slices);
    if (depth * places(slices) != slices.size()) return false;
    std::vector<Slices> runs(depth);
    for (std::size_t at = 0; at < slices.size(); at += depth) {
      Slices here(slices.begin() + static_cast<std::ptrdiff_t>(at),
                  slices.begin() + static_cast<std::ptrdiff_t>(at + depth));
      std::stable_sort(here.begin(), here.end(),
                       [&](const Slice& a, const Slice& b) { return value(a) < value(b); });
      for (std::size_t n = 0; n < depth; ++n) {
        if (n > 0 && !(value(here[n]) > value(here[n - 1]))) return false;
        runs[n].push_back(here[n]);
      }
    }
    put(std::move(runs), part, out);
    return true;
  }

  static double usual_gap(const Slices& sorted) {
    std::vector<double> gaps;
    for (std::size_t n = 1; n < sorted.size(); ++n)
      gaps.push_back(sorted[n].along_mm - sorted[n - 1].along_mm);
    if (gaps.empty()) return 0;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2),
                     gaps.end());
    return gaps[gaps.size() / 2];
  }

  // No place has two slices, yet two phases may lie between each other's slices.
  bool by_overlap(const Slices& slices, const std::string& part, int depth,
                  std::vector<Group>& out) {
    constexpr std::size_t kLeast = 4, kMost = 16;
    if (slices.size() < 2 * kLeast) return false;
    for (const Fact fact :
         {Fact::kernel, Fact::kvp, Fact::temporal, Fact::cardiac, Fact::acquisition}) {
      Parts parts = parts_by(slices, [&](const Slice& s) { return key_of(phase(s), fact); });
      if (parts.size() < 2 || parts.size() > kMost) continue;
      if (std::any_of(parts.begin(), parts.end(),
                      [](const auto& p) { return p.second.size() < kLeast; }))
        continue;
      if (!interleaved(parts)) continue;
      if (fact == Fact::acquisition && fill_each_other(slices, parts)) continue;
      take(std::move(parts), fact, part, depth, out);
      return true;
    }
    return false;
  }
  static bool interleaved(const Parts& parts) {
    for (const auto& a : parts)
      for (const auto& b : parts) {
        if (&a == &b) continue;
        const double lo = b.second.front().along_mm, hi = b.second.back().along_mm;
        const auto inside = std::count_if(a.second.begin(), a.second.end(), [&](const Slice& s) {
          return s.along_mm > lo && s.along_mm < hi;
        });
        if (2 * inside >= static_cast<std::ptrdiff_t>(a.second.size())) return true;
      }
    return false;
  }
  // Each takes the slices that the other one leaves out, as some scanners do in two passes.
  [[nodiscard]] bool fill_each_other(const Slices& all, const Parts& parts) const {
    const double thickness = frame_of(series_, all.front()).thickness_mm,
                 own = usual_gap(parts.front().second);
    if (thickness > 0) return own > 1.2 * thickness;
    const double gap = usual_gap(all);
    for (std::size_t n = 1; n < all.size(); ++n)
      if (std::abs(all[n].along_mm - all[n - 1].along_mm - gap) > 0.2 * gap) return false;
    return true;
  }

  // Slices far from each other are two scans, not one with a hole.
  static std::vector<Group> blocks(std::vector<Group> groups) {
    std::vector<Group> out;
    for (Group& group : groups) {
      const double gap = usual_gap(group.slices);
      std::vector<Slices> parts(1);
      for (const Slice& s : group.slices) {
        if (!parts.back().empty()) {
          const double step = s.along_mm - parts.back().back().along_mm;
          if (gap > kSamePlace && (step > 25 * gap || (step > 30 && step > 3 * gap)))
            parts.emplace_back();
        }
        parts.back().push_back(s);
      }
      if (group.mixed || parts.size() == 1) {
        out.push_back(std::move(group));
        continue;
      }
      for (std::size_t n = 0; n < parts.size(); ++n) {
        const double length = parts[n].back().along_mm - parts[n].front().along_mm + gap;
        out.push_back({std::move(parts[n]),
                       joined(group.part, fmt::format("block {} of {}, {:.3g} mm long", n + 1,
                                                      parts.size(), length)),
                       false, n == 0 ? group.same_place : 0});
      }
    }
    return out;
  }

  const Series& series_;
};

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
    return slices.size() == 1 || high - low > kSamePlace;
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
                                                     std::lround(s.along_mm / kSamePlace),
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
      for (Group& group : Divider(series).divide(std::move(kind), frame.order != Order::numbers)) {
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
  return fmt::format("#{}: {} {} pictures {} x {}, {}{}{}{}{}{}", place + 1,
                     h.modality.empty() ? "unknown kind," : base::printable(h.modality, 16) + ",",
                     volume.slices.size(), h.columns, h.rows,
                     gap > 0 ? fmt::format("{:.3g} mm", gap) : std::string("thickness unknown"),
                     plane_of(frame), kernel, volume.part.empty() ? "" : ", " + volume.part,
                     scout(h) ? ", scout" : "", bone_kernel(series, volume) ? ", bone kernel" : "");
}

Result<std::size_t> choose(const Found& found, const std::vector<Volume>& volumes,
                           const ReadOptions& options, const std::string& file, Scan& scan) {
  const std::vector<Series>& all = found.series;
  constexpr std::size_t kNamed = 64;  // in a sentence
  std::string list;
  for (std::size_t v = 0; v < std::min(volumes.size(), kNamed); ++v)
    list += (v > 0 ? "; " : "") + one_line(all[volumes[v].series], volumes[v], v);
  if (volumes.size() > kNamed) list += fmt::format("; and {} more", volumes.size() - kNamed);
  // of each series its best volume, and of these the best
  const auto best_of = [&](auto counts) {
    std::map<std::size_t, std::size_t> best;
    for (std::size_t v = 0; v < volumes.size(); ++v) {
      const auto [now, fresh] = best.try_emplace(volumes[v].series, v);
      if (!fresh && better(all[volumes[v].series], volumes[v], volumes[now->second]))
        now->second = v;
    }
    std::size_t most = volumes.size();
    for (const auto& [series, v] : best)
      if (counts(volumes[v]) &&
          (most == volumes.size() ||
           worth(all[series], volumes[v]) > worth(all[volumes[most].series], volumes[most])))
        most = v;
    return most;
  };
  if (!options.series.empty()) {
    const std::size_t mark = std::min(options.series.find('#'), options.series.size());
    const std::string uid = options.series.substr(0, mark);
    std::int64_t place = 0;
    const bool numbered = mark < options.series.size();
    const bool good =
        !numbered || (to_number(options.series.substr(mark + 1), place) && place >= 1);
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
      return best_of([&](const Volume& v) { return v.series == *fits.begin(); });
    return error(Trouble::usage,
                 fmt::format("{}: {} series match --series \"{}\"; there are {}", file,
                             numbered ? 0 : fits.size(), options.series, list));
  }
  const std::size_t best = best_of([](const Volume&) { return true; });
  if (volumes.size() > all.size())
    scan.notices.push_back(fmt::format(
        "{} volumes found in {} series ({}); #{} was taken (of one series: the most slices, then "
        "the bone kernel), choose with --series.",
        volumes.size(), all.size(), list, best + 1));
  else if (volumes.size() > 1)
    scan.notices.push_back(
        fmt::format("{} series found ({}); #{} is used, choose another with --series.", all.size(),
                    list, best + 1));
  return best;
}

}  // namespace burr::io

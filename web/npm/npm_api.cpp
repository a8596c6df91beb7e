// What the npm package burr-core calls (npm/index.mjs): bones, sessions that go on tick by tick, recordings. All of it is the
// library's own code, so a session has the bits that it has in C++, in Python and on the page.
//
// One thread. A bone and a session are pointers that the package holds, until npm_forget_*(). What a call gives lies in the
// module's memory until the next call of the same function. 0 and nullptr: npm_why() says why. Units: SI, but for settings,
// whose words name theirs (docs/use/settings.md). Frame: world (LPS).
#include <emscripten.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/version.h"
#include "burr/device/pushed_hand.h"
#include "burr/phantom/phantoms.h"
#include "burr/record/bone_blob.h"
#include "burr/record/grid_json.h"
#include "burr/record/schema.h"
#include "burr/surface/mesher.h"
#include "burr/tick/controls.h"
#include "burr/tick/servo.h"
#include "burr/tick/setting_table.h"
#include "burr/volume/bone.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/volume/iso_vertices.h"
#include "burr/volume/volume_of.h"
#include "page_recorder.h"

namespace {

using namespace burr;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kReserveBricks = 4096;  // room for what a session adds, as in Python
constexpr int kCommitEvery = 50;              // ticks

std::string why, text;

const char* as_text(std::string what) {
  text = std::move(what);
  return text.c_str();
}
std::nullptr_t failed(const Error& error) {
  why = error.text;
  return nullptr;
}
std::nullptr_t failed(std::string sentence) {
  why = std::move(sentence);
  return nullptr;
}

struct NpmBone {
  std::unique_ptr<volume::Bone> bone;
  std::string phantom;  // its source; empty: it is no phantom
  double voxel_mm = 0;
  // What the last call of each function gave; JavaScript copies it.
  surface::Mesh mesh;
  std::vector<std::uint8_t> blob;
  std::vector<volume::Field> field;
  std::vector<volume::TissueId> labels;
};

NpmBone* boxed(std::unique_ptr<volume::Bone> bone) {
  auto box = std::make_unique<NpmBone>();
  box->voxel_mm = 1e3 * bone->grid().voxel;
  box->bone = std::move(bone);
  return box.release();
}

// ---- a row, as in recordings and in Python, all of it as doubles

struct Field {
  const char* name;
  int count;
};
constexpr Field kRow[] = {{"tick", 1},
                          {"hand_m", 3},
                          {"hand_q", 4},
                          {"hand_v_m_per_s", 3},
                          {"pedal", 1},
                          {"proxy_m", 3},
                          {"normal", 3},
                          {"force_n", 3},
                          {"torque_nm", 3},
                          {"depth_m", 1},
                          {"touching", 1},
                          {"flags", 1},
                          {"asked_m3", 1},
                          {"removed_m3", 1},
                          {"debt_m3", 1},
                          {"added_m3", 1},
                          {"undone_m3", 1},
                          {"cutting_energy_j", 1},
                          {"spindle_rad_per_s", 1},
                          {"cutting_torque_nm", 1},
                          {"cutting_power_w", 1},
                          {"tool_radius_m", 1},
                          {"coolant", 1}};

constexpr std::size_t row_width() {
  std::size_t width = 0;
  for (const Field& one : kRow) width += static_cast<std::size_t>(one.count);
  return width;
}

void put(const tick::TickRow& row, std::vector<double>& out) {
  const auto vector = [&out](const math::Vec3& v) { out.insert(out.end(), {v.x(), v.y(), v.z()}); };
  const math::Quat& q = row.hand.world_from_tool.q;
  out.push_back(static_cast<double>(row.tick));
  vector(row.hand.world_from_tool.p);
  out.insert(out.end(), {q.w(), q.x(), q.y(), q.z()});
  vector(row.hand.velocity);
  out.push_back(row.hand.pedal);
  vector(row.contact.proxy);
  vector(row.contact.normal);
  vector(row.contact.force);
  vector(row.contact.torque);
  out.insert(out.end(), {row.contact.depth, row.contact.touching ? 1.0 : 0.0,
                         static_cast<double>(row.contact.flags), row.ledger.asked,
                         row.ledger.removed, row.ledger.debt, row.ledger.added, row.ledger.undone,
                         row.ledger.energy, row.spindle_rad_s, row.cutting_nm, row.cutting_w,
                         row.tool.radius, row.tool.irrigated ? 1.0 : 0.0});
}

// ---- a session

struct NpmSession {
  std::unique_ptr<volume::Bone> bone;
  std::unique_ptr<volume::IsoVertices> surface;
  std::unique_ptr<device::PushedHand> hand;
  std::unique_ptr<tick::Servo> servo;
  std::unique_ptr<web::PageRecorder> recorder;  // nullptr: it is not recorded, or no more
  std::string file;                             // of the recording
  rt::ChangedBits* changed = nullptr;
  std::unique_ptr<surface::Mesher> mesher;
  std::vector<int> due, named;  // patches
  std::vector<bool> queued;
  surface::Patch patch;
  tick::TickRow row;
  int undrained = 0;
  bool keeps_rows = false;
  std::vector<double> rows, given;  // since the last npm_rows(); what that gave
  NpmBone* shown = nullptr;         // npm_session_bone()

  void want(int number) {
    if (queued[static_cast<std::size_t>(number)]) return;
    queued[static_cast<std::size_t>(number)] = true;
    due.push_back(number);
  }
  bool drain() {
    undrained = 0;
    const Status drained = recorder->drain();
    if (drained.ok()) return true;
    failed(drained.error());
    servo->set_recorder_rings({});
    recorder.reset();
    return false;
  }
  void commit() {
    bone->commit_ahead();
    surface->commit_ahead();
    servo->commit_ahead();
  }
};

// A number, true or false, a name; as the setting has it.
std::optional<base::Given> given_of(const json& value, const base::Given& usual) {
  if (std::holds_alternative<bool>(usual))
    return value.is_boolean() ? std::optional<base::Given>(value.get<bool>()) : std::nullopt;
  if (std::holds_alternative<std::string>(usual))
    return value.is_string() ? std::optional<base::Given>(value.get<std::string>()) : std::nullopt;
  if (!value.is_number()) return std::nullopt;
  if (std::holds_alternative<double>(usual)) return value.get<double>();
  const double number = value.get<double>();
  if (number != std::floor(number) || std::abs(number) > 9e15) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

// Settings by the names that Python has.
Result<tick::ServoSettings> settings_of(const json& wanted) {
  tick::TypedValues values = tick::usual_values();
  for (const auto& [name, value] : wanted.items()) {
    const tick::About* about = nullptr;
    for (const auto& one : tick::servo_settings())
      if (one.about.typed.word != nullptr && one.about.typed.place != tick::Typed::Place::neither &&
          name == tick::property_of(one.about))
        about = &one.about;
    if (about == nullptr)
      return error(Trouble::usage,
                   fmt::format("there is no setting {}; `settings()` lists them", name));
    const auto given = given_of(value, values.at(about->typed.word));
    if (!given)
      return error(Trouble::usage, fmt::format("{}: must be {}, not {}", name,
                                               tick::typed_range(*about), value.dump()));
    values[about->typed.word] = *given;
  }
  tick::ServoSettings servo;
  if (Status taken = tick::take_typed(
          values, [](const tick::About& about) { return std::string(tick::property_of(about)); },
          servo);
      !taken.ok())
    return taken.error();
  if (Status good = tick::check_settings(servo); !good.ok()) return good.error();
  return servo;
}

ordered_json json_of(const math::Vec3& p) { return {p.x(), p.y(), p.z()}; }

constexpr const char* kKinds[] = {"air", "soft", "solid"};  // volume::TissueKind

// [{name, kind, colour, friction, cutting_energy_j_per_m3}], all but the name as usual where they are left out.
Result<volume::TissueTable> tissues_of(const json& list) {
  const auto wrong = [](std::string_view what) {
    return error(Trouble::usage, fmt::format("tissues: {}", what));
  };
  if (!list.is_array() || list.empty() || list.size() > 256)
    return wrong("must be a list of 1 to 256, air first");
  volume::TissueTable table;
  table.tissues.clear();
  for (const json& one : list) {
    volume::Tissue tissue;
    if (!one.is_object() || !one.contains("name") || !one.at("name").is_string())
      return wrong("each must have a name");
    tissue.name = one.at("name").get<std::string>();
    const json kind = one.value("kind", json(kKinds[2]));
    const auto found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                    [&kind](const char* word) { return kind == word; });
    if (found == std::end(kKinds))
      return wrong(fmt::format("the kind of {} must be air, soft or solid", tissue.name));
    tissue.kind = static_cast<volume::TissueKind>(found - std::begin(kKinds));
    const json colour = one.value("colour", json(tissue.colour));
    bool good = colour.is_array() && colour.size() == 3;
    for (std::size_t n = 0; good && n < 3; ++n) {
      good = colour[n].is_number() && colour[n] >= 0 && colour[n] <= 1;
      if (good) tissue.colour[n] = colour[n].get<float>();
    }
    if (!good)
      return wrong(fmt::format("the colour of {} must be three numbers from 0 to 1", tissue.name));
    const auto number = [&](const char* name, double& to, double most) {
      const json value = one.value(name, json(to));
      if (!value.is_number() || !(value.get<double>() >= 0 && value.get<double>() <= most))
        return false;
      to = value.get<double>();
      return true;
    };
    if (!number("friction", tissue.friction, 10) ||
        !number("cutting_energy_j_per_m3", tissue.cutting_energy, 1e12))
      return wrong(fmt::format(
          "friction and cutting_energy_j_per_m3 of {} must be numbers of 0 or more", tissue.name));
    table.tissues.push_back(std::move(tissue));
  }
  if (table.tissues.front().kind != volume::TissueKind::air)
    return wrong("the first one must be of kind air, because label 0 is air");
  return table;
}

template <class Value>
std::vector<Value> of_all_voxels(const volume::Bone& bone,
                                 Value (volume::Bone::*value)(int, int, int) const) {
  const math::Ijk size = bone.grid().size;
  std::vector<Value> all;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i) all.push_back((bone.*value)(i, j, k));
  return all;
}

// The grid that a field of numbers has; none: npm_why().
std::optional<volume::Grid> grid_of(int x, int y, int z, double voxel_mm, const double* origin_mm) {
  constexpr int kMost = 2048;
  if (std::min({x, y, z}) < 1 || std::max({x, y, z}) > kMost) {
    failed(fmt::format("size: must be three whole numbers from 1 to {}, not {} x {} x {}", kMost, x,
                       y, z));
    return std::nullopt;
  }
  if (!(voxel_mm > 1e-3 && voxel_mm < 100)) {
    failed(fmt::format("voxel_mm: must be a number from 0.001 to 100, not {:g}", voxel_mm));
    return std::nullopt;
  }
  volume::Grid grid;
  grid.size = {x, y, z};
  grid.voxel = 1e-3 * voxel_mm;
  grid.frame.p = 1e-3 * math::Vec3(origin_mm[0], origin_mm[1], origin_mm[2]);
  return grid;
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* npm_why() { return why.c_str(); }
EMSCRIPTEN_KEEPALIVE const char* npm_version() { return base::version(); }

// [{name, voxel_mm}] of the bones by formula.
EMSCRIPTEN_KEEPALIVE const char* npm_phantoms() {
  ordered_json all = ordered_json::array();
  for (const std::string_view name : phantom::phantom_names())
    all.push_back({{"name", name}, {"voxel_mm", phantom::default_voxel_mm(name)}});
  return as_text(all.dump());
}
// [{name, unit, usual, range, help}] of what npm_session() takes.
EMSCRIPTEN_KEEPALIVE const char* npm_settings() {
  ordered_json all = ordered_json::array();
  for (const auto& one : tick::servo_settings()) {
    const tick::About& about = one.about;
    if (about.typed.word == nullptr || about.typed.place == tick::Typed::Place::neither) continue;
    const char* help = about.typed.help;
    all.push_back({{"name", tick::property_of(about)},
                   {"unit", about.typed.unit},
                   {"range", tick::typed_range(about)},
                   {"help", *help == '\0' ? about.help : help}});
    std::visit([&](const auto& value) { all.back()["usual"] = value; }, tick::usual_value(one));
  }
  return as_text(all.dump());
}

// ---- bones

// A bone by formula: "tooth", "temporal-bone?bone=7". voxel_mm 0: the one that suits it.
EMSCRIPTEN_KEEPALIVE NpmBone* npm_phantom(const char* name, double voxel_mm) {
  const std::string prefix = "phantom:", asked = name;
  const std::string plain = asked.starts_with(prefix) ? asked.substr(prefix.size()) : asked;
  NoProgress quiet;
  auto bone = phantom::phantom(plain, voxel_mm, quiet, kReserveBricks, 1);
  if (!bone) return failed(bone.error());
  NpmBone* box = boxed(std::move(*bone));
  box->phantom = prefix + plain;
  return box;
}
// Of a .bone file.
EMSCRIPTEN_KEEPALIVE NpmBone* npm_blob(const std::uint8_t* bytes, int size) {
  auto bone =
      record::bone_from_blob({bytes, static_cast<std::size_t>(size)}, kReserveBricks, "the bone");
  if (!bone) return failed("this is no .bone file, or it is damaged; write it anew");
  return boxed(std::move(*bone));
}
// Of a field, x fastest: 0 air, 32768 the surface, 65535 solid. labels: nullptr, or the number of a tissue for each voxel.
// tissues: JSON, tissues_of(); "": air and bone.
EMSCRIPTEN_KEEPALIVE NpmBone* npm_field(const volume::Field* field, const volume::TissueId* labels,
                                        int x, int y, int z, double voxel_mm,
                                        const double* origin_mm, const char* tissues) {
  const auto grid = grid_of(x, y, z, voxel_mm, origin_mm);
  if (!grid) return nullptr;
  const auto all =
      static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z);
  volume::TissueTable table;
  if (*tissues != '\0') {
    auto given = tissues_of(json::parse(tissues, nullptr, false));
    if (!given) return failed(given.error());
    table = std::move(*given);
  }
  if (labels != nullptr) {
    const volume::TissueId most = *std::max_element(labels, labels + all);
    if (most >= table.tissues.size())
      return failed(
          fmt::format("labels: {} has no tissue; {} are given", most, table.tissues.size()));
  }
  return boxed(volume::bone_from_arrays(
      *grid, std::move(table), {field, all},
      labels == nullptr ? std::span<const volume::TissueId>() : std::span(labels, all), {},
      kReserveBricks));
}
EMSCRIPTEN_KEEPALIVE void npm_forget_bone(NpmBone* box) { delete box; }

// {size, voxel_mm, origin_mm, tissues, hash, volume_mm3, source}
EMSCRIPTEN_KEEPALIVE const char* npm_bone_about(const NpmBone* box) {
  const volume::Grid& grid = box->bone->grid();
  ordered_json out = {{"size", {grid.size.x(), grid.size.y(), grid.size.z()}},
                      {"voxel_mm", 1e3 * grid.voxel},
                      {"origin_mm", json_of(1e3 * grid.frame.p)},
                      {"hash", fmt::format("0x{:016x}", box->bone->content_hash())},
                      {"source", box->phantom}};
  out["tissues"] = ordered_json::array();
  for (const volume::Tissue& one : box->bone->tissues().tissues)
    out["tissues"].push_back({{"name", one.name},
                              {"kind", kKinds[static_cast<std::size_t>(one.kind)]},
                              {"colour", one.colour}});
  return as_text(out.dump());
}
// Of all tissues, as the ledger counts it [m^3].
EMSCRIPTEN_KEEPALIVE double npm_volume(const NpmBone* box) { return volume::volume_of(*box->bone); }

EMSCRIPTEN_KEEPALIVE const std::uint8_t* npm_bone_blob(NpmBone* box) {
  box->blob = record::bone_to_blob(*box->bone);
  return box->blob.data();
}
EMSCRIPTEN_KEEPALIVE int npm_bone_blob_size(const NpmBone* box) {
  return static_cast<int>(box->blob.size());
}
// The whole field and the numbers of the tissues, x fastest.
EMSCRIPTEN_KEEPALIVE const volume::Field* npm_bone_field(NpmBone* box) {
  box->field = of_all_voxels<volume::Field>(*box->bone, &volume::Bone::field);
  return box->field.data();
}
EMSCRIPTEN_KEEPALIVE const volume::TissueId* npm_bone_labels(NpmBone* box) {
  box->labels = of_all_voxels<volume::TissueId>(*box->bone, &volume::Bone::tissue);
  return box->labels.data();
}
// The surface: how many vertices (0 also where there is none), then surface::Vertex each, then the triangles.
EMSCRIPTEN_KEEPALIVE int npm_mesh(NpmBone* box) {
  NoProgress quiet;
  auto mesh = surface::whole_surface(*box->bone, 1, quiet);
  if (!mesh) {
    failed(mesh.error());
    return -1;
  }
  box->mesh = std::move(*mesh);
  return static_cast<int>(box->mesh.vertices.size());
}
EMSCRIPTEN_KEEPALIVE const surface::Vertex* npm_mesh_vertices(const NpmBone* box) {
  return box->mesh.vertices.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint32_t* npm_mesh_triangles(const NpmBone* box) {
  return box->mesh.triangles.data();
}
EMSCRIPTEN_KEEPALIVE int npm_mesh_triangle_count(const NpmBone* box) {
  return static_cast<int>(box->mesh.triangles.size() / 3);
}
EMSCRIPTEN_KEEPALIVE int npm_vertex_size() { return sizeof(surface::Vertex); }

// ---- sessions

// Of a copy of the bone. settings: JSON {name: value}; record: not 0: into `file`, in the module's own file system.
EMSCRIPTEN_KEEPALIVE NpmSession* npm_session(const NpmBone* box, const char* settings, int record,
                                             int rows, const char* file) {
  const json wanted = json::parse(settings, nullptr, false);
  if (!wanted.is_object()) return failed("settings: must be an object");
  auto servo = settings_of(wanted);
  if (!servo) return failed(servo.error());
  const double h = box->bone->grid().voxel, r = servo->burr.radius;
  if (r < 2 * h)
    return failed(
        fmt::format("a burr of {:.2f} mm is smaller than 4 voxels of {:.3f} mm; use "
                    "voxels of {:.3f} mm or finer, or a burr of {:.2f} mm or larger",
                    2e3 * r, 1e3 * h, std::floor(1e6 * r / 2) / 1e3, std::ceil(4e5 * h) / 100));
  auto session = std::make_unique<NpmSession>();
  session->bone = volume::copy_of(*box->bone);
  session->changed = &session->bone->add_watcher();
  session->hand = std::make_unique<device::PushedHand>(
      device::ArmSettings{.stiffness = std::numeric_limits<double>::infinity()});
  if (const Status opened = session->hand->open(); !opened.ok()) return failed(opened.error());
  const device::DeviceSpec& spec = session->hand->spec();
  // as Session::make caps them (sim/session.cpp)
  tick::ServoSettings capped = *servo;
  capped.force.stiffness = tick::coupling_of(spec, *servo).stiffness;
  capped.force.damping = std::min(servo->force.damping, spec.max_damping);
  NoProgress quiet;
  session->surface =
      std::make_unique<volume::IsoVertices>(*session->bone, volume::IsoSettings{}, 1, quiet);
  session->servo =
      std::make_unique<tick::Servo>(*session->bone, *session->surface, *session->hand, capped);
  session->keeps_rows = rows != 0;
  if (record != 0) {
    web::PageTask task;
    task.phantom = box->phantom;
    task.motion = "javascript";
    session->file = file;
    auto recorder = web::PageRecorder::begin(*session->bone, capped, spec,
                                             box->phantom.empty() ? 0 : box->voxel_mm, task,
                                             session->file.c_str());
    if (!recorder) return failed(recorder.error());
    session->recorder = std::move(*recorder);
    session->servo->set_recorder_rings(session->recorder->rings());
  }
  session->mesher = std::make_unique<surface::Mesher>(*session->bone);
  session->queued.resize(static_cast<std::size_t>(session->mesher->patch_count()));
  for (int n = 0; n < session->mesher->patch_count(); ++n) session->want(n);
  return session.release();
}
EMSCRIPTEN_KEEPALIVE void npm_forget_session(NpmSession* session) {
  session->servo->set_recorder_rings({});
  delete session;
}

// Where the tip is after so many ticks; 0: there at once, at rest. Quaternion w, x, y, z.
EMSCRIPTEN_KEEPALIVE int npm_hand(NpmSession* session, double x, double y, double z, double qw,
                                  double qx, double qy, double qz, double pedal, double ticks) {
  math::Quat q(qw, qx, qy, qz);
  const double length = std::sqrt(qw * qw + qx * qx + qy * qy + qz * qz);
  if (!std::isfinite(x + y + z) || !(length > 1e-9 && length < 1e9) ||
      !(pedal >= 0 && pedal <= 1) || !(ticks >= 0 && ticks <= 1e9)) {
    failed(
        "the hand: the place must be three numbers [m], the quaternion must not be 0, the pedal "
        "from 0 to "
        "1, the ticks from 0 to 1e9");
    return 0;
  }
  q.normalize();
  const math::Pose there{{x, y, z}, q};
  if (ticks < 1)
    session->hand->place(there, pedal, 0);
  else
    session->hand->move(there, pedal, 0, static_cast<std::uint64_t>(ticks));
  return 1;
}

// How many were made; fewer: the recording has failed, npm_why().
EMSCRIPTEN_KEEPALIVE int npm_step(NpmSession* session, int ticks) {
  NpmSession& s = *session;
  for (int n = 0; n < ticks; ++n) {
    s.row = s.servo->tick(false);
    s.servo->publish();
    if (s.keeps_rows) put(s.row, s.rows);
    if (s.recorder != nullptr && ++s.undrained >= web::PageRecorder::kDue && !s.drain())
      return n + 1;
    if ((n + 1) % kCommitEvery == 0) s.commit();
  }
  s.commit();
  return ticks;
}

// "tick:1 hand_m:3 ...": the fields of a row and how many numbers each has.
EMSCRIPTEN_KEEPALIVE const char* npm_row_fields() {
  std::string out;
  for (const Field& one : kRow)
    out += fmt::format("{}{}:{}", out.empty() ? "" : " ", one.name, one.count);
  return as_text(std::move(out));
}
EMSCRIPTEN_KEEPALIVE const double* npm_row(const NpmSession* session) {
  static std::vector<double> row;
  row.clear();
  put(session->row, row);
  return row.data();
}
// Of all ticks since the last call: how many, then the numbers.
EMSCRIPTEN_KEEPALIVE int npm_rows(NpmSession* session) {
  session->given = std::exchange(session->rows, {});
  return static_cast<int>(session->given.size() / row_width());
}
EMSCRIPTEN_KEEPALIVE const double* npm_rows_data(const NpmSession* session) {
  return session->given.data();
}
// Of the last tick; it stands for all before it.
EMSCRIPTEN_KEEPALIVE const char* npm_hash(const NpmSession* session) {
  return as_text(fmt::format("0x{:016x}", session->row.hash));
}

// name: as in a recording (docs/use/recording.md), "spindle_speed", "undo"; its value in SI.
EMSCRIPTEN_KEEPALIVE int npm_command(NpmSession* session, const char* name, double value) {
  tick::CommandRow row;
  const json wanted = {{"tick", 0}, {"kind", name}, {"value", value}};
  if (!std::isfinite(value) || !record::command_from_json(wanted.dump(), row)) {
    failed(fmt::format("there is no command {}, or not with that value", name));
    return 0;
  }
  if (session->servo->commands().push(row.command)) return 1;
  failed("too many commands wait; step first");
  return 0;
}

// The bone as it is now.
EMSCRIPTEN_KEEPALIVE NpmBone* npm_session_bone(const NpmSession* session) {
  return boxed(volume::copy_of(*session->bone));
}
// The next patch of the surface that has changed: its number, or -1. Its vertices and triangles stay until the next call.
EMSCRIPTEN_KEEPALIVE int npm_patch(NpmSession* session) {
  NpmSession& s = *session;
  s.changed->take_all([&s](std::size_t brick) {
    s.named.clear();
    s.mesher->patches_of_brick(static_cast<volume::BrickIndex>(brick), s.named);
    for (const int patch : s.named) s.want(patch);
  });
  if (s.due.empty()) return -1;
  const int number = s.due.back();
  s.due.pop_back();
  s.queued[static_cast<std::size_t>(number)] = false;
  while (!s.mesher->mesh_patch(number, s.patch)) {  // nobody writes: it succeeds at once
  }
  return number;
}
EMSCRIPTEN_KEEPALIVE int npm_patch_vertex_count(const NpmSession* session) {
  return static_cast<int>(session->patch.vertices.size());
}
EMSCRIPTEN_KEEPALIVE const surface::Vertex* npm_patch_vertices(const NpmSession* session) {
  return session->patch.vertices.data();
}
EMSCRIPTEN_KEEPALIVE int npm_patch_triangle_count(const NpmSession* session) {
  return static_cast<int>(session->patch.triangles.size() / 3);
}
EMSCRIPTEN_KEEPALIVE const std::uint32_t* npm_patch_triangles(const NpmSession* session) {
  return session->patch.triangles.data();
}

// A complete file of everything so far, PageRecorder::kCopy; the recording goes on.
EMSCRIPTEN_KEEPALIVE int npm_recording(NpmSession* session) {
  NpmSession& s = *session;
  if (s.recorder == nullptr) {
    failed("this session is not recorded; ask for it: session(bone, {}, {record: true})");
    return 0;
  }
  while (s.servo->bricks_to_write() > 0) {
    s.servo->flush_bricks();
    if (!s.drain()) return 0;
  }
  if (const Status done = s.recorder->copy(); !done.ok()) {
    failed(done.error());
    return 0;
  }
  return 1;
}

}  // extern "C"

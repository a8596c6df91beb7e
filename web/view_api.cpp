// What the page calls (pages/mill/view.js): the picture, and where the hand is while it follows a
// point in the picture.
//
//     view_open(width, height) -> view_bone(voxel_mm) -> view_patch() ..., view_soft() ...
//     then, each picture: view_row(), view_aim(), view_show()
//
// Thread: the page's. Lengths in m, angles in rad, points of the picture in pixels of the canvas.
#include <emscripten.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/mouse/mouse_aim.h"
#include "burr/render/governor.h"
#include "burr/render/held_tool.h"
#include "burr/render/pick.h"
#include "burr/render/renderer.h"
#include "burr/render/soft_scene.h"
#include "burr/render/thin_patch.h"
#include "burr/render/wound.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/work_view.h"
#include "work_of_page.h"

namespace {

using namespace burr;

// Levels of a patch with fewer triangles [voxel], made when it has been at rest for this long [s], in this share of
// the time of a picture, and in no more than that [s].
constexpr std::array<double, 4> kThinned = {0.25, 0.45, 1, 2};
constexpr double kThinRest = 0.3, kThinShare = 0.25, kThinMost = 0.06, kThinLeast = 0.004;
// A picture with fewer triangles is drawn once more with all of them when nothing has changed for this long, longer
// than two updates of dust and blood lie apart (render/governor.h) [s].
constexpr double kWholeRest = 2.5;
constexpr double kSuctionBeside = 3e-3;  // as in the window: its reach beyond the burr [m]
constexpr double kSpin = 9;              // 40 000 rpm are too fast to see, as in the window [rad/s]

struct View {
  std::unique_ptr<render::Renderer> renderer;
  render::Scene scene;
  std::optional<render::FrameGovernor> governor;
  std::optional<render::Wound> wound;
  std::optional<mouse::MouseAim> aim;
  mouse::MouseHand::Aim hand;
  render::HeldTool held;
  bool leans = true;   // the tool follows a mouse, and is drawn as a hand would hold it
  bool sucks = false;  // suction beside the burr is on
  std::map<int, std::shared_ptr<const render::ToolLook>> looks;     // of tools of the rack
  std::map<int, std::shared_ptr<const render::CoarseMesh>> shapes;  // of pieces of bone
  workshop::PieceLook piece;
  std::size_t tissue_count = 0;
  tick::TickRow row;
  double rate = web::kRate;             // of ticks [Hz]
  std::vector<volume::Tissue> tissues;  // of the next bone
  std::vector<std::pair<std::size_t, render::Colour>>
      unlit;                       // colours of tissues before they were lit
  double voxel = 0;                // [m]
  std::vector<double> changed_at;  // of each patch [s]
  std::size_t next_to_thin = 0;
  double now = 0, drawn_at = 0;  // the last picture, and the last in which bone was drawn [s]
  bool thin_shown = false;       // some of it was drawn with fewer triangles
  std::string why;               // of the last call that failed
  math::Vec3 work_at = web::work_at(), work_into = web::work_into();  // what the first view shows
  double work_high = 2 * std::clamp(20 * web::kBurrRadius, 20e-3, 70e-3);
};

View& view() {
  static View one;
  return one;
}

// As the window begins (apps/burr/shared/window_session.cpp).
render::Camera first_camera() {
  const View& v = view();
  return render::view_of_work(v.work_at, -v.work_into, v.work_high);
}

// How far the bone hides a place from this camera [m]; 0: it is seen.
double hidden(const View& v, const render::Camera& camera, const math::Vec3& place) {
  const math::Vec3 way = place - camera.eye();
  const double far = way.norm();
  if (far <= 0) return 0;
  const auto hit = render::pick(v.scene, {camera.eye(), way / far});
  return hit ? std::max(0.0, far - hit->distance) : 0;
}

surface::Patch patch_of(const surface::Vertex* vertices, int vertex_count,
                        const std::uint32_t* triangles, int index_count) {
  return {{vertices, vertices + vertex_count}, {triangles, triangles + index_count}};
}

// What was shown before goes; the camera stays.
void show_bone(const volume::TissueTable& tissues, double voxel_mm, double rate, bool leans) {
  View& v = view();
  v.leans = leans;
  v.looks.clear();
  v.shapes.clear();
  v.piece = {};
  v.tissue_count = tissues.tissues.size();
  const render::Camera camera = v.aim ? v.scene.camera : first_camera();
  const double voxel = 1e-3 * voxel_mm;
  const std::vector<render::ScenePatch> before = std::exchange(v.scene.patches, {});
  v.scene = {};
  // the renderer knows a patch by its number and its version: those of the bone before must differ
  v.scene.patches.resize(before.size());
  for (std::size_t n = 0; n < before.size(); ++n) {
    v.scene.patches[n].version = before[n].version + 1;
    v.scene.changes.add(static_cast<int>(n));
  }
  v.unlit.clear();
  v.voxel = voxel;
  v.changed_at.clear();
  v.next_to_thin = 0;
  v.scene.camera = camera;
  v.scene.scale_bar = true;
  v.scene.tissue_colours = render::colours_of(tissues);
  v.scene.materials = render::materials_of(tissues);
  v.wound.emplace(voxel, render::bleeding_of(tissues));
  v.aim.emplace(voxel);
  v.row = {};
  v.rate = rate;
}

// The renderer draws all of a picture whose look has changed: here by less than can be seen.
void draw_all(render::Scene& scene) {
  constexpr double kUnseen = 1e-9;
  double& gloss = scene.look.gloss;
  gloss = render::Look{}.gloss + (gloss == render::Look{}.gloss ? kUnseen : 0);
}

// Where pictures are slow: makes coarser levels of some patches. took: the picture before [s]
void thin_some(View& v, double took) {
  const render::Quality& quality = v.scene.quality;
  if (quality.coarse_px <= 0 && quality.coarse_still_px <= 0) return;
  std::array<double, kThinned.size()> errors = kThinned;
  for (double& error : errors) error *= v.voxel;
  const double until =
      emscripten_get_now() + 1e3 * std::clamp(kThinShare * took, kThinLeast, kThinMost);
  for (render::SoftStructure& one : v.scene.soft) {
    if (one.mesh->levels.size() > 1 || emscripten_get_now() > until) continue;
    auto thin = std::make_shared<render::CoarseMesh>(*one.mesh);
    const std::vector<std::uint32_t>& all = one.mesh->levels.front().indices;
    for (render::CoarseLevel& level : render::thinned(thin->vertices, all, errors))
      thin->levels.push_back(std::move(level));
    if (thin->levels.size() == 1) thin->levels.push_back(thin->levels.front());  // not once more
    one.mesh = std::move(thin);
  }
  const std::size_t count = std::min(v.scene.patches.size(), v.changed_at.size());
  for (std::size_t n = 0; n < count && emscripten_get_now() < until; ++n) {
    const std::size_t at = v.next_to_thin % count;
    ++v.next_to_thin;
    const render::ScenePatch& patch = v.scene.patches[at];
    if (patch.mesh == nullptr || patch.coarser != nullptr) continue;
    if (v.now - v.changed_at[at] < kThinRest) continue;
    render::set_coarser(v.scene, static_cast<int>(at),
                        std::make_shared<const std::vector<render::CoarseLevel>>(
                            render::thinned(*patch.mesh, errors)));
  }
}

// All triangles, once nothing changes any more.
void show_whole_at_rest(View& v) {
  render::Quality& quality = v.scene.quality;
  const bool thin = quality.coarse_px > 0 || quality.coarse_still_px > 0;
  if (!thin || !v.thin_shown || v.now - v.drawn_at < kWholeRest) return;
  quality.coarse_px = quality.coarse_still_px = 0;
  draw_all(v.scene);
  v.thin_shown = false;
}

}  // namespace

extern "C" {

// Makes the picture on the canvas "#picture". 0: view_why() says why not.
EMSCRIPTEN_KEEPALIVE int view_open(int width, int height) {
  View& v = view();
  auto renderer = render::Renderer::window("burr", width, height);
  if (!renderer) {
    v.why = renderer.error().text;
    return 0;
  }
  v.renderer = std::move(*renderer);
  v.governor.emplace(v.renderer->software());
  return 1;
}
EMSCRIPTEN_KEEPALIVE const char* view_why() { return view().why.c_str(); }
// The browser has taken the canvas's context away. Until view_open() has made another one, on the same canvas or a new one, nothing
// that asks for the picture may be called; the bone and its changes are taken as before.
EMSCRIPTEN_KEEPALIVE void view_lost() { view().renderer.reset(); }
// Where the first view looks: the place [m], the way into the bone, the burr's radius there [m].
EMSCRIPTEN_KEEPALIVE void view_work(double x, double y, double z, double into_x, double into_y,
                                    double into_z, double radius) {
  View& v = view();
  v.work_at = {x, y, z};
  v.work_into = {into_x, into_y, into_z};
  v.work_high = 2 * std::clamp(20 * radius, 20e-3, 70e-3);
}
// Turns the view to a place [m]: it stands in the middle, seen from where the bone hides it least, from as near to the present side
// as may be; `high` of the picture at its depth [m].
EMSCRIPTEN_KEEPALIVE void view_turn_to(double x, double y, double z, double high) {
  View& v = view();
  const math::Vec3 place(x, y, z);
  const double distance = 0.5 * high / std::tan(0.5 * v.scene.camera.field_of_view);
  const render::Camera from = v.scene.camera;
  constexpr double kStep = 0.35, kMostHidden = 1e-3;  // [rad], [m]
  double least = 1e9;
  for (const double up : {0.0, 1.0, -1.0, 2.0, -2.0, 3.0})
    for (const double aside : {0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.5, -4.5, 6.0, -6.0, 9.0}) {
      render::Camera one = from;
      one.placed.reset();
      one.target = place;
      one.distance = distance;
      render::orbit(one, kStep * aside, kStep * up);
      const double behind = std::max(0.0, hidden(v, one, place) - kMostHidden);
      const double cost = behind + 1e-4 * (std::abs(up) + std::abs(aside));
      if (cost < least) {
        least = cost;
        v.scene.camera = one;
      }
    }
}
EMSCRIPTEN_KEEPALIVE const char* view_gpu() {
  static std::string name;
  name = view().renderer->gpu();
  return name.c_str();
}

// A bone with voxels of this size; what was shown before goes.
EMSCRIPTEN_KEEPALIVE void view_bone(double voxel_mm) {
  show_bone(web::phantom_of_page(1e-3 * voxel_mm).tissues, voxel_mm, web::kRate, true);
}
// The same for another bone: view_tissue() for each of its tissues (core_tissue()), then view_other_bone().
// rate: of its ticks [Hz]. mouse: not 0: its tool follows a mouse.
EMSCRIPTEN_KEEPALIVE void view_tissue(const char* name, int kind, double red, double green,
                                      double blue, double bleeds) {
  volume::Tissue tissue;
  tissue.name = name;
  tissue.kind = static_cast<volume::TissueKind>(kind);
  tissue.colour = {static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)};
  tissue.bleeds = bleeds;
  view().tissues.push_back(tissue);
}
EMSCRIPTEN_KEEPALIVE void view_other_bone(double voxel_mm, double rate, int mouse) {
  volume::TissueTable table;
  table.tissues = std::exchange(view().tissues, {});
  show_bone(table, voxel_mm, rate, mouse != 0);
}
// The whole bone, seen from the right.
EMSCRIPTEN_KEEPALIVE void view_whole() {
  View& v = view();
  v.scene.camera = render::whole_view(
      v.scene, -1.2, 0.2,
      static_cast<double>(v.renderer->width()) / std::max(1, v.renderer->height()));
}

EMSCRIPTEN_KEEPALIVE void view_patch(int number, const surface::Vertex* vertices, int vertex_count,
                                     const std::uint32_t* triangles, int index_count) {
  View& v = view();
  render::set_patch(v.scene, number, patch_of(vertices, vertex_count, triangles, index_count));
  v.wound->stain(v.scene, number);
  if (const auto at = static_cast<std::size_t>(number); at >= v.changed_at.size())
    v.changed_at.resize(at + 1);
  v.changed_at[static_cast<std::size_t>(number)] = v.now;
}
EMSCRIPTEN_KEEPALIVE void view_soft(int tissue, const render::SkinVertex* vertices,
                                    int vertex_count, const std::uint32_t* triangles,
                                    int index_count) {
  render::SoftStructure one;
  one.tissue = static_cast<volume::TissueId>(tissue);
  render::CoarseMesh mesh;
  mesh.vertices.assign(vertices, vertices + vertex_count);
  mesh.levels.push_back({0, {triangles, triangles + index_count}});
  for (const render::SkinVertex& vertex : mesh.vertices) one.box.extend(vertex.p.cast<double>());
  one.mesh = std::make_shared<const render::CoarseMesh>(std::move(mesh));
  view().scene.soft.push_back(std::move(one));
}

// Draw the whole picture next time. Call it while the bone's first patches come: the renderer takes the
// bone that it drew last for the whole bone, and draws only what differs.
EMSCRIPTEN_KEEPALIVE void view_anew() { draw_all(view().scene); }

// The newest row of the ticks, tick::TickRow.
EMSCRIPTEN_KEEPALIVE void view_row(const void* bytes) {
  View& v = view();
  std::memcpy(static_cast<void*>(&v.row), bytes, sizeof v.row);
  workshop::put_tool(v.scene, v.row, false);
  v.wound->see(workshop::wound_tick(v.row, v.rate, {}));
}
// The surface of a tool of the rack: what cuts, what rubs.
EMSCRIPTEN_KEEPALIVE void view_tool_look(int number, const surface::Vertex* cuts, int cuts_count,
                                         const std::uint32_t* cuts_triangles, int cuts_indices,
                                         const surface::Vertex* rubs, int rubs_count,
                                         const std::uint32_t* rubs_triangles, int rubs_indices) {
  auto look = std::make_shared<render::ToolLook>();
  look->cuts = patch_of(cuts, cuts_count, cuts_triangles, cuts_indices);
  look->rubs = patch_of(rubs, rubs_count, rubs_triangles, rubs_indices);
  view().looks[number] = std::move(look);
}
// The tool in the hand, of which view_tool_look() was told; any other number: the round burr. Call it after view_row().
EMSCRIPTEN_KEEPALIVE void view_tool(int number) {
  View& v = view();
  const auto found = v.looks.find(number);
  v.scene.burr.other = found == v.looks.end() ? nullptr : found->second;
}
// The surface of a piece of bone where it came free.
EMSCRIPTEN_KEEPALIVE void view_piece_shape(int number, const render::SkinVertex* vertices,
                                           int vertex_count, const std::uint32_t* triangles,
                                           int index_count) {
  auto mesh = std::make_shared<render::CoarseMesh>();
  mesh->vertices.assign(vertices, vertices + vertex_count);
  // twice the same level: thin_some() leaves it, for PieceLook knows its mesh by the pointer
  mesh->levels.assign(2, {0, {triangles, triangles + index_count}});
  view().shapes[number] = std::move(mesh);
}
// The piece that is out of the bone, and by how much: x, y, z [m], unit quaternion w, x, y, z. Another number than those
// of view_piece_shape(): none is out.
EMSCRIPTEN_KEEPALIVE void view_piece(int number, const double* by) {
  View& v = view();
  const auto found = v.shapes.find(number);
  v.piece.put(v.scene, found == v.shapes.end() ? nullptr : found->second,
              {{by[0], by[1], by[2]}, {by[3], by[4], by[5], by[6]}}, v.tissue_count);
}
// What the page writes of the row: time [s], force [N], removed [mm^3], diameter of the burr [mm],
// speed that is set [rpm], speed now [rpm], touching, flags, coolant runs.
EMSCRIPTEN_KEEPALIVE const double* view_figures() {
  static double figures[9];
  const tick::TickRow& row = view().row;
  constexpr double kRpm = 60 / (2 * 3.14159265358979323846);
  figures[0] = static_cast<double>(row.tick) / view().rate;
  figures[1] = row.contact.force.norm();
  figures[2] = 1e9 * (row.ledger.removed - row.ledger.undone);
  figures[3] = 2e3 * row.tool.radius;
  figures[4] = row.tool.full_speed * kRpm;
  figures[5] = row.spindle_rad_s * kRpm;
  figures[6] = row.contact.touching ? 1 : 0;
  figures[7] = row.contact.flags;
  figures[8] = row.tool.irrigated ? 1 : 0;
  return figures;
}

// Suction beside the burr: water, dust and blood near it leave the picture.
EMSCRIPTEN_KEEPALIVE void view_suction(int on) { view().sucks = on != 0; }

// Where the hand shall be for this point of the picture: the bytes of a MouseHand::Aim for
// core_aim(). pressed: not 0, at `depth` below the surface and this share of the speed.
EMSCRIPTEN_KEEPALIVE const void* view_aim(double x, double y, int pressed, double depth,
                                          double spindle, int left_handed) {
  View& v = view();
  const render::Ray ray =
      render::ray_through(v.scene.camera, x, y, v.renderer->width(), v.renderer->height());
  std::optional<mouse::MouseAim::Push> push;
  if (pressed != 0) push = {depth, spindle};
  v.hand = v.aim->at(v.scene, ray, push, left_handed != 0);
  return &v.hand;
}
EMSCRIPTEN_KEEPALIVE int view_aim_size() { return sizeof(mouse::MouseHand::Aim); }
// Whether there is bone at this point.
EMSCRIPTEN_KEEPALIVE int view_hits(double x, double y) {
  View& v = view();
  return render::pick(v.scene, render::ray_through(v.scene.camera, x, y, v.renderer->width(),
                                                   v.renderer->height()))
             ? 1
             : 0;
}
// Where a ball is in the picture: x, y and its radius there [pixel]; a negative radius: behind the eye.
EMSCRIPTEN_KEEPALIVE const double* view_place(double x, double y, double z, double radius) {
  static double at[3];
  const View& v = view();
  const render::Camera& camera = v.scene.camera;
  const double high = v.renderer->height();
  const math::Vec3 from = math::Vec3(x, y, z) - camera.eye();
  const double before = -from.dot(camera.backward()), far = std::max(1e-6, before);
  const double pixels = high / (2 * std::tan(0.5 * camera.field_of_view) * far);
  at[0] = 0.5 * v.renderer->width() + pixels * from.dot(camera.right());
  at[1] = 0.5 * high - pixels * from.dot(camera.above());
  at[2] = before > 0 ? pixels * radius : -1;
  return at;
}
// Of the burr.
EMSCRIPTEN_KEEPALIVE const double* view_burr() {
  const tick::TickRow& row = view().row;
  return view_place(row.contact.proxy.x(), row.contact.proxy.y(), row.contact.proxy.z(),
                    row.tool.radius);
}
// Gives a tissue this colour, until view_unlight().
EMSCRIPTEN_KEEPALIVE void view_light(int tissue, double red, double green, double blue) {
  View& v = view();
  const auto at = static_cast<std::size_t>(tissue);
  if (at >= v.scene.tissue_colours.size()) return;
  v.unlit.emplace_back(at, v.scene.tissue_colours[at]);
  v.scene.tissue_colours[at] = {static_cast<float>(red), static_cast<float>(green),
                                static_cast<float>(blue)};
}
EMSCRIPTEN_KEEPALIVE void view_unlight() {
  View& v = view();
  for (const auto& [at, colour] : v.unlit) v.scene.tissue_colours[at] = colour;
  v.unlit.clear();
}

EMSCRIPTEN_KEEPALIVE void view_orbit(double azimuth_by, double elevation_by) {
  render::orbit(view().scene.camera, azimuth_by, elevation_by);
}
EMSCRIPTEN_KEEPALIVE void view_zoom(double factor) { render::zoom(view().scene.camera, factor); }
EMSCRIPTEN_KEEPALIVE void view_pan(double right_by, double up_by) {
  render::pan(view().scene.camera, right_by, up_by);
}
EMSCRIPTEN_KEEPALIVE void view_home() { view().scene.camera = first_camera(); }

// Draws. now: time of the page [s]; took: how long the picture before this one took [s]. 0: view_why()
// says why not.
EMSCRIPTEN_KEEPALIVE int view_show(double now, double took, int left_handed) {
  View& v = view();
  static double before = 0;
  const double seconds = std::clamp(now - before, 0.0, 0.1);
  before = now;
  if (v.scene.burr.visible && v.scene.burr.other == nullptr) {
    if (v.leans)
      v.scene.burr.world_from_tool =
          v.held.at(v.scene, v.row.contact.proxy, left_handed != 0, seconds);
    if (v.row.spindle_rad_s > 0)
      v.scene.burr.turn = std::remainder(v.scene.burr.turn + kSpin * seconds, 6.2832);
  }
  v.governor->end(took, v.renderer->figures().redrawn, now);
  v.scene.quality = v.governor->begin(v.scene.camera, now);
  v.now = now;
  if (v.sucks) v.wound->suck(v.row.contact.proxy, v.row.tool.radius + kSuctionBeside, seconds);
  v.wound->renew(v.scene, now);
  thin_some(v, took);
  show_whole_at_rest(v);
  const Status shown = v.renderer->show(v.scene);
  if (!shown) v.why = shown.error().text;
  if (v.renderer->figures().patches_drawn > 0) {
    v.drawn_at = now;
    v.thin_shown = v.scene.quality.coarse_px > 0 || v.scene.quality.coarse_still_px > 0;
  }
  return shown ? 1 : 0;
}
// Of the last picture: share that was drawn anew, patches sent, patches drawn, triangles drawn, step of the
// governor.
EMSCRIPTEN_KEEPALIVE const double* view_drawn() {
  static double figures[5];
  const render::Renderer::Figures last = view().renderer->figures();
  figures[0] = last.redrawn;
  figures[1] = last.patches_uploaded;
  figures[2] = last.patches_drawn;
  figures[3] = static_cast<double>(last.triangles_drawn);
  figures[4] = view().governor->step();
  return figures;
}
// 1: nothing is left out of the picture.
EMSCRIPTEN_KEEPALIVE int view_refined() {
  return view().renderer->refined() && !view().thin_shown ? 1 : 0;
}

}  // extern "C"

#include "burr/report/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/metrics/region.h"
#include "burr/render/picture.h"
#include "burr/render/soft_scene.h"
#include "burr/report/report_colours.h"
#include "burr/volume/sample.h"
#include "burr/words/words.h"
#include "burr/workshop/work_view.h"

namespace burr::report {

using words::Word;
using words::word;

namespace {

using math::Vec3;
using render::Colour;
using scoring::Spot;

constexpr int kProofWide = 300, kProofHigh = 225;  // of a piece of evidence
constexpr double kSectionHigh = 18e-3;             // height of a section [m]
constexpr double kMissed = 0.5e-3;   // bone deeper in a region than this is missed [m]
constexpr double kExcess = 0.25e-3;  // a cut deeper in what must stay than this is too much [m]

// A picture of a recorded view.
render::Camera camera_of(const record::View& view, const Vec3& target, double aspect) {
  render::Camera camera;
  Eigen::Matrix3d axes;
  axes << view.right, view.up, view.back;
  render::PlacedEye eye;
  eye.world_from_eye = {view.eye, math::Quat(axes)};
  eye.top = std::tan(0.5 * view.field_of_view);
  eye.bottom = -eye.top;
  eye.right = eye.top * aspect;
  eye.left = -eye.right;
  camera.target = target;
  camera.distance = std::max(2e-3, (target - view.eye).dot(-view.back));
  camera.field_of_view = view.field_of_view;
  camera.placed = eye;
  return camera;
}

// A ring of two pixels around a place in a section.
void draw_ring(render::Image& image, const render::Slice& slice, const Vec3& at, double radius) {
  const Eigen::Vector2d middle = render::pixel_of(slice, at, image.width, image.height);
  const double per_m = image.height / slice.height, r = std::max(4.0, radius * per_m);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double off = std::hypot(x + 0.5 - middle.x(), y + 0.5 - middle.y()) - r;
      if (std::abs(off) > 1) continue;
      std::uint8_t* pixel = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
      for (std::size_t n = 0; n < 3; ++n)
        pixel[n] = static_cast<std::uint8_t>(255 * kBareColour[n]);
    }
}

// Behind a caption: how much the picture shows from left to right, at its middle.
std::string wide_words(double wide) { return fmt::format(", {:.0f} mm ↔", 1e3 * wide); }

Result<ReportPicture> as_picture(const render::Image& image, std::string caption) {
  auto png = render::png_of(image);
  if (!png) return png.error();
  return ReportPicture{std::move(*png), std::move(caption), image.width, image.height};
}

}  // namespace

ReportArtist::ReportArtist(Scored& scored)
    : scored_(scored), cavity_(removed_box(*scored.before, *scored.after)) {
  towards_ = towards_surgeon(scored.judged.lesson, scored.judged.work);
  sides_ = product_views(cavity_, towards_, scored.judged.work.at);
  views_ = scored.judged.player->views();
  pieces_.emplace(*scored.judged.player);
}

Result<std::unique_ptr<ReportArtist>> ReportArtist::make(Scored& scored, Progress& progress) {
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  std::unique_ptr<ReportArtist> made(new ReportArtist(scored));
  made->renderer_ = std::move(*renderer);
  if (const Status skinned = made->skin(progress); !skinned) return skinned.error();
  return made;
}

Status ReportArtist::skin(Progress& progress) {
  volume::Bone& bone = *scored_.after;
  slicer_ = std::make_unique<render::Slicer>(bone);
  worker_ = std::make_unique<surface::Worker>(bone, 2);
  scene_.look = render::still_look();
  scene_.look.background_top = scene_.look.background_bottom = {0.93F, 0.94F, 0.95F};
  scene_.tissue_colours = render::colours_of(bone.tissues());
  if (const Status soft = render::add_soft(scene_, bone, progress); !soft) return soft;
  // the last numbers of tissues, if the bone does not use them itself
  constexpr std::size_t kIds = 256, kOwn = 4;
  if (scene_.tissue_colours.size() + kOwn <= kIds) {
    scene_.tissue_colours.push_back(workshop::PieceLook::kColour);
    cut_ = static_cast<volume::TissueId>(scene_.tissue_colours.size());
    missed_ = static_cast<volume::TissueId>(cut_ + 1);
    excess_ = static_cast<volume::TissueId>(cut_ + 2);
    for (const Colour& colour : {kCutColour, kLeftColour, kBareColour})
      scene_.tissue_colours.push_back(colour);
  }
  return worker_->first(progress, [&](const surface::Skin& skin) {
    const auto at = static_cast<std::size_t>(skin.patch);
    if (plain_.size() <= at) plain_.resize(at + 1);
    plain_[at] = *skin.mesh;
    render::set_patch(scene_, skin.patch, *skin.mesh);
  });
}

// False: no vertex of the patch is new or lies in the region, which is never nearer than its depth
// says.
bool ReportArtist::may_show(std::size_t patch, const metrics::Region& region) const {
  const math::Aabb& box = scene_.patches[patch].box;
  const math::Aabb near = cavity_.inflated(2 * scored_.before->grid().voxel);
  const bool at_the_cut =
      (box.lo.array() <= near.hi.array()).all() && (box.hi.array() >= near.lo.array()).all();
  return at_the_cut || (region && region(box.centre()) > -0.5 * box.extent().norm());
}

// Gives the vertices their colours; 0: that of the tissue. region: where vertices that are not new
// may get one. Only patches that look different then are sent again.
void ReportArtist::paint(const Paint& colour, const metrics::Region& region) {
  painted_.resize(plain_.size(), false);
  for (std::size_t n = 0; n < plain_.size(); ++n) {
    if (plain_[n].triangles.empty()) continue;
    const bool was = painted_[n];
    painted_[n] = false;
    surface::Patch patch;
    if (colour && may_show(n, region)) {
      patch = plain_[n];
      for (surface::Vertex& vertex : patch.vertices) {
        const volume::TissueId id = colour(vertex);
        if (id == 0) continue;
        painted_[n] = true;
        vertex.tissue = id;
        if (id != cut_) vertex.beneath = 0;
      }
    }
    if (painted_[n])
      render::set_patch(scene_, static_cast<int>(n), patch);
    else if (was)
      render::set_patch(scene_, static_cast<int>(n), plain_[n]);
  }
}

bool ReportArtist::is_new(const surface::Vertex& vertex) const {
  const volume::Bone& before = *scored_.before;
  return volume::depth_at(before, vertex.p.cast<double>()) > 0.4 * before.grid().voxel;
}

ReportArtist::Paint ReportArtist::all_of_the_case() const {
  if (cut_ == 0) return {};
  return [this](const surface::Vertex& vertex) -> volume::TissueId {
    const scoring::Shown& shown = scored_.score.shown;
    const Vec3 p = vertex.p.cast<double>();
    const bool fresh = is_new(vertex);
    const double kept = shown.keep ? shown.keep(p) : -1;
    if (fresh && kept > kExcess) return excess_;
    if (kept < 0 && shown.remove && shown.remove(p) > kMissed) return missed_;
    return fresh ? cut_ : volume::TissueId{0};
  };
}

Result<ReportPicture> ReportArtist::drawn(int width, int height, std::string caption) {
  const auto image = renderer_->image(scene_, width, height);
  if (!image) return image.error();
  return as_picture(*image, std::move(caption));
}

// Puts the camera at a side of what was removed.
void ReportArtist::aim(const ProductView& side) {
  scene_.camera = side.camera;
  scene_.burr.visible = false;
  scene_.markers.clear();
}

Result<ReportPicture> ReportArtist::side(std::size_t which) {
  static constexpr std::array<Word, kSides> kNames = {Word::report_straight, Word::report_below,
                                                      Word::report_left, Word::report_right};
  if (which == 0) paint(all_of_the_case(), scored_.score.shown.remove);
  aim(sides_[which]);
  return drawn(kViewWide, kViewHigh, word(kNames[which]) + wide_words(sides_[which].wide()));
}

Result<std::vector<ReportArtist::Plain>> ReportArtist::plain() {
  std::vector<Plain> out;
  for (const ProductView& view : sides_) {
    if (!view.slice) {
      aim(view);
      auto picture = drawn(kViewWide, kViewHigh, "");
      if (!picture) return picture.error();
      out.push_back({view.name, view.wide(), std::move(*picture)});
      continue;
    }
    render::Image image{kViewWide, kViewHigh, {}};
    while (!slicer_->draw(*view.slice, image)) {
    }
    auto picture = as_picture(image, "");
    if (!picture) return picture.error();
    out.push_back({view.name, view.wide(), std::move(*picture)});
  }
  return out;
}

Result<ReportPicture> ReportArtist::map_of(const std::vector<Spot>& spots, std::string caption) {
  math::Aabb box;
  for (const Spot& spot : spots) box.extend(spot.at);
  const double height = std::clamp(1.5 * box.extent().maxCoeff() + 6e-3, 14e-3, 60e-3);
  scene_.camera = camera_from(towards_, box.centre(), height);
  scene_.markers.clear();
  for (const Spot& spot : spots) {
    const Colour colour = spot.kind == Spot::Kind::good   ? kGoodColour
                          : spot.kind == Spot::Kind::left ? kLeftColour
                                                          : kBareColour;
    scene_.markers.push_back({spot.at, std::max(0.25e-3, height / 90), colour, true});
  }
  auto made = drawn(kProofWide, kProofHigh,
                    std::move(caption) + wide_words(height * kProofWide / kProofHigh));
  scene_.markers.clear();
  return made;
}

// Voxels of the region: bone that stands where it should go, or is gone where it should stay.
std::vector<Spot> ReportArtist::faults_in(const metrics::Region& region, bool keep) const {
  const volume::Bone &before = *scored_.before, &after = *scored_.after;
  const volume::Grid& grid = before.grid();
  const double half = 0.5 * std::sqrt(3.0) * volume::kBrickEdge * grid.voxel;
  std::vector<Spot> all;
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const volume::Field *was = before.brick_field(brick), *is = after.brick_field(brick);
    if (was == nullptr) continue;
    const math::Ijk first = before.brick_ijk(brick);
    const Vec3 middle = first.cast<double>() + Vec3::Constant(0.5 * (volume::kBrickEdge - 1));
    if (region(grid.world_from_grid(middle)) < -half) continue;
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      const bool gone = is == nullptr || is[v] < volume::kIso;
      if (was[v] < volume::kIso || gone != keep) continue;
      const math::Ijk ijk = first + math::Ijk(v & 7, (v >> 3) & 7, v >> 6);
      const Vec3 p = grid.world_from_grid(ijk.cast<double>());
      if (region(p) > (keep ? 0 : kMissed))
        all.push_back({p, keep ? Spot::Kind::bare : Spot::Kind::left});
    }
  }
  std::vector<Spot> some;
  const std::size_t every = all.size() / scoring::kMostSpots + 1;
  for (std::size_t n = 0; n < all.size(); n += every) some.push_back(all[n]);
  return some;
}

Result<ReportPicture> ReportArtist::section_at(const Vec3& at, double ring, std::string caption) {
  render::Slice slice;
  double least = 2;
  for (const render::Plane plane :
       {render::Plane::axial, render::Plane::coronal, render::Plane::sagittal}) {
    const double across =
        std::abs(render::right_of(plane).cross(render::up_of(plane)).dot(towards_));
    if (across >= least - 1e-9) continue;
    least = across;
    slice.plane = plane;
  }
  slice.through = at;
  slice.height = kSectionHigh;
  render::Image image{kProofWide, kProofHigh, {}};
  while (!slicer_->draw(slice, image)) {
  }
  draw_ring(image, slice, at, ring);
  return as_picture(image, std::move(caption) + wide_words(kSectionHigh * kProofWide / kProofHigh));
}

// The bone and the burr at the tick of the evidence.
Status ReportArtist::moment_of(const scoring::Outcome& outcome, std::size_t room,
                               std::vector<ReportPicture>& out) {
  record::Player& player = *scored_.judged.player;
  const double t = static_cast<double>(*outcome.tick) / player.info().rate_hz;
  if (const Status there = player.bone_at(t, *scored_.after); !there) return there;
  worker_->settle([&](const surface::Skin& skin) {
    plain_[static_cast<std::size_t>(skin.patch)] = *skin.mesh;
    render::set_patch(scene_, skin.patch, *skin.mesh);
  });
  const auto step = player.step_at(t);
  if (!step) return step.error();
  const tick::TickRow* tick = &step->row;
  const record::View* seen = nullptr;
  for (const record::View& view : views_)
    if (view.tick <= *outcome.tick) seen = &view;
  const Vec3& tip = tick->contact.proxy;
  constexpr double kAspect = static_cast<double>(kProofWide) / kProofHigh;
  scene_.camera = seen != nullptr
                      ? camera_of(*seen, tip, kAspect)
                      : render::view_of_work(tip, towards_, 8 * tick->tool.radius + 10e-3);
  workshop::put_tool(scene_, *tick, true);
  if (looks_.empty()) looks_ = workshop::ToolLooks(player.info().tools);
  looks_.put(scene_, tick->tool.number);
  const tool::Tool* other = record::tool_of(player.info().second);
  second_.put(scene_, step->second ? &*step->second : nullptr, other);
  const auto piece = pieces_->at(*tick, t, *scored_.after);
  if (!piece) return piece.error();
  piece_.put(scene_, piece->mesh, piece->by, scored_.after->tissues().tissues.size());
  auto view = drawn(kProofWide, kProofHigh,
                    word(seen != nullptr ? Word::report_as_seen : Word::report_from_outside));
  scene_.burr.visible = false;
  scene_.markers.clear();
  scene_.rods.clear();
  second_.put(scene_, nullptr, other);
  piece_.take_away(scene_);
  if (!view) return view.error();
  out.push_back(std::move(*view));
  if (room < 2) return fine();
  auto section = section_at(tip, tick->tool.radius, word(Word::report_cut_open));
  if (!section) return section.error();
  out.push_back(std::move(*section));
  return fine();
}

// A picture that needs the bone at the end only; none: there is nothing to see.
Result<std::optional<ReportPicture>> ReportArtist::still_of(const scoring::Item& item,
                                                            const scoring::Outcome& outcome) {
  const std::string_view how = item.how->name;
  const auto region = scored_.score.shown.regions.find(item.region);
  const bool of_a_region =
      (how == "removed" || how == "kept") && region != scored_.score.shown.regions.end();
  const std::vector<Spot> faults =
      of_a_region ? faults_in(region->second, how == "kept") : std::vector<Spot>{};
  std::optional<Result<ReportPicture>> made;
  if (!faults.empty())
    made = map_of(faults, word(Word::report_region));
  else if (!outcome.spots.empty())
    made = map_of(outcome.spots, word(Word::report_map));
  else if (outcome.place)
    made = section_at(*outcome.place, 0.6e-3, word(Word::report_cut_open));
  if (!made) return std::optional<ReportPicture>{};
  if (!*made) return made->error();
  return std::optional<ReportPicture>(std::move(**made));
}

Result<ReportArtist::Pictures> ReportArtist::evidence(std::span<const std::size_t> items,
                                                      std::size_t most) {
  Pictures made;
  std::size_t room = most;
  std::vector<std::pair<std::size_t, std::size_t>> moments;  // item, room for it
  paint({}, {});
  for (const std::size_t n : items) {
    if (room == 0) break;
    const scoring::Outcome& outcome = scored_.score.outcomes[n];
    if (outcome.tick) {
      moments.emplace_back(n, std::min<std::size_t>(room, 2));
      room -= moments.back().second;
      continue;
    }
    auto one = still_of(scored_.judged.rubric.items[n], outcome);
    if (!one) return one.error();
    if (!*one) continue;
    made[n].push_back(std::move(**one));
    --room;
  }
  std::sort(moments.begin(), moments.end(), [&](const auto& a, const auto& b) {
    return *scored_.score.outcomes[a.first].tick < *scored_.score.outcomes[b.first].tick;
  });
  for (const auto& [n, space] : moments)
    if (const Status shown = moment_of(scored_.score.outcomes[n], space, made[n]); !shown)
      return shown.error();
  return made;
}

}  // namespace burr::report

#include "burr/tick/touch_methods.h"

#include <algorithm>
#include <cmath>

namespace burr::tick {
namespace {

using haptics::Method;
using math::Vec3;

constexpr double kAround = 3e-3;  // of triangles beyond the burr: how far it goes in a frame [m]
constexpr double kShallow = 0.5;  // in bone, from which ours comes out by itself         [voxel]

}  // namespace

TouchMethods::TouchMethods(const volume::IsoVertices& surface,
                           const haptics::ProxySettings& settings, Method first,
                           const std::vector<tool::ShapedTool>* tools, int number,
                           std::unique_ptr<surface::Mesher> mesher)
    : surface_(surface),
      bone_(surface.bone()),
      radius_(settings.radius),
      method_(first),
      tools_(tools),
      number_(number),
      mesher_(mesher ? std::move(mesher) : std::make_unique<surface::Mesher>(bone_)) {
  for (int n = 0; n < haptics::kMethods; ++n)
    all_[static_cast<std::size_t>(n)] =
        haptics::make_method(static_cast<Method>(n), surface, settings, Vec3::Zero());
  constraint_ = static_cast<haptics::Proxy*>(all_[index(Method::constraint)].get());
  triangles_ = static_cast<haptics::TriangleProxy*>(all_[index(Method::triangles)].get());
  shaft_ = static_cast<haptics::ShaftTouch*>(all_[index(Method::shaft)].get());
  if (tools != nullptr && !tools->empty())
    tool_ = std::make_unique<haptics::ToolTouch>(
        surface, (*tools)[static_cast<std::size_t>(std::max(0, number))].tool, settings,
        haptics::ShaftTouch::kLever, math::Pose{nowhere(), math::Quat::Identity()});
  // what a patch can have at most: a vertex on each edge of its cells, five triangles a cell
  constexpr std::size_t kEdge = surface::kPatchEdge;
  patch_.vertices.reserve(3 * kEdge * (kEdge + 1) * (kEdge + 1));
  patch_.triangles.reserve(15 * kEdge * kEdge * kEdge);
}

bool TouchMethods::choose(Method method) BURR_RT {
  const Vec3 at = now().position();
  method_ = method;
  if (number_ >= 0) return true;  // for the burr, when it is in the hand again
  now().place(at);
  return can_begin(at);
}

bool TouchMethods::can_begin(const Vec3& at) BURR_RT {
  if (!haptics::begins_free(method_) || constraint_->is_free(at)) return true;
  // a hair in bone it comes out by itself, as from bone that grew under it
  const bool shallow =
      constraint_->set_radius(radius_ - kShallow * bone_.grid().voxel) && constraint_->is_free(at);
  constraint_->place(nowhere());
  static_cast<void>(constraint_->set_radius(radius_));
  constraint_->place(at);
  return shallow;
}

bool TouchMethods::take(int number) BURR_RT {
  const math::Pose at =
      number_ < 0 ? math::Pose{now().position(), math::Quat::Identity()} : tool_->pose();
  number_ = number;
  if (number < 0) {
    now().place(at.p);
    return can_begin(at.p);
  }
  tool_->take((*tools_)[static_cast<std::size_t>(number)].tool);
  tool_->place(at);
  return false;  // as the hand turns it, only the next tick knows
}

void TouchMethods::set_max_moves(int moves) BURR_RT {
  constraint_->set_max_moves(moves);
  shaft_->set_max_moves(moves);
  if (tool_) tool_->set_max_moves(moves);
}

void TouchMethods::couple(double lever) BURR_RT {
  shaft_->couple(lever);
  if (tool_) tool_->couple(lever);
}

Vec3 TouchMethods::nowhere() const BURR_RT {
  return bone_.grid().world_from_grid(Vec3::Constant(-1e4));
}

bool TouchMethods::set_radius(double radius) BURR_RT {
  if (!now().set_radius(radius)) return false;
  for (auto& one : all_) {
    if (one.get() == &now()) continue;
    one->place(nowhere());
    static_cast<void>(one->set_radius(radius));
  }
  radius_ = radius;
  return true;
}

void TouchMethods::show(std::uint64_t tick) BURR_RT {
  if (method_ != Method::triangles) return;
  const std::uint64_t in_frame = tick % kFrame;
  if (in_frame == 0 && surface_.revision() != shown_) triangles_->clear();
  if (in_frame != 1 && (in_frame == 0 || triangles_->size() > 0)) return;
  shown_ = surface_.revision();
  triangles_->clear();
  const volume::Grid& grid = bone_.grid();
  const Vec3 centre = grid.grid_from_world(triangles_->position());
  const double reach = (radius_ + kAround) / grid.voxel;
  const math::Ijk patches = mesher_->patches();
  math::Ijk lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    // patch p: between voxels 16 p - 1 and 16 p + 15
    const auto at = [&](double voxel) {
      return static_cast<int>(std::floor((voxel + 1) / surface::kPatchEdge));
    };
    lo[axis] = std::max(0, at(centre[axis] - reach));
    hi[axis] = std::min(patches[axis] - 1, at(centre[axis] + reach));
  }
  for (int k = lo.z(); k <= hi.z(); ++k)
    for (int j = lo.y(); j <= hi.y(); ++j)
      for (int i = lo.x(); i <= hi.x(); ++i) {
        const int patch = i + patches.x() * (j + patches.y() * k);
        if (!mesher_->mesh_patch(patch, patch_)) continue;
        const auto corner = [&](std::size_t n) -> const math::Vec3f& {
          return patch_.vertices[patch_.triangles[n]].p;
        };
        for (std::size_t n = 0; n + 2 < patch_.triangles.size(); n += 3)
          if (!triangles_->add({corner(n), corner(n + 1), corner(n + 2)})) return;
      }
}

}  // namespace burr::tick

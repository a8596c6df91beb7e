// make_method() of haptics/touch_method.h: the one place that knows every method.
#include "burr/haptics/baselines/penalty.h"
#include "burr/haptics/baselines/sample_method.h"
#include "burr/haptics/baselines/thesis_method.h"
#include "burr/haptics/baselines/triangles.h"
#include "burr/haptics/baselines/voxel_springs.h"
#include "burr/haptics/proxy.h"
#include "burr/haptics/six/shaft_touch.h"
#include "burr/haptics/touch_method.h"

namespace burr::haptics {

std::unique_ptr<TouchMethod> make_method(Method method, const volume::IsoVertices& surface,
                                         const ProxySettings& settings, const math::Vec3& hand) {
  const volume::Bone& bone = surface.bone();
  switch (method) {
    case Method::constraint:
      break;
    case Method::thesis:
      return std::make_unique<ThesisProxy>(bone, settings, hand, false);
    case Method::thesis_literal:
      return std::make_unique<ThesisProxy>(bone, settings, hand, true);
    case Method::voxel_springs:
      return std::make_unique<VoxelSprings>(bone, settings, hand);
    case Method::samples:
      return std::make_unique<SampleProxy>(bone, settings, hand);
    case Method::triangles:
      return std::make_unique<TriangleProxy>(bone.grid().voxel, settings, hand);
    case Method::penalty:
      return std::make_unique<PenaltyProxy>(bone, settings, hand);
    case Method::shaft:
      return std::make_unique<ShaftTouch>(surface, settings, hand);
  }
  return std::make_unique<Proxy>(surface, settings, hand);
}

}  // namespace burr::haptics

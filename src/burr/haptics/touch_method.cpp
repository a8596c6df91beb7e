#include "burr/haptics/touch_method.h"

namespace burr::haptics {

std::optional<Method> method_named(std::string_view name) {
  for (std::size_t n = 0; n < kMethodNames.size(); ++n)
    if (kMethodNames[n] == name) return static_cast<Method>(n);
  return std::nullopt;
}

Touch TouchMethod::felt(const SixTouch&, const math::Pose&) BURR_RT { return {}; }

}  // namespace burr::haptics

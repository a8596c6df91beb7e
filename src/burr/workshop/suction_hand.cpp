#include "burr/workshop/suction_hand.h"
#include "burr/tick/second_hand.h"

#include <algorithm>
#include <utility>

namespace burr::workshop {

Result<std::unique_ptr<SuctionHand>> SuctionHand::add(sim::Session& session,
                                                      const std::string& device,
                                                      const math::Pose& start,
                                                      const math::Quat& world_from_view,
                                                      std::optional<tool::ShapedTool> tool) {
  HandRequest request;
  request.device = device;
  auto laid = open_hand(request, start, world_from_view);
  if (!laid) return laid.error();
  device::MappedHand& hand = *laid->hand;
  tick::SecondHandSettings settings;
  settings.radius = kRadius;
  settings.tool = std::move(tool);
  settings.force = session.settings().servo.force;
  settings.limit.user_force = laid->max_force;
  const Status joined = session.add_second_hand(std::move(laid->hand), settings);
  if (!joined) return joined.error();
  return std::unique_ptr<SuctionHand>(new SuctionHand(session, hand));
}

const tick::TickRow& SuctionHand::now() {
  static_cast<void>(session_.second_hand()->view().take(row_));
  return row_;
}

const tool::Tool* SuctionHand::tool() const {
  const auto& tool = session_.second_hand()->settings().tool;
  return tool ? &tool->tool : nullptr;
}

}  // namespace burr::workshop

#include "suction_hand.h"

#include <utility>

namespace burr::app {

SuctionHand::SuctionHand(std::unique_ptr<device::MappedHand> hand) : hand_(std::move(hand)) {
  thread_ = std::make_unique<rt::Thread>(
      rt::ThreadWish{.name = "suction", .realtime = true, .priority = 70}, [this] {
        const double rate = tick_rate(hand_->spec());
        rt::WallClock wall(rate);
        rt::TickClock* own = hand_->clock(rate);
        rt::TickClock& clock = own != nullptr ? *own : wall;
        while (!stop_.load(std::memory_order_relaxed)) {
          static_cast<void>(clock.wait());
          const device::HandState read = hand_->state(1 / rate);
          hand_->write_force(math::Vec3::Zero());
          told_.publish({read.world_from_tool, read.valid,
                         read.valid && (read.buttons & device::kLifted) == 0 && read.pedal <= 0});
        }
      });
}

SuctionHand::~SuctionHand() {
  stop_ = true;
  thread_->join();
  hand_->close();
}

Result<std::unique_ptr<SuctionHand>> SuctionHand::open(const std::string& device,
                                                       const math::Pose& start,
                                                       const math::Quat& world_from_view) {
  HandWish wish;
  wish.device = device;
  auto laid = lay_hand(wish, start, world_from_view);
  if (!laid) return laid.error();
  return std::unique_ptr<SuctionHand>(new SuctionHand(std::move(laid->hand)));
}

SuctionHand::Seen SuctionHand::now() {
  static_cast<void>(told_.take(seen_));
  return seen_;
}

}  // namespace burr::app

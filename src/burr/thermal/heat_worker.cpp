#include "burr/thermal/heat_worker.h"

#include <chrono>
#include <thread>

namespace burr::thermal {
namespace {

constexpr auto kLook = std::chrono::milliseconds(5);  // well below a step, and almost no load

}  // namespace

Worker::Worker(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings,
               std::size_t rows)
    : heating_(bone, work, settings), rows_(rows), thread_({.name = "heat"}, [this] { run(); }) {}

Worker::~Worker() {
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
}

void Worker::run() {
  while (!stop_.load(std::memory_order_relaxed)) {
    HeatRow row;
    if (!rows_.pop(row)) {
      std::this_thread::sleep_for(kLook);
      continue;
    }
    if (heating_.take(row)) summary_.publish(heating_.summary());
    worked_.fetch_add(1, std::memory_order_release);
  }
}

void Worker::settle() const {
  const std::uint64_t all = pushed_.load(std::memory_order_acquire);
  while (worked_.load(std::memory_order_acquire) < all)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace burr::thermal

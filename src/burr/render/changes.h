// render/changes.h - lists the patches of a scene that changed last, so that a copy can be updated
// without a look at all patches: a fine scan has some ten thousand.
//
//     if (!scene.changes.since(known, look_at)) look_at_all();
//     known = scene.changes.newest();
//
// The numbers of changes are unique over all scenes of the program, so a number belongs to one
// history. For a number of another scene, or of a scene that changed after it was copied, since()
// returns false.
// Thread: that of its scene.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

namespace burr::render {

class Changes {
 public:
  void add(int patch) {
    if (log_.size() == kKept)
      log_.erase(log_.begin(), log_.begin() + static_cast<std::ptrdiff_t>(kKept / 2));
    log_.push_back({next_number(), patch});
  }

  [[nodiscard]] std::uint64_t newest() const { return log_.empty() ? 0 : log_.back().number; }

  // Visits every patch that changed after `known`, an earlier newest(); a patch that changed twice
  // comes twice. False: `known` is too old or belongs to another scene; nothing was visited.
  template <class Visit>
  [[nodiscard]] bool since(std::uint64_t known, const Visit& visit) const {
    const auto at = std::ranges::lower_bound(log_, known, {}, &One::number);
    if (at == log_.end() || at->number != known) return false;
    for (auto next = at + 1; next != log_.end(); ++next) visit(next->patch);
    return true;
  }

 private:
  static constexpr std::size_t kKept = 4096;
  struct One {
    std::uint64_t number = 0;
    int patch = 0;
  };
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> count = 0;
    return ++count;
  }
  std::vector<One> log_;
};

}  // namespace burr::render

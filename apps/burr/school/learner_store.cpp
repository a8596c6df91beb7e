#include "school/learner_store.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <ctime>

#include "school/store_command.h"
#include "shared/counted.h"
#include "shared/front_words.h"

namespace burr::app {

std::string day_of(std::int64_t ms) {
  const auto seconds = static_cast<std::time_t>(ms / 1000);
  std::tm local = {};
  localtime_r(&seconds, &local);
  return fmt::format("{:%Y-%m-%d}", local);
}

void say_others(const school::TakenIn& in) {
  if (in.others > 0)
    fmt::print(stderr, "{} here for other stores\n",
               in.others == 1 ? "1 session waits" : fmt::format("{} sessions wait", in.others));
}

Result<std::unique_ptr<school::Store>> open_store(const LearnerOptions& options, MakeStore make) {
  const auto where = store_place(options.store);
  if (!where) return where.error();
  if (make == MakeStore::no)
    if (const Status there = check_store_is_there(*where); !there) return there.error();
  auto store = school::Store::open(*where);
  if (!store) return store.error();
  print_notices((*store)->notices());
  if ((*store)->reads_only()) return store;
  const school::TakenIn in = school::take_in(**store, {});
  print_notices(in.notices);
  if (in.taken > 0)
    fmt::print(stderr, "{} that waited came into the store\n", counted(in.taken, "session"));
  if (in.unscored > 0)
    fmt::print(
        stderr, "{} to be scored; run `burr learner take-in`\n",
        in.unscored == 1 ? "1 recording waits" : fmt::format("{} recordings wait", in.unscored));
  say_others(in);
  return store;
}

}  // namespace burr::app

#include "school/store_command.h"

#include <fmt/core.h>

#include <filesystem>
#include <system_error>

#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "shared/front_words.h"
#include "shared/json_line.h"

namespace burr::app {

Result<school::StorePlace> store_place(const std::string& given) {
  return school::place_of(given, users_places());
}

Status check_store_is_there(const school::StorePlace& place) {
  std::error_code nobody_asks;
  if (place.address.find("://") != std::string::npos ||
      std::filesystem::exists(place.address, nobody_asks))
    return fine();
  return error(Trouble::usage,
               fmt::format("there is no store at {}; make one with `burr learner add`, or name one "
                           "with --store",
                           base::printable(place.address, 300)));
}

Result<std::unique_ptr<school::Store>> store_that_is_there(const std::string& given) {
  const auto place = store_place(given);
  if (!place) return place.error();
  if (const Status there = check_store_is_there(*place); !there) return there.error();
  auto store = school::Store::open(*place);
  if (!store) return store.error();
  print_notices((*store)->notices());
  return store;
}

void add_store_option(CLI::App& command, std::string& store) {
  command.add_option("--store", store,
                     "a file, or postgresql://... (default: BURR_STORE, or school.sqlite in burr's "
                     "data folder)");
}

void print_json(bool wanted, const nlohmann::ordered_json& json) {
  if (wanted) fmt::print("{}\n", json_line(json));
}

}  // namespace burr::app

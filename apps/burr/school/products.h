// apps/burr/school/products.h - what a rater is given to mark: the queue, a product's recording, and its items. The command
// line, the instructor's page and the window ask here, so that all three hold the same queue and show the same items; what
// is marked goes through school::mark().
//
// Nothing here says whose a product is, when it was made, or what the machine thinks of it. Thread: as the Store. Errors: one
// sentence that names no learner and no file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/ratings.h"
#include "burr/school/store.h"

namespace burr::app {

// school::to_mark(), of which the recording is on this computer; of how many more it is not.
struct ProductQueue {
  std::vector<school::Product> here;
  std::size_t elsewhere = 0;
};
[[nodiscard]] Result<ProductQueue> products_here(school::Store& store, const std::string& rater,
                                                 const std::string& rubric_hash,
                                                 std::uint64_t seed);

// The recording of a session, on this computer and with the SHA-1 that it had when it came into the store.
[[nodiscard]] Result<std::string> recording_of(school::Store& store, const std::string& session);

// The items that a rater marks on a product. Items of the process are left out, since a finished product does not show how it was made.
struct ProductItem {
  std::string id;
  std::map<std::string, std::string>
      say;  // by language; empty where the rubric cannot be read any more
  [[nodiscard]] std::string in(
      const std::string& language) const;  // otherwise English, otherwise the id
};
[[nodiscard]] Result<std::vector<ProductItem>> product_items(school::Store& store,
                                                             const std::string& session,
                                                             const std::string& rubric_hash);

}  // namespace burr::app

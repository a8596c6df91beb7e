#include "school/products.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "burr/base/printable.h"
#include "burr/school/forget.h"
#include "burr/school/sessions.h"
#include "burr/school/uuid.h"
#include "burr/scoring/rubric.h"

namespace burr::app {

Result<ProductQueue> products_here(school::Store& store, const std::string& rater,
                                   const std::string& rubric_hash, std::uint64_t seed) {
  auto queue = school::to_mark(store, rater, rubric_hash, seed);
  if (!queue) return queue.error();
  ProductQueue out;
  std::error_code nobody_asks;
  for (school::Product& one : *queue)
    if (const std::string path = school::path_of(one.recording_uri);
        !path.empty() && std::filesystem::exists(path, nobody_asks))
      out.here.push_back(std::move(one));
  out.elsewhere = queue->size() - out.here.size();
  return out;
}

Result<std::string> recording_of(school::Store& store, const std::string& session) {
  const auto found = store.database().rows(
      "SELECT recording_uri, recording_hash FROM session WHERE id = $1", {session});
  if (!found) return found.error();
  if (found->empty())
    return error(Trouble::usage,
                 fmt::format("{}: there is no such session", base::printable(session)));
  // its name may name the learner, so no sentence does
  const std::string path = school::path_of(school::text((*found)[0][0]));
  if (path.empty())
    return error(Trouble::io, "the recording of this session is on another computer");
  const auto hash = school::sha1_of_file(path);
  if (!hash || *hash != school::text((*found)[0][1]))
    return error(Trouble::io,
                 "the recording of this session is not there any more, or was changed");
  return path;
}

std::string ProductItem::in(const std::string& language) const {
  for (const std::string& code : {language, std::string("en")})
    if (const auto found = say.find(code); found != say.end() && !found->second.empty())
      return found->second;
  return id;
}

Result<std::vector<ProductItem>> product_items(school::Store& store, const std::string& session,
                                               const std::string& rubric_hash) {
  const auto items = school::items_of(store, session);
  if (!items) return items.error();
  const auto text = store.database().rows("SELECT text FROM rubric WHERE hash = $1", {rubric_hash});
  if (!text) return text.error();
  const auto rubric =
      scoring::parse_rubric(text->empty() ? std::string() : school::text((*text)[0][0]), "rubric");
  std::vector<ProductItem> all;
  for (const school::ItemRow& one : *items) {
    if (one.part != "product") continue;
    ProductItem& made = all.emplace_back(ProductItem{one.id, {}});
    if (const scoring::Item* item = rubric ? rubric->item(one.id) : nullptr; item != nullptr)
      made.say = {item->say.by_language.begin(), item->say.by_language.end()};
  }
  return all;
}

}  // namespace burr::app

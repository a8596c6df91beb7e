#include "serve/product_pictures.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

PictureDesk::~PictureDesk() {
  drawing_.reset();  // it is stopped before its folder goes
  std::error_code nobody_asks;
  if (!folder_.empty()) fs::remove_all(folder_, nobody_asks);
}

void PictureDesk::want(const std::string& session, bool first) {
  if (drawn_ != session && of(session) == nullptr &&
      std::find(waiting_.begin(), waiting_.end(), session) == waiting_.end()) {
    if (first)
      waiting_.push_front(session);
    else
      waiting_.push_back(session);
    while (waiting_.size() > kMostKept / 2) waiting_.pop_back();
  }
  go_on();
}

const ProductPictures* PictureDesk::of(const std::string& session) {
  go_on();
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& one) { return one.session == session; });
  return found == kept_.end() ? nullptr : &*found;
}

void PictureDesk::go_on() {
  if (drawing_ && drawing_->ended()) collect();
  if (drawing_ || waiting_.empty()) return;
  drawn_ = waiting_.front();
  waiting_.pop_front();
  if (folder_.empty()) {
    std::string name = (fs::temp_directory_path() / "burr-marking-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) folder_ = name;  // for this user alone
  }
  // the store's address may hold a password: it is in the environment, not on the command line
  if (!folder_.empty())
    drawing_ = std::make_unique<HelperProcess>(
        std::vector<std::string>{burr_itself(), "--quiet", "rate", "--session", drawn_,
                                 "--pictures", (folder_ / "now").string()});
  if (!drawing_ || !drawing_->began()) {
    kept_.push_front({drawn_, {}, "the pictures cannot be drawn on this computer"});
    drawing_.reset();
    drawn_.clear();
  }
}

void PictureDesk::collect() {
  ProductPictures made{drawn_, {}, {}};
  const fs::path now = folder_ / "now";
  if (drawing_->fine()) {
    const auto list = nlohmann::json::parse(bytes_of(now / "pictures.json"), nullptr, false);
    if (list.is_array())
      for (const auto& one : list) {
        const std::string name = one.value("name", "");
        made.pictures.push_back({name, one.value("wide_mm", 0.0), one.value("width", 0),
                                 one.value("height", 0), bytes_of(now / (name + ".png"))});
      }
    if (made.pictures.empty()) made.trouble = "the pictures cannot be drawn on this computer";
  } else {
    made.trouble = drawing_->complaint("the pictures cannot be drawn on this computer");
  }
  std::error_code nobody_asks;
  fs::remove_all(now, nobody_asks);
  drawing_.reset();
  drawn_.clear();
  kept_.push_front(std::move(made));
  while (kept_.size() > kMostKept) kept_.pop_back();
}

}  // namespace burr::app

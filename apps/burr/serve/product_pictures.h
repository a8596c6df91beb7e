// apps/burr/serve/product_pictures.h - pictures of a session's product, drawn by another burr, so that the server goes on
// answering meanwhile: seconds of scoring and drawing each.
//
//     pictures.want(session);                          // again on each request, until they are there
//     if (const auto* set = pictures.of(session)) ...
//
// One is drawn at a time, the one that was wanted last first. The files lie in a folder that only this user can read, and
// only until they are in memory; the last kMostKept sets are kept. Thread: one.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "shared/helper_process.h"

namespace burr::app {

struct ProductPicture {
  std::string name;    // "straight", "axial-1"; ReportArtist::Plain
  double wide_mm = 0;  // from left to right
  int width = 0, height = 0;
  std::string png;
};

struct ProductPictures {
  std::string session;
  std::vector<ProductPicture> pictures;
  std::string trouble;  // a sentence; empty: they are there
};

class PictureDesk {
 public:
  static constexpr std::size_t kMostKept = 8;

  PictureDesk() = default;
  ~PictureDesk();
  PictureDesk(const PictureDesk&) = delete;
  PictureDesk& operator=(const PictureDesk&) = delete;

  // first: before all that wait.
  void want(const std::string& session, bool first = true);
  // nullptr: not yet.
  [[nodiscard]] const ProductPictures* of(const std::string& session);

 private:
  void go_on();
  void collect();

  std::filesystem::path folder_;
  std::unique_ptr<HelperProcess> drawing_;
  std::string drawn_;  // the session that is being drawn
  std::deque<std::string> waiting_;
  std::deque<ProductPictures> kept_;  // the newest first
};

}  // namespace burr::app

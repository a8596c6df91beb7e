// shared/page_source.h - where the page comes from that somebody wants to put on a host: a folder, an archive, what came with this program, or
// the sources of burr, where the program still lies beside them.
//
// Thread: one.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/result.h"
#include "shared/built_page.h"

namespace burr::app {

class PageSource {
 public:
  PageSource() = default;
  PageSource(const PageSource&) = delete;
  PageSource& operator=(const PageSource&) = delete;
  ~PageSource();  // removes what was unpacked

  // from: a folder, or an archive burr-web-VERSION.tar.gz; empty: what came with this program, and where nothing came, it is built, which
  // takes minutes and says how far it is. The files stay as long as this object.
  [[nodiscard]] Result<BuiltPage> open(const std::string& from);

 private:
  [[nodiscard]] Result<BuiltPage> unpack(const std::string& archive);
  std::filesystem::path unpacked_;
};

}  // namespace burr::app

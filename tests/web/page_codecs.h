// tests/web/page_codecs.h - asks the codecs of the page: node runs tests/web/page_codecs.mjs with what lies in the built site.
//
// The environment names the site, as BURR_SITE; scripts/checks/page.sh sets it. Throws if node does not answer.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/folder.h"
#include "support/test_places.h"

namespace burr::web {

using Bytes = std::vector<std::uint8_t>;

// The names of web/pages/common/codecs.mjs, in the order of page_codecs.mjs.
enum class Codec : std::uint32_t { zstd, jpeg_ls, jpeg_2000 };

struct Asked {
  Codec codec;
  std::uint32_t columns, rows;  // of zstd: the size, and 0
  Bytes bytes;
};
struct Answer {
  bool good = false;
  Bytes bytes;
  // of a picture
  [[nodiscard]] std::vector<std::int32_t> values() const {
    std::vector<std::int32_t> all(bytes.size() / 4);
    if (!all.empty()) std::memcpy(all.data(), bytes.data(), 4 * all.size());
    return all;
  }
};

inline const char* site_of_page() { return std::getenv("BURR_SITE"); }

// Unpacks each of `all` in the page's codecs, by node; the answers are in the same order.
inline std::vector<Answer> ask_page(const std::vector<Asked>& all) {
  const test::Folder folder;
  const std::string asked = folder / "asked", answered = folder / "answered";
  {
    std::ofstream out(asked, std::ios::binary);
    const auto put = [&](std::uint32_t number) {
      out.write(reinterpret_cast<const char*>(&number), 4);
    };
    for (const Asked& one : all) {
      put(static_cast<std::uint32_t>(one.codec));
      put(one.columns);
      put(one.rows);
      put(static_cast<std::uint32_t>(one.bytes.size()));
      out.write(reinterpret_cast<const char*>(one.bytes.data()),
                static_cast<std::streamsize>(one.bytes.size()));
    }
  }
  const std::string call = "node '" + test::source_dir() + "/tests/web/page_codecs.mjs' '" +
                           site_of_page() + "' '" + asked + "' '" + answered + "'";
  if (std::system(call.c_str()) != 0) throw std::runtime_error("failed: " + call);
  std::ifstream in(answered, std::ios::binary);
  const Bytes got{std::istreambuf_iterator<char>(in), {}};
  std::vector<Answer> answers;
  for (std::size_t at = 0; at + 4 <= got.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, &got[at], 4);
    at += 4;
    Answer answer;
    answer.good = size != UINT32_MAX;
    if (answer.good) {
      const auto begin = got.begin() + static_cast<std::ptrdiff_t>(at);
      answer.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
      at += size;
    }
    answers.push_back(std::move(answer));
  }
  if (answers.size() != all.size()) throw std::runtime_error("answers are missing: " + call);
  return answers;
}

}  // namespace burr::web

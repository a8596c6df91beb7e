#include "burr/scenario/read_texts.h"

#include <string>

namespace burr::scenario {

void read_texts(Reader& reader, std::string_view key, Texts& out, bool needed) {
  if (reader.is_table(key))
    return reader.table(key, [&](Reader& inner) {
      inner.each_text([&](std::string_view language, const std::string& text) {
        if (language.size() != 2 || language[0] < 'a' || language[0] > 'z' || language[1] < 'a' ||
            language[1] > 'z')
          inner.fail(language, "is not a language; use two letters, en, sv, de");
        out.by_language[std::string(language)] = text;
      });
    });
  std::string text;
  reader.text(key, text, needed);
  if (!text.empty()) out.by_language["en"] = text;
}

}  // namespace burr::scenario

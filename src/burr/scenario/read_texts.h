// scenario/read_texts.h - a text in one language or several, for the readers of cases, tools and rubrics.
//
// Thread: any.
#pragma once

#include <string_view>

#include "burr/scenario/lesson.h"
#include "burr/scenario/toml_reader.h"

namespace burr::scenario {

// A text, or a table of texts by language: say = "...", say.en = "...".
void read_texts(Reader& reader, std::string_view key, Texts& out, bool needed = false);

}  // namespace burr::scenario

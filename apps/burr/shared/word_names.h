// apps/burr/shared/word_names.h - the texts of the room `words`, by short names: nearly every line of the window that shows
// something says one.
#pragma once

#include "burr/words/anatomy.h"
#include "burr/words/case_name.h"
#include "burr/words/words.h"

namespace burr::app {

using words::anatomy;
using words::anatomy_list;
using words::english;
using words::Language;
using words::language_of;
using words::language_of_environment;
using words::languages;
using words::name_of_case;
using words::name_of_work;
using words::place_name;
using words::say;
using words::speak;
using words::spoken;
using words::take_titles_of;
using words::Word;
using words::word;

}  // namespace burr::app

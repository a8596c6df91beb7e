// record/copy_records.h - copies what is in one recording to another one, for repair and for a session that
// goes on: damage is left out, what burr does not know comes along.
//
// Thread: as McapWriter. Errors: as McapWriter; damage is no error.
#pragma once

#include <cstddef>
#include <string_view>

#include "burr/base/result.h"
#include "burr/record/mcap/mcap_reader.h"
#include "burr/record/mcap/mcap_writer.h"

namespace burr::record {

// What stands before the chunks, but for a seal, which is about the bytes of that file alone. without: the name of
// metadata that is left out; "": none.
[[nodiscard]] Status copy_beginning(const McapReader& from, McapWriter& to,
                                    std::string_view without = "");
// One chunk with its indexes, if it is good.
[[nodiscard]] Status copy_chunk(const McapReader& from, std::size_t index, McapWriter& to);

}  // namespace burr::record

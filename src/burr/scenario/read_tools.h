// scenario/read_tools.h - reads a list of tools, [[key]], as a file of tools has it. read_tools.cpp
// holds all of rack.h that reads. For use of this room only.
//
// Thread: any.
#pragma once

#include <string>
#include <string_view>

#include "burr/scenario/rack.h"
#include "burr/scenario/toml_reader.h"

namespace burr::scenario {

// Adds them to `rack`; one of the same name takes the place of the older one.
void read_tool_list(Reader& reader, std::string_view key, const MeshReader& meshes,
                    const std::string& folder, Rack& rack);

}  // namespace burr::scenario

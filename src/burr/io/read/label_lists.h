// io/read/label_lists.h - names and colours of labels in the ways that other programs write them:
// XML and JSON in the header extension of a NIfTI file, and lists in text files. Internal to io and
// importing.
//
// The texts come from strangers' files: at most 4096 labels are taken, and what is not understood is
// passed over. Thread: any.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burr/io/scan.h"

namespace burr::io {

// <Label Key="1" Red="1" Green="0.5" Blue="0" ...><![CDATA[name]]></Label>, as Connectome Workbench
// and TotalSegmentator write it.
[[nodiscard]] std::vector<Label> labels_in_xml(std::string_view text);

// {"1": "name"}, {"1": {"name": "name"}}, {"name": 1} where all are numbers, or {"name": "name",
// "label": 1}, at any place in the JSON.
[[nodiscard]] std::vector<Label> labels_in_json(std::string_view text);

// The list of ITK-SNAP (number, red, green, blue, alpha, switches, "name"), of FreeSurfer
// and 3D Slicer (number, name, red, green, blue, alpha): one label a line, # begins a comment. Empty: it is
// neither.
[[nodiscard]] std::vector<Label> labels_in_lut(std::string_view text);

// What a code says that a label is: "Mandible SCT 91609006". Empty where it says no more than
// "tissue".
[[nodiscard]] std::string meaning_of_code(std::string_view scheme, std::string_view code,
                                          std::string_view meaning);

}  // namespace burr::io

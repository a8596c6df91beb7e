// Included before each source of the module burr_import. Sizes of files have 64 bits there, and memory 32: the readers
// compare them with the file before they take memory, and the page refuses files above 1 GB (pages/common/import.js).
#pragma once
#pragma clang diagnostic ignored "-Wshorten-64-to-32"

// web/import/left_out.h - what a page leaves out of reading scans ends the worker that reads, with a sentence.
#pragma once

namespace burr::web {

// key: of web/words; part: what stands in its gap. Throws in JavaScript; nothing in this module runs after it.
[[noreturn]] void leave_out(const char* key, const char* part);

}  // namespace burr::web

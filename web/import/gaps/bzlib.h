// A page does not unpack bzip2: whoever tries ends the reader's worker with a sentence (web/import/left_out.h).
#pragma once

#include "left_out.h"

struct bz_stream {  // NOLINT(readability-identifier-naming): bzip2's name
  char *next_in, *next_out;
  unsigned avail_in, avail_out;
};
enum { BZ_OK = 0, BZ_STREAM_END = 4 };
inline int BZ2_bzDecompressInit(bz_stream*, int, int) { burr::web::leave_out("no_bzip2", ""); }
inline int BZ2_bzDecompress(bz_stream*) { return BZ_STREAM_END; }
inline int BZ2_bzDecompressEnd(bz_stream*) { return BZ_OK; }

// io/write/dicom_seg_child.h - the side of `burr-seg` in writing a DICOM segmentation, and the form in which it is told
// what to write. For use of this room only.
//
// The job lies in memory that the caller made: 8 bytes that say how long the description is, the description (CBOR, as
// write_dicom_seg.cpp makes it), then the labels, x fastest. The file goes to the standard output. Messages are lines:
// "progress 0.5", or "error " and a sentence without its full stop. Thread: main.
#pragma once

namespace burr::io {

inline constexpr int kSegJob = 3, kSegMessages = 4;  // file descriptors that it is started with

// The whole main() of burr-seg. Returns the exit status. If a user starts the program by hand, it says so and does
// nothing.
[[nodiscard]] int write_one_segmentation();

}  // namespace burr::io

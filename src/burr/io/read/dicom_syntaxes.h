// io/read/dicom_syntaxes.h - the transfer syntaxes of DICOM (PS3.6 A): which of them burr reads, and what the
// others are called. Internal to io. Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::io {

// Why a file of this transfer syntax is not read: "its pixels are compressed as JPEG XL, which burr does
// not read (1.2.840...)". Empty: burr reads it.
[[nodiscard]] std::string why_not_read(std::string_view transfer_syntax);

// High-Throughput JPEG 2000. A decoder of JPEG 2000 tells it by the stream itself.
[[nodiscard]] bool is_high_throughput(std::string_view transfer_syntax);

}  // namespace burr::io

// In place of GDCM (gdcmImageReader.h beside this).
#pragma once

namespace gdcm {
struct Trace {
  static void DebugOff() {}
  static void WarningOff() {}
  static void ErrorOff() {}
};
}  // namespace gdcm

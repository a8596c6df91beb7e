// python/src/python_report.h - the report of a recording, made in this process.
//
// Thread: any; with pictures Python's main thread alone (python_eye.h). Reports are made one after the other: the language of the
// texts is one for the whole process.
#pragma once

#include <string>

#include "common.h"

namespace burr::python {

struct ReportWish {
  std::string recording, volume;  // volume: the scan, if burr does not find it; may be empty
  std::string out;                // .html
  std::string rubric;             // empty: the built-in one of the case
  std::string language;           // "en"
  int pictures = 0;               // at most so many
  std::string beside;             // a recording of an expert; empty: none
};
// Raises burr.Error, with the sentences of `burr report`; burr.Cancelled.
void write_report(const ReportWish& wish, Work& work);

}  // namespace burr::python

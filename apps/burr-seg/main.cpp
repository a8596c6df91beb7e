// burr-seg - writes one DICOM segmentation for burr and does nothing else, so that its library is not loaded into the
// program that runs a device (io/write/write_dicom_seg.h).
#include "burr/io/write/dicom_seg_child.h"

int main() { return burr::io::write_one_segmentation(); }

#define BURR_KERNEL avx2
#include "burr/haptics/scan_kernel.inc"

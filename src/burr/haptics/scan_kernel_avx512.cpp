#define BURR_KERNEL avx512
#include "burr/haptics/scan_kernel.inc"

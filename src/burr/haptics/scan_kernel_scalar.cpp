#define BURR_KERNEL scalar
#include "burr/haptics/scan_kernel.inc"
